#include "pipeline/run/progress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace selvedge {

std::string duration_text(double seconds) {
  const long whole = std::lround(std::max(0.0, seconds));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
  return fmt::format("{} h {} min", whole / 3600, whole % 3600 / 60);
}

Progress::Progress(std::ostream& stream, bool terminal)
    : stream_(stream), terminal_(terminal), interval_(terminal ? 0.1 : 5) {}

void Progress::begin(int done, int frames, const std::string& what) {
  what_ = what;
  first_ = done;
  frames_ = frames;
  started_ = shown_ = Clock::now();
}

std::string Progress::line(int index) const {
  const double elapsed = seconds_since(started_), rate = elapsed > 0 ? (index - first_) / elapsed : 0;
  const std::string left = rate > 0 ? duration_text((frames_ - index) / rate) + " left" : "";
  return fmt::format("{} {} of {}, {:.3g} frames/s, {}", what_, index, frames_, rate, left);
}

void Progress::frame(int index) {
  if (seconds_since(shown_) < interval_) return;
  shown_ = Clock::now();
  if (terminal_) {
    stream_ << '\r' << line(index) << "\033[K" << std::flush;
  } else {
    stream_ << line(index) << std::endl;
    interval_ = std::min(2 * interval_, 300.0);
  }
}

void Progress::end() {
  if (terminal_) stream_ << "\r\033[K" << std::flush;
}

}  // namespace selvedge
