#pragma once

#include "learned/repulsion/mesh_layers.hpp"

namespace selvedge {

// Predicts a drape from pose, shape and style by a multi-layer perceptron (the baseline of Tan et al. 2022, table 6).
// The perceptron gives the displacement of each vertex from the garment at rest in the body's zero pose, and skinning
// takes it into the pose: x_v = A_v (rest_v + mean_v + unit y_v) + b_v. y is the perceptron's output plus a linear
// regression, if there is one. In a graph network (their table 5) the perceptron gives values on the coarsest level of
// the mesh, and convolutions over the garment compute y from them.

using VertexFrame = Eigen::Matrix<double, 3, 4>;  // (A, b)

// One drape. `truth` may be empty.
struct DrapeCase {
  std::vector<float> inputs;        // pose, shape, style
  Points rest;                      // garment space, N x 3 [m]
  std::vector<VertexFrame> frames;  // one per vertex
  Points truth;                     // positions at rest on the body [m]
};

struct DrapeNetwork {
  PlainNetwork plain;
  std::vector<MeshLayer> mesh;                 // layers after the perceptron; empty: none
  std::vector<float> input_mean, input_scale;  // inputs are read as (input - mean) * scale; 0: a constant input
  Points mean;                                 // mean displacement in garment space, N x 3 [m]
  double unit = 0.01;                          // unit of outputs [m]
  Eigen::MatrixXf linear;                      // 3 N x inputs, in units; empty: none
};

struct DrapeShape {
  int layers = 5, width = 256;
  double last_scale = 0.1;          // factor of the last layer's weights at the start
  std::vector<char> unread = {};    // flags of inputs that are left out; empty: none
  MeshShape mesh = {0};             // levels 0: no mesh layers
  const Adjacency* ring = nullptr;  // the garment's; needed for mesh layers
};
// Means and deviations are those of the cases, which must be of one garment and at least one (assert).
DrapeNetwork make_drape_network(const DrapeShape&, std::span<const DrapeCase* const>, std::uint64_t seed);

// Fits a ridge regression of the cases' displacements on the perceptron's inputs. `ridge` is relative to the mean
// square length of the inputs. `trust` is empty or has one number per input: the share of the displacement that it is
// expected to explain beside the others. The ridge of its coefficients is divided by the square of the trust. The
// perceptron's own output is ignored.
void fit_linear_part(std::span<const DrapeCase* const>, double ridge, std::span<const double> trust, DrapeNetwork&);

// The inputs of the perceptron, one row per case.
FeatureRows drape_inputs(const DrapeNetwork&, std::span<const DrapeCase* const>);
// y, one row per case.
FeatureRows drape_outputs(const DrapeNetwork&, const FeatureRows& inputs);
// The positions of the vertices from one row of outputs.
Points drape_positions(const DrapeNetwork&, const DrapeCase&, const FeatureRows& outputs, Eigen::Index row);
Points drape_positions(const DrapeNetwork&, const DrapeCase&);
// The derivative of a loss by the outputs of a case, from that by the positions.
Eigen::RowVectorXf by_drape_outputs(const DrapeNetwork&, const DrapeCase&, const Points& by_positions);

}  // namespace selvedge
