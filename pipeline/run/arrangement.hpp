#pragma once

namespace selvedge {

// Chooses how the threads of a run work: all of them step, or one audits and makes drives beside the others. Which is
// faster depends on the scene and the machine, so that both are tried. A trial is three frames in the other arrangement
// and three more in the old one, so that a scene that becomes slower with time favours neither; the last two of each
// three count. The first trial comes after three frames, the next ones after 6, 12, 24 and then every 48. The choice
// affects only the time of frames.
class Arrangement {
 public:
  bool beside() const { return beside_; }
  void took(double seconds);  // seconds of a frame in this arrangement

 private:
  enum class Phase { kept, other, back };
  void begin(Phase phase, bool beside);
  void choose(double after);

  Phase phase_ = Phase::kept;
  bool beside_ = true;
  int frames_ = 0, kept_frames_ = 3;  // in this phase so far; in the next kept phase, doubled at each choice
  double last_ = 0;                   // the last frame's time [s]
  double before_ = 0, other_ = 0;     // mean times of a frame before the trial and in it [s]
};

}  // namespace selvedge
