#include "physics/steppers/substep_solve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "collision/geometry/stopwatch.hpp"
#include "physics/scene/features.hpp"
#include "physics/solve/forces_of_terms.hpp"
#include "physics/steppers/count_solve.hpp"

namespace selvedge {
namespace {

std::vector<double> normal_forces(const std::vector<ContactTerm>& terms) {
  std::vector<double> forces;
  for (const ContactTerm& term : terms) forces.push_back(term.normal_force);
  return forces;
}

}  // namespace

SubstepSolve::SubstepSolve(const Scene& scene, const ImplicitEulerOptions& euler, const SubstepOptions& options,
                           ContactStage& stage)
    : scene_(scene),
      stage_(stage),
      options_(options),
      solver_(scene, euler),
      friction_(features_of(scene).friction),
      slip_speed_(euler.slip_speed),
      edge_length_(mean_edge_length(scene)),
      deep_(deep_impact(scene, options)),
      rough_newton_(std::max(options.rough_iterations,
                             static_cast<int>(std::lround(options.contact_iterations * euler.max_newton)))),
      most_newton_(euler.max_newton_step) {}

ContactMotion SubstepSolve::motion_of(const Substep& s) const {
  return {scene_, stage_.world, stage_.inverse_mass, s.start.nodes, s.nodes, s.h, options_.contact};
}

NewtonReport SubstepSolve::once(const StepProblem& problem, Points& x, StepReport& report) {
  const Timed timed(report.seconds.solve);
  StepProblem bounded = problem;
  bounded.most_iterations = std::max(1, std::min(problem.most_iterations, most_newton_ - report.iterations));
  const NewtonReport newton = solver_.solve(bounded, x);
  count_solve(newton, report);
  report.out_of_newton = report.out_of_newton || (!newton.converged && report.iterations >= most_newton_);
  return newton;
}

void SubstepSolve::choose_guess(const StepProblem& problem, Substep& s, StepReport& report) {
  const Timed timed(report.seconds.solve);
  s.carried(scene_.pins, Eigen::all) = s.pins;
  auto x = s.nodes.topRows(s.carried.rows());
  if (solver_.potential(problem, s.carried) < solver_.potential(problem, x)) x = s.carried;
}

std::vector<Impact> SubstepSolve::impacts(const Points& nodes0, const Points& nodes1, StepReport& report) {
  ResolveReport times;
  auto found = find_impacts(stage_.search, stage_.inverse_mass, stage_.options, nodes0, nodes1, stage_.path, times);
  add(times, report);
  return found;
}

void SubstepSolve::choose_starts(Substep& s, const Contacts& contacts, StepProblem& problem) {
  if (!parts_) parts_.emplace(scene_);
  s.contact.resize(parts_->part.size(), VertexContact::none);
  mark_near(s.start.history, contacts, s.contact);
  const auto rules = vertex_rules(*parts_, s.start.history, s.h, contacts, s.contact);
  s.starts = starts_of(rules, s.start.history, *problem.x0, *problem.v0, s.h);
  problem.starts = &s.starts;
}

NewtonReport SubstepSolve::with_contact(Substep& s, StepProblem& problem, Points& x, Contacts& contacts,
                                        StepReport& report) {
  const Points& nodes0 = s.start.nodes;
  const double creep = slip_speed_ * s.h;
  // If nothing touches, or touching cloth does not move, the first solve is likely to be the last one.
  const bool calm = !s.pinched && mean_touching(contacts.terms, s.h * *problem.v0) < creep;
  const int last = s.pinched ? options_.pinched_passes : options_.max_passes;
  for (int pass = 0;; ++pass) {
    problem.contacts = contacts.terms;
    problem.iteration_scale = contacts.terms.empty() ? 1 : options_.contact_iterations;
    problem.warm_start = pass > 0;
    const bool friction = friction_ && !contacts.terms.empty();
    // The second solve begins where the first one ends, which may be far from its minimum.
    problem.most_iterations = pass == 0 && !calm && last > 0 ? rough_newton_ : std::numeric_limits<int>::max();
    problem.tolerance_scale = pass > 1 || (calm && friction) ? options_.friction_tolerance
                              : pass == 0 && !calm           ? options_.first_tolerance
                                                             : 1;
    if (s.by_vertex) choose_starts(s, contacts, problem);
    const NewtonReport newton = once(problem, x, report);
    if (!newton.finite || newton.stopped) return newton;
    s.nodes.topRows(x.rows()) = x;
    if (s.forces) s.friction_loads = normal_forces(contacts.terms);
    const std::vector<ContactTerm> solved = calm ? contacts.terms : std::vector<ContactTerm>{};
    const double change = lag_normal_forces(contacts.terms, x);
    if (pass == 0)
      s.parts = parts_for_slide(farthest_slide(contacts.terms, *problem.x0, *problem.x0 + s.h * *problem.v0, x),
                                edge_length_, s.max_parts, options_);
    if (pass == last) return newton;
    const auto found = impacts(nodes0, s.nodes, report);
    if (pass == 0)
      s.parts = std::max(s.parts,
                         parts_for_impact(farthest_past(found, nodes0, s.nodes), edge_length_, s.max_parts, options_));
    if (s.parts > 1 || report.out_of_newton || report.out_of_response) return newton;
    if (calm && mean_touching(contacts.terms, x - *problem.x0) < creep && deepest(found, s.nodes) < deep_ &&
        mistaken_friction(solved, contacts.terms, *problem.x0, x, creep) < options_.normal_change)
      return newton;
    const int least = friction ? 2 : 1;
    // If Newton has not converged, normal forces change for that reason, and one more solve for them would be as rough.
    const bool bounded = change < options_.normal_change || !newton.converged;
    if (pass >= least && bounded && deepest(found, s.nodes) < deep_) return newton;
    const Timed timed(report.seconds.response);
    add_impact_terms(motion_of(s), found, deep_, contacts);
    raise_stiffness(contacts.terms, x);
    if (pass == least - 1) relinearise(motion_of(s), contacts);
  }
}

void SubstepSolve::stick(Substep& s, const StepProblem& problem, const Contacts& contacts, Points& x,
                         StepReport& report) const {
  const Timed timed(report.seconds.response);
  const double slip_width = slip_speed_ * s.h;
  const auto apply = [&](Points* forces) {
    apply_static_friction(contacts.terms, stage_.inverse_mass, *problem.x0, s.h, slip_width, x, options_.contact,
                          forces);
  };
  if (!s.forces) return apply(nullptr);
  const Points solved = x;
  Points sticking = Points::Zero(x.rows(), 3);
  apply(&sticking);
  s.forces = std::make_shared<const ContactForces>(
      forces_of_terms(scene_, {contacts.terms, s.friction_loads, *problem.x0, solved, slip_width}, sticking));
}

std::vector<Proximity> SubstepSolve::near(const Substep& s, StepReport& report) {
  const Timed timed(report.seconds.response);
  const Points& nodes = s.start.nodes;
  const double thickness = scene_.contact.thickness;
  auto found = find_proximities(stage_.world, pairs_within(stage_.path, nodes, thickness), nodes, thickness);
  for (const Proximity& p : found) report.collision.min_gap = std::min(report.collision.min_gap, p.gap);
  return found;
}

Contacts SubstepSolve::loaded_contacts(const Substep& s, const std::vector<Proximity>& near, const StepProblem& problem,
                                       const Points& x, StepReport& report) {
  const Timed timed(report.seconds.response);
  Contacts contacts = contact_terms(motion_of(s), near);
  // The load of a contact is the force on it at the place where the cloth would go without contact.
  if (!contacts.terms.empty())
    set_load_stiffness(contacts.terms, stage_.inverse_mass, -solver_.gradient(problem, x), options_.contact);
  return contacts;
}

}  // namespace selvedge
