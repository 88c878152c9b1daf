#pragma once

#include <cstdint>
#include <filesystem>
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
  int person = 0;                 // who wears it
  double weight = 1;              // how often it is drawn, beside the others' of the person
};

// Displacements of the soft tissue in a pose. Vertices that do not move are left out.
struct TissueDisplacements {
  std::vector<int> vertices;
  PointsF displacements;  // [m]
};

// A clip, 30 poses a second. Frames of soft tissue are found when they are first asked for.
struct TrainingClip {
  std::string name;
  Clip motion;  // made for its body's joints
  double weight = 1;
  std::map<int, TissueDisplacements> given = {};
  bool looked = false;  // whether the folder of what is kept was asked for frames
};

// A person's body of one shape and what it does.
struct TrainingBody {
  Eigen::VectorXd shape;
  Points joints;
  std::shared_ptr<const GiveWay> soft_tissue;  // null: it passes through itself
  std::vector<TrainingClip> clips;
  std::uint64_t tissue_key = 0;  // of what its frames depend on beside shape, layers and poses
  int person = 0;
  double weight = 1;
};

// The mannequin, or one of the file's people.
struct TrainingPerson {
  std::string name;
  BodyModel body;
  Surface surface, mirrored;      // of its skin; with the sides of triangles exchanged
  std::vector<int> joined;        // of each vertex the one that stands for it in `surface`; empty: none is joined
  std::vector<int> wear, bodies;  // numbers in the world
  std::uint64_t hash = 0;         // of the body's arrays
  double weight = 1;
};

// Everything that samples are made of. One thread at a time.
struct TrainingWorld {
  std::vector<TrainingPerson> people;
  std::vector<TrainingWear> wear;
  std::vector<TrainingBody> bodies;
  std::filesystem::path soft_tissue_folder;  // folder in which frames of soft tissue are kept; empty: they are not
  std::size_t tissue_bytes = 0;              // of frames of soft tissue in memory,
  std::size_t most_tissue = 512u << 20;      // and how many there may be
  std::vector<std::string> warnings;         // of files
};

// The people whom the options name, with garments and clips for training: the mannequin with garments by code and
// procedural clips, and those of the file. Takes seconds where garments are not in the cache. Throws Error for files
// that cannot be read or do not fit each other.
TrainingWorld make_training_world(const SampleOptions&, std::uint64_t seed);

// Who wears the garments.
const TrainingPerson& wearer(const TrainingWorld&, int wear);
int layer_count(const TrainingWorld&, const TrainingPerson&);  // of the outfit with the most garments

int frame_count(const TrainingWorld&, int body, int clip);

// A hash of what files and code have made: bodies, shapes, garments and poses.
std::uint64_t world_hash(const TrainingWorld&);

// Who is trained on and what is held out, a line a person.
std::string people_text(const TrainingWorld&, const SampleOptions&);

}  // namespace selvedge
