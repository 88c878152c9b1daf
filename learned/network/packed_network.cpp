#include "learned/network/packed_network.hpp"

#include <algorithm>

#include "learned/network/engine_kernels.hpp"

namespace selvedge {
namespace {

AlignedFloats pad(const std::vector<float>& values) {
  if (values.empty()) return {};
  AlignedFloats copy(static_cast<std::size_t>(padded(static_cast<int>(values.size()))));
  std::copy(values.begin(), values.end(), copy.data());
  return copy;
}

// Columns [begin, begin + inputs) of the layer.
PackedLayer pack_layer(const AffineLayer& layer, int begin, int inputs, bool with_bias, int panel) {
  PackedLayer packed;
  packed.inputs = inputs;
  const int outputs = static_cast<int>(layer.weight.rows());
  packed.outputs = (outputs + panel - 1) / panel * panel;
  packed.weight = AlignedFloats(static_cast<std::size_t>(packed.outputs) * inputs);
  float* to = packed.weight.data();
  for (int first = 0; first < packed.outputs; first += panel)
    for (int k = 0; k < inputs; ++k)
      for (int i = first; i < first + panel; ++i) *to++ = i < outputs ? layer.weight(i, begin + k) : 0.f;
  packed.bias = with_bias ? pad(layer.bias) : AlignedFloats(static_cast<std::size_t>(padded(outputs)));
  return packed;
}

// The first layer's inputs in blocks of `block` columns.
PackedPerceptron pack(const Perceptron& p, int block, int panel) {
  PackedPerceptron packed;
  const int inputs = static_cast<int>(p.layers.front().weight.cols());
  for (int begin = 0; begin < inputs; begin += block)
    packed.blocks.push_back(pack_layer(p.layers.front(), begin, block, begin == 0, panel));
  for (std::size_t layer = 1; layer < p.layers.size(); ++layer)
    packed.layers.push_back(
        pack_layer(p.layers[layer], 0, static_cast<int>(p.layers[layer].weight.cols()), true, panel));
  packed.scale = pad(p.scale);
  packed.shift = pad(p.shift);
  packed.outputs = static_cast<int>(p.layers.back().bias.size());
  return packed;
}

}  // namespace

std::shared_ptr<const PackedNetwork> pack_network(const Architecture& a, const NetworkWeights& weights,
                                                  InstructionSet set) {
  check_architecture(a, "network");
  check_weights(a, weights, "network");
  const int panel = kernels_for(set).panel;
  auto packed = std::make_shared<PackedNetwork>();
  packed->architecture = a;
  packed->set = set;
  packed->node_encoder = pack(weights.node_encoder, a.node_inputs, panel);
  for (std::size_t i = 0; i < a.encoders.size(); ++i)
    packed->encoders.push_back(pack(weights.encoders[i], a.encoders[i].inputs, panel));
  for (const StepWeights& step : weights.steps) {
    PackedStep& to = packed->steps.emplace_back();
    for (const Perceptron& edges : step.edges) to.edges.push_back(pack(edges, a.width, panel));
    to.node = pack(step.node, a.width, panel);
  }
  packed->decoder = pack(weights.decoder, a.width, panel);
  return packed;
}

}  // namespace selvedge
