#pragma once

#include <array>

namespace selvedge {

// What the threads of a run do: all of them step, or one of them works beside the others. Which is faster depends on
// the scene and on the machine, so both are tried. A trial is three frames, of which the faster of the last two counts.
// The arrangement that is kept is held against the other again after 6, 12, 24 and then every 48 frames. It changes no
// frame, only what it costs.
class Arrangement {
 public:
  bool beside() const { return beside_; }
  void took(double seconds);  // a frame in this arrangement

 private:
  void change();

  bool beside_ = true, trial_ = true;
  int frames_ = 0;                       // in this arrangement, since the last change or choice
  int kept_frames_ = 3;                  // doubled at each choice
  double before_ = 0;                    // the last frame's time [s]
  std::array<double, 2> times_{-1, -1};  // of all stepping, of one beside [s]; below 0: not tried yet
};

}  // namespace selvedge
