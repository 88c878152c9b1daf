#include "physics/solve/implicit_euler.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>

#include <Eigen/LU>

#include "physics/energies/joints.hpp"
#include "physics/energies/measures.hpp"
#include "physics/linear/linear_solver.hpp"
#include "physics/solve/step_potential.hpp"

namespace selvedge {
namespace {

constexpr double rounding = std::numeric_limits<double>::epsilon();
constexpr double sufficient_decrease = 1e-4;  // Armijo
constexpr int max_halvings = 40;

struct EnergyChange {
  double change = 0;  // [J]
  double noise = 0;   // smaller changes mean nothing
};

double sum_of(const std::vector<double>& parts) { return std::accumulate(parts.begin(), parts.end(), 0.0); }

EnergyChange energy_change(const std::vector<double>& from, const std::vector<double>& to) {
  EnergyChange result;
  double size = 0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    result.change += to[i] - from[i];
    size += std::abs(from[i]) + std::abs(to[i]);
  }
  result.noise = 8 * rounding * size;
  return result;
}

// Positions are known to a rounding error, so forces are known to that error times the stiffness.
bool below_rounding(const Points& gradient, std::span<const Mat3> diagonal, const Points& x) {
  const double error = 2 * rounding * x.cwiseAbs().maxCoeff();
  for (int i = 0; i < gradient.rows(); ++i)
    if (!(gradient.row(i).cwiseAbs().maxCoeff() <= error * diagonal[i].trace())) return false;
  return true;
}

Vertices rest_vertices(const Scene& scene) {
  const Surface& surface = scene.surface;
  std::vector<std::pair<int, int>> border;
  for (int e = 0; e < surface.edges.rows(); ++e)
    if (surface.edge_triangles[e][1] < 0) border.emplace_back(surface.edges(e, 0), surface.edges(e, 1));
  return {scene.rest, adjacency_of(surface.vertex_count, surface.edges), rims(scene.rest, unique_edges(border))};
}

// Components that nothing holds or touches.
std::vector<char> drifting_components(const Scene& scene, const std::vector<int>& component,
                                      const StepPotential& step) {
  std::vector<char> drifting(scene.surface.component_count, true);
  for (int pin : scene.pins) drifting[component[pin]] = false;
  for (const ContactBlock& contact : step.contacts)
    for (int node : contact.nodes)
      if (node >= 0) drifting[component[node]] = false;
  return drifting;
}

// Elastic forces do not change under translation, so that the best translation of a drifting component is known
// exactly, whatever the linear solver found. Conserves linear momentum up to rounding and never raises the quadratic
// model.
void correct_translations(const std::vector<int>& component, const StepPotential& step,
                          const std::vector<char>& drifting, const Points& gradient, Points& motion) {
  std::vector<double> weight(drifting.size(), 0.0);
  std::vector<Vec3> missing(drifting.size(), Vec3::Zero());
  for (int i = 0; i < motion.rows(); ++i) {
    if (!step.free[i] || !drifting[component[i]]) continue;
    weight[component[i]] += step.diagonal[i];
    missing[component[i]] -= row(gradient, i) + step.diagonal[i] * row(motion, i);
  }
  for (int i = 0; i < motion.rows(); ++i)
    if (step.free[i] && drifting[component[i]])
      motion.row(i) += (missing[component[i]] / weight[component[i]]).transpose();
}

}  // namespace

struct ImplicitEuler::Impl {
  const Scene& scene;
  ImplicitEulerOptions options;
  Eigen::VectorXd masses;
  Elastic elastic;
  std::vector<int> component;  // of each vertex
  StepPotential step;
  StepScratch scratch;
  LinearSystemSolver linear;
  PairBlocks hessian;
  std::vector<Mat3> diagonal;
  Points gradient, motion, trial;
  std::vector<double> energy, trial_energy;
  std::vector<char> drifting;
  double relative_stiffness = 0;  // mean_stiffness of the last system
  int exact_from, exact_wait;     // Newton iterations until the exact Hessian is tried

  Impl(const Scene& s, const ImplicitEulerOptions& o, const Eigen::VectorXd& m)
      : scene(s),
        options(o),
        masses(m),
        elastic(make_elastic(s)),
        component(joined_components(s)),
        linear(o.linear_solver, rest_vertices(s), free_vertices(s, m)),
        exact_from(o.newton.exact_from),
        exact_wait(o.newton.exact_from) {}

  void start(const StepProblem& problem) {
    prepare(scene, elastic, masses, problem, options.slip_speed, scratch, step);
    if (!problem.warm_start) exact_wait = options.newton.exact_from;
    exact_from = exact_wait;
    linear.start_family();
  }
  LinearSystem system() const {
    return {elastic.pattern, hessian,       step.diagonal, elastic.flat,
            step.flat_scale, step.contacts, step.lists,    step.free};
  }
  double goal(const Points& x) const;
  double energy_goal(const Points& x) const;
  double distance_left(double gain) const;
  double mean_stiffness() const;
  bool choose_first_guess(Points& x);
  bool solve_linear(Definite, NewtonReport&);
  enum class Direction { none, rough, accurate };  // none: x is the minimiser to rounding
  Direction find_direction(const Points& x, NewtonReport&);
  double line_search(Points& x);
};

ImplicitEuler::ImplicitEuler(const Scene& scene, const ImplicitEulerOptions& options)
    : impl_(std::make_unique<Impl>(scene, options, lumped_masses(scene))) {}
ImplicitEuler::~ImplicitEuler() = default;
LinearSolver ImplicitEuler::chosen_solver() const { return impl_->linear.chosen(); }
const Eigen::VectorXd& ImplicitEuler::masses() const { return impl_->masses; }
const Elastic& ImplicitEuler::elastic() const { return impl_->elastic; }

double ImplicitEuler::potential(const StepProblem& problem, const Points& x) {
  impl_->start(problem);
  energies(impl_->step, x, impl_->scratch, impl_->energy);
  return sum_of(impl_->energy);
}

Points ImplicitEuler::gradient(const StepProblem& problem, const Points& x) {
  impl_->start(problem);
  derivatives(impl_->step, x, impl_->scratch, impl_->gradient, nullptr);
  return impl_->gradient;
}

// The caller's guess or the ballistic positions, whichever has the lower potential (free fall is then exact). Sets pins
// to their targets. False if neither potential is finite.
bool ImplicitEuler::Impl::choose_first_guess(Points& x) {
  if (step.problem->warm_start) {
    energies(step, x, scratch, energy);
    return std::isfinite(sum_of(energy)) && x.allFinite();
  }
  trial = x;
  for (int i = 0; i < x.rows(); ++i)
    if (step.free[i]) trial.row(i) = step.ballistic.row(i);
  for (std::size_t p = 0; p < scene.pins.size(); ++p)
    x.row(scene.pins[p]) = trial.row(scene.pins[p]) = step.problem->pins->row(p);
  energies(step, x, scratch, energy);
  energies(step, trial, scratch, trial_energy);
  const double guess = sum_of(energy);
  const double ballistic = sum_of(trial_energy);
  if (ballistic < guess || (std::isfinite(ballistic) && !std::isfinite(guess))) {
    x = trial;
    energy = trial_energy;
  }
  return std::isfinite(std::min(guess, ballistic)) && x.allFinite();
}

// The RMS displacement of a Newton step below which Newton ends [m].
double ImplicitEuler::Impl::goal(const Points& x) const {
  const StepProblem& problem = *step.problem;
  return std::max(
      options.velocity_tolerance * problem.h * problem.tolerance_scale,
      options.relative_tolerance * std::max(problem.tolerance_scale, 1.0) * root_mean_square(x - *problem.x0));
}

// The energy gain of a Newton step below which Newton ends in stiff cloth [J], where small errors store much energy.
double ImplicitEuler::Impl::energy_goal(const Points& x) const {
  const double reach = options.newton.stiff_allowance * goal(x);
  return reach * reach * sum_of(step.inertia);
}

// A bound of the RMS distance from x to the minimiser of a convex potential, if a Newton step can gain the energy
// `gain` [J]: the minimum is lower by half of it, and inertia alone takes as much for that distance. After the step
// less is left.
double ImplicitEuler::Impl::distance_left(double gain) const {
  const double inertia = sum_of(step.inertia);
  return inertia > 0 ? std::sqrt(std::max(gain, 0.0) / inertia) : 0;
}

// Mean stiffness of the vertices, divided by their inertia.
double ImplicitEuler::Impl::mean_stiffness() const {
  double stiffness = 0, inertia = 0;
  for (std::size_t i = 0; i < diagonal.size(); ++i) {
    if (!step.free[i]) continue;
    stiffness += diagonal[i].trace() / 3;
    inertia += step.inertia[i];
  }
  return inertia > 0 ? stiffness / inertia : 0;
}

// One linear solve for the Newton step; true if it is as accurate as asked for. The norm in which it converges weights
// a motion by its stiffness. So in stiff cloth the soft modes, which make up most of the motion, count little and need
// a smaller tolerance.
bool ImplicitEuler::Impl::solve_linear(Definite definite, NewtonReport& report) {
  relative_stiffness = mean_stiffness();
  const double tolerance =
      options.linear_tolerance * std::min(1.0, std::sqrt(options.newton.stiff / relative_stiffness));
  const LinearReport solved =
      linear.solve(system(), diagonal, -gradient, tolerance, options.max_linear, motion, definite);
  report.linear_iterations += solved.iterations;
  report.coarse_builds += solved.coarse_builds;
  return solved.converged;
}

// Assembles at x and solves for the Newton step. Filtered Hessians always lead downhill but converge slowly where cloth
// is compressed; the exact one converges quadratically where it is positive definite, so it is tried after a few
// iterations (projection on demand, after Longva et al. 2023), and less often each time it fails. What failed in a
// solve counts in those that continue it.
ImplicitEuler::Impl::Direction ImplicitEuler::Impl::find_direction(const Points& x, NewtonReport& report) {
  for (const HessianForm form : {HessianForm::exact, HessianForm::filtered}) {
    const bool exact = form == HessianForm::exact;
    if (exact && report.iterations < exact_from) continue;
    derivatives(step, x, scratch, gradient, &hessian, form);
    diagonal_blocks(system(), diagonal);
    if (below_rounding(gradient, diagonal, x)) return Direction::none;
    drifting = drifting_components(scene, component, step);
    const bool accurate = solve_linear(exact ? Definite::perhaps : Definite::yes, report);
    correct_translations(component, step, drifting, gradient, motion);
    const bool downhill = motion.allFinite() && gradient.cwiseProduct(motion).sum() < 0;
    if (accurate && downhill) return Direction::accurate;
    if (exact) {
      exact_from = report.iterations + exact_wait;
      exact_wait *= 2;
    } else if (!downhill) {
      for (int i = 0; i < motion.rows(); ++i)
        motion.row(i) = step.free[i] ? Eigen::RowVector3d(-(diagonal[i].inverse() * row(gradient, i)).transpose())
                                     : Eigen::RowVector3d::Zero();
    }
  }
  return Direction::rough;
}

// Moves x along `motion` so that the potential falls enough. Returns the step length, or 0 if none was found. Filtered
// Hessians overestimate the stiffness of buckling cloth: if the potential falls almost linearly, and by more than
// rounding, longer steps are tried.
double ImplicitEuler::Impl::line_search(Points& x) {
  const double slope = gradient.cwiseProduct(motion).sum();
  const auto try_length = [&](double length) {
    trial = x + length * motion;
    energies(step, trial, scratch, trial_energy);
    return energy_change(energy, trial_energy);
  };
  double length = 1;
  EnergyChange best = try_length(length);
  const auto enough = [&] {
    return std::isfinite(best.change) && best.change <= sufficient_decrease * length * slope + best.noise;
  };
  for (int halving = 0; halving < max_halvings && !enough(); ++halving) best = try_length(length *= 0.5);
  if (!enough()) return 0;
  std::vector<double> best_energy = trial_energy;
  const bool measurable = -slope > best.noise;
  while (measurable && length >= 1 && length < options.newton.longest_step &&
         best.change < options.newton.nearly_linear * length * slope - best.noise) {
    const EnergyChange longer = try_length(2 * length);
    if (!(longer.change < best.change)) break;
    best = longer;
    length *= 2;
    best_energy.swap(trial_energy);
  }
  x += length * motion;
  energy.swap(best_energy);
  return length;
}

NewtonReport ImplicitEuler::solve(const StepProblem& problem, Points& x) {
  Impl& impl = *impl_;
  assert(x.rows() == impl.masses.size());
  assert(impl.scene.pins.empty() || problem.pins->rows() == static_cast<Eigen::Index>(impl.scene.pins.size()));
  NewtonReport report;
  impl.start(problem);
  report.finite = impl.choose_first_guess(x);
  if (!report.finite) return report;
  const int most = std::max(1, static_cast<int>(std::lround(problem.iteration_scale * impl.options.max_newton)));
  bool unfinished = false;  // the last step gained too much energy for Newton to end
  while (!report.converged &&
         report.iterations <
             std::min(problem.most_iterations, unfinished ? impl.options.newton.more_iterations * most : most)) {
    if (problem.stop && stopped(*problem.stop)) {
      report.stopped = true;
      break;
    }
    const auto direction = impl.find_direction(x, report);
    if (direction == Impl::Direction::none) {
      report.converged = true;
      break;
    }
    const double gain = -impl.gradient.cwiseProduct(impl.motion).sum(), length = impl.line_search(x);
    report.left = impl.distance_left(gain);
    if (length == 0) break;
    ++report.iterations;
    const bool far = !problem.contacts.empty() && gain > impl.options.newton.far_energy * std::abs(sum_of(impl.energy));
    unfinished = far || (impl.relative_stiffness > impl.options.newton.stiff && gain > impl.energy_goal(x));
    report.converged = !unfinished && direction == Impl::Direction::accurate &&
                       std::max(length, 1.0) * root_mean_square(impl.motion) < impl.goal(x);
  }
  return report;
}

}  // namespace selvedge
