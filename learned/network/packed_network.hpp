#pragma once

#include <memory>
#include <vector>

#include "learned/network/aligned_floats.hpp"
#include "learned/network/instruction_set.hpp"
#include "learned/network/weights.hpp"

namespace selvedge {

// Weights of one layer, or of those columns that one block of its inputs meets, in panels (LayerTile).
struct PackedLayer {
  int inputs = 0, outputs = 0;  // outputs: padded
  AlignedFloats weight, bias;   // bias: zero where another block brings it
};

// A perceptron whose first layer reads several blocks of inputs: an edge network target, source and edge, a node
// network its node and the sums of each kind of edges.
struct PackedPerceptron {
  std::vector<PackedLayer> blocks, layers;  // the first layer, and those behind it
  AlignedFloats scale, shift;               // empty without layer norm
  int outputs = 0;                          // not padded
};

struct PackedStep {
  std::vector<PackedPerceptron> edges;
  PackedPerceptron node;
};

// Weights laid out for the kernels of one instruction set. It is read only; threads may share it.
struct PackedNetwork {
  Architecture architecture;
  InstructionSet set = InstructionSet::plain;
  PackedPerceptron node_encoder;
  std::vector<PackedPerceptron> encoders;
  std::vector<PackedStep> steps;
  PackedPerceptron decoder;
};

// backward: from the derivatives with respect to a layer's results to those with respect to its inputs. Layers are
// transposed, and have neither bias nor norm.
enum class PackedWay { forward, backward };

// Throws Error unless the weights have the architecture's shapes (`check_weights`) and the machine has the set.
std::shared_ptr<const PackedNetwork> pack_network(const Architecture&, const NetworkWeights&,
                                                  InstructionSet = best_instruction_set());

// One direction, first without weights; pack_again fills them in after every change. Their shapes must be the same;
// nothing is checked.
PackedNetwork packed_shapes(const Architecture&, InstructionSet, PackedWay);
void pack_again(const NetworkWeights&, PackedWay, PackedNetwork&);

}  // namespace selvedge
