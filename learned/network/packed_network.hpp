#pragma once

#include <memory>
#include <vector>

#include "learned/network/aligned_floats.hpp"
#include "learned/network/engine_kernels.hpp"
#include "learned/network/weights.hpp"

namespace selvedge {

// Weights of one layer, or of its columns for one block of inputs, in panels (LayerTile).
struct PackedLayer {
  int inputs = 0, outputs = 0;  // outputs: padded
  AlignedFloats weight, bias;   // bias: zero except in the first block
  AlignedFloats unit;           // of integer weights, else empty

  // The tile that reads the rows `input` and writes `out`, for the kernels.
  LayerTile tile(const float* const* input, float* out, int stride, int rows) const {
    return {input, inputs, weight.data(), bias.data(), unit.data(), out, stride, outputs, weight.data(), rows};
  }
};

// A perceptron whose first layer reads several blocks: an edge network reads target, source and edge, a node network
// reads its node and the sums of each kind of edges.
struct PackedPerceptron {
  std::vector<PackedLayer> blocks, layers;  // the first layer, and the layers after it
  AlignedFloats scale, shift;               // empty without layer norm
  int outputs = 0;                          // not padded
};

struct PackedStep {
  std::vector<PackedPerceptron> edges;
  PackedPerceptron node;
};

// Weights laid out for the kernels of one instruction set. Threads may share it, for it is only read.
struct PackedNetwork {
  Architecture architecture;
  InstructionSet set = InstructionSet::plain;
  PackedPerceptron node_encoder;
  std::vector<PackedPerceptron> encoders;
  std::vector<PackedStep> steps;
  PackedPerceptron decoder;
};

// backward: from derivatives by a layer's results to those by its inputs. Layers are transposed and have neither bias
// nor norm.
enum class PackedWay { forward, backward };

// Throws Error unless the weights have the architecture's shapes (`check_weights`) and the machine has the set.
std::shared_ptr<const PackedNetwork> pack_network(const Architecture&, const NetworkWeights&,
                                                  InstructionSet = best_instruction_set());

// The network packed in one direction, without weights. pack_again fills the weights in after every change. Shapes must
// agree and are not checked.
PackedNetwork packed_shapes(const Architecture&, InstructionSet, PackedWay);
void pack_again(const NetworkWeights&, PackedWay, PackedNetwork&);

}  // namespace selvedge
