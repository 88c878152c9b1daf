#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "learned/graph/feature_options.hpp"
#include "learned/losses/loss_garment.hpp"
#include "learned/steppers/network_device.hpp"
#include "pipeline/config/options.hpp"
#include "pipeline/training/schedule.hpp"
#include "pipeline/training/training_people.hpp"

namespace selvedge {

// Forces on the cloth beside gravity, of networks that see accelerations (Liao et al. 2024, section 3.1): each roll-out
// has a direction on the sphere and a strength of its own.
struct ForceSampling {
  double strongest = 0;     // the strength is uniform up to here [m/s2]; 0: there are no such forces
  double wind_share = 0.5;  // of roll-outs: a wind on each triangle, as strong on one that faces it
  double sheet_share = 0;   // of roll-outs: of a hung sheet without a body, in place of a garment
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

// What a network is trained on.
struct SampleOptions {
  std::filesystem::path folder;  // of the training file, where relative paths begin; empty: the working folder
  std::vector<std::string> garments{"tshirt"};  // by code, or outfits of outfits.yaml; `none`: no mannequin
  double edge = 0.035;                          // of garments' triangles [m]
  std::vector<std::string> clips;               // empty: all of the training split
  int shapes = 1;                               // of the body; the first is the mean one
  double shape_spread = 1;                      // standard deviations of its coefficients
  VertexMaterial material;                      // HOOD's unless it says otherwise
  MaterialSampling sample_materials = MaterialSampling::none;
  double still_share = 0.5;        // of roll-outs that begin at rest with a settling frame
  double noise = 3e-3;             // of start positions [m]
  bool yaw = true, mirror = true;  // turned about the vertical, and left for right
  double no_body_share = 0;        // of roll-outs
  double folded_share = 0;         // of roll-outs whose cloth meets itself: of a sheet with a corner folded through it
  bool soft_tissue = true;         // the body gives way where it would pass through itself
  GarmentStart start = GarmentStart::skinned;
  ForceSampling forces;
  std::vector<Config> people;              // of own data, as the table person_section has them
  std::optional<double> mannequin_weight;  // how often the mannequin is drawn among them; 1 where it is not said
  SplitOptions split;                      // of them
};

bool has_mannequin(const SampleOptions&);

// The procedural clips in which the mannequin is trained.
std::vector<std::string> training_clip_names(const SampleOptions&);

// How states are rolled out.
struct PoolOptions {
  int states = 32;                // advanced one at a time at random; 1: one roll-out after another
  LossRamp frames{1, 30, 0, .5};  // most of a roll-out; its length is random up to that where there are several states
  bool random_length = true;
  int passes = 2;               // runs of the network a frame, an optimiser step each
  int gate = 0;                 // factors of the network's correction that advancing tries; 0: takes it as it is
  double reset_distance = 0.6;  // of a vertex from the skinned garment [m]
  double long_share = 0;        // of roll-outs that go on to the clip's end,
  int long_frames = 150;        // or for so many frames
  bool safeguarded = false;     // advanced through Bridson's response; a state that it gives up is left
  double no_contact_share = 0;  // of roll-outs without cloth-cloth edges and terms
};

// Which pairs of cloth see each other.
struct ContactOptions {
  bool edges = false;      // of cloth with cloth, in the graph
  bool classify = false;   // by contours; false: all repel
  bool attraction = true;  // pairs that do not repel are edges; false: they are left out (Grigorev et al. 2024, 4.3)
};

struct OptimiserOptions {
  double learning_rate = 1.5e-3;
  Decay decay = Decay::cosine;
  int halving_steps = 50000;
  double floor = 0.01;            // of the halving decay
  bool normalise_samples = true;  // each sample's gradient by its own size
  bool clip_median = true;        // at `clip` times the running median of the gradient's norm; false: at `clip`
  double clip = 3;
  int warm_up = 100;              // states that only feed the statistics
  bool freeze_statistics = true;  // after the warm-up
  double decoder_scale = 0.01;    // of the decoder's last layer at the start
};

// When a run writes and measures.
struct WatchOptions {
  double checkpoint_minutes = 5;
  int measurements = 20;      // of the run: roll-outs and gaps
  int frames = 60;            // of a measuring roll-out
  std::string garment;        // of the measuring roll-out; empty: the first
  std::string clip = "walk";  // of the training split
  int fixed_states = 8;
  int most_bad_samples = 50;  // without a finite loss in a row, before the run stops
  double keep_at = 0;         // part of the run at which weights are kept as kept.h5; 0: they are not
};

struct TrainingOptions {
  std::string name;  // empty: the file's
  std::string architecture = "small";
  int width = 0, message_steps = 0;  // in place of the architecture's own; 0: those
  double contour_force = 0;          // of contours in the force that the network is shown [N/m]
  std::string weights;               // of an earlier stage, to start from, seen from samples.folder; empty: fresh ones
  std::uint64_t seed = 1;
  int steps = 8700;                           // of the optimiser
  NetworkDevice device = NetworkDevice::cpu;  // that goes forward and backward
  SampleOptions samples;
  PoolOptions pool;
  ContactOptions contact;
  SpaceOptions space;
  LossOptions objective = fast_losses();
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

// Complaints, one per line, about ramps that do not reach their full value before the run ends.
std::vector<std::string> unfinished_ramps(const TrainingOptions&);

}  // namespace selvedge
