#include <algorithm>
#include <memory>
#include <optional>

#include "pipeline/body_hdf5.hpp"
#include "pipeline/body_smpl.hpp"
#include "pipeline/clip_amass.hpp"
#include "pipeline/clip_bvh.hpp"
#include "pipeline/clip_procedural.hpp"
#include "pipeline/mannequin.hpp"
#include "pipeline/setup_motion.hpp"
#include "pipeline/setup_obstacle.hpp"
#include "pipeline/setup_paths.hpp"
#include "pipeline/smpl_joints.hpp"
#include "pipeline/t_pose.hpp"

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

// What clips are made for: the body in SMPL's zero pose.
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
Clip read_clip(const Config& clip, const Measures& who, const std::filesystem::path& folder) {
  const std::filesystem::path name(clip.text());
  if (name.extension() == ".npz")
    return read_amass(existing_path(clip, folder), amass_fps, row(who.joints, smpl::pelvis));
  if (name.extension() == ".bvh") {
    BvhOptions options;
    options.floor = who.floor;
    return retargeted(read_bvh(existing_path(clip, folder)), who.joints, options);
  }
  const std::vector<std::string> known = procedural_clip_names();
  if (std::find(known.begin(), known.end(), clip.text()) == known.end())
    clip.fail("is the unknown clip `" + clip.text() + "`",
              "name a .bvh or .npz file, or one of " + joined(known) + suggestion(clip.text(), known));
  return make_clip(clip.text(), who.joints, who.floor);
}

// The clip by the body's own joints, from its own zero pose. A start with the arms down comes before the body's own
// zero pose is accounted for, since it is said in SMPL's; the zero pose that cloth was fitted to is the body's own.
Clip performed(const Config& section, const Performance& who, const std::filesystem::path& folder) {
  const double seconds = section["blend_in"].number();
  const bool from_zero = section["start_pose"].text() == "zero";
  const auto blended = [&](const Clip& clip, StartPose start, bool wanted) {
    return wanted && seconds > 0 ? blended_in(clip, seconds, start) : clip;
  };
  check_joints(who.body, section["clip"]);
  const Points joints = joint_positions(who.body, who.shape);
  const std::optional<BodyPose> t = t_pose(who.body, joints);
  Clip clip = read_clip(section["clip"], measured(who, joints, t), folder);
  clip = blended(clip, StartPose::arms_down, !from_zero);
  if (t) clip = from_own_zero_pose(clip, who.body, joints, *t);
  return blended(clip, StartPose::zero, from_zero);
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
  if (clip.given) who.clip = performed(section, who, folder);
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
