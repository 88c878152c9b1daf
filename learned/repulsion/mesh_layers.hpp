#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "collision/geometry/adjacency.hpp"
#include "learned/repulsion/plain_network.hpp"

namespace selvedge {

// Convolutions over a mesh with locally varying kernels (Zhou et al. 2020): every edge mixes matrices that all edges
// share, with its own coefficients. A target i reads sources j over its edges e: y_i = sum over e of sum over k of a_ek
// (B_k h_j + b_k) + p_e (C h_j + c), h = max(0, x). B, b, C, c are shared; a and p are learned per edge, and p pools.
// Sources are the vertices themselves, or those of a coarser level.
struct MeshLayer {
  int sources = 0;
  std::vector<int> begin;   // edges of target i: begin[i] to begin[i + 1]
  std::vector<int> source;  // one per edge
  PlainNetwork kernels;     // one affine layer: channels of a source to all B h + b, then C h + c
  PlainNetwork mix;         // one affine layer: its weight is a, one row per edge, and its bias is p

  int targets() const { return static_cast<int>(begin.size()) - 1; }
  int channels_in() const { return kernels.inputs(); }
  int channels_out() const { return kernels.outputs() / (mix.inputs() + 1); }
};

// Convolutions over a garment's mesh. Members are described where keys are bound to them:
// pipeline/drapes/drape_training_options.cpp.
struct MeshShape {
  int levels = 4, channels = 16, kernels = 9;
};

// A coarser mesh: the coarse vertex of each fine one, and the adjacency of coarse ones. A vertex becomes a centre, in
// ascending order, if no neighbour is one; so each fine vertex is a centre or beside one.
struct PooledMesh {
  std::vector<int> coarse_of;
  Adjacency ring;
};
PooledMesh pooled(const Adjacency& ring);

// Layers from the coarsest level to three numbers per vertex: one up to each finer level, and one on the finest.
std::vector<MeshLayer> make_mesh_layers(const Adjacency& ring, const MeshShape&, std::uint64_t seed);

// One row per case, with the channels of each vertex in turn. Any number of threads gives the same bits.
FeatureRows evaluate(std::span<const MeshLayer>, const FeatureRows& inputs);

// Gradient of a loss by the parameters (kernels and mix of each layer, in the order of parameters_of) and by the
// inputs.
struct MeshGradients {
  std::vector<std::vector<float>> parts;
  FeatureRows inputs;
};
MeshGradients backward(std::span<const MeshLayer>, const FeatureRows& inputs, const FeatureRows& by_outputs);

}  // namespace selvedge
