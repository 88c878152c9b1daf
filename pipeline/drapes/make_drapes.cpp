#include "pipeline/drapes/make_drapes.hpp"

#include <algorithm>

#include "collision/audit/audit.hpp"
#include "collision/geometry/stopwatch.hpp"
#include "collision/search/intersections.hpp"
#include "collision/search/obstacle.hpp"
#include "physics/frame/make_frame.hpp"
#include "physics/scene/make_scene.hpp"
#include "physics/steppers/decorated_stepper.hpp"
#include "pipeline/measures/motion_measures.hpp"
#include "pipeline/motions/clip_procedural.hpp"

namespace selvedge {
namespace {

// A soft knit (configs/materials/jersey.yaml), damped so that it comes to rest soon.
Material drape_material(const DrapeOptions& options) {
  constexpr double youngs = 300, poisson = 0.4;
  Material material;
  material.name = "jersey";
  material.density = 0.187;
  material.lame_mu = youngs / (2 * (1 + poisson));
  material.lame_lambda = youngs * poisson / (1 - poisson * poisson);
  material.bending = 6.2e-6;
  material.mass_damping = options.damping;
  return material;
}

// A path in progress.
struct PathMaker {
  const DrapeWorld& world;
  const std::function<bool()>& stop;
  DrapePath path;
  RandomStream random;
  Points joints;  // of the shaped body
  Scene scene;
  State state;
  std::unique_ptr<Stepper> stepper;
  BodyPose pose;
  IntersectionCache body_cache;
  std::optional<Clip> clip;  // source of the poses; none: they are drawn
  FrameAudits audits{scene};

  Points body_in(const BodyPose& at) const {
    return posed(world.body.skin, path.shape, at, joint_transforms(world.body, joints, at));
  }
};

void dress(PathMaker& maker) {
  const DrapeWorld& world = maker.world;
  const Points rest = styled_rest(world, maker.path.shape, maker.path.style);
  add_cloth(maker.scene, rest, world.garment.skin.triangles, drape_material(world.options), world.garment.name);
  maker.scene.rest_is_flat = true;
  maker.scene.pins = world.garment.pins;
  maker.scene.contact.thickness = world.options.thickness;
  maker.scene.contact.friction = world.options.friction;
  add_obstacle(maker.scene, world.body_surface.vertex_count, world.body_surface.triangles, true, "body");
  maker.pose.rotations = Points::Zero(static_cast<Eigen::Index>(world.body.joints.size()), 3);
  maker.state = first_state(maker.scene, rest, {maker.body_in(maker.pose)});
  maker.stepper = make_recovering_conventional_stepper(maker.scene);
}

// The pose of the clip at that time, or the first later one in which the body does not intersect itself.
BodyPose clip_pose(PathMaker& maker, double time) {
  const Clip& clip = *maker.clip;
  BodyPose pose;
  for (int later = 0; later < std::ssize(clip.poses); ++later, ++maker.path.poses_redrawn) {
    pose = matched(pose_at(clip, time + later / clip.fps), clip.joints, maker.world.body.joints);
    pose.translation.setZero();
    if (intersecting_pairs(maker.world.body_surface, maker.body_in(pose), maker.body_cache).empty()) break;
  }
  return pose;
}

// The pose of the path's drape k.
BodyPose next_pose(PathMaker& maker, int k) {
  if (maker.clip) {
    const double length = static_cast<double>(maker.clip->poses.size()) / maker.clip->fps;
    return clip_pose(maker, length * (k + 1) / (maker.world.options.poses + 1));
  }
  constexpr int most_draws = 50;
  BodyPose pose;
  for (int draw = 0; draw < most_draws; ++draw, ++maker.path.poses_redrawn) {
    pose = draw_pose(maker.random, maker.world.body.joints, maker.world.options.pose_range);
    if (intersecting_pairs(maker.world.body_surface, maker.body_in(pose), maker.body_cache).empty()) break;
  }
  return pose;
}

// Returns false if the step is rejected.
bool advance(PathMaker& maker, const BodyPose& at) {
  Drive drive = at_rest(maker.scene, maker.state);
  drive.obstacles = {maker.body_in(at)};
  if (!maker.scene.pins.empty()) {
    const std::vector<VertexFrame> frames = vertex_frames(maker.world, maker.path.shape, at);
    drive.pins.resize(std::ssize(maker.scene.pins), 3);
    for (std::size_t k = 0; k < maker.scene.pins.size(); ++k) {
      const VertexFrame& frame = frames[static_cast<std::size_t>(maker.scene.pins[k])];
      drive.pins.row(static_cast<Eigen::Index>(k)) =
          (frame.leftCols<3>() * row(maker.scene.rest, maker.scene.pins[k]) + frame.col(3)).transpose();
    }
  }
  State next;
  const StepReport report =
      make_frame(*maker.stepper, maker.audits, maker.state, drive, 1 / maker.world.options.fps, next);
  if (report.status != StepStatus::accepted) return false;
  maker.state = std::move(next);
  return true;
}

double speed_of_fast_ones(const Points& v) {
  const Eigen::VectorXd speeds = v.rowwise().norm();
  return percentile({speeds.begin(), speeds.end()}, 0.99);
}

// The reason to drop the drape; empty: it is kept.
std::string reason_to_drop(const PathMaker& maker, bool at_rest) {
  if (!at_rest) return "not at rest";
  const State& state = maker.state;
  const Points body = maker.body_in(maker.pose);
  if (!state.x.allFinite()) return "not finite";
  const std::vector<AuditBody> bodies{{&maker.world.body_surface, &body}};
  const Audit found = audit(maker.world.surface, state.x, bodies);
  const bool meets_body = !found.obstacle_pairs.empty(), meets_self = !found.self_pairs.empty();
  if (obstacle_available()) {
    const ObstacleModel cloth(maker.world.surface.triangles, state.x), solid(maker.world.body_surface.triangles, body);
    if (collision_free(cloth, solid) == meets_body) return "FCL and audit differ on the body";
    if (obstacle_self_pairs(cloth, maker.world.surface.triangles).empty() == meets_self)
      return "FCL and audit differ on cloth";
  }
  if (meets_body) return "crosses the body";
  if (found.inside_vertices > 0) return "inside the body";
  if (meets_self) return "crosses itself";
  if (!found.vertex_pairs.empty()) return "crosses itself at a vertex";
  return "";
}

enum class PoseEnd { reached, rejected, stopped };

// Takes the garment into the next pose and lets it come to rest.
PoseEnd go_on(PathMaker& maker, int number) {
  const DrapeOptions& options = maker.world.options;
  const BodyPose goal = next_pose(maker, number);
  const Clip transition{"transition", 1, maker.world.body.joints, {maker.pose, goal}, {}};
  bool rests = false;
  for (int k = 1; k <= options.move_frames + std::max(options.most_settle_frames, options.settle_frames); ++k) {
    if (maker.stop && maker.stop()) return PoseEnd::stopped;
    const double t = std::min(1.0, static_cast<double>(k) / options.move_frames);
    maker.pose = t < 1 ? pose_at(transition, t * t * (3 - 2 * t)) : goal;
    if (!advance(maker, maker.pose)) return PoseEnd::rejected;
    rests = speed_of_fast_ones(maker.state.v) < options.rest_speed;
    if (rests && k >= options.move_frames + options.settle_frames) break;
  }
  if (const std::string reason = reason_to_drop(maker, rests); !reason.empty()) {
    ++maker.path.dropped[reason];
    return PoseEnd::reached;
  }
  maker.path.rotations.push_back(goal.rotations);
  maker.path.x.push_back(maker.state.x.cast<float>().cast<double>());
  return PoseEnd::reached;
}

}  // namespace

std::optional<DrapePath> make_drape_path(const DrapeWorld& world, std::uint64_t number,
                                         const std::function<bool()>& stop) {
  Stopwatch watch;
  const DrapeOptions& options = world.options;
  PathMaker maker{world, stop, {}, stream_of(options.seed, number), {}, {}, {}, {}, {}, {}, {}};
  // Paths along clips share their bodies.
  constexpr std::uint64_t shapes_from = 1'000'000;
  const auto shapes = static_cast<std::uint64_t>(options.shapes);
  RandomStream of_shape = options.clips.empty() ? maker.random : stream_of(options.seed, shapes_from + number % shapes);
  maker.path.shape = draw_body_shape(of_shape, world.body.skin.shape_directions.cols(), options.shape_spread);
  if (options.clips.empty()) maker.random = of_shape;
  maker.path.style = draw_style(maker.random, world.options.style_spread);
  maker.joints = joint_positions(world.body, maker.path.shape);
  if (!options.clips.empty()) {
    std::vector<std::string> all = options.clips;
    all.insert(all.end(), options.test_clips.begin(), options.test_clips.end());
    maker.clip = make_clip(all[number / shapes], maker.joints.topRows(24));
  }
  dress(maker);
  for (int k = 0; k < world.options.poses; ++k) {
    const PoseEnd end = go_on(maker, k);
    if (end == PoseEnd::stopped) return {};
    if (end == PoseEnd::rejected) {
      maker.path.dropped["step rejected"] += world.options.poses - k;
      break;
    }
  }
  maker.path.seconds = watch.lap();
  return std::move(maker.path);
}

}  // namespace selvedge
