#pragma once

#include <memory>
#include <string>

#include "physics/scene/stepper.hpp"

namespace selvedge {

struct TrainingScene;  // training_roll.hpp

// converged: one substep, solved closely, so that a step of 1/30 s is the minimum of its incremental potential.
// standard: what a scene has whose file says nothing of the solver.
enum class TeacherQuality { converged, standard };

// How the solver teaches. Members are described where keys are bound to them: pipeline/training/training_options.cpp.
struct TeacherOptions {
  TeacherQuality quality = TeacherQuality::converged;
};

// The stepper of a run with recovery from tangled starts. Keeps a reference to the scene.
std::unique_ptr<Stepper> make_teacher_stepper(const Scene&, const TeacherOptions&);

// The solver of a roll-out's scene. It is kept from frame to frame for its caches alone.
struct RollSolver {
  std::shared_ptr<const TrainingScene> scene;
  std::unique_ptr<Stepper> stepper;
};

// What the solver makes of the start of a frame.
struct TeacherStep {
  Points x;             // of the cloth at the end of the frame [m]; no rows: the step was rejected
  std::string refused;  // why it was; empty: it was not
};

}  // namespace selvedge
