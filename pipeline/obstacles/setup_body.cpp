#include "pipeline/obstacles/setup_body.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "collision/geometry/stopwatch.hpp"
#include "pipeline/bodies/body_hdf5.hpp"
#include "pipeline/bodies/body_outward.hpp"
#include "pipeline/bodies/body_smpl.hpp"
#include "pipeline/bodies/mannequin.hpp"
#include "pipeline/bodies/skin_places.hpp"
#include "pipeline/bodies/smpl_joints.hpp"
#include "pipeline/bodies/up_axis.hpp"
#include "pipeline/host/bounds.hpp"
#include "pipeline/host/bytes_of.hpp"
#include "pipeline/host/file_formats.hpp"
#include "pipeline/host/kept_rows.hpp"
#include "pipeline/host/lower_extension.hpp"
#include "pipeline/motions/clip_amass.hpp"
#include "pipeline/motions/clip_bvh.hpp"
#include "pipeline/motions/clip_procedural.hpp"
#include "pipeline/motions/rig_gltf.hpp"
#include "pipeline/motions/t_pose.hpp"
#include "pipeline/obstacles/setup_motion.hpp"
#include "pipeline/obstacles/setup_paths.hpp"

namespace selvedge {
namespace {

constexpr double gltf_frames = 60;  // frames per second in scenes: glTF files have none

BodyModel read_model(const Config& model, const std::filesystem::path& folder, std::vector<std::string>& warnings) {
  if (model.text() == "mannequin") return kept_mannequin(cache_folder());
  const std::filesystem::path file = existing_path(model, folder);
  if (lower_extension(file) == ".npz") return read_smpl(file);
  if (lower_extension(file) == ".h5") return read_body(file);
  if (is_gltf(file)) {
    GltfRig rig = read_gltf_rig(file);
    warnings = rig.scene.mesh.warnings;
    return std::move(rig.body);
  }
  model.fail("is neither `mannequin` nor a .npz, .h5, .glb or .gltf file",
             export_cure(file, ".glb", "convert the body as docs/bodies.md says"));
}

// The body in SMPL's zero pose, for which clips are made.
struct Measures {
  Points joints;     // 24 x 3
  double floor = 0;  // y of the soles
};

Measures measured(const Performance& who, const Points& joints, const std::optional<BodyPose>& t_pose) {
  if (!t_pose) return {smpl_joints(who.body, joints), shaped(who.body.skin, who.shape).col(1).minCoeff()};
  return {smpl_joints(who.body, posed_joints(who.body, joints, *t_pose)),
          posed(who.body, who.shape, *t_pose).col(1).minCoeff()};
}

void check_joints(const BodyModel& body, const Config& clip) {
  const std::vector<std::string> names = smpl_joint_names(smpl::joints);
  const std::vector<int> found = smpl_joints_among(body.joints);
  for (std::size_t j = 0; j < found.size(); ++j)
    if (found[j] < 0)
      clip.fail("needs the joint `" + names[j] + "`, which the body " + body.name + " lacks",
                "name the body's joints as SMPL does, see docs/mannequin.md");
}

// Rotations from SMPL's zero pose.
Clip read_clip(const Config& section, const Measures& who, const std::filesystem::path& folder,
               std::vector<std::string>& warnings) {
  const Config& clip = section["clip"];
  const std::filesystem::path name(clip.text());
  for (const std::string key : {"joints", "rest_frame"})
    if (section[key].given && lower_extension(name) != ".bvh")
      section[key].fail("is given for a clip that is no .bvh file", "leave it out");
  if (lower_extension(name) == ".npz")
    return read_amass(existing_path(clip, folder), row(who.joints, smpl::pelvis), warnings);
  if (lower_extension(name) == ".bvh") {
    BvhOptions options;
    options.floor = who.floor;
    if (const Config& names = section["joints"]; names.given)
      for (const std::string& joint : smpl_joint_names(smpl::joints))
        if (names[joint].given) options.joints[joint] = names[joint].text();
    if (section["rest_frame"].given) options.rest_frame = section["rest_frame"].integer();
    return retargeted(read_bvh(existing_path(clip, folder)), who.joints, options);
  }
  const std::vector<std::string> known = procedural_clip_names();
  if (std::find(known.begin(), known.end(), clip.text()) == known.end())
    clip.fail("is the unknown clip `" + clip.text() + "`",
              export_cure(name, ".glb or .bvh",
                          "name a .bvh, .npz, .glb or .gltf file, or one of " + joined(known) +
                              suggestion(clip.text(), known)));
  return make_clip(clip.text(), who.joints, who.floor);
}

// An animation of the body's own skeleton, unchanged.
Clip own_animation(const Config& section, const Performance& who, const std::filesystem::path& folder,
                   std::vector<std::string>& warnings) {
  const Config &clip = section["clip"], &animation = section["animation"];
  const GltfRig rig = read_gltf_rig(existing_path(clip, folder));
  const Points ours = joint_positions(who.body, who.shape);
  if (rig.body.joints != who.body.joints || !(joint_positions(rig.body, {}) - ours).isZero(1e-3))
    clip.fail("moves another skeleton than the body's", "give the same file as `model`, or the body made of it");
  const std::string name = animation.given ? animation.text() : "";
  return read_gltf_clip(rig, name, gltf_rate(rig, name, warnings));
}

// `fps` is the rate at which the scene counts the clip's frames.
void begin_later(const Config& first_frame, double fps, Clip& clip) {
  const double first = std::round(first_frame.integer() * clip.fps / fps);
  if (first >= static_cast<double>(clip.poses.size()))
    first_frame.fail(fmt::format("is beyond the clip's {:.0f} frames", std::floor(end_of(clip) * fps + 1e-6) + 1),
                     "give one of its frames");
  clip.poses.erase(clip.poses.begin(), clip.poses.begin() + static_cast<std::ptrdiff_t>(first));
}

// Extends the clip: backward to its first pose, forward again, and so on.
void turn_round(int turns, Clip& clip) {
  const std::size_t once = clip.poses.size();
  clip.poses.reserve(once + static_cast<std::size_t>(turns) * (once - 1));
  for (int turn = 0; turn < turns; ++turn)
    for (std::size_t k = 1; k < once; ++k) clip.poses.push_back(clip.poses[turn % 2 == 0 ? once - 1 - k : k]);
}

// The clip for the body's own joints, from its own zero pose. A start with arms down is added before the conversion,
// since it refers to SMPL's zero pose; a start in the zero pose to which cloth was fitted is added after it.
Clip performed(const Config& section, const Performance& who, const std::filesystem::path& folder,
               std::vector<std::string>& warnings) {
  const double seconds = section["blend_in"].number();
  const bool from_zero = section["start_pose"].text() == "zero";
  const auto blended = [&](const Clip& clip, StartPose start, bool wanted) {
    return wanted && seconds > 0 ? blended_in(clip, seconds, start) : clip;
  };
  const bool gltf = is_gltf(section["clip"].text());
  if (section["animation"].given && !gltf)
    section["animation"].fail("is given for a clip that is no glTF file", "leave it out");
  if (gltf) {
    Clip clip = own_animation(section, who, folder, warnings);
    begin_later(section["first_frame"], gltf_frames, clip);
    turn_round(section["turns"].integer(), clip);
    return blended(clip, from_zero ? StartPose::zero : StartPose::arms_down, true);
  }
  check_joints(who.body, section["clip"]);
  const Points joints = joint_positions(who.body, who.shape);
  const std::optional<BodyPose> t = t_pose(who.body, joints);
  Clip clip = read_clip(section, measured(who, joints, t), folder, warnings);
  begin_later(section["first_frame"], clip.fps, clip);
  turn_round(section["turns"].integer(), clip);
  clip = blended(clip, StartPose::arms_down, !from_zero);
  if (t) clip = from_own_zero_pose(clip, who.body, joints, *t);
  return blended(clip, StartPose::zero, from_zero);
}

void forget(PosedBodies& known) {
  known.at.clear();
  known.joints.resize(0, 3);
  known.skin.reset();
}

void leave_room(double room, Performance& who) {
  who.soft_tissue = nullptr;
  if (room > 0)
    who.soft_tissue =
        std::make_shared<GiveWay>(who.surface, shaped(who.body.skin, who.shape), GiveWayOptions{.room = room});
  forget(*who.known);
  who.known->room = room;
  who.known->performance = room > 0 ? hash_of_performance(who.surface, who.body.skin, who.shape, who.clip, room) : 0;
}

void give_way(const GiveWay& tissue, PosedBodies& known, PosedBody& body) {
  if (known.store)
    if (std::optional<Points> given = known_tissue(*known.store, body.skinned)) {
      body.given = std::move(*given);
      return;
    }
  Stopwatch watch;
  body.given = tissue(body.skinned, &body.apart);
  ++known.poses;
  known.seconds += watch.lap();
  if (known.store) keep_tissue(body.skinned, body.given, *known.store);
}

}  // namespace

Performance figure_of(BodyModel body, const std::string& what) {
  Performance who;
  who.body = std::move(body);
  turn_outward(what, who.body, who.warnings);
  warn_of_axis(what, who.body, who.warnings);
  WeldedSurface closed = closed_surface(who.body);
  who.surface = std::move(closed.surface);
  who.joined = std::move(closed.joined);
  return who;
}

Performance read_figure(const Config& section, const std::filesystem::path& folder) {
  std::vector<std::string> warnings;
  Performance who = figure_of(read_model(section["model"], folder, warnings), section["model"].text());
  who.warnings.insert(who.warnings.begin(), warnings.begin(), warnings.end());
  return who;
}

void perform_clip(Clip made, const Config& section, const Config& what, Performance& who) {
  who.clip = std::move(made);
  for (std::size_t f = 0; f < who.clip.poses.size(); ++f)
    if (const BodyPose& pose = who.clip.poses[f]; !(pose.rotations.cwiseAbs().maxCoeff() <= largest_turn) ||
                                                  !(pose.translation.cwiseAbs().maxCoeff() <= largest_length))
      what.fail(fmt::format("moves the body absurdly far in frame {}", f),
                fmt::format("repair it where it was made; up to {:g} m and {:g} radians are allowed", largest_length,
                            largest_turn));
  who.fits_room = section["room"].numbers.empty();
  leave_room(who.fits_room ? GiveWayOptions{}.room : section["room"].number(), who);
}

void perform(const Config& section, const std::filesystem::path& folder, Performance& who) {
  const Config &clip = section["clip"], &shape = section["shape"];
  const bool of_smpl = lower_extension(section["model"].text()) == ".npz";
  who.shape.resize(0);
  who.given_shape.resize(0);
  who.clip = {};
  leave_room(0, who);
  if (shape.given)
    who.shape = who.given_shape =
        Eigen::Map<const Eigen::VectorXd>(shape.numbers.data(), static_cast<Eigen::Index>(shape.numbers.size()));
  else if (of_smpl && clip.given && lower_extension(clip.text()) == ".npz")
    who.shape = read_amass_shape(existing_path(clip, folder), who.warnings);
  if (who.shape.size() > who.body.skin.shape_directions.cols())
    shape.fail("has more coefficients than the body has shapes",
               "give at most " + std::to_string(who.body.skin.shape_directions.cols()));
  if (const Config& given = shape.given ? shape : clip;
      !(shaped(who.body.skin, who.shape).cwiseAbs().maxCoeff() <= largest_length))
    given.fail("makes the body absurdly large", "coefficients of SMPL's shapes are mostly between -5 and 5");
  warn_of_crossings(section["model"].text(), own_crossings(who.body, who.shape), who.warnings);
  for (const std::string key : {"joints", "rest_frame"})
    if (section[key].given && !clip.given) section[key].fail("is given without a clip", "name a .bvh file as `clip`");
  if (!clip.given) return;
  perform_clip(performed(section, who, folder, who.warnings), section, clip, who);
}

void place_performance(const Config& section, const std::string& name, Performance& who) {
  who.name = name;
  who.section = section;
  who.motion = section["motion"].given ? read_motion(section["motion"], body_at(who, 0)) : Motion{};
}

Performance read_performance(const Config& section, const std::filesystem::path& folder) {
  Performance who = read_figure(section, folder);
  perform(section, folder, who);
  return who;
}

void wear(int garments, Performance& who) {
  constexpr double a_garment = 0.005;  // [m]
  who.garments = garments;
  if (who.soft_tissue && who.fits_room && garments > 1)
    leave_room(GiveWayOptions{}.room + (garments - 1) * a_garment, who);
}

Performances read_performances(const Config& obstacles, const std::filesystem::path& folder) {
  Performances all;
  for (const Config& section : obstacles.items) {
    all.emplace_back();
    if (!section["body"].given) continue;
    const auto who = std::make_shared<Performance>(read_performance(section["body"], folder));
    place_performance(section, obstacle_name(section, all.size() - 1), *who);
    all.back() = who;
  }
  return all;
}

void come_from(const Points& rotations, double begins, double seconds, Performance& who) {
  const double fps = std::ceil(seconds * who.clip.fps) / seconds;  // whole frames
  const Clip still{who.name, fps, who.body.joints, {pose_at(who, 0)}, {}};
  who.before = blended_in(still, seconds, rotations);
  who.begins = begins;
  forget(*who.known);
}

std::uint64_t hash_of_performance(const Surface& surface, const SkinnedSurface& skin, const Eigen::VectorXd& shape,
                                  const Clip& clip, double room) {
  std::uint64_t hash = hash_of(fmt::format("{} {:a} {} {:a}", GiveWay::recipe, room, clip.name, clip.fps));
  const auto take = [&](const auto& numbers) { hash = hash_of(bytes_of(numbers), hash); };
  take(surface.triangles);
  take(shaped(skin, shape));
  for (const BodyPose& pose : clip.poses) take(pose.rotations);
  return hash;
}

void read_tissue(const std::filesystem::path& folder, const std::vector<std::shared_ptr<PosedBodies>>& bodies) {
  for (const auto& body : bodies)
    if (body && body->performance != 0 && !folder.empty())
      body->store = std::make_shared<TissueStore>(read_tissue_store(folder, body->performance));
}

void write_tissue(const std::vector<std::shared_ptr<PosedBodies>>& bodies) {
  for (const auto& body : bodies)
    if (body && body->store) write_tissue_store(*body->store);
}

BodyPose pose_at(const Performance& who, double time) {
  if (time < 0 && !who.before.poses.empty()) return pose_at(who.before, time - who.begins);
  if (who.clip.poses.empty()) return {Points::Zero(static_cast<Eigen::Index>(who.body.joints.size()), 3)};
  return matched(pose_at(who.clip, time), who.clip.joints, who.body.joints);
}

JointTransforms transforms_to(const Performance& who, const BodyPose& pose) {
  Points& joints = who.known->joints;
  if (joints.rows() == 0) joints = joint_positions(who.body, who.shape);
  return joint_transforms(who.body, joints, pose);
}

const PosedBody& posed_at(const Performance& who, double time) {
  constexpr std::size_t most = 4;  // times that a step needs
  std::map<double, PosedBody>& at = who.known->at;
  if (const auto found = at.find(time); found != at.end()) return found->second;
  if (!who.known->keeps_all && at.size() >= most) at.clear();
  const BodyPose pose = pose_at(who, time);
  PosedBody body{posed(who.body.skin, who.shape, pose, transforms_to(who, pose)), {}};
  if (who.soft_tissue)
    give_way(*who.soft_tissue, *who.known, body);
  else
    body.given = body.skinned;
  hold_together(who.joined, body.given);
  return at.emplace(time, std::move(body)).first->second;
}

const PosedSkin& skin_at(const Performance& who, double time) {
  PosedBodies& known = *who.known;
  if (!known.skin || known.skin_at != time) {
    known.skin.emplace(who.surface, posed_at(who, time).given);
    known.skin_at = time;
  }
  return *known.skin;
}

Points in_scene(const Performance& who, const Points& x, double time) {
  return moved(who.motion, placed(who.section, x), time);
}

Points body_at(const Performance& who, double time) { return in_scene(who, posed_at(who, time).given, time); }

bool is_still(const Performance& who) {
  return who.clip.poses.size() < 2 && who.before.poses.size() < 2 && is_still(who.motion);
}

ObstaclePart obstacle_of(const std::shared_ptr<const Performance>& who) {
  ObstaclePart part;
  part.obstacle.name = who->name;
  part.obstacle.surface = who->surface;
  part.obstacle.moving = !is_still(*who);
  if (who->clip.poses.size() > 1) part.ends = end_of(who->clip);
  part.at = [who](double time) { return body_at(*who, time); };
  part.body = [who, joints = joint_positions(who->body, who->shape)](double time) {
    const BodyPose pose = pose_at(*who, time);
    return BodyFrame{who->shape, pose.rotations, pose.translation,
                     in_scene(*who, posed_joints(who->body, joints, pose), time), posed_at(*who, time).apart};
  };
  return part;
}

}  // namespace selvedge
