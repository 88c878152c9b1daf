#pragma once

#include <span>
#include <vector>

#include "collision/contact/resolve.hpp"
#include "physics/scene/scene.hpp"
#include "physics/scene/stepper.hpp"

namespace selvedge {

// What contact of a scene needs from step to step: the numbering of nodes, the trees, the settings. Thickness,
// separation and friction of `limits` are replaced by the scene's contact settings. Its `budget` is lowered to what a
// step of a cloth of this size may take at most. Holds references to the scene, and caches.
struct ContactStage {
  explicit ContactStage(const Scene&, const ResolveOptions& limits = {});
  ContactStage(const ContactStage&) = delete;
  ContactStage& operator=(const ContactStage&) = delete;

  // From now on searches leave these pairs out; null: none. Keeps the pointer.
  void leave_alone(const Exemption*);

  ContactWorld world;
  PairSearch search;
  ResolveOptions options;
  Eigen::VectorXd inverse_mass;  // of all nodes, 0 where positions are prescribed [1/kg]
  PathPairs path;                // pairs near the last motion
  bool exempt = false;           // pairs were left out when `path` was made
};

// pins_give_way.hpp of the scene's pins, but those that a body carries (with skinned targets) give way to no body. A
// limb that pushed them off would take the cloth along, and could keep it away for ever. `left_alone`: by contact of
// the step.
int pins_give_way(ContactStage&, std::span<const int> pins, const ResolveOptions&, const Drive&,
                  const Exemption& left_alone, const Points& x0, Points& x1, ResolveReport&);

// Adds counts and times of a response to the report.
void add(const ResolveReport&, StepReport&);

// Bridson's response alone, for the straight motion of a proposal: the cloth moves from the state to x, obstacles to
// `obstacles`. Both are overwritten with where they end. With `last_resort` in the options the motion is then free of
// impacts, except for pairs left alone; without it `clean` of the report says whether it is. Its counts and the largest
// zone say how hard that was. `left_alone` may be null.
ResolveReport resolve_proposal(ContactStage&, const ResolveOptions&, const State& from, const Exemption* left_alone,
                               Points& x, std::vector<Points>& obstacles);

}  // namespace selvedge
