#include "learned/repulsion/plain_network.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <random>

#include "collision/geometry/error.hpp"
#include "collision/geometry/parallel.hpp"
#include "learned/gradients/adam_rule.hpp"
#include "learned/network/dense_products.hpp"

namespace selvedge {
namespace {

constexpr int rows_at_once = 128;  // per chunk, whose results stay in the cache

// Intermediate results of one layer for a chunk of rows.
struct LayerTrace {
  FeatureRows input, input_tangent;
  FeatureRows sum, sum_tangent;  // before the activation
  FeatureRows slope;             // of the activation; empty for the last layer
};

struct Bent {
  float value, slope;
};
Bent bent(const PlainNetwork& n, float a) {
  if (n.bend == Bend::rectified) return {a < 0 ? 0 : a, static_cast<float>(a > 0)};
  const auto beta = static_cast<float>(n.beta);
  const float e = std::exp(-beta * std::abs(a));
  return {std::max(a, 0.0f) + std::log1p(e) / beta, (a >= 0 ? 1 : e) / (1 + e)};
}
// The derivative of the slope, from the slope.
float bend_curvature(const PlainNetwork& n, float slope) {
  return n.bend == Bend::rectified ? 0 : static_cast<float>(n.beta) * slope * (1 - slope);
}

FeatureRows beside(const FeatureRows& left, const FeatureRows& right) {
  FeatureRows both(left.rows(), left.cols() + right.cols());
  both << left, right;
  return both;
}

// Goes forward over one chunk. Without directions there are no tangents.
std::vector<LayerTrace> trace(const PlainNetwork& n, const FeatureRows& inputs, const FeatureRows& directions) {
  const bool tangents = directions.rows() > 0;
  std::vector<LayerTrace> made(n.layers.size());
  FeatureRows at = inputs, along = directions;
  for (std::size_t l = 0; l < n.layers.size(); ++l) {
    LayerTrace& layer = made[l];
    const bool again = static_cast<int>(l) == n.again_layer;
    layer.input = again ? beside(at, inputs.leftCols(n.again_columns)) : std::move(at);
    layer.sum = product_transposed(layer.input, n.layers[l].weight);
    layer.sum.rowwise() += Eigen::Map<const Eigen::RowVectorXf>(n.layers[l].bias.data(), layer.sum.cols());
    if (tangents) {
      layer.input_tangent = again ? beside(along, directions.leftCols(n.again_columns)) : std::move(along);
      layer.sum_tangent = product_transposed(layer.input_tangent, n.layers[l].weight);
    }
    if (l + 1 == n.layers.size()) break;
    at.resize(layer.sum.rows(), layer.sum.cols());
    layer.slope.resize(layer.sum.rows(), layer.sum.cols());
    for (Eigen::Index i = 0; i < at.size(); ++i) {
      const Bent found = bent(n, layer.sum.data()[i]);
      at.data()[i] = found.value;
      layer.slope.data()[i] = found.slope;
    }
    if (tangents) along = layer.sum_tangent.cwiseProduct(layer.slope);
  }
  return made;
}

template <class Visit>
void for_each_chunk(Eigen::Index rows, const Visit& visit) {
  const int count = static_cast<int>(rows);
  parallel_for(chunks_of(count, rows_at_once), 1, [&](int c) {
    const int first = c * rows_at_once;
    visit(c, first, std::min(rows_at_once, count - first));
  });
}

FeatureRows some_rows(const FeatureRows& rows, int first, int count) {
  return rows.rows() > 0 ? FeatureRows(rows.middleRows(first, count)) : FeatureRows(0, rows.cols());
}

// Goes back over one chunk. Writes the parameters' gradient to `gradient`, and returns that of the inputs.
FeatureRows trace_back(const PlainNetwork& n, const std::vector<LayerTrace>& made, FeatureRows value,
                       FeatureRows tangent, std::span<float> gradient) {
  const bool tangents = tangent.rows() > 0;
  const auto inputs = static_cast<Eigen::Index>(n.inputs());
  FeatureRows seen_again = FeatureRows::Zero(value.rows(), inputs);
  std::size_t end = gradient.size();
  for (std::size_t l = n.layers.size(); l-- > 0;) {
    const LayerTrace& layer = made[l];
    if (l + 1 < n.layers.size()) {  // through the activation
      if (tangents) {
        const FeatureRows curved = layer.slope.binaryExpr(
            layer.sum_tangent, [&](float slope, float d) { return d * bend_curvature(n, slope); });
        value = value.cwiseProduct(layer.slope) + tangent.cwiseProduct(curved);
        tangent = tangent.cwiseProduct(layer.slope).eval();
      } else {
        value = value.cwiseProduct(layer.slope).eval();
      }
    }
    const AffineLayer& affine = n.layers[l];
    const auto size = static_cast<std::size_t>(affine.weight.size());
    end -= affine.bias.size() + size;
    Eigen::Map<FeatureRows> weight(gradient.data() + end, affine.weight.rows(), affine.weight.cols());
    weight.setZero();
    add_transposed_product(value, layer.input, weight);
    if (tangents) add_transposed_product(tangent, layer.input_tangent, weight);
    Eigen::Map<Eigen::RowVectorXf>(gradient.data() + end + size, affine.weight.rows()) = value.colwise().sum();
    value = product(value, affine.weight);
    if (tangents) tangent = product(tangent, affine.weight);
    if (static_cast<int>(l) != n.again_layer) continue;
    seen_again.leftCols(n.again_columns) += value.rightCols(n.again_columns);
    value.conservativeResize(Eigen::NoChange, value.cols() - n.again_columns);
    if (tangents) tangent.conservativeResize(Eigen::NoChange, tangent.cols() - n.again_columns);
  }
  return value + seen_again;
}

}  // namespace

PlainNetwork make_plain_network(const PlainShape& shape, std::uint64_t seed) {
  PlainNetwork made{{}, shape.bend, shape.beta, shape.again_layer, shape.again_columns};
  std::mt19937_64 random(seed);
  int inputs = shape.inputs;
  for (std::size_t l = 0; l < shape.outputs.size(); ++l) {
    if (static_cast<int>(l) == shape.again_layer) inputs += shape.again_columns;
    const int outputs = shape.outputs[l];
    if (inputs < 1 || outputs < 1)
      throw Error("the layer has no inputs or no outputs", "layer " + std::to_string(l),
                  "give it one of each at least");
    AffineLayer layer{FeatureRows(outputs, inputs), std::vector<float>(static_cast<std::size_t>(outputs), 0)};
    const double reach = std::sqrt(6.0 / inputs);
    for (float& w : layer.weight.reshaped<Eigen::RowMajor>())
      w = static_cast<float>(reach * (2 * static_cast<double>(random() >> 11) * 0x1p-53 - 1));
    made.layers.push_back(std::move(layer));
    inputs = outputs;
  }
  return made;
}

long long parameter_count(const PlainNetwork& n) {
  long long count = 0;
  for (const AffineLayer& layer : n.layers) count += layer.weight.size() + static_cast<long long>(layer.bias.size());
  return count;
}

std::vector<float> parameters_of(const PlainNetwork& n) {
  std::vector<float> all;
  all.reserve(static_cast<std::size_t>(parameter_count(n)));
  for (const AffineLayer& layer : n.layers) {
    all.insert(all.end(), layer.weight.data(), layer.weight.data() + layer.weight.size());
    all.insert(all.end(), layer.bias.begin(), layer.bias.end());
  }
  return all;
}

void set_parameters(std::span<const float> all, PlainNetwork& n) {
  assert(static_cast<long long>(all.size()) == parameter_count(n));
  auto at = all.begin();
  for (AffineLayer& layer : n.layers) {
    std::copy_n(at, layer.weight.size(), layer.weight.data());
    at += layer.weight.size();
    std::copy_n(at, layer.bias.size(), layer.bias.begin());
    at += static_cast<std::ptrdiff_t>(layer.bias.size());
  }
}

FeatureRows evaluate(const PlainNetwork& n, const FeatureRows& inputs) {
  FeatureRows outputs(inputs.rows(), n.outputs());
  for_each_chunk(inputs.rows(), [&](int, int first, int count) {
    outputs.middleRows(first, count) = trace(n, some_rows(inputs, first, count), {}).back().sum;
  });
  return outputs;
}

ValueAndGradient evaluate_with_gradient(const PlainNetwork& n, const FeatureRows& inputs, int columns) {
  assert(n.outputs() == 1);
  ValueAndGradient result{FeatureRows(inputs.rows(), 1), FeatureRows(inputs.rows(), columns)};
  for_each_chunk(inputs.rows(), [&](int, int first, int count) {
    const std::vector<LayerTrace> made = trace(n, some_rows(inputs, first, count), {});
    result.value.middleRows(first, count) = made.back().sum;
    FeatureRows back = FeatureRows::Ones(count, 1), again = FeatureRows::Zero(count, n.inputs());
    for (std::size_t l = n.layers.size(); l-- > 0;) {
      if (l + 1 < n.layers.size()) back = back.cwiseProduct(made[l].slope).eval();
      back = product(back, n.layers[l].weight);
      if (static_cast<int>(l) != n.again_layer) continue;
      again.leftCols(n.again_columns) += back.rightCols(n.again_columns);
      back.conservativeResize(Eigen::NoChange, back.cols() - n.again_columns);
    }
    result.gradient.middleRows(first, count) = (back + again).leftCols(columns);
  });
  return result;
}

PlainGradients backward(const PlainNetwork& n, const FeatureRows& inputs, const FeatureRows& directions,
                        const PlainAdjoints& adjoints) {
  const auto size = static_cast<std::size_t>(parameter_count(n));
  const int chunks = chunks_of(static_cast<int>(inputs.rows()), rows_at_once);
  std::vector<std::vector<float>> parts(static_cast<std::size_t>(chunks));
  PlainGradients result{std::vector<float>(size, 0), FeatureRows(inputs.rows(), n.inputs())};
  for_each_chunk(inputs.rows(), [&](int c, int first, int count) {
    parts[static_cast<std::size_t>(c)].resize(size);
    const bool tangents = directions.rows() > 0 && adjoints.tangent.rows() > 0;
    const auto made =
        trace(n, some_rows(inputs, first, count), tangents ? some_rows(directions, first, count) : FeatureRows());
    result.inputs.middleRows(first, count) = trace_back(
        n, made, some_rows(adjoints.value, first, count),
        tangents ? some_rows(adjoints.tangent, first, count) : FeatureRows(), parts[static_cast<std::size_t>(c)]);
  });
  constexpr int stretch = 4096;
  parallel_for(chunks_of(static_cast<int>(size), stretch), 1, [&](int s) {
    const std::size_t end = std::min(size, static_cast<std::size_t>(s + 1) * stretch);
    for (const std::vector<float>& part : parts)
      for (std::size_t i = static_cast<std::size_t>(s) * stretch; i < end; ++i) result.parameters[i] += part[i];
  });
  return result;
}

bool take_step(PlainAdam& adam, std::span<const float> gradient, PlainNetwork& network) {
  if (!std::ranges::all_of(gradient, [](float g) { return std::isfinite(g); })) return false;
  std::vector<float> parameters = parameters_of(network);
  adam.first.resize(parameters.size(), 0);
  adam.second.resize(parameters.size(), 0);
  const auto kept = static_cast<float>(1 - adam.rate * adam.decay);
  if (adam.decay > 0)
    for (float& value : parameters) value *= kept;
  const AdamNumbers numbers = adam_numbers(adam.rate, adam.beta1, adam.beta2, adam.epsilon, ++adam.steps);
  take_adam_step(numbers, static_cast<std::ptrdiff_t>(parameters.size()), gradient.data(), adam.first.data(),
                 adam.second.data(), parameters.data());
  set_parameters(parameters, network);
  return true;
}

}  // namespace selvedge
