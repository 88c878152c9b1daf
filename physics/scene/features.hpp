#pragma once

#include <string>
#include <vector>

#include "physics/scene/scene.hpp"

namespace selvedge {

struct StepperTraits;

// What a scene needs, derived from its data. Factories build only what is set here.
struct Features {
  bool obstacles = false, moving_obstacles = false;
  bool self_contact = false;
  bool friction = false;
  bool membrane = false;
  bool curvature_bending = false, curved_rest = false, hinge_bending = false;
  bool stiffness_damping = false, mass_damping = false;
  bool wind = false;
  bool pins = false;
  bool springs = false;
};
Features features_of(const Scene&);

// One line of `selvedge plan`: a feature, whether the scene needs it, and why.
struct PlanLine {
  std::string feature;
  bool in = false;
  std::string why;
};
std::vector<PlanLine> plan_lines(const Scene&);

// Features that the scene has and a stepper with these traits ignores, as lines with `in` false.
std::vector<PlanLine> ignored_lines(const Scene&, const StepperTraits&);

// The scene without the forces that a stepper with these traits ignores.
Scene without_ignored(Scene, const StepperTraits&);

}  // namespace selvedge
