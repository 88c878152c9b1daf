#include "physics/steppers/guard.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "physics/energies/measures.hpp"
#include "physics/energies/nearest.hpp"

namespace selvedge {
namespace {

constexpr double standard_gravity = 9.81;  // [m/s2]

double total(const std::vector<double>& parts) { return std::accumulate(parts.begin(), parts.end(), 0.0); }

double elastic_energy(const Elastic& elastic, const Points& x) {
  std::vector<double> parts;
  append_elastic_energies(elastic, x, parts);
  return total(parts);
}

// Mean diagonal of the elastic Hessian at rest.
std::vector<double> rest_stiffness(const Scene& scene, const Elastic& elastic, const std::vector<char>& free) {
  AssemblyScratch scratch;
  PairBlocks pairs;
  elastic_derivatives(elastic, scene.rest, scratch, nullptr, &pairs);
  const std::vector<double> none(free.size(), 0.0), ones(free.size(), 1.0);
  const ContactLists no_contacts;
  std::vector<Mat3> blocks;
  diagonal_blocks({elastic.pattern, pairs, none, elastic.flat, ones, {}, no_contacts, free}, blocks);
  std::vector<double> stiffness;
  for (const Mat3& block : blocks) stiffness.push_back(block.trace() / 3);
  return stiffness;
}

std::vector<int> patches(const Scene& scene, int patch_size) {
  std::vector<int> middles;
  for (int v = 0; v < scene.surface.vertex_count; v += patch_size) middles.push_back(v);
  return nearest_along_edges(scene, middles);
}

// RMS of force over mass, of patches that nothing touches, weighted by mass. Internal elastic forces cancel in a patch,
// so that this finds a wrong motion of a patch as a whole, which a Jacobi sweep of stiff cloth does not.
double patch_acceleration(const Guard& guard, const Points& gradient, const std::vector<char>& touching) {
  Points forces = Points::Zero(gradient.rows(), 3);
  std::vector<double> masses(static_cast<std::size_t>(gradient.rows()), 0.0);
  std::vector<char> left_out(masses.size(), 0);
  for (std::size_t v = 0; v < masses.size(); ++v) {
    if (guard.patch[v] < 0) continue;
    const auto patch = static_cast<std::size_t>(guard.patch[v]);
    if (!touching.empty() && touching[v]) left_out[patch] = 1;
    if (!guard.free[v]) continue;
    forces.row(guard.patch[v]) += gradient.row(static_cast<Eigen::Index>(v));
    masses[patch] += guard.masses[static_cast<Eigen::Index>(v)];
  }
  double squares = 0, mass = 0;
  for (std::size_t p = 0; p < masses.size(); ++p) {
    if (left_out[p] || !(masses[p] > 0)) continue;
    squares += forces.row(static_cast<Eigen::Index>(p)).squaredNorm() / masses[p];
    mass += masses[p];
  }
  return mass > 0 ? std::sqrt(squares / mass) : 0;
}

// The largest acceleration, of components that nothing holds or touches, which forces from outside do not explain:
// forces within a component cancel. One implicit step has all the acceleration of these forces, an exact flight half of
// it.
double unexplained_flight(const Guard& guard, const State& from, double dt, const Points& x, const Points& gradient,
                          const std::vector<char>& touching) {
  const Surface& surface = guard.scene.surface;
  struct Component {
    Vec3 momentum = Vec3::Zero(), residual = Vec3::Zero();  // gained by the motion [kg m], and force [N]
    double mass = 0;
    bool flies = true;
  };
  std::vector<Component> components(static_cast<std::size_t>(surface.component_count));
  for (int v = 0; v < surface.vertex_count; ++v) {
    Component& one = components[surface.component[v]];
    one.flies = one.flies && guard.free[v] && (touching.empty() || !touching[v]);
    one.momentum += guard.masses[v] * (row(x, v) - row(from.x, v) - dt * row(from.v, v));
    one.residual += row(gradient, v);
    one.mass += guard.masses[v];
  }
  double largest = 0;
  for (const Component& one : components) {
    if (!one.flies || !(one.mass > 0)) continue;
    const Vec3 flown = one.momentum / (one.mass * dt * dt), given = flown - one.residual / one.mass;
    const double square = given.squaredNorm();
    const double share = square > 0 ? std::clamp(flown.dot(given) / square, 0.5, 1.0) : 1;
    largest = std::max(largest, (flown - share * given).norm());
  }
  return largest;
}

// How the motion differs from that of a free flight without gravity.
void measure_motion(const Guard& guard, const State& from, double dt, const Points& x, GuardMeasures& m) {
  double largest = 0, changes = 0, motions = 0;
  int count = 0;
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    if (!guard.free[static_cast<std::size_t>(i)]) continue;
    const double change = (x.row(i) - from.x.row(i) - dt * from.v.row(i)).squaredNorm();
    largest = std::max(largest, change);
    changes += change;
    motions += dt * dt * from.v.row(i).squaredNorm();
    ++count;
  }
  if (count == 0) return;
  m.acceleration = std::sqrt(largest) / (dt * dt);
  m.mean_acceleration = std::sqrt(changes / count) / (dt * dt);
  m.change_of_motion = std::sqrt(changes / count) / std::max(guard.options.still, std::sqrt(motions / count));
}

double largest_stretch(const Guard& guard, const Points& x) {
  const Stretches stretches = principal_stretches(guard.elastic.membrane, guard.scene.surface.triangles.rows(), x);
  return stretches.rows() > 0 ? stretches.col(1).maxCoeff() : 1;
}

void measure_energy(const Guard& guard, const State& from, const Points& x, GuardMeasures& m) {
  const double growth = elastic_energy(guard.elastic, x) - elastic_energy(guard.elastic, from.x);
  m.energy_growth = guard.unit_energy > 0 ? growth / guard.unit_energy : 0;
}

// For vertices that nothing touches: forces on patches, and a Jacobi sweep with the stiffness of the rest shape.
void measure_residual(Guard& guard, const State& from, const Drive& drive, double dt, const Points& x,
                      const std::vector<char>& touching, GuardMeasures& m) {
  const StepProblem problem{dt, &from.x, &from.v, &drive.pins, drive.acceleration, drive.wind, {}, 1};
  prepare(guard.scene, guard.elastic, guard.masses, problem, 1, guard.scratch, guard.step);
  Points gradient;
  derivatives(guard.step, x, guard.scratch, gradient, nullptr);
  m.patch_acceleration = patch_acceleration(guard, gradient, touching);
  m.unexplained_flight = unexplained_flight(guard, from, dt, x, gradient, touching);
  double moves = 0, gain = 0;
  int count = 0, left_out = 0;
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    const auto v = static_cast<std::size_t>(i);
    if (!guard.free[v]) continue;
    if (!touching.empty() && touching[v]) {
      ++left_out;
      continue;
    }
    const double diagonal = guard.step.diagonal[v] + guard.stiffness[v], force = gradient.row(i).squaredNorm();
    moves += force / (diagonal * diagonal);
    gain += 0.5 * force / diagonal;
    ++count;
  }
  m.imbalance = count > 0 ? std::sqrt(moves / count) : 0;
  m.decrement = guard.unit_energy > 0 ? gain / guard.unit_energy : 0;
  m.in_contact = count + left_out > 0 ? static_cast<double>(left_out) / (count + left_out) : 0;
}

// Cloth stops or turns back only because of forces. If the motion changes by about as much as itself, and too little
// for the bounds on acceleration, forces must explain it. Frozen cloth is recognised by nothing else.
bool is_explained(const GuardOptions& most, const GuardMeasures& m) {
  return m.change_of_motion <= most.change_of_motion ||
         m.patch_acceleration <= std::max(most.slight, most.unexplained * m.mean_acceleration);
}

}  // namespace

Guard::Guard(const Scene& s, const GuardOptions& o)
    : scene(s),
      options(o),
      masses(lumped_masses(s)),
      elastic(make_elastic(s)),
      free(free_vertices(s, masses)),
      unit_energy(masses.sum() * standard_gravity * mean_edge_length(s)),
      stiffness(rest_stiffness(s, elastic, free)),
      patch(patches(s, o.patch_size)) {}

Verdict judge_motion(const Guard& guard, const State& from, double dt, const Points& x, GuardMeasures& m) {
  const GuardOptions& most = guard.options;
  m = {};
  if (!x.allFinite()) return Verdict::not_finite;
  measure_motion(guard, from, dt, x, m);
  const bool goes_on = m.mean_acceleration <= most.mean_acceleration || m.change_of_motion <= most.change_of_motion;
  return m.acceleration <= most.acceleration && goes_on ? Verdict::admitted : Verdict::moved_too_far;
}

Verdict judge_stretch(const Guard& guard, const State& from, const Points& x, GuardMeasures& m) {
  m.stretch_before = largest_stretch(guard, from.x);
  m.stretch = largest_stretch(guard, x);
  const double most = std::max(guard.options.stretch, guard.options.stretch_growth * m.stretch_before);
  return m.stretch <= most ? Verdict::admitted : Verdict::overstretched;
}

Verdict judge(Guard& guard, const State& from, const Drive& drive, double dt, const Points& x,
              const AskTouching& touching, GuardMeasures& m) {
  const GuardOptions& most = guard.options;
  if (const Verdict motion = judge_motion(guard, from, dt, x, m); motion != Verdict::admitted) return motion;
  if (const Verdict stretch = judge_stretch(guard, from, x, m); stretch != Verdict::admitted) return stretch;
  measure_energy(guard, from, x, m);
  if (!(m.energy_growth <= most.energy_growth)) return Verdict::energy_gain;
  measure_residual(guard, from, drive, dt, x, touching ? touching() : std::vector<char>{}, m);
  if (!(m.patch_acceleration <= most.patch_acceleration) || !(m.imbalance <= most.imbalance) ||
      !(m.decrement <= most.decrement) || !(m.unexplained_flight <= most.slight) || !is_explained(most, m))
    return Verdict::unbalanced;
  return Verdict::admitted;
}

GuardMeasures measure(Guard& guard, const State& from, const Drive& drive, double dt, const Points& x,
                      const AskTouching& touching) {
  GuardMeasures m;
  measure_motion(guard, from, dt, x, m);
  m.stretch_before = largest_stretch(guard, from.x);
  m.stretch = largest_stretch(guard, x);
  measure_energy(guard, from, x, m);
  measure_residual(guard, from, drive, dt, x, touching ? touching() : std::vector<char>{}, m);
  return m;
}

std::vector<char> touching_vertices(ContactStage& stage, const State& from, const std::vector<Points>& obstacles,
                                    const Points& x) {
  const Points before = gather_nodes(from.x, from.obstacles), after = gather_nodes(x, obstacles);
  std::vector<char> touching(static_cast<std::size_t>(x.rows()), 0);
  const double reach = contact_reach * stage.options.thickness;
  update_pairs(stage.search, reach, before, after, stage.path);
  const TouchTest touches(stage.path, reach, before, after);
  const auto is_known = [&](int node) { return node >= x.rows() || touching[static_cast<std::size_t>(node)]; };
  for (std::size_t i = 0; i < stage.path.pairs.size(); ++i) {
    const std::array<int, 4>& nodes = stage.path.pairs[i].nodes;
    if (std::ranges::all_of(nodes, is_known) || !touches(i)) continue;
    for (const int node : nodes)
      if (node < x.rows()) touching[static_cast<std::size_t>(node)] = 1;
  }
  return touching;
}

bool is_contact_free(const State& to, const StepReport& report) {
  return to.clean && report.collision.passed_through == 0 && report.collision.pairs_after == 0;
}

}  // namespace selvedge
