#include <algorithm>

#include "collision/geometry/welded_surface.hpp"
#include "pipeline/training/soft_tissue_hdf5.hpp"

namespace selvedge {
namespace {

std::size_t bytes_of(const TissueDisplacements& tissue) {
  return tissue.vertices.size() * (sizeof(int) + 3 * sizeof(float)) + sizeof(TissueDisplacements);
}

// Writes frames to the folder and frees their memory.
void forget_tissue(TrainingWorld& world) {
  write_soft_tissue(world.soft_tissue_folder, world);
  for (TrainingBody& body : world.bodies)
    for (TrainingClip& clip : body.clips) {
      clip.given.clear();
      clip.looked = false;
    }
  world.tissue_bytes = 0;
}

const TissueDisplacements& tissue_displacements(TrainingWorld& world, TrainingBody& body, int clip, int frame,
                                                const Points& skinned) {
  if (world.tissue_bytes > world.most_tissue) forget_tissue(world);
  TrainingClip& of = body.clips[static_cast<std::size_t>(clip)];
  if (!of.looked) {
    of.given.merge(read_soft_tissue(world.soft_tissue_folder, world, body, of));
    of.looked = true;
    for (const auto& [_, known] : of.given) world.tissue_bytes += bytes_of(known);
  }
  if (const auto found = of.given.find(frame); found != of.given.end()) return found->second;
  const Points moves = (*body.soft_tissue)(skinned)-skinned;
  TissueDisplacements kept;
  for (int v = 0; v < moves.rows(); ++v)
    if (moves.row(v).cwiseAbs().maxCoeff() > 1e-7) kept.vertices.push_back(v);
  kept.displacements = moves(kept.vertices, Eigen::all).cast<float>();
  world.tissue_bytes += bytes_of(kept);
  return of.given.emplace(frame, std::move(kept)).first->second;
}

}  // namespace

SkinnedFrame skinned_frame(TrainingWorld& world, int wear, int body, int clip, int frame) {
  TrainingBody& who = world.bodies[static_cast<std::size_t>(body)];
  const TrainingPerson& person = world.people[static_cast<std::size_t>(who.person)];
  const Clip& motion = who.clips[static_cast<std::size_t>(clip)].motion;
  const auto last = static_cast<int>(motion.poses.size()) - 1;
  const int k = std::clamp(frame, 0, last);
  const BodyPose pose = matched(motion.poses[static_cast<std::size_t>(k)], motion.joints, person.body.joints);
  const JointTransforms transforms = joint_transforms(person.body, who.joints, pose);
  Points skinned = posed(person.body.skin, who.shape, pose, transforms);
  Points moves;
  if (who.soft_tissue) {
    const TissueDisplacements& given = tissue_displacements(world, who, clip, k, skinned);
    moves = Points::Zero(skinned.rows(), 3);
    moves(given.vertices, Eigen::all) = given.displacements.cast<double>();
    skinned += moves;
  }
  hold_together(person.joined, skinned);
  SkinnedFrame result;
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

}  // namespace selvedge
