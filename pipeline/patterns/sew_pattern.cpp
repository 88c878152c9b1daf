#include "pipeline/patterns/sew_pattern.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "collision/geometry/disjoint_sets.hpp"
#include "collision/geometry/stopwatch.hpp"
#include "collision/untangle/untangle.hpp"
#include "physics/steppers/decorated_stepper.hpp"

namespace selvedge {
namespace {

constexpr double one_place = 1e-7;                            // vertices nearer than this lie at one place [m]
constexpr double first_stiffness = 30, last_stiffness = 2e4;  // of a stitch, while it gets shorter [N/m]
constexpr double kept_of_rest = 0.7;                          // what contact keeps of a distance at rest
constexpr double pulled_within = 0.5;  // of the distance that contact keeps: how near a stitch pulls its sides
constexpr double facing = 0.01;        // [m]
constexpr int settling_frames = 8, shutting_frames = 20, most_shut_frames = 10;
constexpr int least_draping = 15;  // frames: what begins to fall is slow and not at rest

// Panels with some stitches joined: of each vertex its number, and how many there are.
struct Joining {
  std::vector<int> number;
  int count = 0;
};

Joining join(const PatternMesh& mesh, const std::function<bool(std::size_t stitch)>& joined) {
  DisjointSets sets(static_cast<int>(mesh.placed.rows()));
  for (std::size_t s = 0; s < mesh.sewn.size(); ++s)
    if (joined(s)) sets.join(mesh.sewn[s][0], mesh.sewn[s][1]);
  return {sets.numbers(), sets.count()};
}

Points means(const Points& x, const Joining& to) {
  Points sum = Points::Zero(to.count, 3);
  Eigen::VectorXd members = Eigen::VectorXd::Zero(to.count);
  for (Eigen::Index v = 0; v < x.rows(); ++v) {
    sum.row(to.number[static_cast<std::size_t>(v)]) += x.row(v);
    members[to.number[static_cast<std::size_t>(v)]] += 1;
  }
  for (int v = 0; v < to.count; ++v) sum.row(v) /= members[v];
  return sum;
}

Points spread(const Points& x, const Joining& from) { return x(from.number, Eigen::all); }

Triangles renumbered(Triangles triangles, const Joining& to) {
  for (int& v : triangles.reshaped()) v = to.number[static_cast<std::size_t>(v)];
  return triangles;
}

// `apart`: where vertices count as when contact asks how close they rest: those of a stitch at one place, so that it
// does not hold them off each other.
Scene scene_of(const PatternMesh& mesh, const Joining& joining, const Points& apart, const Triangles& body_triangles,
               Eigen::Index body_vertices, const SewingOptions& options) {
  Scene scene;
  Material material = options.material;
  material.mass_damping = std::max(material.mass_damping, options.damping);
  add_cloth(scene, means(apart, joining), renumbered(mesh.triangles, joining), material, "garment", mesh.rest);
  add_obstacle(scene, static_cast<int>(body_vertices), body_triangles, false, "body");
  scene.contact = options.contact;
  return scene;
}

Points apart_from_itself(const Points& body, const Triangles& triangles) {
  return untangle(make_surface(static_cast<int>(body.rows()), triangles), body, {}).x;
}

struct Sewing {
  const PatternMesh& mesh;
  const Points& body;
  const Triangles& body_triangles;
  const SewingOptions& options;
  const std::function<void(const SewingFrame&)>& seen;
  SewnPattern result = {};

  double gap(const Points& x, std::size_t s) const {
    return (row(x, mesh.sewn[s][0]) - row(x, mesh.sewn[s][1])).norm();
  }

  double largest_gap(const Points& x) const {
    double most = 0;
    for (std::size_t s = 0; s < mesh.sewn.size(); ++s) most = std::max(most, gap(x, s));
    return most;
  }

  // Returns the share of vertices that move, or nothing where the step was rejected.
  std::optional<double> step(Stepper& stepper, const Scene& scene, const Joining& joining, bool sewn,
                             const Vec3& gravity, State& state) {
    Drive drive = at_rest(scene, state);
    drive.acceleration = gravity;
    drive.obstacles = {body};
    State next;
    const StepReport report = stepper.step(state, drive, 1 / options.fps, next);
    if (report.status != StepStatus::accepted) {
      result.rejected = true;
      return {};
    }
    const Eigen::VectorXd moved = (next.x - state.x).rowwise().norm();
    const double share =
        static_cast<double>((moved.array() > options.resting_motion).count()) / static_cast<double>(moved.size());
    state = std::move(next);
    if (seen) {
      const Points x = spread(state.x, joining);
      seen({state.time, sewn, largest_gap(x), share, &report, &x});
    }
    return share;
  }

  // Where vertices rest for contact, which keeps pairs of one piece no farther apart than a share of their distance at
  // rest: those of a stitch lie `gap` apart round their middle, each toward its panel.
  Points rest_with_gap(double gap) const {
    const Joining all = join(mesh, [](std::size_t) { return true; });
    const Points middle = spread(means(mesh.placed, all), all);
    Points rest = mesh.placed;
    for (const std::array<int, 2>& stitch : mesh.sewn)
      for (const int v : stitch) {
        const Vec3 away = row(mesh.placed, v) - row(middle, v);
        if (const double far = away.norm(); far > 0) rest.row(v) = middle.row(v) + gap / (2 * far) * away.transpose();
      }
    return rest;
  }

  // How long a stitch is in a frame of the closing, and how far apart contact keeps its sides [m]: first all get as
  // short as `facing`, at which the edges of two panels find their places beside each other; then they close, so slowly
  // that nothing collides.
  struct Closing {
    double share, shortest, keep;  // of their first length that is gone; [m]
  };
  Closing closing_at(int frame) const {
    const double first_frames = options.closing * options.fps, t = std::min(1.0, frame / first_frames);
    const double shut = std::clamp((frame - first_frames - settling_frames) / shutting_frames, 0.0, 1.0);
    const double shortest = facing * std::pow(pulled_within * options.closed / facing, shut);
    return {t * t * (3 - 2 * t), shortest, std::min(options.contact.thickness, shortest / pulled_within)};
  }

  // Positions of the panels' vertices with the stitches closed as far as they come.
  Points close() {
    const Joining joining = join(mesh, [&](std::size_t s) { return gap(mesh.placed, s) < one_place; });
    Scene scene = scene_of(mesh, joining, mesh.placed, body_triangles, body.rows(), options);
    scene.contact.friction = scene.contact.self_friction = 0;
    // Stitches make one piece of the panels.
    std::ranges::fill(scene.surface.component, 0);
    scene.surface.component_count = 1;
    State state = first_state(scene, means(mesh.placed, joining), {body});
    std::vector<double> first;
    for (const std::array<int, 2>& stitch : mesh.sewn) {
      const int a = joining.number[static_cast<std::size_t>(stitch[0])],
                b = joining.number[static_cast<std::size_t>(stitch[1])];
      if (a == b) continue;
      first.push_back((row(state.x, a) - row(state.x, b)).norm());
      scene.springs.push_back({a, b, first.back(), first_stiffness});
    }
    const int frames = static_cast<int>(options.closing * options.fps) + settling_frames + shutting_frames;
    for (int frame = 1; frame <= frames + most_shut_frames; ++frame) {
      const Closing now = closing_at(frame);
      for (std::size_t s = 0; s < first.size(); ++s) {
        scene.springs[s].rest_length = std::max((1 - now.share) * first[s], std::min(first[s], now.shortest));
        scene.springs[s].stiffness = first_stiffness * std::pow(last_stiffness / first_stiffness, now.share);
      }
      scene.rest = means(rest_with_gap(now.keep / kept_of_rest), joining);
      // A stepper takes stitches as they are when it is made.
      if (!step(*make_recovering_conventional_stepper(scene), scene, joining, false, Vec3::Zero(), state)) break;
      result.closing_frames = frame;
      if (frame >= frames && largest_gap(spread(state.x, joining)) < 2 * options.closed) break;
    }
    return spread(state.x, joining);
  }

  void drape(const Points& closed) {
    const Joining joining = join(mesh, [](std::size_t) { return true; });
    for (std::size_t s = 0; s < mesh.sewn.size(); ++s) result.gaps.push_back(gap(closed, s));
    const Points joined = means(closed, joining);
    result.joined_by = (spread(joined, joining) - closed).rowwise().norm().maxCoeff();
    const Scene scene = scene_of(mesh, joining, mesh.placed, body_triangles, body.rows(), options);
    State state = first_state(scene, joined, {body});
    state.time = result.closing_frames / options.fps;
    state.frame = result.closing_frames;
    const auto stepper = make_recovering_conventional_stepper(scene);
    const Vec3 gravity(0, -9.81, 0);
    for (int frame = 1; frame <= options.most_draping * options.fps; ++frame) {
      const std::optional<double> share = step(*stepper, scene, joining, true, gravity, state);
      if (!share) break;
      result.draping_frames = frame;
      result.moving_share = *share;
      if (frame >= least_draping && state.clean && *share < options.resting_share) break;
    }
    result.x = state.x;
    result.triangles = scene.surface.triangles;
    result.rest = scene.rest_triangle;
    result.vertex = joining.number;
  }
};

}  // namespace

SewnPattern sew_pattern(const PatternMesh& mesh, const Points& body, const Triangles& body_triangles,
                        const SewingOptions& options, const std::function<void(const SewingFrame&)>& seen) {
  Stopwatch watch;
  const Points parted = apart_from_itself(body, body_triangles);
  Sewing sewing{mesh, parted, body_triangles, options, seen};
  sewing.result.body = parted;
  sewing.result.body_moved = (parted - body).rowwise().norm().maxCoeff();
  sewing.drape(sewing.close());
  for (const auto& [name, vertices] : mesh.groups) {
    std::vector<int> members;
    for (const int v : vertices) members.push_back(sewing.result.vertex[static_cast<std::size_t>(v)]);
    std::ranges::sort(members);
    members.erase(std::unique(members.begin(), members.end()), members.end());
    sewing.result.groups.emplace_back(name, std::move(members));
  }
  sewing.result.seconds = watch.lap();
  return sewing.result;
}

}  // namespace selvedge
