#include "learned/repulsion/repulsion_training.hpp"

#include <algorithm>

namespace selvedge {
namespace {

// The derivative of x' by x for one pushed vertex.
Mat3 layer_jacobian(const PushedVertex& pushed, LayerGradient gradient) {
  SignedDistance at = pushed.at;
  const bool turned = (at.gradient.normalized() - pushed.direction).norm() > 1e-9;
  if (!turned) {
    return gradient == LayerGradient::full ? full_jacobian(at, pushed.alpha, pushed.slope)
                                           : frozen_jacobian(at, pushed.alpha, pushed.slope);
  }
  const double factor = pushed.alpha + at.value * pushed.slope;
  return Mat3::Identity() - factor * pushed.direction * at.gradient.transpose();
}

FeatureRows as_rows(std::span<const float> values) {
  return Eigen::Map<const FeatureRows>(values.data(), 1, static_cast<Eigen::Index>(values.size()));
}

// Writes k's gradient from that by the vertices' latents, and returns the gradient by z.
FeatureRows back_through_k(const ScaleNetwork& network, const FeatureRows& z, std::span<const int> vertices,
                           const FeatureRows& by_latents, std::vector<float>& gradient) {
  const AffineLayer& layer = network.k.layers.front();
  gradient.assign(static_cast<std::size_t>(parameter_count(network.k)), 0);
  Eigen::Map<FeatureRows> weight(gradient.data(), layer.weight.rows(), layer.weight.cols());
  Eigen::Map<Eigen::VectorXf> bias(gradient.data() + layer.weight.size(), layer.weight.rows());
  FeatureRows by_z = FeatureRows::Zero(1, z.cols());
  const bool shared = network.shape.form == ScaleForm::shared_latent;
  const Eigen::Index each = by_latents.cols();
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Eigen::Index first = shared ? 0 : each * vertices[i];
    const auto by = by_latents.row(static_cast<Eigen::Index>(i));
    weight.middleRows(first, each) += by.transpose() * z;
    bias.segment(first, each) += by.transpose();
    by_z += by * layer.weight.middleRows(first, each);
  }
  return by_z;
}

}  // namespace

RepulsionLosses repulsion_losses(const Repelled& layer, const Points& truth, const AskDistance& judge,
                                 const RepulsionLossOptions& options) {
  std::vector<SignedDistance> found;
  judge(layer.x, found);
  RepulsionLosses losses;
  const double per_unit = 1 / options.unit;
  losses.by_x = 2 * options.reconstruction * per_unit * per_unit * (layer.x - truth);
  losses.reconstruction = per_unit * per_unit * (layer.x - truth).squaredNorm();
  for (int v = 0; v < layer.x.rows(); ++v) {
    const SignedDistance& at = found[static_cast<std::size_t>(v)];
    if (!(at.value < 0)) continue;
    losses.collision -= per_unit * at.value;
    losses.by_x.row(v) -= options.collision * per_unit * at.gradient.transpose();
  }
  losses.total = options.reconstruction * losses.reconstruction + options.collision * losses.collision;
  for (const PushedVertex& pushed : layer.pushed) {
    const Vec3 by_moved = row(losses.by_x, pushed.vertex);
    losses.by_alpha.push_back(pushed.bounded ? 0 : -pushed.at.value * by_moved.dot(pushed.direction));
    losses.by_x.row(pushed.vertex) = (layer_jacobian(pushed, options.gradient).transpose() * by_moved).transpose();
  }
  return losses;
}

ScaleGradients scale_gradients(const ScaleNetwork& network, std::span<const float> inputs,
                               std::span<const int> vertices, std::span<const double> distances,
                               std::span<const double> by_alpha) {
  const auto count = static_cast<Eigen::Index>(vertices.size());
  const Eigen::Index columns = network.g.inputs() - 1;
  const bool has_latents = network.shape.form != ScaleForm::distance_only;
  FeatureRows z, latents(count, columns);
  if (has_latents) {
    z = evaluate(network.h, as_rows(inputs)).cwiseMax(0.0f);
    const AffineLayer& layer = network.k.layers.front();
    const bool shared = network.shape.form == ScaleForm::shared_latent;
    const Eigen::Map<const Eigen::VectorXf> bias(layer.bias.data(), layer.weight.rows());
    for (Eigen::Index i = 0; i < count; ++i) {
      const Eigen::Index first = shared ? 0 : columns * vertices[static_cast<std::size_t>(i)];
      latents.row(i) =
          (layer.weight.middleRows(first, columns) * z.transpose() + bias.segment(first, columns)).transpose();
    }
  }
  const FeatureRows read = scale_inputs(network, latents, distances), sums = evaluate(network.g, read);
  PlainGradients of_end = backward(network.g, read, {}, scale_adjoints(sums, by_alpha));
  ScaleGradients gradients{{}, {}, std::move(of_end.parameters)};
  if (!has_latents) return gradients;
  FeatureRows by_z = back_through_k(network, z, vertices, of_end.inputs.leftCols(columns), gradients.k);
  by_z = (z.array() > 0).select(by_z, FeatureRows::Zero(1, z.cols())).eval();
  gradients.h = backward(network.h, as_rows(inputs), {}, {by_z, {}}).parameters;
  return gradients;
}

}  // namespace selvedge
