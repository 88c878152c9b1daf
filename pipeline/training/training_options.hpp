#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "learned/graph/feature_options.hpp"
#include "learned/losses/loss_garment.hpp"
#include "learned/losses/loss_options.hpp"
#include "learned/steppers/network_device.hpp"
#include "pipeline/config/options.hpp"
#include "pipeline/training/teacher_step.hpp"
#include "pipeline/training/training_people.hpp"

namespace selvedge {

// Forces on the cloth beside gravity, of networks that see accelerations (Liao et al. 2024, section 3.1). Members are
// described where keys are bound to them: pipeline/training/training_options.cpp.
struct ForceSampling {
  double strongest = 0;
  double wind_share = 0.5, sheet_share = 0;
};

enum class GarmentStart {
  skinned,   // where skinning puts the garment, perhaps tangled
  untangle,  // the same, untangled by minimised contours before the roll-out starts
  cut,       // the same without intersecting triangles; vertices left without any follow the skinned garment
  tangled    // skinned without gaps between layers and without soft tissue, with a wide spread of shapes
};

// The extent of one random material, drawn from the authors' ranges.
enum class MaterialSampling {
  none,     // all have the material of the configuration
  garment,  // each garment of a roll-out has its own
  vertex    // each garment changes from one to another over its rest shape
};

// What a network is trained on. Members are described where keys are bound to them:
// pipeline/training/training_options.cpp.
struct SampleOptions {
  std::filesystem::path folder;  // of the training file, where relative paths begin; empty: the working folder
  std::vector<std::string> garments{"tshirt"};
  double edge = 0.035;
  std::vector<std::string> clips;
  int shapes = 1;
  double shape_spread = 1;
  VertexMaterial material;
  MaterialSampling sample_materials = MaterialSampling::none;
  double still_share = 0.5;
  double noise = 3e-3;
  bool yaw = true, mirror = true;
  double no_body_share = 0, folded_share = 0;
  double simulated_share = 0;
  int simulated_frames = 20;
  bool random_simulated = false;
  double noise_share = 0;
  bool soft_tissue = true;
  GarmentStart start = GarmentStart::skinned;
  ForceSampling forces;
  std::vector<Config> people;
  std::optional<double> mannequin_weight;
  SplitOptions split;
};

bool has_mannequin(const SampleOptions&);

// The procedural clips in which the mannequin is trained.
std::vector<std::string> training_clip_names(const SampleOptions&);

// What runs behind the network where a state goes on to its next frame.
enum class BehindNetwork {
  nothing,   // the state is what the network made
  response,  // Bridson's response to contact, as in the stepper `carried`
  solve      // one rough solve that begins at what the network made, then the response, as in `carried_rough`
};

// How states are rolled out. Members are described where keys are bound to them:
// pipeline/training/training_options.cpp.
struct PoolOptions {
  int states = 32;
  LossRamp frames{1, 30, 0, .5};
  bool random_length = true;
  int passes = 2;
  int gate = 0;
  double reset_distance = 0.6;
  double long_share = 0;
  int long_frames = 150;
  bool safeguarded = false;
  BehindNetwork behind = BehindNetwork::nothing;
  double no_contact_share = 0;
};

// Which pairs of cloth see each other (Grigorev et al. 2024, section 4.3). Members are described where keys are bound
// to them: pipeline/training/training_options.cpp.
struct ContactOptions {
  bool edges = false, classify = false;
  bool attraction = true;
};

enum class Decay { cosine, halving, none };

// How weights are optimised. Members are described where keys are bound to them:
// pipeline/training/training_options.cpp.
struct OptimiserOptions {
  int batch = 1;
  double learning_rate = 1.5e-3;
  Decay decay = Decay::cosine;
  int halving_steps = 50000;
  double floor = 0.01;
  bool normalise_samples = true;
  bool clip_median = true;
  double clip = 3;
  int warm_up = 100;
  bool freeze_statistics = true;
  double decoder_scale = 0.01;
};

// When a run writes and measures. Members are described where keys are bound to them:
// pipeline/training/training_options.cpp.
struct WatchOptions {
  double checkpoint_minutes = 5;
  int measurements = 20;
  int frames = 60;
  std::string garment, clip = "walk";
  int fixed_states = 8;
  int taught_rolls = 3, taught_frames = 10;
  int most_bad_samples = 50;
  double keep_at = 0;
};

// A training file, read. Members are described where keys are bound to them: pipeline/training/training_options.cpp.
struct TrainingOptions {
  std::string name;
  std::string architecture = "small";
  int width = 0, message_steps = 0;
  double contour_force = 0;
  std::string weights;
  std::uint64_t seed = 1;
  int steps = 8700;
  NetworkDevice device = NetworkDevice::cpu;
  SampleOptions samples;
  PoolOptions pool;
  ContactOptions contact;
  SpaceOptions space;
  LossOptions objective = fast_losses();
  TeacherOptions teacher;
  OptimiserOptions optimiser;
  WatchOptions watch;
};

// The table of a training file.
const Options<TrainingOptions>& training_options();

// Reads a training file over its base, the base's base, and so on. Overrides are key=value. Throws Error, also for a
// circular base, for clips, garments or outfits of the validation split, and for unknown names.
TrainingOptions read_training(const std::filesystem::path&, const std::vector<std::string>& overrides = {});

// The whole configuration as YAML. A file in `samples.folder` with this text gives the same options.
std::string training_yaml(const TrainingOptions&);

// The path of the earlier stage's weights, if there are some.
std::filesystem::path weights_path(const TrainingOptions&);

// The same options with absolute paths, so that they can be read from any folder.
TrainingOptions with_absolute_paths(TrainingOptions);

// Every section of a training file as Markdown: the end of docs/training.md.
std::string training_reference();

// What the terms of the objective need of the solver at some point of the run.
TeacherWork teacher_work(const LossOptions&);

// Complaints, one per line, about ramps that do not reach their full value before the run ends.
std::vector<std::string> unfinished_ramps(const TrainingOptions&);

}  // namespace selvedge
