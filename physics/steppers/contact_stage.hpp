#pragma once

#include <vector>

#include "collision/contact/resolve.hpp"
#include "physics/scene/scene.hpp"
#include "physics/scene/stepper.hpp"

namespace selvedge {

// The work that the response of one step of so many cloth vertices may take, over all its substeps and attempts. The
// most that an ordinary frame of about 4,000 was seen to take is a twentieth of it (docs/results/contact.md).
ResponseWork most_response(int cloth_vertices);

// What contact of a scene needs from step to step: the numbering of nodes, the trees, the settings. The scene's contact
// settings replace thickness, separation and friction of `limits`, and its size the work. Holds references to the
// scene, and caches.
struct ContactStage {
  explicit ContactStage(const Scene&, const ResolveOptions& limits = {});
  ContactStage(const ContactStage&) = delete;
  ContactStage& operator=(const ContactStage&) = delete;

  // From here on these pairs are not found; null: all are. Keeps the pointer.
  void leave_alone(const Exemption*);

  ContactWorld world;
  PairSearch search;
  ResolveOptions options;
  Eigen::VectorXd inverse_mass;  // of all nodes, 0 where positions are prescribed [1/kg]
  PathPairs path;                // pairs near the last positions
  bool exempt = false;           // something was left alone when they were listed
};

// Adds what a response did, and its times.
void add(const ResolveReport&, StepReport&);

// Bridson's response by itself, to the straight motion of a proposal: the cloth goes from the state to x, obstacles to
// `obstacles`, and both are overwritten with where they end. With `last_resort` in the options the motion is then free
// of impacts but for what is left alone; without it the report says whether it is. Its counts and
// the largest zone say how hard that was. `left_alone` may be null.
ResolveReport resolve_proposal(ContactStage&, const ResolveOptions&, const State& from, const Exemption* left_alone,
                               Points& x, std::vector<Points>& obstacles);

}  // namespace selvedge
