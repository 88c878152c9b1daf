#include "learned/repulsion/neural_distance.hpp"

#include <cmath>

#include "collision/geometry/error.hpp"

namespace selvedge {
namespace {

FeatureRows query_rows(const QueryMap& query, const Points& at) {
  FeatureRows rows = at.cast<float>() * query.linear.transpose();
  rows.rowwise() += query.offset.transpose();
  return rows;
}

// The network's inputs for samples: the query of each, then its body's numbers.
FeatureRows sample_inputs(const PlainNetwork& network, const DistanceSamples& samples) {
  FeatureRows inputs(samples.points.rows(), network.inputs());
  for (Eigen::Index i = 0; i < inputs.rows(); ++i) {
    const int body = samples.body[static_cast<std::size_t>(i)];
    const QueryMap& query = samples.queries[static_cast<std::size_t>(body)];
    const Eigen::Vector3f point = samples.points.row(i).transpose().cast<float>();
    inputs.row(i).head(query.size()) = (query.linear * point + query.offset).transpose();
    inputs.row(i).tail(samples.conditions.cols()) = samples.conditions.row(body);
  }
  return inputs;
}

struct SampleLoss {
  float by_value = 0;                                     // dL/df
  Eigen::Vector3f by_gradient = Eigen::Vector3f::Zero();  // dL/d(grad f)
};

// Adds one sample's part to the sums. `surface` and `free` are the numbers of samples of each kind.
SampleLoss sample_loss(const DistanceSamples& samples, std::size_t i, float f, const Eigen::Vector3f& gradient,
                       const DistanceLossWeights& weights, double surface, double free, DistanceLosses& losses) {
  const auto count = static_cast<double>(samples.distance.size());
  const double miss = static_cast<double>(f) - static_cast<double>(samples.distance[i]);
  SampleLoss result;
  losses.value += std::abs(miss) / count;
  result.by_value = static_cast<float>(weights.value * (miss > 0 ? 1 : miss < 0 ? -1 : 0) / count);
  if (samples.on_surface[i]) {
    const Eigen::Vector3f apart = gradient - samples.normals.row(static_cast<Eigen::Index>(i)).transpose();
    const float length = apart.norm();
    losses.surface_gradient += static_cast<double>(length) / surface;
    if (length > 0) result.by_gradient = static_cast<float>(weights.surface_gradient / surface) / length * apart;
  } else {
    const float length = gradient.norm();
    losses.eikonal += std::pow(static_cast<double>(length) - 1, 2) / free;
    if (length > 0)
      result.by_gradient = static_cast<float>(weights.eikonal / free) * 2 * (length - 1) / length * gradient;
  }
  return result;
}

}  // namespace

QueryMap point_query() { return {Eigen::Matrix3f::Identity(), Eigen::Vector3f::Zero()}; }

QueryMap bone_query(const std::vector<Eigen::Matrix<double, 3, 4>>& frames) {
  const auto rows = static_cast<Eigen::Index>(3 * frames.size());
  QueryMap query{Eigen::Matrix<float, Eigen::Dynamic, 3>(rows, 3), Eigen::VectorXf(rows)};
  for (std::size_t b = 0; b < frames.size(); ++b) {
    query.linear.middleRows<3>(static_cast<Eigen::Index>(3 * b)) = frames[b].leftCols<3>().cast<float>();
    query.offset.segment<3>(static_cast<Eigen::Index>(3 * b)) = frames[b].col(3).cast<float>();
  }
  return query;
}

PlainNetwork make_neural_distance(const NeuralDistanceShape& shape, std::uint64_t seed) {
  PlainShape plain{shape.query + shape.condition,
                   std::vector<int>(static_cast<std::size_t>(shape.layers), shape.width),
                   Bend::softplus,
                   shape.beta,
                   shape.again_layer,
                   shape.query};
  plain.outputs.push_back(1);
  return make_plain_network(plain, seed);
}

NeuralDistance::NeuralDistance(const PlainNetwork& network, const QueryMap& query, std::span<const float> condition)
    : network_(network), query_(query) {
  const int read = query.size() + static_cast<int>(condition.size());
  if (network.inputs() != read || network.outputs() != 1 ||
      (network.again_layer >= 0 && network.again_columns != query.size()))
    throw Error("the network reads " + std::to_string(network.inputs()) + " numbers and got " + std::to_string(read),
                "neural distance", "give it query, shape and pose as in training");
  AffineLayer& first = network_.layers.front();
  const Eigen::Map<const Eigen::VectorXf> numbers(condition.data(), static_cast<Eigen::Index>(condition.size()));
  Eigen::Map<Eigen::VectorXf>(first.bias.data(), static_cast<Eigen::Index>(first.bias.size())) +=
      first.weight.rightCols(numbers.size()) * numbers;
  first.weight = first.weight.leftCols(query.size()).eval();
}

void NeuralDistance::ask(const Points& at, std::vector<SignedDistance>& found) const {
  const ValueAndGradient made = evaluate_with_gradient(network_, query_rows(query_, at), query_.size());
  const FeatureRows gradient = made.gradient * query_.linear;
  found.assign(static_cast<std::size_t>(at.rows()), {});
  for (Eigen::Index i = 0; i < at.rows(); ++i) {
    SignedDistance& result = found[static_cast<std::size_t>(i)];
    result.value = static_cast<double>(made.value(i, 0));
    result.gradient = gradient.row(i).transpose().cast<double>();
    const double length = result.gradient.norm();
    result.closest = row(at, static_cast<int>(i));
    if (length > 0) result.closest -= result.value / length * result.gradient;
  }
}

DistanceLosses distance_losses(const PlainNetwork& network, const DistanceSamples& samples,
                               const DistanceLossWeights& weights) {
  const FeatureRows inputs = sample_inputs(network, samples);
  const int query = static_cast<int>(inputs.cols() - samples.conditions.cols());
  const ValueAndGradient made = evaluate_with_gradient(network, inputs, query);
  double surface = 0;
  for (const char on : samples.on_surface) surface += on;
  const double free = static_cast<double>(samples.on_surface.size()) - surface;

  // With v held, a derivative of (grad f . v) is that of the tangent in the direction v.
  DistanceLosses losses;
  FeatureRows directions = FeatureRows::Zero(inputs.rows(), inputs.cols());
  PlainAdjoints adjoints{FeatureRows(inputs.rows(), 1), FeatureRows::Ones(inputs.rows(), 1)};
  for (Eigen::Index i = 0; i < inputs.rows(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    const QueryMap& map = samples.queries[static_cast<std::size_t>(samples.body[k])];
    const Eigen::Vector3f gradient = map.linear.transpose() * made.gradient.row(i).transpose();
    const SampleLoss loss = sample_loss(samples, k, made.value(i, 0), gradient, weights, surface, free, losses);
    adjoints.value(i, 0) = loss.by_value;
    directions.row(i).head(query) = (map.linear * loss.by_gradient).transpose();
  }
  losses.total = weights.value * losses.value + weights.surface_gradient * losses.surface_gradient +
                 weights.eikonal * losses.eikonal;
  losses.gradient = backward(network, inputs, directions, adjoints).parameters;
  return losses;
}

DistanceErrors distance_errors(const PlainNetwork& network, const DistanceSamples& samples) {
  const FeatureRows made = evaluate(network, sample_inputs(network, samples));
  constexpr double near = 0.05;
  DistanceErrors errors;
  int counted = 0, near_ones = 0;
  for (Eigen::Index i = 0; i < made.rows(); ++i) {
    const auto truth = static_cast<double>(samples.distance[static_cast<std::size_t>(i)]);
    const double miss = std::abs(static_cast<double>(made(i, 0)) - truth);
    errors.absolute += miss;
    if (std::abs(truth) < near) {
      errors.near += miss;
      errors.wrong_side += (made(i, 0) < 0) != (truth < 0) ? 100 : 0;
      ++near_ones;
    }
    if (std::abs(truth) < 1e-4) continue;
    errors.relative += 100 * miss / std::abs(truth);
    ++counted;
  }
  if (made.rows() > 0) errors.absolute /= static_cast<double>(made.rows());
  if (counted > 0) errors.relative /= counted;
  if (near_ones > 0) {
    errors.near /= near_ones;
    errors.wrong_side /= near_ones;
  }
  return errors;
}

double forward_operations(const PlainNetwork& network, double rows) {
  double sum = 0;
  for (const AffineLayer& layer : network.layers) sum += 2.0 * static_cast<double>(layer.weight.size());
  return sum * rows;
}

}  // namespace selvedge
