#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "collision/untangle/give_way.hpp"
#include "pipeline/garments/garment.hpp"
#include "pipeline/hdf5/trajectory.hpp"
#include "pipeline/motions/clip.hpp"
#include "pipeline/obstacles/tissue_store_hdf5.hpp"
#include "pipeline/training/training_options.hpp"

namespace selvedge {

// The garments of one scene: one, or those of an outfit from the body outward.
struct TrainingWear {
  std::string name;
  std::vector<Garment> garments;
  std::vector<SkinWeights> skin;  // how each vertex follows soft tissue; empty: not at all
  int person = 0;                 // who wears it
  double weight = 1;              // weight in the draw among the person's
};

// A clip with 30 poses per second. Soft tissue is read, and what is new computed, at the first request.
struct TrainingClip {
  std::string name;
  Clip motion;  // for its body's joints
  double weight = 1;
  std::optional<TissueStore> tissue = {};
};

// A person's body of one shape, with its clips.
struct TrainingBody {
  Eigen::VectorXd shape;
  Points joints;
  std::shared_ptr<const GiveWay> soft_tissue;  // null: the body may intersect itself
  std::vector<TrainingClip> clips;
  double room = 0;  // that soft tissue leaves between the body's parts [m]
  int person = 0;
  double weight = 1;
};

// The mannequin, or one of the file's people.
struct TrainingPerson {
  std::string name;
  BodyModel body;
  Surface surface, mirrored;      // of the skin; the same with reversed triangles
  std::vector<int> joined;        // the vertex of `surface` for each vertex; empty: none are joined
  std::vector<int> wear, bodies;  // indices into the world's lists
  std::uint64_t hash = 0;         // of the body's arrays
  double weight = 1;
};

// The source of all samples. One thread at a time may use it.
struct TrainingWorld {
  std::vector<TrainingPerson> people;
  std::vector<TrainingWear> wear;
  std::vector<TrainingBody> bodies;
  std::filesystem::path cache;           // the folder in which soft tissue is kept; empty: it is not
  std::size_t tissue_bytes = 0;          // of soft tissue in memory,
  std::size_t most_tissue = 512u << 20;  // and how many there may be
  std::vector<std::string> warnings;     // of files
};

// The people of the options, with garments and clips for training: the mannequin with garments by code and procedural
// clips, and those of the file. Takes seconds if garments are not in the cache. Throws Error for files that cannot be
// read or do not fit each other.
TrainingWorld make_training_world(const SampleOptions&, std::uint64_t seed);

// The person who wears the garments.
const TrainingPerson& wearer(const TrainingWorld&, int wear);
int layer_count(const TrainingWorld&, const TrainingPerson&);  // of the outfit with the most garments

// The number of poses in the clip number `clip` of the body number `body`.
int frame_count(const TrainingWorld&, int body, int clip);

// A hash of bodies, shapes, garments and poses, as files and code made them.
std::uint64_t world_hash(const TrainingWorld&);

// The people of the training, and what is held out, one line per person.
std::string people_text(const TrainingWorld&, const SampleOptions&);

// Body and garments in a frame of a clip, the garments one behind the other [m].
struct SkinnedFrame {
  PointsF body, cloth;
};
SkinnedFrame skinned_frame(TrainingWorld&, int wear, int body, int clip, int frame);

// Writes what was computed of soft tissue to the cache, in which at most so many bytes of it stay.
void write_soft_tissue(TrainingWorld&, std::uintmax_t most = most_kept_tissue);

}  // namespace selvedge
