#include <algorithm>
#include <memory>

#include "pipeline/body_hdf5.hpp"
#include "pipeline/body_smpl.hpp"
#include "pipeline/clip_amass.hpp"
#include "pipeline/clip_bvh.hpp"
#include "pipeline/clip_procedural.hpp"
#include "pipeline/mannequin.hpp"
#include "pipeline/setup_motion.hpp"
#include "pipeline/setup_obstacle.hpp"
#include "pipeline/setup_paths.hpp"

namespace selvedge {
namespace {

constexpr double amass_fps = 30;

// A body, its shape and what it does.
struct Performance {
  BodyModel body;
  Eigen::VectorXd shape;
  Clip clip;  // without poses: it stands in the zero pose
};

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

Performance read_performance(const Config& section, const std::filesystem::path& folder) {
  const Config &clip = section["clip"], &shape = section["shape"];
  Performance who{read_model(section["model"], folder), {}, {}};
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

}  // namespace

ObstaclePart read_performer(const Config& section, const std::filesystem::path& folder) {
  const auto who = std::make_shared<const Performance>(read_performance(section["body"], folder));
  const auto skin_at = [who, section](double time) {
    BodyPose pose{Points::Zero(static_cast<Eigen::Index>(who->body.joints.size()), 3)};
    if (!who->clip.poses.empty()) pose = matched(pose_at(who->clip, time), who->clip.joints, who->body.joints);
    return placed(section, posed(who->body, who->shape, pose));
  };
  const Points start = skin_at(0);
  const Motion motion = read_motion(section["motion"], start);
  ObstaclePart part;
  part.obstacle.surface = make_surface(static_cast<int>(start.rows()), who->body.skin.triangles);
  part.obstacle.moving = who->clip.poses.size() > 1 || !is_still(motion);
  part.at = [skin_at, motion](double time) { return moved(motion, skin_at(time), time); };
  return part;
}

}  // namespace selvedge
