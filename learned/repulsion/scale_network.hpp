#pragma once

#include <span>
#include <vector>

#include "learned/repulsion/plain_network.hpp"

namespace selvedge {

// The push of a penetrating vertex in multiples of its distance (Tan et al. 2022, equations 4-6): alpha_i = g(k(z)_i,
// f(x_i)), z = h(shape, pose, style). vertex_latents: as written. shared_latent: g(k'(z), f) with one latent for all
// vertices and as many parameters (their "Alt. 1"). distance_only: g'(f) ("Alt. 2").
enum class ScaleForm { vertex_latents, shared_latent, distance_only };

// at_least_one: 1 + softplus, for exact distances, so that penetrating vertices come out. at_least_zero: softplus, for
// approximate distances. Last biases make either begin near 1.02.
enum class ScaleRange { at_least_one, at_least_zero };

struct ScaleShape {
  int inputs = 0;       // of h: pose, shape and style
  int vertices = 0;     // number of the garment's vertices
  int latent = 1024;    // M: width of z and of each layer of h; as in the paper
  int per_vertex = 10;  // D: latents per vertex
  ScaleForm form = ScaleForm::vertex_latents;
  ScaleRange range = ScaleRange::at_least_one;
  double unit = 0.01;  // unit of distances in g [m]; the paper gives none
};

struct ScaleNetwork {
  ScaleShape shape;
  PlainNetwork h, k, g;  // h: three layers with activations; k: one; g: 10, 10, 1 wide; h and k may be empty
};

// Throws Error for sizes that give no network.
ScaleNetwork make_scale_network(const ScaleShape&, std::uint64_t seed);
long long parameter_count(const ScaleNetwork&);
// The width of the shared latent with as many parameters as vertex latents have, g's first layer included.
int shared_latent_width(const ScaleShape&);

// Scales and their derivatives by the distance [1/m].
struct Scales {
  std::vector<double> alpha, slope;
};

// Scales for one pose, shape and style. z is computed once, and of k only the rows of the requested vertices.
class ScaleEvaluator {
 public:
  // Keeps a reference to the network. Throws Error for another number of inputs.
  ScaleEvaluator(const ScaleNetwork&, std::span<const float> inputs);
  // `distances` [m] belong to the vertices, which must be the garment's (assert).
  Scales operator()(std::span<const int> vertices, std::span<const double> distances) const;

 private:
  const ScaleNetwork& network_;
  std::vector<float> latent_;  // z, or the shared latent
};

// The inputs of g in training: latents and distances, one row per vertex.
FeatureRows scale_inputs(const ScaleNetwork&, const FeatureRows& latents, std::span<const double> distances);
// A network g with that number of inputs, two layers of width 10 and one output, whose scales begin near 1.02.
PlainNetwork make_scale_end(int inputs, ScaleRange, std::uint64_t seed);
// The output activation of g, and the adjoints of g's outputs `sums` from derivatives by the scales.
double scale_end(ScaleRange, double sum);
PlainAdjoints scale_adjoints(const FeatureRows& sums, std::span<const double> by_alpha);

}  // namespace selvedge
