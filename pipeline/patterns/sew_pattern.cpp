#include "pipeline/patterns/sew_pattern.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "collision/geometry/disjoint_sets.hpp"
#include "collision/geometry/stopwatch.hpp"
#include "collision/untangle/untangle.hpp"
#include "physics/frame/make_frame.hpp"
#include "physics/steppers/decorated_stepper.hpp"
#include "pipeline/patterns/clear_stitches.hpp"

namespace selvedge {
namespace {

constexpr double one_place = 1e-7;                            // vertices nearer than this lie at one place [m]
constexpr double first_stiffness = 30, last_stiffness = 2e4;  // of a stitch, rising while it gets shorter [N/m]
constexpr double sewn_stiffer = 30;  // factor on bending while panels are sewn, which keeps them from folding
constexpr double facing = 0.01;      // length of stitches at which edges align [m]
constexpr int facing_frames = 8, shutting_frames = 10, most_shut_frames = 10, flattening_frames = 8;
constexpr double round_body = 0.25;  // distance of a garment that begins to fall on the body, relative to its extent
constexpr int least_draping = 15;    // frames, since a garment that begins to fall is slow but not at rest

// Panels with some stitches joined: the new number of each vertex, and the count.
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
    sum.row(to.number[v]) += x.row(v);
    members[to.number[v]] += 1;
  }
  for (int v = 0; v < to.count; ++v) sum.row(v) /= members[v];
  return sum;
}

Points spread(const Points& x, const Joining& from) { return x(from.number, Eigen::all); }

Triangles renumbered(Triangles triangles, const Joining& to) {
  for (int& v : triangles.reshaped()) v = to.number[v];
  return triangles;
}

// `stiffer`: factor on the material's bending.
Scene scene_of(const PatternMesh& mesh, const Joining& joining, const Triangles& body_triangles,
               Eigen::Index body_vertices, const SewingOptions& options, double stiffer) {
  Scene scene;
  Material material = options.material;
  material.mass_damping = std::max(material.mass_damping, options.damping);
  material.bending *= stiffer;
  add_cloth(scene, means(mesh.placed, joining), renumbered(mesh.triangles, joining), material, "garment", mesh.rest);
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

  // Returns the share of vertices that move, or nothing if the step was rejected.
  std::optional<double> step(Stepper& stepper, FrameAudits& audits, const Joining& joining, bool sewn,
                             const Vec3& gravity, State& state) {
    Drive drive = at_rest(audits.scene, state);
    drive.acceleration = gravity;
    drive.obstacles = {body};
    State next;
    const StepReport report = make_frame(stepper, audits, state, drive, 1 / options.fps, next);
    if (report.status != StepStatus::accepted) {
      result.rejected = true;
      return {};
    }
    const double share = moving_share(next.x - state.x, 1 / options.fps);
    state = std::move(next);
    if (seen) {
      const Points x = spread(state.x, joining);
      seen({state.time, sewn, largest_gap(x), share, &report, &x});
    }
    return share;
  }

  // The length of a stitch with first length `first` in a frame of the closing [m]. First all shrink to `facing`, at
  // which the edges of two panels align, then they close.
  double length_at(int frame, double first) const {
    const double closing_frames = options.closing * options.fps, t = std::min(1.0, frame / closing_frames);
    const double shut = std::clamp((frame - closing_frames - facing_frames) / shutting_frames, 0.0, 1.0);
    return std::max((1 - t * t * (3 - 2 * t)) * first, (1 - shut) * std::min(first, facing));
  }

  // Positions of the panels' vertices with stitches closed as far as possible. At the end contact of cloth with cloth
  // is off: it would keep edges apart that lie on each other, and overlapping edges could not pass each other.
  Points close() {
    const Joining joining = join(mesh, [&](std::size_t s) { return gap(mesh.placed, s) < one_place; });
    Scene scene = scene_of(mesh, joining, body_triangles, body.rows(), options, sewn_stiffer);
    scene.contact.friction = scene.contact.self_friction = 0;
    State state = first_state(scene, means(mesh.placed, joining), {body});
    std::vector<double> first;
    for (const std::array<int, 2>& stitch : mesh.sewn) {
      const int a = joining.number[stitch[0]], b = joining.number[stitch[1]];
      if (a == b) continue;
      first.push_back((row(state.x, a) - row(state.x, b)).norm());
      scene.springs.push_back({a, b, first.back(), first_stiffness});
    }
    const int closing_frames = static_cast<int>(options.closing * options.fps),
              facing_end = closing_frames + facing_frames, shut_end = facing_end + shutting_frames;
    for (int frame = 1; frame <= shut_end + most_shut_frames; ++frame) {
      for (std::size_t s = 0; s < first.size(); ++s) {
        scene.springs[s].rest_length = length_at(frame, first[s]);
        scene.springs[s].stiffness =
            first_stiffness * std::pow(last_stiffness / first_stiffness, std::min(1.0, 1.0 * frame / shut_end));
      }
      scene.contact.self = frame <= facing_end;
      FrameAudits audits(scene);
      // A stepper keeps the stitches with which it was made.
      if (!step(*make_recovering_conventional_stepper(scene), audits, joining, false, Vec3::Zero(), state)) break;
      result.closing_frames = frame;
      if (frame >= shut_end && largest_gap(spread(state.x, joining)) < options.closed) break;
    }
    return spread(state.x, joining);
  }

  void drape(const Points& closed) {
    const Joining joining = join(mesh, [](std::size_t) { return true; });
    for (std::size_t s = 0; s < mesh.sewn.size(); ++s) result.gaps.push_back(gap(closed, s));
    const Points joined = means(closed, joining);
    result.watch.part = worn_part(joined, body, round_body);
    result.joined_by = (spread(joined, joining) - closed).rowwise().norm().maxCoeff();
    Scene flat = scene_of(mesh, joining, body_triangles, body.rows(), options, sewn_stiffer);
    State state = first_state(flat, joined, {body});
    state.time = result.closing_frames / options.fps;
    state.frame = result.closing_frames;
    // Overlaps at the seams spring flat before contact of cloth with cloth is on again.
    flat.contact.self = false;
    flat.contact.friction = 0;
    const auto flattening = make_recovering_conventional_stepper(flat);
    FrameAudits flat_audits(flat);
    for (int frame = 1; frame <= flattening_frames; ++frame)
      if (!step(*flattening, flat_audits, joining, true, Vec3::Zero(), state)) return;
    state.clean = false;
    const Scene scene = scene_of(mesh, joining, body_triangles, body.rows(), options, 1);
    const auto stepper = make_recovering_conventional_stepper(scene);
    FrameAudits audits(scene);
    const Vec3 gravity(0, -9.81, 0);
    for (int frame = 1; frame <= options.most_draping * options.fps; ++frame) {
      const std::optional<double> share = step(*stepper, audits, joining, true, gravity, state);
      if (!share) break;
      result.draping_frames = frame;
      result.moving_share = *share;
      result.watch.see(state.frame, state.x, body);
      if (result.watch.left_in >= 0) break;
      if (frame >= least_draping && state.clean && *share < resting_share) break;
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
  PatternMesh begun = mesh;
  begun.placed = clear_of(mesh, parted, body_triangles);
  Sewing sewing{begun, parted, body_triangles, options, seen};
  sewing.result.body = parted;
  sewing.result.body_moved = (parted - body).rowwise().norm().maxCoeff();
  sewing.drape(sewing.close());
  for (const auto& [name, vertices] : mesh.groups) {
    std::vector<int> members;
    for (const int v : vertices) members.push_back(sewing.result.vertex[v]);
    std::ranges::sort(members);
    members.erase(std::unique(members.begin(), members.end()), members.end());
    sewing.result.groups.emplace_back(name, std::move(members));
  }
  sewing.result.seconds = watch.lap();
  return sewing.result;
}

}  // namespace selvedge
