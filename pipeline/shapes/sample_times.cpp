#include "pipeline/shapes/sample_times.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace selvedge {
namespace {

constexpr double rounding = 1e-6;  // of times in files [frames]

}  // namespace

SampleTimes steady(std::size_t count, double fps) {
  SampleTimes times{{}, fps};
  for (std::size_t k = 0; k < count; ++k) times.at.push_back(static_cast<double>(k));
  return times;
}

SamplePlace place_of(const SampleTimes& times, double time) {
  const std::vector<double>& at = times.at;
  assert(!at.empty() && times.fps > 0);
  const double now = std::clamp(time * times.fps, at.front(), at.back());
  const auto after = std::upper_bound(at.begin(), at.end(), now);
  const auto k = static_cast<std::size_t>(after - at.begin()) - 1;
  if (after == at.end()) return {k, 0};
  return {k, (now - at[k]) / (at[k + 1] - at[k])};
}

SamplePlace steady_place(std::size_t count, double fps, double time) {
  const double now = std::clamp(time * fps, 0.0, static_cast<double>(count - 1)), whole = std::floor(now);
  return {static_cast<std::size_t>(whole), now - whole};
}

void begin_at(double time, SampleTimes& times) {
  const double later = time * times.fps - times.at.front();
  for (double& at : times.at) at += later;
}

void warn_of_begin(const std::string& noun, const std::string& cure, const SampleTimes& times,
                   std::vector<std::string>& warnings) {
  if (times.at.size() < 2 || std::abs(times.at.front()) <= rounding) return;
  if (times.first() > 0)
    warnings.push_back(
        fmt::format("{} begins at {:.4g} s, as its file says, and is held until then; {}", noun, times.first(), cure));
  else
    warnings.push_back(fmt::format("{} begins {:.4g} s before time 0, as its file says: that part is not seen; {}",
                                   noun, -times.first(), cure));
}

void warn_of_end(const std::string& noun, double last, double fps, int frames, std::vector<std::string>& warnings) {
  const double frame = std::max(last, 0.0) * fps;
  if (frame >= frames - 1 - rounding) return;  // the last sample covers its own frame
  warnings.push_back(fmt::format("{} ends at {:.4g} s: from frame {:.0f} of {} on it is held as it is then", noun, last,
                                 std::ceil(frame - rounding), frames));
}

}  // namespace selvedge
