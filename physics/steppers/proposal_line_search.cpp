#include "physics/steppers/proposal_line_search.hpp"

#include "physics/solve/contact_terms.hpp"

namespace selvedge {
namespace {

ImplicitEulerOptions with_iterations(ImplicitEulerOptions options, int newton) {
  if (newton > 0) options.max_newton = newton;
  return options;
}

Contacts contacts_at_start(const Scene& scene, ContactStage& stage, const State& from, const Drive& drive, double dt,
                           const Points& x) {
  const double thickness = scene.contact.thickness;
  const Points before = gather_nodes(from.x, from.obstacles), after = gather_nodes(x, drive.obstacles);
  update_pairs(stage.search, thickness, before, after, stage.path);
  const std::vector<Proximity> near =
      find_proximities(stage.world, pairs_within(stage.path, before, thickness), before, thickness);
  return contact_terms(scene, stage.world, near, stage.inverse_mass, before, after, dt);
}

}  // namespace

ProposalLineSearch::ProposalLineSearch(const Scene& s, ImplicitEulerOptions options, int k)
    : scene(s), newton(k), solver(s, with_iterations(options, k)) {}

bool search_along(ProposalLineSearch& line, ContactStage& stage, const State& from, const Drive& drive, double dt,
                  int steps, Points& x) {
  const Scene& scene = line.scene;
  Points begin = from.x + dt * from.v;
  begin(scene.pins, Eigen::all) = drive.pins;
  const Contacts contacts = contacts_at_start(scene, stage, from, drive, dt, x);
  const StepProblem problem{dt, &from.x, &from.v, &drive.pins, drive.acceleration, drive.wind, contacts.terms, 1};
  if (line.newton > 0) line.solver.solve(problem, begin);
  const Points correction = x - begin;
  int best = 0;
  double least = line.solver.potential(problem, begin);
  for (int k = 1; k <= steps; ++k) {
    const double energy = line.solver.potential(problem, begin + (k / static_cast<double>(steps)) * correction);
    if (!(energy < least)) continue;
    least = energy;
    best = k;
  }
  if (best < steps) x = begin + (best / static_cast<double>(steps)) * correction;
  return best > 0;
}

}  // namespace selvedge
