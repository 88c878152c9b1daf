#include "learned/steppers/refu_stepper.hpp"

#include <algorithm>

#include "collision/distance/outside_budget.hpp"
#include "collision/geometry/distance.hpp"
#include "collision/geometry/stopwatch.hpp"
#include "learned/steppers/learned_state.hpp"
#include "physics/frame/bounded_step.hpp"
#include "physics/scene/part_of_scene.hpp"
#include "physics/solve/bdf2.hpp"

namespace selvedge {
namespace {

// A closed obstacle, and the faces nearest to cloth vertices at the last query.
struct RefuBody {
  int obstacle;
  DistanceField field;
  std::vector<int> faces;  // one per cloth vertex
  EdgePassMemory edges;
};

// The distance of a vertex from the obstacle in which it lies deepest.
struct DeepestIn {
  SignedDistance at;
  int body = -1;
};

class RefuStepper final : public Stepper {
 public:
  RefuStepper(const Scene& scene, std::unique_ptr<Stepper> inner, const RefuOptions& options)
      : scene_(scene),
        inner_(std::move(inner)),
        options_(options),
        ring_(adjacency_of(scene.surface.vertex_count, scene.surface.edges)),
        held_(static_cast<std::size_t>(scene.surface.vertex_count)) {
    for (const int pin : scene.pins) held_[static_cast<std::size_t>(pin)] = true;
    for (int k = 0; k < static_cast<int>(scene.obstacles.size()); ++k)
      if (is_closed(scene.obstacles[static_cast<std::size_t>(k)].surface))
        bodies_.push_back({k, DistanceField(scene.obstacles[static_cast<std::size_t>(k)].surface), {}, {}});
  }

  const StepperTraits& traits() const override { return inner_->traits(); }
  StepReport step(const State& from, const Drive& drive, double dt, State& to, const StepExtras& extras) override {
    return bounded_step(traits().name, extras.stop, [&] { return take_step(from, drive, dt, to, extras); });
  }

 private:
  StepReport take_step(const State& from, const Drive& drive, double dt, State& to, const StepExtras&);
  std::vector<DeepestIn> ask(const Points& at, std::span<const int> vertices);
  bool any_inside(const State&);
  Repelled push_out_of_bodies(const Points& x);
  void pass_all_edges(Points& x);
  void calm(const State& from, double dt, const Repelled&, State& to);

  const Scene& scene_;
  std::unique_ptr<Stepper> inner_;
  RefuOptions options_;
  Adjacency ring_;
  std::vector<char> held_;
  std::vector<RefuBody> bodies_;
  OutsideBudget budget_;
};

// `vertices` has the cloth vertex of each point, whose last face starts the search; or it is empty.
std::vector<DeepestIn> RefuStepper::ask(const Points& at, std::span<const int> vertices) {
  std::vector<DeepestIn> deepest(static_cast<std::size_t>(at.rows()));
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    RefuBody& body = bodies_[b];
    body.faces.resize(static_cast<std::size_t>(scene_.surface.vertex_count), -1);
    std::vector<int> faces;
    for (const int v : vertices) faces.push_back(body.faces[static_cast<std::size_t>(v)]);
    std::vector<SignedDistance> found;
    body.field.ask(at, faces, found);
    for (std::size_t i = 0; i < vertices.size(); ++i) body.faces[static_cast<std::size_t>(vertices[i])] = faces[i];
    for (std::size_t i = 0; i < found.size(); ++i)
      if (deepest[i].body < 0 || found[i].value < deepest[i].at.value) deepest[i] = {found[i], static_cast<int>(b)};
  }
  return deepest;
}

// Moves the bodies, and queries the vertices that may have come inside.
bool RefuStepper::any_inside(const State& state) {
  for (RefuBody& body : bodies_) body.field.move_to(state.obstacles[static_cast<std::size_t>(body.obstacle)]);
  if (!options_.budget) budget_ = {};
  const std::vector<int> due = budget_.due(state.x, joined_rows(state.obstacles));
  const std::vector<DeepestIn> found = ask(state.x(due, Eigen::all), due);
  bool inside = false;
  for (std::size_t i = 0; i < due.size(); ++i) {
    budget_.renew(due[i], found[i].at.value);
    inside |= found[i].at.value < 0 && !held_[static_cast<std::size_t>(due[i])];
  }
  return inside;
}

Repelled RefuStepper::push_out_of_bodies(const Points& x) {
  const AskDistance distance = [this](const Points& at, std::vector<SignedDistance>& found) {
    const std::vector<DeepestIn> deepest = ask(at, {});
    found.resize(deepest.size());
    std::ranges::transform(deepest, found.begin(), [](const DeepestIn& d) { return d.at; });
  };
  AskScale scale = [this](std::span<const int> vertices, std::span<const double>) {
    return constant_scale(vertices, options_.alpha);
  };
  if (options_.neighbours) scale = ask_neighbours(*options_.neighbours, x, ring_, distance);
  return repel(x, ring_, distance, scale, options_.repulsion, held_);
}

void RefuStepper::pass_all_edges(Points& x) {
  if (options_.edge_pass.rounds == 0) return;
  for (RefuBody& body : bodies_) pass_edges(body.field, scene_.surface, options_.edge_pass, x, held_, &body.edges);
}

// Stops pushed vertices from going inward again: removes the part of their velocity, relative to the surface that they
// were pushed to, against its normal.
void RefuStepper::calm(const State& from, double dt, const Repelled& pushed, State& to) {
  std::vector<int> vertices;
  Points at(static_cast<Eigen::Index>(pushed.pushed.size()), 3);
  for (const PushedVertex& vertex : pushed.pushed) {
    at.row(static_cast<Eigen::Index>(vertices.size())) = to.x.row(vertex.vertex);
    vertices.push_back(vertex.vertex);
  }
  const std::vector<DeepestIn> found = ask(at, {});
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const RefuBody& body = bodies_[static_cast<std::size_t>(found[i].body)];
    const auto obstacle = static_cast<std::size_t>(body.obstacle);
    const auto t = body.field.surface().triangles.row(found[i].at.triangle);
    const Points &x = to.obstacles[obstacle], &before = from.obstacles[obstacle];
    const Closest near = point_triangle(found[i].at.closest, row(x, t[0]), row(x, t[1]), row(x, t[2]));
    Vec3 body_velocity = Vec3::Zero();
    for (int k = 0; k < 3; ++k) body_velocity -= near.weights[1 + k] * (row(x, t[k]) - row(before, t[k])) / dt;
    const Vec3& normal = found[i].at.gradient;
    const double inward = std::min(0.0, normal.dot(row(to.v, vertices[i]) - body_velocity));
    to.v.row(vertices[i]) -= (inward * normal).transpose();
  }
  carry_velocities(vertices, to);
}

// The last substep leads to the pushed cloth, so that the motion that a frame shows is audited. The hybrid has taken
// the path of a step that it has judged; then all of the step leads there.
void lead_to(const State& pushed, const State& from, StepPath& path) {
  if (path.substeps.empty()) {
    path.start = gather_nodes(from.x, from.obstacles);
    path.substeps.emplace_back();
  }
  const State seen = path.part ? state_of(*path.part, pushed) : pushed;
  path.substeps.back().nodes = gather_nodes(seen.x, seen.obstacles);
}

double longest_edge(const Scene& scene) {
  double longest = 0;
  for (const auto& edge : scene.surface.edges.rowwise())
    longest = std::max(longest, (scene.rest.row(edge[0]) - scene.rest.row(edge[1])).norm());
  return longest;
}

StepReport RefuStepper::take_step(const State& from, const Drive& drive, double dt, State& to,
                                  const StepExtras& extras) {
  StepReport report = inner_->step(from, drive, dt, to, extras);
  const auto is_finite = [](const Points& x) { return x.allFinite(); };
  if (report.status != StepStatus::accepted || !is_finite(to.x) || !std::ranges::all_of(to.obstacles, is_finite))
    return report;
  Stopwatch watch;
  if (!any_inside(to)) {
    report.seconds.response += watch.lap();
    return report;
  }
  Repelled pushed = push_out_of_bodies(to.x);
  to.x = std::move(pushed.x);
  pass_all_edges(to.x);
  calm(from, dt, pushed, to);
  forget_history(to);  // the cloth did not come here by its own motion
  report.collision.pushed_out = static_cast<int>(pushed.pushed.size());
  report.seconds.response += watch.lap();
  report.audit.reset();
  lead_to(to, from, report.path);
  return report;
}

}  // namespace

std::unique_ptr<Stepper> make_refu_stepper(const Scene& scene, std::unique_ptr<Stepper> inner,
                                           const RefuOptions& options) {
  if (std::ranges::none_of(scene.obstacles, [](const Obstacle& o) { return is_closed(o.surface); })) return inner;
  RefuOptions fitting = options;
  LayerOrder& order = fitting.repulsion.order;
  order.span = std::max(order.span, 1.5 * longest_edge(scene));
  return std::make_unique<RefuStepper>(scene, std::move(inner), fitting);
}

}  // namespace selvedge
