#include "learned/network/packed_network.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <limits>

#include "learned/network/engine_kernels.hpp"

namespace selvedge {
namespace {

int whole_panels(int columns, int panel) { return (columns + panel - 1) / panel * panel; }

PackedLayer layer_shape(int inputs, int outputs, const EngineKernels& kernels) {
  PackedLayer packed;
  packed.inputs = inputs;
  packed.outputs = whole_panels(outputs, kernels.panel);
  if (kernels.pairs) packed.unit = AlignedFloats(static_cast<std::size_t>(padded(outputs)));
  const int rows = kernels.pairs ? pairs_of(inputs) : inputs;
  packed.weight = AlignedFloats(static_cast<std::size_t>(packed.outputs) * static_cast<std::size_t>(rows));
  packed.bias = AlignedFloats(static_cast<std::size_t>(padded(outputs)));
  return packed;
}

// The first layer reads `blocks` blocks of `block` inputs.
PackedPerceptron perceptron_shape(const Architecture& a, int blocks, int block, int outputs, bool norm,
                                  const EngineKernels& kernels, PackedWay way) {
  const bool forward = way == PackedWay::forward;
  PackedPerceptron packed;
  for (int i = 0; i < blocks; ++i)
    packed.blocks.push_back(forward ? layer_shape(block, a.width, kernels) : layer_shape(a.width, block, kernels));
  for (int layer = 1; layer <= a.hidden_layers; ++layer) {
    const int to = layer == a.hidden_layers ? outputs : a.width;
    packed.layers.push_back(forward ? layer_shape(a.width, to, kernels) : layer_shape(to, a.width, kernels));
  }
  if (forward && norm && a.layer_norm) {
    packed.scale = AlignedFloats(static_cast<std::size_t>(padded(outputs)));
    packed.shift = AlignedFloats(static_cast<std::size_t>(padded(outputs)));
  }
  packed.outputs = outputs;
  return packed;
}

// Packs columns [begin, begin + inputs) of the layer in panels of outputs.
void fill_forward(const FeatureRows& weight, Eigen::Index begin, int panel, PackedLayer& packed) {
  const auto outputs = static_cast<int>(weight.rows());
  float* panels = packed.weight.data();
  for (int i = 0; i < outputs; ++i) {
    const float* from = weight.row(i).data() + begin;
    float* to = panels + static_cast<std::ptrdiff_t>(i / panel) * panel * packed.inputs + i % panel;
    for (int k = 0; k < packed.inputs; ++k) to[static_cast<std::ptrdiff_t>(k) * panel] = from[k];
  }
}

// The unit in which an output's weights become whole numbers. No weight is above 16 bits then, and no sum with inputs
// up to `largest_input` above 32, whatever the inputs and however each weight is rounded.
float unit_of(const float* weight, int inputs) {
  float sum = 0, largest = 0;
  for (int k = 0; k < inputs; ++k) {
    sum += std::abs(weight[k]);
    largest = std::max(largest, std::abs(weight[k]));
  }
  const int most = std::numeric_limits<std::int32_t>::max() / largest_input - inputs;
  return std::max(sum / static_cast<float>(most), largest / std::numeric_limits<std::int16_t>::max());
}

std::uint32_t whole(float weight, float unit) {
  const float ratio = weight / unit;  // no number for zero weights
  return std::isfinite(ratio) ? static_cast<std::uint16_t>(std::lround(ratio)) : 0u;
}

// The same as whole numbers. Those of two neighbours lie in one place, the first in its lower half.
void fill_pairs(const FeatureRows& weight, Eigen::Index begin, int panel, PackedLayer& packed) {
  const int pairs = pairs_of(packed.inputs);
  for (int i = 0; i < static_cast<int>(weight.rows()); ++i) {
    const float* from = weight.row(i).data() + begin;
    const float unit = packed.unit.data()[i] = unit_of(from, packed.inputs);
    float* to = packed.weight.data() + static_cast<std::ptrdiff_t>(i / panel) * panel * pairs + i % panel;
    for (int k = 0; k < pairs; ++k) {
      const std::uint32_t second = 2 * k + 1 < packed.inputs ? whole(from[2 * k + 1], unit) : 0;
      to[static_cast<std::ptrdiff_t>(k) * panel] = std::bit_cast<float>(whole(from[2 * k], unit) | second << 16);
    }
  }
}

// Packs the same columns transposed, in panels of these columns.
void fill_backward(const FeatureRows& weight, Eigen::Index begin, Eigen::Index columns, int panel,
                   PackedLayer& packed) {
  float* to = packed.weight.data();
  for (Eigen::Index first = 0; first < columns; first += panel)
    for (int k = 0; k < packed.inputs; ++k, to += panel)
      std::copy_n(weight.row(k).data() + begin + first, std::min<Eigen::Index>(panel, columns - first), to);
}

// One layer to fill in.
struct PackTask {
  const AffineLayer* from;
  Eigen::Index begin, columns;
  PackedLayer* to;
};

void list_tasks(const Perceptron& p, PackedPerceptron& packed, std::vector<PackTask>& tasks) {
  const AffineLayer& first = p.layers.front();
  const Eigen::Index block = first.weight.cols() / static_cast<Eigen::Index>(packed.blocks.size());
  for (std::size_t i = 0; i < packed.blocks.size(); ++i)
    tasks.push_back({&first, static_cast<Eigen::Index>(i) * block, block, &packed.blocks[i]});
  for (std::size_t layer = 1; layer < p.layers.size(); ++layer)
    tasks.push_back({&p.layers[layer], 0, p.layers[layer].weight.cols(), &packed.layers[layer - 1]});
}

void copy_vectors(const Perceptron& p, PackedPerceptron& packed) {
  std::copy(p.layers.front().bias.begin(), p.layers.front().bias.end(), packed.blocks.front().bias.data());
  for (std::size_t layer = 1; layer < p.layers.size(); ++layer)
    std::copy(p.layers[layer].bias.begin(), p.layers[layer].bias.end(), packed.layers[layer - 1].bias.data());
  std::copy(p.scale.begin(), p.scale.end(), packed.scale.data());
  std::copy(p.shift.begin(), p.shift.end(), packed.shift.data());
}

// Calls visit(perceptron, packed perceptron) for each perceptron.
template <class Visit>
void visit_perceptrons(const NetworkWeights& weights, PackedNetwork& packed, Visit&& visit) {
  visit(weights.node_encoder, packed.node_encoder);
  for (std::size_t i = 0; i < weights.encoders.size(); ++i) visit(weights.encoders[i], packed.encoders[i]);
  for (std::size_t s = 0; s < weights.steps.size(); ++s) {
    for (std::size_t k = 0; k < weights.steps[s].edges.size(); ++k)
      visit(weights.steps[s].edges[k], packed.steps[s].edges[k]);
    visit(weights.steps[s].node, packed.steps[s].node);
  }
  visit(weights.decoder, packed.decoder);
}

}  // namespace

PackedNetwork packed_shapes(const Architecture& a, InstructionSet set, PackedWay way) {
  const EngineKernels& kernels = kernels_for(set);
  assert(way == PackedWay::forward || !kernels.pairs);
  const auto shape = [&](int blocks, int block, int outputs, bool norm) {
    return perceptron_shape(a, blocks, block, outputs, norm, kernels, way);
  };
  PackedNetwork packed;
  packed.architecture = a;
  packed.set = set;
  packed.node_encoder = shape(1, a.node_inputs, a.width, true);
  for (const EdgeEncoder& encoder : a.encoders) packed.encoders.push_back(shape(1, encoder.inputs, a.width, true));
  for (const MessageStep& step : a.steps) {
    PackedStep& to = packed.steps.emplace_back();
    for (std::size_t k = 0; k < step.edge_keys.size(); ++k) to.edges.push_back(shape(3, a.width, a.width, true));
    to.node = shape(1 + static_cast<int>(step.edge_keys.size()), a.width, a.width, true);
  }
  packed.decoder = shape(1, a.width, a.outputs, false);
  return packed;
}

void pack_again(const NetworkWeights& weights, PackedWay way, PackedNetwork& packed) {
  const EngineKernels& kernels = kernels_for(packed.set);
  const int panel = kernels.panel;
  const bool forward = way == PackedWay::forward;
  std::vector<PackTask> tasks;
  visit_perceptrons(weights, packed, [&](const Perceptron& p, PackedPerceptron& to) {
    list_tasks(p, to, tasks);
    if (forward) copy_vectors(p, to);
  });
  const int count = static_cast<int>(tasks.size());
#pragma omp parallel for schedule(static)
  for (int i = 0; i < count; ++i) {
    const PackTask& task = tasks[static_cast<std::size_t>(i)];
    if (kernels.pairs)
      fill_pairs(task.from->weight, task.begin, panel, *task.to);
    else if (forward)
      fill_forward(task.from->weight, task.begin, panel, *task.to);
    else
      fill_backward(task.from->weight, task.begin, task.columns, panel, *task.to);
  }
}

std::shared_ptr<const PackedNetwork> pack_network(const Architecture& a, const NetworkWeights& weights,
                                                  InstructionSet set) {
  check_architecture(a, "network");
  check_weights(a, weights, "network");
  auto packed = std::make_shared<PackedNetwork>(packed_shapes(a, set, PackedWay::forward));
  pack_again(weights, PackedWay::forward, *packed);
  return packed;
}

}  // namespace selvedge
