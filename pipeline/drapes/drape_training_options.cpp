#include "pipeline/drapes/drape_training_options.hpp"

#include <algorithm>

#include "collision/geometry/error.hpp"
#include "pipeline/config/section_tree.hpp"
#include "pipeline/host/read_file.hpp"

namespace selvedge {
namespace {

using namespace table;

const Options<StageOptions>& stage_options() {
  using O = StageOptions;
  static const Options<O> table(
      "stage", "How long one network is trained.",
      {integer("steps", &O::steps, at_least_one, "Number of steps of Adam."),
       integer("batch", &O::batch, at_least_one,
               "Number of drapes in a step. The distance network takes `bodies` instead."),
       number("learning_rate", &O::learning_rate, Unit::none, positive,
              "Learning rate at the start. It falls to zero over the stage as half a cosine."),
       number("weight_decay", &O::weight_decay, Unit::none, not_negative,
              "Decay of the weights of the backbone's perceptron in each step, in learning rates.")});
  return table;
}

template <class Struct>
Option<Struct> stage(std::string name, StageOptions Struct::*member, std::string about) {
  return renamed(section(member, stage_options(), std::move(about)), std::move(name));
}

const Options<MeshShape>& mesh_options() {
  using O = MeshShape;
  static const Options<O> table(
      "mesh", "Convolutions over the garment's mesh, of the backbone `gcnn`.",
      {integer("levels", &O::levels, at_least_one, "Number of levels of pooling."),
       integer("channels", &O::channels, at_least_one,
               "Number of channels of the finest level. Coarser levels have twice, then four times as many."),
       integer("kernels", &O::kernels, at_least_one, "Number of matrices that each edge mixes.")});
  return table;
}

const Options<BackboneOptions>& backbone_options() {
  using O = BackboneOptions;
  static const Options<O> table(
      "backbone", "The network that predicts a drape from pose, shape and style.",
      {choice("kind", &O::kind, {{"mlp", BackboneKind::perceptron}, {"gcnn", BackboneKind::mesh}},
              "`mlp`: a perceptron. `gcnn`: a perceptron for the coarsest level, and convolutions with locally varying "
              "kernels from there to the garment."),
       section(&O::mesh, mesh_options(), "Convolutions of `gcnn`."),
       integer("layers", &O::layers, at_least_one, "Number of layers of the perceptron."),
       integer("width", &O::width, at_least_one, "Width of all layers except the last."),
       flag("linear", &O::linear, "True: a linear regression of the training drapes is added to the network's output."),
       number("least_carried", &O::least_carried, Unit::none, not_negative,
              "Joints that carry a smaller share of the garment, by its skin weights, are left out."),
       stage("stage", &O::stage, "")});
  return table;
}

const Options<DistanceOptions>& distance_options() {
  using O = DistanceOptions;
  static const Options<O> table(
      "distance", "The network of the body's signed distance, for rows such as `approximate` and `hybrid`.",
      {text("weights", &O::weights,
            "File of an earlier run, relative to the working folder. Default: the network is trained."),
       integer("layers", &O::layers, at_least_one, "Number of layers before the last."),
       integer("width", &O::width, at_least_one, "Width of these layers."),
       number("beta", &O::beta, Unit::none, positive, "Sharpness of softplus."),
       flag("bones", &O::bones,
            "True: the network reads a point in each bone's frame. False: it reads the point in space."),
       integer("bodies", &O::bodies, at_least_one, "Number of bodies in a batch."),
       integer("points", &O::points, at_least_one, "Number of points of each body in a batch."),
       number("noise", &O::noise, Unit::length, not_negative, "Standard deviation of points round surfaces."),
       number("box", &O::box, Unit::length, positive, "Edge of the cube in which points are drawn."),
       stage("stage", &O::stage, "")});
  return table;
}

const Options<LayerOptions>& layer_options() {
  using O = LayerOptions;
  static const Options<O> table(
      "layer", "The repulsive layer and the losses 7 to 9.",
      {integer("latent", &O::latent, at_least_one, "M, the width of z and of the layers of h. The paper has 1024."),
       integer("per_vertex", &O::per_vertex, at_least_one, "D, the width of each vertex's latent vector."),
       number("unit", &O::unit, Unit::length, positive, "Unit in which g reads distances."),
       number("scale_rate", &O::scale_rate, Unit::none, positive,
              "Factor on the learning rate of the scale networks, which begin untrained."),
       number("deep", &O::deep, Unit::length, positive, "Depth beyond which a vertex takes its neighbours' direction."),
       number("most_beyond", &O::most_beyond, Unit::length, positive,
              "Largest distance from the body to which a scale takes a vertex. The paper has no such bound."),
       integer("recheck", &O::recheck, not_negative, "Number of rechecks of pushed vertices in measurements."),
       number("reconstruction", &O::reconstruction, Unit::none, not_negative, "Weight of loss 8."),
       number("collision", &O::collision, Unit::none, not_negative, "Weight of loss 9."),
       number("loss_unit", &O::loss_unit, Unit::length, positive,
              "Unit of lengths in the losses. The paper gives none."),
       choice("gradient", &O::gradient, {{"full", LayerGradient::full}, {"frozen", LayerGradient::frozen}},
              "Jacobian of the layer: `full`, or with a constant direction (`frozen`).")});
  return table;
}

}  // namespace

const Options<DrapeTrainingOptions>& drape_training_options() {
  using O = DrapeTrainingOptions;
  static const Options<O> table(
      "drape training", "A training file with the key `drapes`.",
      {text("description", "Free text for readers."),
       text("name", &O::name, "Name of the run. Default: that of the file."),
       needed(text("drapes", &O::drapes, "Folder that `selvedge dataset` made, relative to the working folder.")),
       integer("seed", &O::seed, not_negative, "Seed of all random numbers."),
       integer("validation_paths", &O::validation_paths, at_least_one,
               "Number of training paths, the last ones, that are kept for validation."),
       texts("rows", &O::rows, "Rows of the table. All are trained equally long from one checkpoint."),
       flag("from_scratch", &O::from_scratch,
            "True: rows begin where the backbone began, and are trained as it was. False: they go on from its end."),
       section(&O::backbone, backbone_options(), ""), stage("fine_tuning", &O::fine_tuning, "Training of each row."),
       section(&O::layer, layer_options(), ""), section(&O::distance, distance_options(), ""),
       number("checkpoint_minutes", &O::checkpoint_minutes, Unit::none, not_negative, "Minutes between checkpoints.")});
  return table;
}

bool is_drape_training(const std::filesystem::path& file) {
  const std::string text = "\n" + read_text_file(file, "configuration");
  return text.find("\ndrapes:") != std::string::npos;
}

DrapeTrainingOptions read_drape_training(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  DrapeTrainingOptions options =
      drape_training_options().read(read_config(file, drape_training_options().section, overrides));
  if (options.name.empty()) options.name = file.stem().string();
  std::vector<std::string> known;
  for (const DrapeRow& row : known_drape_rows()) known.push_back(row.name);
  for (const std::string& name : options.rows)
    if (std::ranges::find(known, name) == known.end())
      throw Error("`" + name + "` is no row", file.string() + ": rows",
                  "one of " + joined(known) + suggestion(name, known));
  return options;
}

std::string drape_training_yaml(const DrapeTrainingOptions& options) {
  return to_yaml(drape_training_options().written(options));
}

std::string drape_training_reference() { return chapters_below(drape_training_options().section); }

const std::vector<DrapeRow>& known_drape_rows() {
  static const std::vector<DrapeRow> rows{
      {"control", "the same fine-tuning without layer and loss 9"},
      {"collision_loss", "loss 9 alone", false, false, true},
      {"collision_loss_approximate", "loss 9 alone, distances by a network", false, false, true, false, true},
      {"fixed", "layer of scale 1, accurate distances", true, false, true},
      {"learned", "layer of learned scales, accurate distances", true, true, true},
      {"neighbours", "scales by what neighbours know, accurate distances", true, false, true, false, false, true},
      {"shared_latent", "learned scales with one latent for all vertices (Alt. 1), accurate distances", true, true,
       true, false, false, false, ScaleForm::shared_latent},
      {"distance_only", "learned scales of the distance alone (Alt. 2), accurate distances", true, true, true, false,
       false, false, ScaleForm::distance_only},
      {"fixed_approximate", "layer of scale 1, distances by a network", true, false, true, true, true},
      {"approximate", "learned scales, distances by a network in layer and loss", true, true, true, true, true},
      {"hybrid", "learned scales, distances by a network in the layer, accurate in the loss", true, true, true, true,
       false}};
  return rows;
}

DrapeRecipe recipe_of(const DrapeRow& row, const LayerOptions& options) {
  DrapeRecipe recipe;
  recipe.layer = row.layer;
  recipe.repulsion.deep = options.deep;
  recipe.repulsion.most_beyond = options.most_beyond;
  recipe.loss = {options.reconstruction, row.collision_loss ? options.collision : 0, options.loss_unit,
                 row.neural_layer ? LayerGradient::frozen : options.gradient};
  return recipe;
}

}  // namespace selvedge
