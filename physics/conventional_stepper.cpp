#include "physics/conventional_stepper.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "collision/audit.hpp"
#include "collision/resolve.hpp"
#include "physics/contact_terms.hpp"
#include "physics/features.hpp"

namespace selvedge {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

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
        inverse_mass_(inverse_masses(scene, world_.node_count)),
        solver_(scene, options.implicit_euler),
        edge_length_(mean_edge_length(scene)) {}

  const StepperTraits& traits() const override { return traits_; }
  StepReport step(const State& from, const Drive& drive, double dt, State& to) override;

 private:
  bool has_contact() const { return features_.self_contact || features_.obstacles; }
  int substeps_for(const State& from, const Drive& drive, double dt) const;
  NewtonReport solve(StepProblem problem, std::vector<ContactTerm>& terms, Points& x);
  bool substep(const Points& nodes0, const Points& v0, const Points& pins, const Drive& drive, double h, Points& nodes1,
               StepReport& report);
  void audit_state(const State& state, StepReport& report) const;

  const Scene& scene_;
  ConventionalOptions options_;
  Features features_;
  ContactWorld world_;
  PairSearch search_;
  Eigen::VectorXd inverse_mass_;
  ImplicitEuler solver_;
  double edge_length_;
  StepperTraits traits_{"conventional"};
  std::vector<NodePair> candidates_;  // pairs within the thickness at the current positions
};

// As many as keep every vertex's motion in a substep near one mesh edge, and at least two: implicit Euler at 1/30 s
// damps visibly.
int ConventionalStepper::substeps_for(const State& from, const Drive& drive, double dt) const {
  if (options_.substeps) return *options_.substeps;
  double speed = drive.acceleration.norm() * dt;
  if (from.v.rows() > 0) speed += from.v.rowwise().norm().maxCoeff();
  for (std::size_t k = 0; k < from.obstacles.size(); ++k)
    speed = std::max(speed, (drive.obstacles[k] - from.obstacles[k]).rowwise().norm().maxCoeff() / dt);
  const double wanted = edge_length_ > 0 ? std::ceil(speed * dt / edge_length_) : 1;
  return static_cast<int>(std::clamp<double>(wanted, 2, options_.max_substeps));
}

// Friction needs normal forces, and these the solution: a first solve gives them, a second one uses them.
NewtonReport ConventionalStepper::solve(StepProblem problem, std::vector<ContactTerm>& terms, Points& x) {
  const bool twice = features_.friction && !terms.empty();
  if (twice) problem.roughness = 8;
  const NewtonReport first = solver_.solve(problem, x);
  if (!twice || !first.finite) return first;
  lag_normal_forces(terms, x);
  problem.roughness = 1;
  NewtonReport second = solver_.solve(problem, x);
  second.iterations += first.iterations;
  second.linear_iterations += first.linear_iterations;
  if (second.finite) {
    lag_normal_forces(terms, x);
    stick(terms, inverse_mass_, *problem.x0, problem.h, options_.implicit_euler.slip_speed * problem.h, x);
  }
  return second;
}

// nodes1 comes with obstacles where they are to end and the cloth at its first guess. False: not finite.
bool ConventionalStepper::substep(const Points& nodes0, const Points& v0, const Points& pins, const Drive& drive,
                                  double h, Points& nodes1, StepReport& report) {
  const auto start = Clock::now();
  const int n = scene_.surface.vertex_count;
  std::vector<ContactTerm> terms;
  if (has_contact()) {
    const auto proximities = find_proximities(world_, candidates_, nodes0, scene_.rest, scene_.contact.thickness);
    terms = contact_terms(scene_, world_, proximities, inverse_mass_, nodes0, nodes1, h);
    report.collision.contacts = static_cast<int>(terms.size());
    for (const Proximity& p : proximities) report.collision.min_gap = std::min(report.collision.min_gap, p.gap);
  }
  report.seconds.response += seconds_since(start);

  const auto solve_start = Clock::now();
  const Points x0 = nodes0.topRows(n);
  Points x = nodes1.topRows(n);
  const StepProblem problem{h, &x0, &v0, &pins, drive.acceleration, drive.wind, terms};
  const NewtonReport newton = solve(problem, terms, x);
  report.iterations += newton.iterations;
  report.linear_iterations += newton.linear_iterations;
  report.residual = newton.residual;
  if (!newton.converged) report.reason = Reason::not_converged;
  report.seconds.solve += seconds_since(solve_start);
  if (!newton.finite) return false;
  nodes1.topRows(n) = x;

  if (has_contact()) {
    ResolveOptions options;
    options.thickness = scene_.contact.thickness;
    options.separation = 0.1 * scene_.contact.thickness;
    options.friction = scene_.contact.friction;
    options.self_friction = scene_.contact.self_friction;
    const ResolveReport resolved = resolve(search_, world_, inverse_mass_, options, nodes0, nodes1, candidates_);
    report.collision.impulses += resolved.impulses;
    report.collision.zones += resolved.zones;
    report.collision.shortened += resolved.shortened;
    report.seconds.broad_phase += resolved.broad_phase;
    report.seconds.ccd += resolved.ccd;
    report.seconds.response += resolved.response;
  }
  return nodes1.allFinite();
}

void ConventionalStepper::audit_state(const State& state, StepReport& report) const {
  const auto start = Clock::now();
  std::vector<Points> positions;
  for (const Points& obstacle : state.obstacles) positions.push_back(rounded_to_float(obstacle));
  std::vector<AuditBody> bodies;
  for (std::size_t k = 0; k < positions.size(); ++k) bodies.push_back({&scene_.obstacles[k].surface, &positions[k]});
  report.collision.pairs_after =
      audit(scene_.surface, rounded_to_float(state.x), bodies, features_.self_contact).intersecting_pairs();
  report.seconds.audit += seconds_since(start);
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
    const auto start = Clock::now();
    search_.restart();
    search_.find(nodes, nodes, 2 * scene_.contact.thickness, candidates_);
    report.seconds.broad_phase += seconds_since(start);
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
