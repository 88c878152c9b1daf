#include "learned/repulsion/drape_training.hpp"

#include <algorithm>
#include <cmath>

namespace selvedge {
namespace {

std::vector<float> scale_inputs_of(const DrapeModel& model, const DrapeCase& drape) {
  const DrapeCase* const one = &drape;
  const FeatureRows row = drape_inputs(model.drape, {&one, 1});
  return {row.data(), row.data() + row.size()};
}

void add(std::vector<float>& sum, const std::vector<float>& part, float factor) {
  if (sum.size() < part.size()) sum.resize(part.size(), 0);
  for (std::size_t k = 0; k < part.size(); ++k) sum[k] += factor * part[k];
}

// The gradient by scales of one drape, and what its layer did.
void add_scales(const DrapeModel& model, const DrapeCase& drape, const Repelled& made, const RepulsionLosses& losses,
                float share, DrapeGradients& result) {
  std::vector<int> vertices;
  std::vector<double> distances;
  for (const PushedVertex& pushed : made.pushed) {
    vertices.push_back(pushed.vertex);
    distances.push_back(pushed.at.value);
    result.alpha += pushed.alpha;
  }
  result.pushed += static_cast<double>(vertices.size());
  if (!model.has_scale() || vertices.empty()) return;
  const ScaleGradients own =
      scale_gradients(model.scale, scale_inputs_of(model, drape), vertices, distances, losses.by_alpha);
  add(result.scale.h, own.h, share);
  add(result.scale.k, own.k, share);
  add(result.scale.g, own.g, share);
}

bool is_finite(const std::vector<float>& values) {
  return std::ranges::all_of(values, [](float g) { return std::isfinite(g); });
}

}  // namespace

Repelled behind_drape(const DrapeModel& model, const DrapeCase& drape, const Points& x, const Adjacency& ring,
                      const AskDistance& ask, const DrapeRecipe& recipe) {
  if (!recipe.layer) {
    Repelled result;
    result.x = x;
    return result;
  }
  if (!model.has_scale()) {
    const AskScale constant = [&](std::span<const int> vertices, std::span<const double>) {
      return constant_scale(vertices, recipe.alpha);
    };
    return repel(x, ring, ask, constant, recipe.repulsion);
  }
  return repel(x, ring, ask, ScaleEvaluator(model.scale, scale_inputs_of(model, drape)), recipe.repulsion);
}

DrapeGradients drape_gradients(const DrapeModel& model, std::span<const DrapeLesson> lessons, const Adjacency& ring,
                               const DrapeRecipe& recipe) {
  std::vector<const DrapeCase*> cases;
  for (const DrapeLesson& lesson : lessons) cases.push_back(lesson.drape);
  const FeatureRows inputs = drape_inputs(model.drape, cases), outputs = evaluate(model.drape.plain, inputs);
  const AskDistance nobody = [](const Points& at, std::vector<SignedDistance>& found) {
    found.assign(static_cast<std::size_t>(at.rows()), {});
  };
  const double share = 1.0 / static_cast<double>(lessons.size());
  DrapeGradients result;
  PlainAdjoints adjoints{FeatureRows(outputs.rows(), outputs.cols()), {}};
  for (std::size_t i = 0; i < lessons.size(); ++i) {
    const DrapeLesson& lesson = lessons[i];
    const auto row = static_cast<Eigen::Index>(i);
    const Repelled made = behind_drape(model, *lesson.drape, drape_positions(model.drape, *lesson.drape, outputs, row),
                                       ring, lesson.layer, recipe);
    const RepulsionLosses losses =
        repulsion_losses(made, lesson.drape->truth, recipe.loss.collision > 0 ? lesson.judge : nobody, recipe.loss);
    result.total += share * losses.total;
    result.reconstruction += share * losses.reconstruction;
    result.collision += share * losses.collision;
    adjoints.value.row(row) = static_cast<float>(share) * by_drape_outputs(model.drape, *lesson.drape, losses.by_x);
    add_scales(model, *lesson.drape, made, losses, static_cast<float>(share), result);
  }
  result.alpha /= std::max(result.pushed, 1.0);
  result.pushed *= share;
  result.drape = backward(model.drape.plain, inputs, {}, adjoints).parameters;
  return result;
}

bool take_step(DrapeAdam& adam, const DrapeGradients& gradients, double rate, DrapeModel& model) {
  const ScaleGradients& scale = gradients.scale;
  for (const std::vector<float>* one : {&gradients.drape, &scale.h, &scale.k, &scale.g})
    if (!is_finite(*one)) return false;
  const auto step = [rate](PlainAdam& one, const std::vector<float>& gradient, PlainNetwork& network) {
    one.rate = rate;
    if (!gradient.empty()) take_step(one, gradient, network);
  };
  step(adam.drape, gradients.drape, model.drape.plain);
  step(adam.h, scale.h, model.scale.h);
  step(adam.k, scale.k, model.scale.k);
  step(adam.g, scale.g, model.scale.g);
  return true;
}

}  // namespace selvedge
