#pragma once

#include "learned/repulsion/mesh_layers.hpp"

namespace selvedge {

// Predicts a drape from pose, shape and style by a multi-layer perceptron (the baseline of Tan et al. 2022, table 6).
// The perceptron gives the displacement of each vertex from the garment at rest in the body's zero pose, and skinning
// takes that into the pose:
//   x_v = A_v (rest_v + mean_v + unit y_v) + b_v.
// y is the sum of the perceptron's output and of a linear regression, if there is one. In a graph network (their table
// 5) the perceptron gives values on the coarsest level of the mesh, and convolutions over the garment give y from them.

using VertexFrame = Eigen::Matrix<double, 3, 4>;  // (A, b)

// What is known of one drape. `truth` may be empty.
struct DrapeCase {
  std::vector<float> inputs;        // pose, shape, style
  Points rest;                      // garment space, N x 3 [m]
  std::vector<VertexFrame> frames;  // of the vertices
  Points truth;                     // where they come to rest [m]
};

struct DrapeNetwork {
  PlainNetwork plain;
  std::vector<MeshLayer> mesh;                 // behind it; empty: there are none
  std::vector<float> input_mean, input_scale;  // inputs are read as (input - mean) * scale; 0 of a constant one
  Points mean;                                 // of displacements in garment space, N x 3 [m]
  double unit = 0.01;                          // of outputs [m]
  Eigen::MatrixXf linear;                      // 3 N x inputs, in units; empty: there is none
};

struct DrapeShape {
  int layers = 5, width = 256;
  double last_scale = 0.1;          // of the last layer's weights at the start
  std::vector<char> unread = {};    // inputs that are left out; empty: none
  MeshShape mesh = {0};             // levels 0: there are no mesh layers
  const Adjacency* ring = nullptr;  // of the garment, where there are mesh layers
};
// Means and deviations are those of the cases, all of one garment, one at least (assert).
DrapeNetwork make_drape_network(const DrapeShape&, std::span<const DrapeCase* const>, std::uint64_t seed);

// Ridge regression of the cases' displacements on the perceptron's inputs. `ridge` is relative to the mean square
// length of the inputs. `trust` is empty or has one number an input: the share of the displacement that this input is
// expected to explain beside the others. The ridge of an input's coefficients is divided by the square of its trust.
// The perceptron's own output is ignored.
void fit_linear_part(std::span<const DrapeCase* const>, double ridge, std::span<const double> trust, DrapeNetwork&);

// The inputs of the perceptron, one row a case.
FeatureRows drape_inputs(const DrapeNetwork&, std::span<const DrapeCase* const>);
// y, a row a case.
FeatureRows drape_outputs(const DrapeNetwork&, const FeatureRows& inputs);
// The positions of the vertices from one row of outputs.
Points drape_positions(const DrapeNetwork&, const DrapeCase&, const FeatureRows& outputs, Eigen::Index row);
Points drape_positions(const DrapeNetwork&, const DrapeCase&);
// Derivative of a loss by the outputs of a case, from the one by the positions.
Eigen::RowVectorXf by_drape_outputs(const DrapeNetwork&, const DrapeCase&, const Points& by_positions);

}  // namespace selvedge
