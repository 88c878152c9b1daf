#include "learned/repulsion/scale_network.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "collision/geometry/error.hpp"

namespace selvedge {
namespace {

constexpr int end_width = 10;             // width of g's two hidden layers
constexpr double first_overshoot = 0.02;  // scales begin at 1 plus this

double soft_plus(double x) { return std::max(x, 0.0) + std::log1p(std::exp(-std::abs(x))); }
double soft_plus_slope(double x) { return x >= 0 ? 1 / (1 + std::exp(-x)) : std::exp(x) / (1 + std::exp(x)); }

// The argument at which softplus is y.
double inverse_soft_plus(double y) { return y + std::log(-std::expm1(-y)); }

int latent_columns(const ScaleShape& shape) {
  if (shape.form == ScaleForm::distance_only) return 0;
  return shape.form == ScaleForm::shared_latent ? shared_latent_width(shape) : shape.per_vertex;
}

Eigen::Map<const Eigen::VectorXf> as_vector(const std::vector<float>& values) {
  return {values.data(), static_cast<Eigen::Index>(values.size())};
}

struct EndResult {
  double alpha, slope;
};

// g for one vertex, with the derivative by its last input, the distance.
EndResult evaluate_end(const ScaleNetwork& network, const Eigen::VectorXf& input) {
  Eigen::VectorXf at = input, along = Eigen::VectorXf::Unit(input.size(), input.size() - 1);
  for (std::size_t l = 0; l < network.g.layers.size(); ++l) {
    const AffineLayer& layer = network.g.layers[l];
    at = (layer.weight * at + as_vector(layer.bias)).eval();
    along = (layer.weight * along).eval();
    if (l + 1 == network.g.layers.size()) break;
    for (Eigen::Index i = 0; i < at.size(); ++i)
      if (!(at[i] > 0)) at[i] = at[i] < 0 ? 0 : at[i], along[i] = 0;
  }
  const double sum = at[0], slope = soft_plus_slope(sum) * along[0];
  return {scale_end(network.shape.range, sum), slope / network.shape.unit};
}

}  // namespace

int shared_latent_width(const ScaleShape& shape) {
  const double of_vertices = static_cast<double>(shape.per_vertex) * shape.vertices * (shape.latent + 1);
  return std::max(1, static_cast<int>(of_vertices / (shape.latent + 1 + end_width)));
}

double scale_end(ScaleRange range, double sum) { return (range == ScaleRange::at_least_one ? 1 : 0) + soft_plus(sum); }

PlainAdjoints scale_adjoints(const FeatureRows& sums, std::span<const double> by_alpha) {
  PlainAdjoints adjoints{FeatureRows(sums.rows(), 1), {}};
  for (Eigen::Index i = 0; i < sums.rows(); ++i)
    adjoints.value(i, 0) = static_cast<float>(by_alpha[i] * soft_plus_slope(static_cast<double>(sums(i, 0))));
  return adjoints;
}

PlainNetwork make_scale_end(int inputs, ScaleRange range, std::uint64_t seed) {
  PlainNetwork made = make_plain_network({inputs, {end_width, end_width, 1}}, seed);
  AffineLayer& last = made.layers.back();
  last.weight *= 0.01f;  // begins near its bias for any latents
  last.bias[0] =
      static_cast<float>(inverse_soft_plus(range == ScaleRange::at_least_one ? first_overshoot : 1 + first_overshoot));
  return made;
}

ScaleNetwork make_scale_network(const ScaleShape& shape, std::uint64_t seed) {
  const bool has_latents = shape.form != ScaleForm::distance_only;
  if (!(shape.unit > 0) || (has_latents && (shape.inputs < 1 || shape.vertices < 1 || shape.latent < 1)) ||
      shape.per_vertex < 0)
    throw Error("no network has these sizes", "scale network", "give inputs, vertices, latent and unit above 0");
  ScaleNetwork made;
  made.shape = shape;
  const int columns = latent_columns(shape);
  if (has_latents) {
    made.h = make_plain_network({shape.inputs, {shape.latent, shape.latent, shape.latent}}, seed);
    const int outputs = shape.form == ScaleForm::shared_latent ? columns : shape.per_vertex * shape.vertices;
    made.k = make_plain_network({shape.latent, {outputs}}, seed + 1);
  }
  made.g = make_scale_end(columns + 1, shape.range, seed + 2);
  return made;
}

long long parameter_count(const ScaleNetwork& n) {
  return parameter_count(n.h) + parameter_count(n.k) + parameter_count(n.g);
}

ScaleEvaluator::ScaleEvaluator(const ScaleNetwork& network, std::span<const float> inputs) : network_(network) {
  if (network.shape.form == ScaleForm::distance_only) return;
  if (static_cast<int>(inputs.size()) != network.shape.inputs)
    throw Error("the network reads " + std::to_string(network.shape.inputs) + " numbers and got " +
                    std::to_string(inputs.size()),
                "scale network", "give it pose, shape and style as in training");
  Eigen::VectorXf at = Eigen::Map<const Eigen::VectorXf>(inputs.data(), static_cast<Eigen::Index>(inputs.size()));
  for (const AffineLayer& layer : network.h.layers)
    at = (layer.weight * at + as_vector(layer.bias)).cwiseMax(0.0f).eval();
  if (network.shape.form == ScaleForm::shared_latent) {
    const AffineLayer& layer = network.k.layers.front();
    at = (layer.weight * at + as_vector(layer.bias)).eval();
  }
  latent_.assign(at.data(), at.data() + at.size());
}

Scales ScaleEvaluator::operator()(std::span<const int> vertices, std::span<const double> distances) const {
  const int count = static_cast<int>(vertices.size());
  Scales result{std::vector<double>(vertices.size()), std::vector<double>(vertices.size())};
  const int columns = latent_columns(network_.shape), each = network_.shape.per_vertex;
#pragma omp parallel for schedule(dynamic, 32)
  for (int i = 0; i < count; ++i) {
    Eigen::VectorXf input(columns + 1);
    if (network_.shape.form == ScaleForm::vertex_latents) {
      assert(vertices[i] >= 0 && vertices[i] < network_.shape.vertices);
      const AffineLayer& layer = network_.k.layers.front();
      const Eigen::Index first = static_cast<Eigen::Index>(each) * vertices[i];
      input.head(columns) =
          layer.weight.middleRows(first, each) * as_vector(latent_) + as_vector(layer.bias).segment(first, each);
    } else if (network_.shape.form == ScaleForm::shared_latent) {
      input.head(columns) = as_vector(latent_);
    }
    input[columns] = static_cast<float>(distances[i] / network_.shape.unit);
    const EndResult end = evaluate_end(network_, input);
    result.alpha[i] = end.alpha;
    result.slope[i] = end.slope;
  }
  return result;
}

FeatureRows scale_inputs(const ScaleNetwork& network, const FeatureRows& latents, std::span<const double> distances) {
  FeatureRows inputs(static_cast<Eigen::Index>(distances.size()), latents.cols() + 1);
  inputs.leftCols(latents.cols()) = latents;
  for (std::size_t i = 0; i < distances.size(); ++i)
    inputs(static_cast<Eigen::Index>(i), latents.cols()) = static_cast<float>(distances[i] / network.shape.unit);
  return inputs;
}

}  // namespace selvedge
