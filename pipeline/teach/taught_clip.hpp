#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "physics/steppers/fit_carried.hpp"
#include "pipeline/scene/setup.hpp"

namespace selvedge {

// A clip of a scene's body, and what the solver makes of it: the stepper `conventional`, as the scene sets it.
struct TaughtClip {
  std::string name;
  Setup setup;
  std::vector<State> begins;  // states of the run from which steppers roll out, with the memory of the carried guess
  std::vector<Points> run;    // the cloth at each frame, from frame 0 on [m]
};

// Roll-outs begin every so many frames of the solver's run, are as long, and are measured at their ends.
constexpr int roll_frames = 10;

// What roll-outs of a stepper, each from a state of the solver, came to.
struct RollDistances {
  double one = 0, ten = 0;            // sums over roll-outs of squared RMS distances to the solver's run [m2]
  int ones = 0, tens = 0;             // numbers of these
  int frames = 0, refused = 0;        // refused: frames that the stepper rejected, each the end of its roll-out
  int pairs = 0;                      // intersecting pairs in the worst frame
  int passed = 0;                     // pairs that passed through each other, all frames
  double distance_after_one() const;  // RMS over the roll-outs [m]; 0 without any
  double distance_after_ten() const;
};

using TeachStop = std::function<bool()>;

// Runs the solver on the clip. Adds its frames to `fit`, if that is not null. Absent: stopped. Throws Error for a clip
// or scene that cannot be run, and where the solver rejects a frame.
std::optional<TaughtClip> simulate_clip(Setup, const std::string& name, const TeachStop&, CarriedFit* fit);

// Lets the stepper roll out from the clip's states. If `fit` is not null, the solver's frame from each state on the way
// is added to it. False: stopped.
bool roll_out(const TaughtClip&, Stepper&, const TeachStop&, RollDistances&, CarriedFit* fit);

}  // namespace selvedge
