#include "pipeline/drapes/drape_stages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

namespace selvedge {
namespace {

std::vector<double> doubles(const std::vector<float>& values) { return {values.begin(), values.end()}; }
std::vector<float> floats(const std::vector<double>& values) { return {values.begin(), values.end()}; }

StageFile state_of(DrapeModel& model, DrapeAdam& adam) {
  StageFile file;
  const std::vector<DrapePart> parts = parts_of(model);
  adam.parts.resize(parts.size());
  for (std::size_t k = 0; k < parts.size(); ++k)
    if (!parts[k].network->layers.empty()) file.parts.push_back({parts[k].name, *parts[k].network, adam.parts[k]});
  file.numbers["input_mean"] = doubles(model.drape.input_mean);
  file.numbers["input_scale"] = doubles(model.drape.input_scale);
  if (model.drape.linear.size() > 0)
    file.numbers["linear"] = {model.drape.linear.data(), model.drape.linear.data() + model.drape.linear.size()};
  file.numbers["mean"] = {model.drape.mean.data(), model.drape.mean.data() + model.drape.mean.size()};
  return file;
}

void restore_into(const StageFile& file, DrapeModel& model, DrapeAdam& adam) {
  const std::vector<DrapePart> parts = parts_of(model);
  adam.parts.resize(parts.size());
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const StagePart* part = file.find(parts[k].name);
    if (!part) continue;
    *parts[k].network = part->network;
    adam.parts[k] = part->adam;
  }
  model.drape.input_mean = floats(file.numbers.at("input_mean"));
  model.drape.input_scale = floats(file.numbers.at("input_scale"));
  const std::vector<double>& mean = file.numbers.at("mean");
  model.drape.mean = Eigen::Map<const Points>(mean.data(), static_cast<Eigen::Index>(mean.size() / 3), 3);
  if (const auto linear = file.numbers.find("linear"); linear != file.numbers.end()) {
    const auto rows = static_cast<Eigen::Index>(mean.size());
    model.drape.linear =
        Eigen::Map<const Eigen::MatrixXd>(linear->second.data(), rows, std::ssize(linear->second) / rows).cast<float>();
  }
}

// Mean error of the drapes' vertices before any layer [mm].
double mean_vertex_error(const DrapeModel& model, const std::vector<std::unique_ptr<DrapeBody>>& bodies) {
  double sum = 0;
  for (const std::unique_ptr<DrapeBody>& body : bodies)
    sum += (drape_positions(model.drape, body->sample.drape) - body->sample.drape.truth).rowwise().norm().mean();
  return 1e3 * sum / static_cast<double>(bodies.size());
}

struct StepSums {
  double total = 0, reconstruction = 0, collision = 0, pushed = 0, alpha = 0;
  int count = 0, bad = 0;
};

// The stage that trains the model on drapes by the recipe.
TrainingStage drape_stage(const std::string& name, const StageOptions& options, const DrapeRow& row,
                          const DrapeRecipe& recipe, double scale_rate, DrapeLessons& lessons, DrapeModel& model) {
  auto adam = std::make_shared<DrapeAdam>();
  adam->scale_rate = scale_rate;
  adam->decay = options.weight_decay;
  auto sums = std::make_shared<StepSums>();
  TrainingStage stage{name, options, "loss,reconstruction,collision,pushed,alpha,bad,validation_mm", {}, {}, {}};
  stage.step = [=, &lessons, &model](double rate, RandomStream& random, bool shown) -> std::string {
    std::vector<DrapeLesson> batch;
    for (int k = 0; k < options.batch; ++k) {
      DrapeBody& body =
          *lessons.training[static_cast<std::size_t>(random.below(static_cast<int>(lessons.training.size())))];
      batch.push_back({&body.sample.drape, row.neural_layer ? body.by_network() : body.accurate(),
                       row.neural_loss ? body.by_network() : body.accurate()});
    }
    const DrapeGradients made = drape_gradients(model, batch, lessons.ring, recipe);
    sums->bad += !take_step(*adam, made, rate, model);
    ++sums->count;
    sums->total += made.total;
    sums->reconstruction += made.reconstruction;
    sums->collision += made.collision;
    sums->pushed += made.pushed;
    sums->alpha += made.alpha;
    if (!shown) return "";
    const double n = sums->count;
    std::string line = fmt::format("{:.6g},{:.6g},{:.6g},{:.3f},{:.4f},{},{:.4f}", sums->total / n,
                                   sums->reconstruction / n, sums->collision / n, sums->pushed / n, sums->alpha / n,
                                   sums->bad, mean_vertex_error(model, lessons.validation));
    *sums = {};
    return line;
  };
  stage.state = [=, &model] { return state_of(model, *adam); };
  stage.restore = [=, &model](const StageFile& file) { restore_into(file, model, *adam); };
  return stage;
}

// Joints that carry little of the garment hardly move it.
std::vector<char> unread_inputs(const DrapeTrainingOptions& options, const DrapeLessons& lessons) {
  const SkinWeights& weights = lessons.set->world.garment.skin.weights;
  std::vector<double> carried(static_cast<std::size_t>(weights.cols()), 0);
  for (Eigen::Index v = 0; v < weights.rows(); ++v)
    for (SkinWeights::InnerIterator entry(weights, v); entry; ++entry)
      carried[static_cast<std::size_t>(entry.col())] += entry.value() / static_cast<double>(weights.rows());
  std::vector<char> unread(lessons.training.front()->sample.drape.inputs.size(), false);
  for (std::size_t j = 0; j < carried.size(); ++j)
    for (std::size_t k = 3 * j; k < 3 * j + 3; ++k) unread[k] = carried[j] < options.backbone.least_carried;
  return unread;
}

// Takes the ridge, and the trust in shape and style beside the pose, that are best on the validation drapes, because a
// set has few shapes and styles.
void fit_best_linear_part(std::span<const DrapeCase* const> cases, const DrapeLessons& lessons, DrapeModel& model) {
  constexpr std::array ridges{0.003, 0.01, 0.03, 0.1, 0.3, 1.0, 3.0};
  constexpr std::array trusts{0.0, 0.2, 0.5, 1.0};
  const std::size_t pose = 3 * lessons.set->world.body.joints.size();
  std::vector<double> trust(cases[0]->inputs.size(), 1), best_trust;
  double best_error = std::numeric_limits<double>::infinity(), best_ridge = 0;
  for (const double in_body : trusts) {
    std::fill(trust.begin() + static_cast<std::ptrdiff_t>(pose), trust.end(), in_body);
    for (const double ridge : ridges) {
      fit_linear_part(cases, ridge, trust, model.drape);
      const double error = mean_vertex_error(model, lessons.validation);
      if (!(error < best_error)) continue;
      best_error = error;
      best_ridge = ridge;
      best_trust = trust;
    }
  }
  fit_linear_part(cases, best_ridge, best_trust, model.drape);
}

}  // namespace

void restore_model(const StageFile& file, DrapeModel& model) {
  DrapeAdam adam;
  restore_into(file, model, adam);
}

DrapeModel blank_drape_model(const DrapeTrainingOptions& options, const DrapeLessons& lessons) {
  std::vector<const DrapeCase*> cases;
  for (const std::unique_ptr<DrapeBody>& body : lessons.training) cases.push_back(&body->sample.drape);
  DrapeShape shape{options.backbone.layers, options.backbone.width, 0.1, unread_inputs(options, lessons)};
  if (options.backbone.linear) shape.last_scale = 0;
  if (options.backbone.kind == BackboneKind::mesh) {
    shape.mesh = options.backbone.mesh;
    shape.ring = &lessons.ring;
  }
  return {make_drape_network(shape, cases, options.seed), {}, {}};
}

DrapeModel make_drape_model(const DrapeTrainingOptions& options, const DrapeLessons& lessons) {
  DrapeModel model = blank_drape_model(options, lessons);
  if (!options.backbone.linear) return model;
  std::vector<const DrapeCase*> cases;
  for (const std::unique_ptr<DrapeBody>& body : lessons.training) cases.push_back(&body->sample.drape);
  fit_best_linear_part(cases, lessons, model);
  return model;
}

void add_scales(const DrapeRow& row, const DrapeTrainingOptions& options, const DrapeLessons& lessons,
                DrapeModel& model) {
  if (row.neighbours) {
    NeighbourShape shape;
    shape.unit = options.layer.unit;
    shape.edge_unit = lessons.set->world.options.edge;
    model.neighbours = make_neighbour_scale(shape, options.seed + 100);
  }
  if (!row.learned) return;
  ScaleShape shape{static_cast<int>(model.drape.input_mean.size()), lessons.set->world.surface.vertex_count,
                   options.layer.latent, options.layer.per_vertex};
  shape.form = row.form;
  shape.unit = options.layer.unit;
  shape.range = row.neural_layer ? ScaleRange::at_least_zero : ScaleRange::at_least_one;
  model.scale = make_scale_network(shape, options.seed + 100);
}

TrainingStage backbone_stage(const DrapeTrainingOptions& options, DrapeLessons& lessons, DrapeModel& model) {
  const DrapeRow row{"backbone", "before fine-tuning"};
  return drape_stage(row.name, options.backbone.stage, row, recipe_of(row, options.layer), options.layer.scale_rate,
                     lessons, model);
}

TrainingStage row_stage(const DrapeRow& row, const DrapeTrainingOptions& options, DrapeLessons& lessons,
                        DrapeModel& model) {
  return drape_stage(row.name, options.from_scratch ? options.backbone.stage : options.fine_tuning, row,
                     recipe_of(row, options.layer), options.layer.scale_rate, lessons, model);
}

}  // namespace selvedge
