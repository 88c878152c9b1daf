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

// Adds the gradient by the scale networks of one drape, and adds to by_x the gradient by positions through the scales.
void add_scales(const DrapeModel& model, const DrapeLesson& lesson, const Points& x, const Adjacency& ring,
                const Repelled& made, float share, RepulsionLosses& losses, std::vector<std::vector<float>>& parts) {
  if (made.pushed.empty()) return;
  const PushedOnes ones = pushed_ones(made.pushed);
  std::size_t next = 1;
  if (model.has_scale()) {
    const ScaleGradients own = scale_gradients(model.scale, scale_inputs_of(model, *lesson.drape), ones.vertices,
                                               ones.distances, losses.by_alpha);
    for (const std::vector<float>* one : {&own.h, &own.k, &own.g}) add(parts[next++], *one, share);
  }
  if (model.has_neighbours()) {
    const NeighbourGradients own = neighbour_gradients(
        model.neighbours, neighbour_patch(x, ring, lesson.layer, ones.vertices), x, ring, losses.by_alpha);
    for (const std::vector<float>* one : {&own.first, &own.second, &own.end}) add(parts[next++], *one, share);
    losses.by_x += own.by_x;
  }
}

bool is_finite(const std::vector<float>& values) {
  return std::ranges::all_of(values, [](float g) { return std::isfinite(g); });
}

}  // namespace

std::vector<DrapePart> parts_of(DrapeModel& model) {
  std::vector<DrapePart> parts{{"drape", &model.drape.plain}};
  if (model.has_scale())
    parts.insert(parts.end(), {{"h", &model.scale.h, true}, {"k", &model.scale.k, true}, {"g", &model.scale.g, true}});
  if (NeighbourScale& n = model.neighbours; model.has_neighbours())
    parts.insert(parts.end(), {{"first", &n.first, true}, {"second", &n.second, true}, {"end", &n.end, true}});
  for (std::size_t l = 0; l < model.drape.mesh.size(); ++l) {
    parts.push_back({"kernels_" + std::to_string(l), &model.drape.mesh[l].kernels});
    parts.push_back({"mix_" + std::to_string(l), &model.drape.mesh[l].mix});
  }
  return parts;
}

Repelled behind_drape(const DrapeModel& model, const DrapeCase& drape, const Points& x, const Adjacency& ring,
                      const AskDistance& ask, const DrapeRecipe& recipe) {
  if (!recipe.layer) return {x, {}};
  if (model.has_neighbours())
    return repel(x, ring, ask, ask_neighbours(model.neighbours, x, ring, ask), recipe.repulsion);
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
  const FeatureRows inputs = drape_inputs(model.drape, cases), outputs = drape_outputs(model.drape, inputs);
  const std::size_t scales = (model.has_scale() ? 3 : 0) + (model.has_neighbours() ? 3 : 0);
  const AskDistance nobody = [](const Points& at, std::vector<SignedDistance>& found) {
    found.assign(static_cast<std::size_t>(at.rows()), {});
  };
  const double share = 1.0 / static_cast<double>(lessons.size());
  DrapeGradients result;
  result.parts.resize(1 + scales + 2 * model.drape.mesh.size());
  PlainAdjoints adjoints{FeatureRows(outputs.rows(), outputs.cols()), {}};
  for (std::size_t i = 0; i < lessons.size(); ++i) {
    const DrapeLesson& lesson = lessons[i];
    const auto row = static_cast<Eigen::Index>(i);
    const Points x = drape_positions(model.drape, *lesson.drape, outputs, row);
    const Repelled made = behind_drape(model, *lesson.drape, x, ring, lesson.layer, recipe);
    RepulsionLosses losses =
        repulsion_losses(made, lesson.drape->truth, recipe.loss.collision > 0 ? lesson.judge : nobody, recipe.loss);
    result.total += share * losses.total;
    result.reconstruction += share * losses.reconstruction;
    result.collision += share * losses.collision;
    for (const PushedVertex& pushed : made.pushed) result.alpha += pushed.alpha;
    result.pushed += static_cast<double>(made.pushed.size());
    add_scales(model, lesson, x, ring, made, static_cast<float>(share), losses, result.parts);
    adjoints.value.row(row) = static_cast<float>(share) * by_drape_outputs(model.drape, *lesson.drape, losses.by_x);
  }
  result.alpha /= std::max(result.pushed, 1.0);
  result.pushed *= share;
  if (!model.drape.mesh.empty()) {
    MeshGradients mesh = backward(model.drape.mesh, evaluate(model.drape.plain, inputs), adjoints.value);
    std::ranges::move(mesh.parts, result.parts.begin() + static_cast<std::ptrdiff_t>(1 + scales));
    adjoints.value = std::move(mesh.inputs);
  }
  result.parts[0] = backward(model.drape.plain, inputs, {}, adjoints).parameters;
  return result;
}

bool take_step(DrapeAdam& adam, const DrapeGradients& gradients, double rate, DrapeModel& model) {
  if (!std::ranges::all_of(gradients.parts, is_finite)) return false;
  const std::vector<DrapePart> parts = parts_of(model);
  adam.parts.resize(parts.size());
  for (std::size_t k = 0; k < parts.size(); ++k) {
    if (k == 0) adam.parts[k].decay = adam.decay;
    adam.parts[k].rate = parts[k].scales ? rate * adam.scale_rate : rate;
    if (!gradients.parts[k].empty()) take_step(adam.parts[k], gradients.parts[k], *parts[k].network);
  }
  return true;
}

}  // namespace selvedge
