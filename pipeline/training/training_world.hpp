#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "collision/untangle/give_way.hpp"
#include "pipeline/formats/trajectory.hpp"
#include "pipeline/garments/garment.hpp"
#include "pipeline/motions/clip.hpp"
#include "pipeline/training/training_options.hpp"

namespace selvedge {

// The garments of one scene: one, or those of an outfit from the body outward.
struct TrainingWear {
  std::string name;
  std::vector<Garment> garments;
  std::vector<SkinWeights> skin;  // how each vertex follows the displacements of soft tissue; empty: it does not
};

// Displacements of the soft tissue in a pose. Vertices that do not move are left out.
struct TissueDisplacements {
  std::vector<int> vertices;
  PointsF displacements;  // [m]
};

// A body of one shape and what it does. Frames are found when they are first asked for.
struct TrainingBody {
  Eigen::VectorXd shape;
  Points joints;
  std::shared_ptr<const GiveWay> soft_tissue;             // null: it passes through itself
  std::vector<Clip> clips;                                // made for this body's joints
  std::vector<std::map<int, TissueDisplacements>> given;  // by clip and frame
};

// Everything that samples are made of. One thread at a time.
struct TrainingWorld {
  BodyModel body;
  Surface surface, mirrored;  // of its skin; with the sides of triangles exchanged
  std::vector<std::string> clip_names;
  std::vector<TrainingWear> wear;
  std::vector<TrainingBody> bodies;
};

// Mannequin, garments and clips of the training split. Takes seconds where garments are not in the cache.
TrainingWorld make_training_world(const SampleOptions&, std::uint64_t seed);

// Body and garments in a frame of a clip, the garments one behind the other [m].
struct WornFrame {
  PointsF body, cloth;
};
WornFrame worn_frame(TrainingWorld&, int wear, int body, int clip, int frame);
int frame_count(const TrainingWorld&, int body, int clip);

}  // namespace selvedge
