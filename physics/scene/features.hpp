#pragma once

#include <string>
#include <vector>

#include "physics/scene/scene.hpp"

namespace selvedge {

struct StepperTraits;

// What a scene needs, derived from its data and never declared. Factories build only what is set here.
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

// One line of `selvedge plan`: a feature, whether it is in, and why.
struct PlanLine {
  std::string feature;
  bool in = false;
  std::string why;
};
std::vector<PlanLine> plan_lines(const Scene&);

// What the scene has and a stepper with these traits ignores: lines that are not in.
std::vector<PlanLine> ignored_lines(const Scene&, const StepperTraits&);

// The scene as such a stepper has it: without the forces that it ignores.
Scene without_ignored(Scene, const StepperTraits&);

}  // namespace selvedge
