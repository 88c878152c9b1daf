#pragma once

#include <ostream>
#include <string>

#include "pipeline/run/simulate.hpp"

namespace selvedge {

// Shows frames per second and the time left: one line that is rewritten on a terminal, a plain line now and then
// elsewhere.
class Progress {
 public:
  Progress(std::ostream& stream, bool terminal);
  void begin(int done, int frames, const std::string& what = "frame");  // `done` of them existed before
  void frame(int index);
  void end();

 private:
  std::string line(int index) const;
  std::ostream& stream_;
  bool terminal_;
  std::string what_;
  int first_ = 0, frames_ = 0;
  double interval_;  // between plain lines [s], doubled after each
  Clock::time_point started_, shown_;
};

std::string duration_text(double seconds);  // "48 s", "3 min 20 s", "2 h 5 min"

}  // namespace selvedge
