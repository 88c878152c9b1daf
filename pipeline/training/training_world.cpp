#include "pipeline/training/training_world.hpp"

#include <algorithm>
#include <cmath>

#include "pipeline/bodies/mannequin.hpp"
#include "pipeline/bodies/smpl_joints.hpp"
#include "pipeline/garments/garment_make.hpp"
#include "pipeline/garments/outfit.hpp"
#include "pipeline/meshes/setup_paths.hpp"
#include "pipeline/motions/clip_procedural.hpp"
#include "pipeline/motions/clip_split.hpp"
#include "pipeline/motions/t_pose.hpp"
#include "pipeline/training/random_stream.hpp"

namespace selvedge {
namespace {

constexpr double tissue_skin_width = 0.02;  // of the skin that a garment's vertex goes along with [m]
constexpr double layer_room = 0.005;        // that a garment more takes between parts of the body [m]

std::vector<std::string> training_clip_names(const SampleOptions& options) {
  if (!options.clips.empty()) return options.clips;
  std::vector<std::string> names;
  for (const ClipEntry& entry : read_clip_split(config_folder() / "clips.yaml"))
    if (!entry.validation) names.push_back(entry.name);
  return names;
}

// A garment by code, or an outfit.
TrainingWear dressed_wear(const std::string& name, const SampleOptions& options, const BodyModel& body) {
  TrainingWear wear{name, {}, {}};
  for (const Outfit& outfit : read_wardrobe(config_folder() / "outfits.yaml").outfits)
    if (outfit.name == name)
      wear.garments = options.start == GarmentStart::tangled ? kept_layers(cache_folder(), outfit, body, options.edge)
                                                             : kept_outfit(cache_folder(), outfit, body, options.edge);
  GarmentOptions cut;
  cut.edge = options.edge;
  if (wear.garments.empty()) wear.garments.push_back(kept_garment(cache_folder(), name, body, cut));
  for (const Garment& garment : wear.garments)
    wear.skin.push_back(options.soft_tissue ? shares_of_body(garment.skin.rest, body, tissue_skin_width)
                                            : SkinWeights{});
  return wear;
}

Eigen::VectorXd training_shape(const SampleOptions& options, std::uint64_t seed, int index, Eigen::Index directions) {
  Eigen::VectorXd shape = Eigen::VectorXd::Zero(directions);
  if (index == 0) return shape;
  RandomStream random = stream_of(seed, static_cast<std::uint64_t>(index));
  for (Eigen::Index k = 0; k < directions; ++k)
    shape[k] = std::clamp(options.shape_spread * random.normal(), -3.0, 3.0);
  return shape;
}

TrainingBody training_body(const TrainingWorld& world, const SampleOptions& options, const Eigen::VectorXd& shape) {
  TrainingBody body;
  body.shape = shape;
  body.joints = joint_positions(world.body, shape);
  const Points rest = shaped(world.body.skin, shape);
  std::size_t layers = 1;
  for (const TrainingWear& wear : world.wear) layers = std::max(layers, wear.garments.size());
  if (options.soft_tissue)
    body.soft_tissue = std::make_shared<GiveWay>(
        world.surface, rest,
        GiveWayOptions{.room = GiveWayOptions{}.room + static_cast<double>(layers - 1) * layer_room});
  const Points joints = smpl_joints(world.body, body.joints);
  for (const std::string& name : world.clip_names)
    body.clips.push_back(make_clip(name, joints, rest.col(1).minCoeff()));
  body.given.resize(body.clips.size());
  return body;
}

const TissueDisplacements& tissue_displacements(TrainingBody& body, int clip, int frame, const Points& skinned) {
  std::map<int, TissueDisplacements>& known = body.given[static_cast<std::size_t>(clip)];
  if (const auto found = known.find(frame); found != known.end()) return found->second;
  const Points moves = (*body.soft_tissue)(skinned)-skinned;
  TissueDisplacements kept;
  for (int v = 0; v < moves.rows(); ++v)
    if (moves.row(v).cwiseAbs().maxCoeff() > 1e-7) kept.vertices.push_back(v);
  kept.displacements = moves(kept.vertices, Eigen::all).cast<float>();
  return known.emplace(frame, std::move(kept)).first->second;
}

}  // namespace

TrainingWorld make_training_world(const SampleOptions& options, std::uint64_t seed) {
  TrainingWorld world;
  world.body = kept_mannequin(cache_folder());
  const auto vertices = static_cast<int>(world.body.skin.rest.rows());
  world.surface = make_surface(vertices, world.body.skin.triangles);
  Triangles turned = world.body.skin.triangles;
  turned.col(1).swap(turned.col(2));
  world.mirrored = make_surface(vertices, turned);
  world.clip_names = training_clip_names(options);
  for (const std::string& name : options.garments) world.wear.push_back(dressed_wear(name, options, world.body));
  for (int k = 0; k < options.shapes; ++k)
    world.bodies.push_back(
        training_body(world, options, training_shape(options, seed, k, world.body.skin.shape_directions.cols())));
  return world;
}

WornFrame worn_frame(TrainingWorld& world, int wear, int body, int clip, int frame) {
  TrainingBody& who = world.bodies[static_cast<std::size_t>(body)];
  const Clip& motion = who.clips[static_cast<std::size_t>(clip)];
  const auto last = static_cast<int>(motion.poses.size()) - 1;
  const int k = std::clamp(frame, 0, last);
  const BodyPose pose = matched(motion.poses[static_cast<std::size_t>(k)], motion.joints, world.body.joints);
  const JointTransforms transforms = joint_transforms(world.body, who.joints, pose);
  Points skinned = posed(world.body.skin, who.shape, pose, transforms);
  Points moves;
  if (who.soft_tissue) {
    const TissueDisplacements& given = tissue_displacements(who, clip, k, skinned);
    moves = Points::Zero(skinned.rows(), 3);
    moves(given.vertices, Eigen::all) = given.displacements.cast<double>();
    skinned += moves;
  }
  WornFrame result;
  result.body = skinned.cast<float>();
  const TrainingWear& what = world.wear[static_cast<std::size_t>(wear)];
  Eigen::Index rows = 0;
  for (const Garment& garment : what.garments) rows += garment.skin.rest.rows();
  result.cloth.resize(rows, 3);
  rows = 0;
  for (std::size_t g = 0; g < what.garments.size(); ++g) {
    Points x = posed(what.garments[g].skin, who.shape, pose, transforms);
    if (who.soft_tissue) x += what.skin[g] * moves;
    result.cloth.middleRows(rows, x.rows()) = x.cast<float>();
    rows += x.rows();
  }
  return result;
}

int frame_count(const TrainingWorld& world, int body, int clip) {
  return static_cast<int>(
      world.bodies[static_cast<std::size_t>(body)].clips[static_cast<std::size_t>(clip)].poses.size());
}

}  // namespace selvedge
