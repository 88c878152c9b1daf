#pragma once

namespace selvedge {

// What the threads of a run do: all of them step, or one of them works beside the others. Which is faster depends on
// the scene and on the machine, so both are tried. A trial is three frames in the other arrangement, and three more as
// before, so that a scene that grows slower with time favours neither; the last two of three frames count. The first
// trial comes after three frames, the next ones after 6, 12, 24 and then every 48. It changes no frame, only what it
// costs.
class Arrangement {
 public:
  bool beside() const { return beside_; }
  void took(double seconds);  // a frame in this arrangement

 private:
  enum class Phase { kept, other, back };
  void begin(Phase phase, bool beside);
  void choose(double after);

  Phase phase_ = Phase::kept;
  bool beside_ = true;
  int frames_ = 0, kept_frames_ = 3;  // of this phase so far; of the next phase that is kept, doubled at each choice
  double last_ = 0;                   // the last frame's time [s]
  double before_ = 0, other_ = 0;     // mean times of a frame before the trial and in it [s]
};

}  // namespace selvedge
