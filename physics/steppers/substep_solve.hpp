#pragma once

#include <vector>

#include "physics/solve/contact_terms.hpp"
#include "physics/solve/implicit_euler.hpp"
#include "physics/steppers/contact_stage.hpp"
#include "physics/steppers/substeps.hpp"

namespace selvedge {

// pinched: zones did not converge, but perhaps obstacles yield.
enum class SubstepAttempt { first, pinched, last_resort };

// A substep under way.
struct Substep {
  const SubstepState& start;
  const Points& pins;  // at its end, one row a Scene::pins entry
  double h;            // [s]
  SubstepAttempt attempt;
  int max_parts;                      // that it may be cut into
  Points nodes, v = {};               // at its end; at first obstacles where they are to be, and the cloth at a guess
  Points unbalanced = {};             // forces that the last solve left at its end [N]
  bool touched = false;               // something was near, met, or left alone
  bool pinched = false;               // obstacles leave the cloth no room
  int parts = 1;                      // that it should be cut into
  Eigen::VectorXd inverse_mass = {};  // of all nodes, those that yield included
};

// The implicit solves of a substep. Times and counts go into reports. Keeps references to the scene and the stage.
class SubstepSolve {
 public:
  SubstepSolve(const Scene&, const ImplicitEulerOptions&, const SubstepOptions&, ContactStage&);
  ImplicitEuler& solver() { return solver_; }

  // x: first guess in, minimiser out.
  NewtonReport once(const StepProblem&, Points& x, StepReport&);
  // What meets on the straight motion.
  std::vector<Impact> impacts(const Points& nodes0, const Points& nodes1, StepReport&);
  // What is near at the start.
  std::vector<Proximity> near(const Substep&, StepReport&);
  // Contact terms of what is near, as stiff as what pulls at them asks for where the cloth would go without any.
  Contacts loaded_contacts(const Substep&, const std::vector<Proximity>&, const StepProblem&, const Points& x,
                           StepReport&);
  // Solves with contacts, again and again until what the cloth runs into besides them is shallow and friction is
  // bounded by the normal forces that there are. x is the cloth in the substep's nodes. Reports the last solve. Ends
  // after the first one where that shows that the substep should be cut into parts.
  NewtonReport with_contact(Substep&, StepProblem&, Points& x, Contacts&, StepReport&);

 private:
  const Scene& scene_;
  ContactStage& stage_;
  SubstepOptions options_;
  ImplicitEuler solver_;
  bool friction_;
  double slip_speed_, edge_length_, deep_;
  int most_newton_;
};

}  // namespace selvedge
