#include "pipeline/compare/row_limits.hpp"

#include <fmt/format.h>

#include <cstdint>

#include "collision/audit/audit.hpp"

namespace selvedge {

int pairs_of_cloth(const Surface& cloth, const Points& x) {
  return static_cast<int>(audit(cloth, x.cast<float>().cast<double>(), {}).self_pairs.size());
}

int pairs_of_cloth(const Scene& scene, const StepReport& report, const Points& x) {
  if (!report.audit) return 0;
  if (scene.contact.self) return static_cast<int>(report.audit->self_pairs.size());
  return pairs_of_cloth(scene.surface, x);
}

StopFlag RowWatch::stop_flag() const {
  if (limits_.seconds == 0) return {};
  return [this] { return out_of_time(); };
}

bool RowWatch::goes_on(const StepReport& report, const Points& x) {
  const std::int64_t most = std::int64_t{limits_.pairs} * scene_.surface.triangles.rows();
  const int pairs = limits_.pairs > 0 ? pairs_of_cloth(scene_, report, x) : 0;
  if (pairs > most) pairs_ = pairs;
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
