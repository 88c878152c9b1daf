#include "pipeline/compare/row_limits.hpp"

#include <fmt/format.h>

#include <cstdint>

namespace selvedge {

StopFlag RowWatch::stop_flag() const {
  if (limits_.seconds == 0) return {};
  return [this] { return out_of_time(); };
}

bool RowWatch::goes_on(const StepReport& report) {
  const std::int64_t most = std::int64_t{limits_.pairs} * triangles_;
  const int pairs = report.audit ? static_cast<int>(report.audit->self_pairs.size()) : 0;
  if (limits_.pairs > 0 && pairs > most) pairs_ = pairs;
  return pairs_ == 0 && !out_of_time();
}

std::string RowWatch::trouble(int last, int frames) const {
  if (last >= frames) return {};
  if (pairs_ > 0)
    return fmt::format("ended by `limits` after frame {} of {}: {} intersecting pairs, more than {} a triangle", last,
                       frames, pairs_, limits_.pairs);
  if (out_of_time())
    return fmt::format("ended by `limits` after frame {} of {}: not done in {} s", last, frames, limits_.seconds);
  return {};
}

}  // namespace selvedge
