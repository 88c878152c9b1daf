#include "pipeline/setup_body.hpp"

#include <algorithm>
#include <cmath>

#include "pipeline/body_hdf5.hpp"
#include "pipeline/body_smpl.hpp"
#include "pipeline/clip_amass.hpp"
#include "pipeline/clip_bvh.hpp"
#include "pipeline/clip_procedural.hpp"
#include "pipeline/mannequin.hpp"
#include "pipeline/setup_motion.hpp"
#include "pipeline/setup_paths.hpp"

namespace selvedge {
namespace {

constexpr double amass_fps = 30;

BodyModel read_model(const Config& model, const std::filesystem::path& folder) {
  if (model.text() == "mannequin") return kept_mannequin(cache_folder());
  const std::filesystem::path file = existing_path(model, folder);
  if (file.extension() == ".npz") return read_smpl(file);
  if (file.extension() == ".h5") return read_body(file);
  model.fail("is neither `mannequin` nor a .npz or .h5 file", "convert the body as docs/bodies.md says");
}

// The joints that clips are made for, 24 x 3; hands that the body lacks are where its wrists are.
Points smpl_joints(const BodyModel& body, const Points& joints, const Config& clip) {
  const std::vector<std::string> names = smpl_joint_names(24);
  Points found(24, 3);
  for (int j = 0; j < 24; ++j) {
    const auto at = std::find(body.joints.begin(), body.joints.end(), names[j]);
    if (at != body.joints.end())
      found.row(j) = joints.row(at - body.joints.begin());
    else if (j >= 22)
      found.row(j) = found.row(j - 2);
    else
      clip.fail("needs the joint `" + names[j] + "`, which the body " + body.name + " lacks",
                "name the body's joints as SMPL does, see docs/mannequin.md");
  }
  return found;
}

Clip read_clip(const Config& clip, const Performance& who, const std::filesystem::path& folder) {
  const Points joints = joint_positions(who.body, who.shape);
  const double floor = shaped(who.body.skin, who.shape).col(1).minCoeff();
  const std::filesystem::path name(clip.text());
  if (name.extension() == ".npz") return read_amass(existing_path(clip, folder), amass_fps, row(joints, 0));
  if (name.extension() == ".bvh") {
    BvhOptions options;
    options.floor = floor;
    return retargeted(read_bvh(existing_path(clip, folder)), smpl_joints(who.body, joints, clip), options);
  }
  const std::vector<std::string> known = procedural_clip_names();
  if (std::find(known.begin(), known.end(), clip.text()) == known.end())
    clip.fail("is the unknown clip `" + clip.text() + "`",
              "name a .bvh or .npz file, or one of " + joined(known) + suggestion(clip.text(), known));
  return make_clip(clip.text(), smpl_joints(who.body, joints, clip), floor);
}

// Scaled, turned and moved as the body is.
Points in_scene(const Performance& who, const Points& x, double time) {
  return moved(who.motion, placed(who.section, x), time);
}

}  // namespace

Performance read_performance(const Config& section, const std::filesystem::path& folder) {
  const Config &clip = section["clip"], &shape = section["shape"];
  Performance who;
  who.body = read_model(section["model"], folder);
  const bool of_smpl = std::filesystem::path(section["model"].text()).extension() == ".npz";
  if (shape.given)
    who.shape =
        Eigen::Map<const Eigen::VectorXd>(shape.numbers.data(), static_cast<Eigen::Index>(shape.numbers.size()));
  else if (of_smpl && clip.given && std::filesystem::path(clip.text()).extension() == ".npz")
    who.shape = read_amass_shape(existing_path(clip, folder));
  if (who.shape.size() > who.body.skin.shape_directions.cols())
    shape.fail("has more coefficients than the body has shapes",
               "give at most " + std::to_string(who.body.skin.shape_directions.cols()));
  if (!clip.given) return who;
  who.clip = read_clip(clip, who, folder);
  const StartPose start = section["start_pose"].text() == "zero" ? StartPose::zero : StartPose::arms_down;
  if (const double seconds = section["blend_in"].number(); seconds > 0) who.clip = blended_in(who.clip, seconds, start);
  return who;
}

Performances read_performances(const Config& obstacles, const std::filesystem::path& folder) {
  Performances all;
  for (const Config& section : obstacles.items) {
    all.emplace_back();
    if (!section["body"].given) continue;
    const auto who = std::make_shared<Performance>(read_performance(section["body"], folder));
    who->name = obstacle_name(section, all.size() - 1);
    who->section = section;
    who->motion = read_motion(section["motion"], body_at(*who, 0));
    all.back() = who;
  }
  return all;
}

void come_from(const Points& rotations, double begins, double seconds, Performance& who) {
  const double fps = std::ceil(seconds * who.clip.fps) / seconds;  // whole frames
  const Clip still{who.name, fps, who.body.joints, {pose_at(who, 0)}, {}};
  who.before = blended_in(still, seconds, rotations);
  who.begins = begins;
}

BodyPose pose_at(const Performance& who, double time) {
  if (time < 0 && !who.before.poses.empty()) return pose_at(who.before, time - who.begins);
  if (who.clip.poses.empty()) return {Points::Zero(static_cast<Eigen::Index>(who.body.joints.size()), 3)};
  return matched(pose_at(who.clip, time), who.clip.joints, who.body.joints);
}

Points body_at(const Performance& who, double time) {
  return in_scene(who, posed(who.body, who.shape, pose_at(who, time)), time);
}

Points worn_at(const Performance& who, const Garment& garment, double time) {
  return in_scene(who, worn(garment, who.body, who.shape, pose_at(who, time)), time);
}

bool is_still(const Performance& who) {
  return who.clip.poses.size() < 2 && who.before.poses.size() < 2 && is_still(who.motion);
}

ObstaclePart obstacle_of(const std::shared_ptr<const Performance>& who) {
  ObstaclePart part;
  part.obstacle.name = who->name;
  part.obstacle.surface = make_surface(static_cast<int>(who->body.skin.rest.rows()), who->body.skin.triangles);
  part.obstacle.moving = !is_still(*who);
  part.at = [who](double time) { return body_at(*who, time); };
  return part;
}

}  // namespace selvedge
