#include "physics/conventional_stepper.hpp"

#include <algorithm>
#include <cmath>

#include "collision/audit.hpp"
#include "collision/resolve.hpp"
#include "collision/stopwatch.hpp"
#include "physics/contact_terms.hpp"
#include "physics/features.hpp"

namespace selvedge {
namespace {

constexpr double edges_a_substep = 2.5;     // how far a vertex may move, in mean edge lengths
constexpr double first_roughness = 8;       // of the solve that only finds impacts and normal forces
constexpr double friction_roughness = 0.2;  // of a solve with friction: sticking shows in small velocities

std::vector<const Surface*> surfaces(const std::vector<Obstacle>& obstacles) {
  std::vector<const Surface*> all;
  for (const Obstacle& obstacle : obstacles) all.push_back(&obstacle.surface);
  return all;
}

// Zero where positions are prescribed: pins, vertices without mass, obstacles.
Eigen::VectorXd inverse_masses(const Scene& scene, int node_count) {
  const Eigen::VectorXd masses = lumped_masses(scene);
  Eigen::VectorXd inverse = Eigen::VectorXd::Zero(node_count);
  for (int v = 0; v < masses.size(); ++v)
    if (masses[v] > 0) inverse[v] = 1 / masses[v];
  for (const int pin : scene.pins) inverse[pin] = 0;
  return inverse;
}

ResolveOptions resolve_options(const ContactSettings& contact) {
  ResolveOptions options;
  options.thickness = contact.thickness;
  options.separation = 0.1 * contact.thickness;
  options.friction = contact.friction;
  options.self_friction = contact.self_friction;
  return options;
}

double mean_edge_length(const Scene& scene) {
  double sum = 0;
  for (const RestTriangle& t : scene.rest_triangle)
    for (int k = 0; k < 3; ++k) sum += (t.col(k) - t.col((k + 1) % 3)).norm();
  return scene.rest_triangle.empty() ? 0 : sum / (3 * static_cast<double>(scene.rest_triangle.size()));
}

// As a file stores them: the audit is of what a reader will see.
Points rounded_to_float(const Points& x) { return x.cast<float>().cast<double>(); }

class ConventionalStepper final : public Stepper {
 public:
  ConventionalStepper(const Scene& scene, const ConventionalOptions& options)
      : scene_(scene),
        options_(options),
        features_(features_of(scene)),
        world_(make_contact_world(scene.surface, surfaces(scene.obstacles), features_.self_contact)),
        search_(world_),
        contact_(resolve_options(scene.contact)),
        inverse_mass_(inverse_masses(scene, world_.node_count)),
        solver_(scene, options.implicit_euler),
        edge_length_(mean_edge_length(scene)) {}

  const StepperTraits& traits() const override { return traits_; }
  StepReport step(const State& from, const Drive& drive, double dt, State& to) override;

 private:
  bool has_contact() const { return features_.self_contact || features_.obstacles; }
  int substeps_for(const State& from, const Drive& drive, double dt) const;
  bool solve(const StepProblem& problem, Points& x, StepReport& report);
  bool substep(const Points& nodes0, const Points& v0, const Points& pins, const Drive& drive, double h, Points& nodes1,
               StepReport& report);
  void audit_state(const State& state, StepReport& report) const;

  const Scene& scene_;
  ConventionalOptions options_;
  Features features_;
  ContactWorld world_;
  PairSearch search_;
  ResolveOptions contact_;
  Eigen::VectorXd inverse_mass_;
  ImplicitEuler solver_;
  double edge_length_;
  StepperTraits traits_{"conventional"};
  PathPairs path_;  // pairs near the current positions
};

// As many as keep every vertex's motion in a substep within a few mesh edges, and at least two: implicit Euler at 1/30
// s damps visibly.
int ConventionalStepper::substeps_for(const State& from, const Drive& drive, double dt) const {
  if (options_.substeps) return *options_.substeps;
  double speed = drive.acceleration.norm() * dt;
  if (from.v.rows() > 0) speed += from.v.rowwise().norm().maxCoeff();
  for (std::size_t k = 0; k < from.obstacles.size(); ++k)
    speed = std::max(speed, (drive.obstacles[k] - from.obstacles[k]).rowwise().norm().maxCoeff() / dt);
  const double wanted = edge_length_ > 0 ? std::ceil(speed * dt / (edges_a_substep * edge_length_)) : 1;
  return static_cast<int>(std::clamp<double>(wanted, 2, options_.max_substeps));
}

void add(const ResolveReport& resolved, StepReport& report) {
  report.collision.impulses += resolved.impulses;
  report.collision.zones += resolved.zones;
  report.collision.shortened += resolved.shortened;
  report.seconds.broad_phase += resolved.broad_phase;
  report.seconds.ccd += resolved.ccd;
  report.seconds.response += resolved.response;
}

// nodes1 comes with obstacles where they are to end and the cloth at its first guess. False: not finite.
bool ConventionalStepper::substep(const Points& nodes0, const Points& v0, const Points& pins, const Drive& drive,
                                  double h, Points& nodes1, StepReport& report) {
  const int n = scene_.surface.vertex_count;
  const Points x0 = nodes0.topRows(n);
  Points x = nodes1.topRows(n);
  StepProblem problem{h, &x0, &v0, &pins, drive.acceleration, drive.wind, {}, 1};
  if (!has_contact()) return solve(problem, x, report) && (nodes1.topRows(n) = x).allFinite();

  Stopwatch watch;
  const auto proximities = find_proximities(world_, path_.pairs, nodes0, scene_.rest, scene_.contact.thickness);
  std::vector<ContactTerm> terms = contact_terms(scene_, world_, proximities, inverse_mass_, nodes0, nodes1, h);
  for (const Proximity& p : proximities) report.collision.min_gap = std::min(report.collision.min_gap, p.gap);
  report.seconds.response += watch.lap();

  // Impacts and the normal forces that bound friction are known after a first, rough solve.
  problem.contacts = terms;
  problem.roughness = first_roughness;
  if (!solve(problem, x, report)) return false;
  nodes1.topRows(n) = x;
  ResolveReport times;
  const auto impacts = find_impacts(search_, inverse_mass_, contact_, nodes0, nodes1, path_, times);
  add(times, report);
  watch.lap();
  add_impact_terms(scene_, world_, impacts, proximities, inverse_mass_, nodes0, nodes1, h, terms);
  report.collision.contacts = static_cast<int>(terms.size());
  report.seconds.response += watch.lap();

  lag_normal_forces(terms, x);
  problem.contacts = terms;
  problem.roughness = 1;
  if (!solve(problem, x, report)) return false;
  if (features_.friction && !terms.empty()) {
    lag_normal_forces(terms, x);
    problem.roughness = friction_roughness;
    if (!solve(problem, x, report)) return false;
  }
  watch.lap();
  lag_normal_forces(terms, x);
  stick(terms, inverse_mass_, x0, h, options_.implicit_euler.slip_speed * h, x);
  report.seconds.response += watch.lap();
  nodes1.topRows(n) = x;
  add(resolve(search_, world_, inverse_mass_, contact_, nodes0, nodes1, path_), report);
  return nodes1.allFinite();
}

bool ConventionalStepper::solve(const StepProblem& problem, Points& x, StepReport& report) {
  Stopwatch watch;
  const NewtonReport newton = solver_.solve(problem, x);
  report.iterations += newton.iterations;
  report.linear_iterations += newton.linear_iterations;
  report.residual = newton.residual;
  if (!newton.converged && problem.roughness <= 1) report.reason = Reason::not_converged;
  report.seconds.solve += watch.lap();
  return newton.finite;
}

void ConventionalStepper::audit_state(const State& state, StepReport& report) const {
  Stopwatch watch;
  std::vector<Points> positions;
  for (const Points& obstacle : state.obstacles) positions.push_back(rounded_to_float(obstacle));
  std::vector<AuditBody> bodies;
  for (std::size_t k = 0; k < positions.size(); ++k) bodies.push_back({&scene_.obstacles[k].surface, &positions[k]});
  report.collision.pairs_after =
      audit(scene_.surface, rounded_to_float(state.x), bodies, features_.self_contact).intersecting_pairs();
  report.seconds.audit += watch.lap();
}

StepReport ConventionalStepper::step(const State& from, const Drive& drive, double dt, State& to) {
  StepReport report;
  report.by = traits_.name;
  report.substeps = substeps_for(from, drive, dt);
  const double h = dt / report.substeps;
  const int n = scene_.surface.vertex_count;
  Points nodes = gather_nodes(from.x, from.obstacles), v = from.v;
  const Points wanted = gather_nodes(from.x, drive.obstacles);
  if (has_contact()) {
    Stopwatch watch;
    search_.restart();
    path_.start = path_.end = nodes;
    search_.find(nodes, nodes, 2 * scene_.contact.thickness, path_.pairs);
    report.seconds.broad_phase += watch.lap();
  }
  report.status = StepStatus::accepted;
  for (int s = 0; s < report.substeps; ++s) {
    const double part = 1.0 / (report.substeps - s);  // of what is left of the frame
    Points next = nodes + part * (wanted - nodes);
    next.topRows(n) = nodes.topRows(n) + h * v;
    Points pins(scene_.pins.size(), 3);
    for (std::size_t k = 0; k < scene_.pins.size(); ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      pins.row(i) = nodes.row(scene_.pins[k]) + part * (drive.pins.row(i) - nodes.row(scene_.pins[k]));
    }
    if (!substep(nodes, v, pins, drive, h, next, report)) {
      report.status = StepStatus::rejected;
      report.reason = Reason::not_finite;
      return report;
    }
    v = (next.topRows(n) - nodes.topRows(n)) / h;
    nodes = std::move(next);
  }
  to.time = from.time + dt;
  to.frame = from.frame + 1;
  to.x = nodes.topRows(n);
  to.v = v;
  to.obstacles.resize(from.obstacles.size());
  for (std::size_t k = 0; k < from.obstacles.size(); ++k)
    to.obstacles[k] = nodes.middleRows(world_.first_node[k], from.obstacles[k].rows());
  if (nodes.rows() > n)
    report.collision.obstacle_lag = (nodes - wanted).bottomRows(nodes.rows() - n).rowwise().norm().maxCoeff();
  audit_state(to, report);
  if (report.collision.pairs_after > 0) report.reason = Reason::penetrating;
  return report;
}

}  // namespace

std::unique_ptr<Stepper> make_conventional_stepper(const Scene& scene, const ConventionalOptions& options) {
  return std::make_unique<ConventionalStepper>(scene, options);
}

}  // namespace selvedge
