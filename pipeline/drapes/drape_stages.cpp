#include "pipeline/drapes/drape_stages.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace selvedge {
namespace {

std::vector<double> doubles(const std::vector<float>& values) { return {values.begin(), values.end()}; }
std::vector<float> floats(const std::vector<double>& values) { return {values.begin(), values.end()}; }

StageFile state_of(const DrapeModel& model, const DrapeAdam& adam) {
  StageFile file;
  file.parts.push_back({"drape", model.drape.plain, adam.drape});
  if (model.has_scale()) {
    file.parts.push_back({"h", model.scale.h, adam.h});
    file.parts.push_back({"k", model.scale.k, adam.k});
    file.parts.push_back({"g", model.scale.g, adam.g});
  }
  file.numbers["input_mean"] = doubles(model.drape.input_mean);
  file.numbers["input_scale"] = doubles(model.drape.input_scale);
  file.numbers["mean"] = {model.drape.mean.data(), model.drape.mean.data() + model.drape.mean.size()};
  return file;
}

void restore_into(const StageFile& file, DrapeModel& model, DrapeAdam& adam) {
  const auto take = [&](const char* name, PlainNetwork& network, PlainAdam& moments) {
    const StagePart* part = file.find(name);
    if (!part) return;
    network = part->network;
    moments = part->adam;
  };
  take("drape", model.drape.plain, adam.drape);
  take("h", model.scale.h, adam.h);
  take("k", model.scale.k, adam.k);
  take("g", model.scale.g, adam.g);
  model.drape.input_mean = floats(file.numbers.at("input_mean"));
  model.drape.input_scale = floats(file.numbers.at("input_scale"));
  const std::vector<double>& mean = file.numbers.at("mean");
  model.drape.mean = Eigen::Map<const Points>(mean.data(), static_cast<Eigen::Index>(mean.size() / 3), 3);
}

struct StepSums {
  double total = 0, reconstruction = 0, collision = 0, pushed = 0, alpha = 0;
  int count = 0, bad = 0;
};

// Trains the model on drapes, with the recipe behind it.
TrainingStage drape_stage(const std::string& name, const StageOptions& options, const DrapeRow& row,
                          const DrapeRecipe& recipe, DrapeLessons& lessons, DrapeModel& model) {
  auto adam = std::make_shared<DrapeAdam>();
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

}  // namespace

double mean_vertex_error(const DrapeModel& model, const std::vector<std::unique_ptr<DrapeBody>>& bodies) {
  double sum = 0;
  for (const std::unique_ptr<DrapeBody>& body : bodies)
    sum += (drape_positions(model.drape, body->sample.drape) - body->sample.drape.truth).rowwise().norm().mean();
  return 1e3 * sum / static_cast<double>(bodies.size());
}

DrapeModel make_drape_model(const DrapeTrainingOptions& options, const DrapeLessons& lessons) {
  std::vector<const DrapeCase*> cases;
  for (const std::unique_ptr<DrapeBody>& body : lessons.training) cases.push_back(&body->sample.drape);
  return {make_drape_network({options.backbone.layers, options.backbone.width}, cases, options.seed), {}};
}

void add_scales(const DrapeRow& row, const DrapeTrainingOptions& options, const DrapeLessons& lessons,
                DrapeModel& model) {
  if (!row.learned) return;
  ScaleShape shape =
      small_scale_shape(static_cast<int>(model.drape.input_mean.size()), lessons.set->world.surface.vertex_count);
  shape.latent = options.layer.latent;
  shape.per_vertex = options.layer.per_vertex;
  shape.unit = options.layer.unit;
  shape.range = row.neural_layer ? ScaleRange::at_least_zero : ScaleRange::at_least_one;
  model.scale = make_scale_network(shape, options.seed + 100);
}

TrainingStage backbone_stage(const DrapeTrainingOptions& options, DrapeLessons& lessons, DrapeModel& model) {
  const DrapeRow row{"backbone", "before fine-tuning"};
  return drape_stage(row.name, options.backbone.stage, row, recipe_of(row, options.layer), lessons, model);
}

TrainingStage row_stage(const DrapeRow& row, const DrapeTrainingOptions& options, DrapeLessons& lessons,
                        DrapeModel& model) {
  return drape_stage(row.name, options.fine_tuning, row, recipe_of(row, options.layer), lessons, model);
}

}  // namespace selvedge
