#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "physics/scene/contact_forces.hpp"
#include "physics/solve/contact_terms.hpp"
#include "physics/solve/implicit_euler.hpp"
#include "physics/steppers/contact_stage.hpp"
#include "physics/steppers/substeps.hpp"
#include "physics/steppers/vertex_history.hpp"

namespace selvedge {

// pinched: zones did not converge in the first attempt, and obstacles may give way.
enum class SubstepAttempt { first, pinched, last_resort };

// A substep under way.
struct Substep {
  const SubstepState& start;
  const Points& pins;  // at its end, one row a Scene::pins entry
  double h;            // [s]
  SubstepAttempt attempt;
  int max_parts;                            // most parts into which it may be cut
  Points nodes, v = {};                     // at its end; at first the wanted obstacles and a guess of the cloth
  Points carried = {};                      // a further first guess of the cloth at its end; empty: none
  Points unbalanced = {};                   // unbalanced forces after the last solve [N]
  bool touched = false;                     // some pair was near, met, or was left alone
  bool pinched = false;                     // obstacles leave the cloth no room
  int parts = 1;                            // parts into which it should be cut
  Eigen::VectorXd inverse_mass = {};        // of all nodes, with those of obstacles that give way
  std::vector<double> friction_loads = {};  // the normal forces that bounded friction in the last solve, if it does [N]
  // With BDF2: whether each vertex has a rule of its own, its contact, where it starts, and where the last solve left
  // it.
  bool by_vertex = false;
  std::vector<VertexContact> contact = {};
  VertexStarts starts = {};
  Points solved = {};
  std::shared_ptr<const ContactForces> forces = {};  // of contact, at its end; null: not asked for
};

// The implicit solves of a substep. Times and counts go into reports. Keeps references to the scene and the stage.
class SubstepSolve {
 public:
  SubstepSolve(const Scene&, const ImplicitEulerOptions&, const SubstepOptions&, ContactStage&);
  ImplicitEuler& solver() { return solver_; }

  // x: first guess in, minimiser out.
  NewtonReport once(const StepProblem&, Points& x, StepReport&);
  // Chooses the rule of each vertex, as vertex_rules says, and lets the problem's inertia start where these have it.
  void choose_starts(Substep&, const Contacts&, StepProblem&);
  // The impacts of the straight motion.
  std::vector<Impact> impacts(const Points& nodes0, const Points& nodes1, StepReport&);
  // Begins at the carried guess, if the potential without contact is lower there than where the nodes are.
  void choose_guess(const StepProblem&, Substep&, StepReport&);
  // The proximities at the start.
  std::vector<Proximity> near(const Substep&, StepReport&);
  // Contact terms of proximities, stiff enough for the forces on them at the place where the cloth would go without
  // contact.
  Contacts loaded_contacts(const Substep&, const std::vector<Proximity>&, const StepProblem&, const Points& x,
                           StepReport&);
  // Solves with contacts until further impacts are shallow and friction is bounded by the present normal forces. x is
  // the cloth in the substep's nodes. Returns the report of the last solve. Ends after the first solve if that shows
  // that the substep should be cut into parts.
  NewtonReport with_contact(Substep&, StepProblem&, Points& x, Contacts&, StepReport&);
  // Static friction behind the solve. Moves x; measures the forces of contact, if they are asked for.
  void stick(Substep&, const StepProblem&, const Contacts&, Points& x, StepReport&) const;

 private:
  ContactMotion motion_of(const Substep&) const;

  const Scene& scene_;
  ContactStage& stage_;
  SubstepOptions options_;
  ImplicitEuler solver_;
  std::optional<PinnedParts> parts_;  // made when first needed
  bool friction_;
  double slip_speed_, edge_length_, deep_;
  int rough_newton_, most_newton_;  // most iterations of the first solve if another one follows, and of a step
};

}  // namespace selvedge
