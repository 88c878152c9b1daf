#include "pipeline/drapes/drape_set.hpp"

#include "pipeline/bodies/mannequin.hpp"
#include "pipeline/garments/garment_make.hpp"
#include "pipeline/obstacles/setup_paths.hpp"

namespace selvedge {

DrapeWorld make_drape_world(const DrapeOptions& options) {
  DrapeWorld world{options, kept_mannequin(cache_folder()), {}, {}, {}};
  world.body_surface = make_surface(static_cast<int>(world.body.skin.rest.rows()), world.body.skin.triangles);
  GarmentOptions cut;
  cut.edge = options.edge;
  world.garment = kept_garment(cache_folder(), options.garment, world.body, cut);
  world.surface = make_surface(static_cast<int>(world.garment.skin.rest.rows()), world.garment.skin.triangles);
  return world;
}

Points styled_rest(const DrapeWorld& world, const Eigen::VectorXd& shape, const Style& style) {
  return styled(rest_shape(world.garment, world.body, shape), joint_positions(world.body, shape), style);
}

std::vector<VertexFrame> vertex_frames(const DrapeWorld& world, const Eigen::VectorXd& shape, const BodyPose& pose) {
  const JointTransforms transforms = joint_transforms(world.body, joint_positions(world.body, shape), pose);
  const SkinWeights& weights = world.garment.skin.weights;
  std::vector<VertexFrame> frames(static_cast<std::size_t>(weights.rows()), VertexFrame::Zero());
  for (Eigen::Index v = 0; v < weights.rows(); ++v) {
    VertexFrame& frame = frames[static_cast<std::size_t>(v)];
    for (SkinWeights::InnerIterator entry(weights, v); entry; ++entry)
      frame += entry.value() * transforms[static_cast<std::size_t>(entry.col())];
    frame.col(3) += pose.translation;
  }
  return frames;
}

DrapeSample drape_sample(const DrapeWorld& world, const DrapePath& path, std::size_t index) {
  DrapeSample sample;
  const BodyPose pose{path.rotations[index]};
  for (const double angle : pose.rotations.reshaped<Eigen::RowMajor>())
    sample.drape.inputs.push_back(static_cast<float>(angle));
  for (const double value : path.shape) sample.drape.inputs.push_back(static_cast<float>(value));
  for (const double value : path.style) sample.drape.inputs.push_back(static_cast<float>(value));
  sample.drape.rest = styled_rest(world, path.shape, path.style);
  sample.drape.frames = vertex_frames(world, path.shape, pose);
  sample.drape.truth = path.x[index];
  sample.transforms = joint_transforms(world.body, joint_positions(world.body, path.shape), pose);
  sample.body = posed(world.body.skin, path.shape, pose, sample.transforms);
  return sample;
}

}  // namespace selvedge
