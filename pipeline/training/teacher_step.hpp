#pragma once

#include <memory>
#include <string>

#include "physics/steppers/frame_potential.hpp"

namespace selvedge {

struct TrainingScene;  // training_roll.hpp

// converged: one substep, solved closely, so that a step of 1/30 s is the minimum of its incremental potential.
// standard: what a scene has whose file says nothing of the solver.
enum class TeacherQuality { converged, standard };

// How the solver teaches. Members are described where keys are bound to them: pipeline/training/training_options.cpp.
struct TeacherOptions {
  TeacherQuality quality = TeacherQuality::converged;
  int uses = 1, kept = 256;
};

// What the objective needs of the solver.
struct TeacherWork {
  bool targets = false, potential = false;
  bool any() const { return targets || potential; }
};

// The stepper of a run with recovery from tangled starts. Keeps a reference to the scene.
std::unique_ptr<Stepper> make_teacher_stepper(const Scene&, const TeacherOptions&);

// The solver of a roll-out's scene. It is kept from frame to frame for its caches alone.
struct RollSolver {
  std::shared_ptr<const TrainingScene> scene;
  std::unique_ptr<Stepper> stepper;
  std::unique_ptr<FramePotential> potential;
};

// What the solver makes of the start of a frame.
struct TeacherStep {
  Points x;                             // of the cloth at the end of the frame [m]; no rows: not wanted, or rejected
  FramePotential* potential = nullptr;  // of the RollSolver, until the next frame is asked for; null: not wanted
  std::string refused;                  // why there is no frame; empty: there is all that is wanted
};

}  // namespace selvedge
