#include <algorithm>

#include "collision/geometry/welded_surface.hpp"
#include "pipeline/obstacles/setup_body.hpp"
#include "pipeline/training/training_world.hpp"

namespace selvedge {
namespace {

constexpr double least_move = 1e-7;  // of a vertex that soft tissue moves [m]

std::size_t memory_of(const TissueStore& store) {
  return store.numbers * sizeof(double) + store.numbers / 3 * sizeof(int) +
         store.poses.size() * sizeof(TissueStore::Pose);
}

// Writes soft tissue to the cache and frees its memory.
void forget_tissue(TrainingWorld& world) {
  write_soft_tissue(world);
  for (TrainingBody& body : world.bodies)
    for (TrainingClip& clip : body.clips) clip.tissue.reset();
  world.tissue_bytes = 0;
}

// How soft tissue moves a pose of the clip [m], in the precision of networks.
Points tissue_moves(TrainingWorld& world, const TrainingBody& body, TrainingClip& clip, const Points& skinned) {
  if (world.tissue_bytes > world.most_tissue) forget_tissue(world);
  if (!clip.tissue) {
    const TrainingPerson& person = world.people[static_cast<std::size_t>(body.person)];
    clip.tissue = read_tissue_store(
        world.cache, hash_of_performance(person.surface, person.body.skin, body.shape, clip.motion, body.room));
    world.tissue_bytes += memory_of(*clip.tissue);
  }
  std::optional<Points> given = known_tissue(*clip.tissue, skinned);
  if (!given) {
    given = (*body.soft_tissue)(skinned);
    world.tissue_bytes -= memory_of(*clip.tissue);
    keep_tissue(skinned, *given, *clip.tissue);
    world.tissue_bytes += memory_of(*clip.tissue);
  }
  const Points exact = *given - skinned;
  Points moves = exact.cast<float>().cast<double>();
  for (Eigen::Index v = 0; v < moves.rows(); ++v)
    if (!(exact.row(v).cwiseAbs().maxCoeff() > least_move)) moves.row(v).setZero();
  return moves;
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
    moves = tissue_moves(world, who, who.clips[static_cast<std::size_t>(clip)], skinned);
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

void write_soft_tissue(TrainingWorld& world, std::uintmax_t most) {
  for (TrainingBody& body : world.bodies)
    for (TrainingClip& clip : body.clips)
      if (clip.tissue) write_tissue_store(*clip.tissue, most);
}

}  // namespace selvedge
