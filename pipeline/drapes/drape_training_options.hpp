#pragma once

#include "learned/repulsion/drape_training.hpp"
#include "learned/repulsion/neural_distance.hpp"
#include "pipeline/config/options.hpp"

namespace selvedge {

// How long and how fast one network is trained. Members are described where keys are bound to them:
// pipeline/drapes/drape_training_options.cpp.
struct StageOptions {
  int steps = 1000, batch = 8;
  double learning_rate = 1e-4;
  double weight_decay = 0;
};

enum class BackboneKind { perceptron, mesh };

// The network that predicts a drape. Members are described where keys are bound to them:
// pipeline/drapes/drape_training_options.cpp.
struct BackboneOptions {
  BackboneKind kind = BackboneKind::perceptron;
  int layers = 5, width = 256;
  MeshShape mesh;
  bool linear = false;
  double least_carried = 0;
  StageOptions stage{6000, 16, 1e-3};
};

// The network of a body's signed distance. Members are described where keys are bound to them:
// pipeline/drapes/drape_training_options.cpp.
struct DistanceOptions {
  std::string weights;
  int layers = 6, width = 128;
  double beta = 100;
  bool bones = true;
  int bodies = 4, points = 128;
  double noise = 0.01;
  double box = 4;
  StageOptions stage{3000, 4, 5e-4};
};

// The repulsive layer and its losses. Members are described where keys are bound to them:
// pipeline/drapes/drape_training_options.cpp.
struct LayerOptions {
  int latent = 64, per_vertex = 10;
  double unit = 0.01;
  double scale_rate = 1;
  double deep = 0.03;
  double most_beyond = 0.01;
  int recheck = 0;
  double reconstruction = 1.5, collision = 0.5;
  double loss_unit = 1;
  LayerGradient gradient = LayerGradient::full;
};

// A training file with the key `drapes`: a backbone, rows of equally long fine-tuning from it, and their table. Members
// are described where keys are bound to them: pipeline/drapes/drape_training_options.cpp.
struct DrapeTrainingOptions {
  std::string name;
  std::string drapes;
  std::uint64_t seed = 1;
  int validation_paths = 4;
  std::vector<std::string> rows{"control", "collision_loss", "fixed", "learned"};
  bool from_scratch = false;
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
