#pragma once

#include "learned/repulsion/drape_training.hpp"
#include "learned/repulsion/neural_distance.hpp"
#include "pipeline/config/options.hpp"

namespace selvedge {

// How long and how fast one network is trained.
struct StageOptions {
  int steps = 1000, batch = 8;
  double learning_rate = 1e-4;  // of Adam, to zero over the stage as half a cosine
  double weight_decay = 0;      // beside Adam's step
};

enum class BackboneKind { perceptron, mesh };

struct BackboneOptions {
  BackboneKind kind = BackboneKind::perceptron;
  int layers = 5, width = 256;  // of the perceptron
  MeshShape mesh;               // behind it, if it is of that kind
  bool linear = false;          // a linear regression beside it
  double least_carried = 0;     // part of the garment that a joint must carry to be read
  StageOptions stage{6000, 16, 1e-3};
};

// The distance by a network.
struct DistanceOptions {
  std::string weights;  // a file of an earlier run; empty: it is trained
  int layers = 6, width = 128;
  double beta = 100;
  bool bones = true;             // it reads the point in each bone's frame
  int bodies = 4, points = 128;  // of a batch
  double noise = 0.01;           // of points round surfaces [m]
  double box = 4;                // edge of the cube that points are drawn in [m]
  StageOptions stage{3000, 4, 5e-4};
};

struct LayerOptions {
  int latent = 64, per_vertex = 10;
  double unit = 0.01;  // in which g reads distances [m]
  double scale_rate = 1;
  double deep = 0.03;
  double most_beyond = 0.01;  // [m]
  int recheck = 0;            // where it is measured
  double reconstruction = 1.5, collision = 0.5;
  double loss_unit = 1;  // of lengths in the losses [m]
  LayerGradient gradient = LayerGradient::full;
};

// A training file with the key `drapes`: a backbone, rows of equally long fine-tuning from it, and their table.
struct DrapeTrainingOptions {
  std::string name;
  std::string drapes;  // folder of a set
  std::uint64_t seed = 1;
  int validation_paths = 4;  // of those to train on, the last ones
  std::vector<std::string> rows{"control", "collision_loss", "fixed", "learned"};
  bool from_scratch = false;  // rows begin as the backbone did and are trained as long
  BackboneOptions backbone;
  StageOptions fine_tuning{1500, 8, 1e-4};
  LayerOptions layer;
  DistanceOptions distance;
  double checkpoint_minutes = 2;
};

// The table of a training file with the key `drapes`.
const Options<DrapeTrainingOptions>& drape_training_options();
// Whether a training file has the key `drapes`.
bool is_drape_training(const std::filesystem::path&);
// Throws Error, also for unknown rows. The folder of the drapes is relative to the working folder.
DrapeTrainingOptions read_drape_training(const std::filesystem::path&, const std::vector<std::string>& overrides = {});
std::string drape_training_yaml(const DrapeTrainingOptions&);
std::string drape_training_reference();  // sections as Markdown

// One row of the table: a variant of the training after the backbone.
struct DrapeRow {
  std::string name;
  std::string about;
  bool layer = false, learned = false;  // learned: scales by a network
  bool collision_loss = false;
  bool neural_layer = false, neural_loss = false;
  bool neighbours = false;  // scales by neighbours, for any garment
  ScaleForm form = ScaleForm::vertex_latents;
};
const std::vector<DrapeRow>& known_drape_rows();
DrapeRecipe recipe_of(const DrapeRow&, const LayerOptions&);

}  // namespace selvedge
