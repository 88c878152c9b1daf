#pragma once

#include <memory>
#include <span>
#include <vector>

#include "learned/repulsion/plain_network.hpp"

namespace selvedge {

// How far a penetrating vertex is pushed, in multiples of its distance (Tan et al. 2022, equations 4-6):
//   alpha_i = g(k(z)_i, f(x_i)),  z = h(shape, pose, style).
// vertex_latents: as written. shared_latent: g(k'(z), f) with one latent for all vertices, as many parameters (their
// "Alt. 1"). distance_only: g'(f) ("Alt. 2").
enum class ScaleForm { vertex_latents, shared_latent, distance_only };

// at_least_one: 1 + softplus, for accurate distances, so that what is inside comes out. at_least_zero: softplus, for
// approximate ones. Their last biases make either begin near 1.02.
enum class ScaleRange { at_least_one, at_least_zero };

struct ScaleShape {
  int inputs = 0;       // of h: pose, shape and style
  int vertices = 0;     // of the garment
  int latent = 1024;    // M: of z and of each layer of h
  int per_vertex = 10;  // D
  ScaleForm form = ScaleForm::vertex_latents;
  ScaleRange range = ScaleRange::at_least_one;
  double unit = 0.01;  // in which g reads distances [m]; the paper is silent
};
ScaleShape paper_scale_shape(int inputs, int vertices);  // M = 1024
ScaleShape small_scale_shape(int inputs, int vertices);  // M = 64

struct ScaleNetwork {
  ScaleShape shape;
  PlainNetwork h, k, g;  // h three layers and a bend behind them, k one, g two of 10 and one; h and k may be empty
};

// Throws Error for sizes that make no network.
ScaleNetwork make_scale_network(const ScaleShape&, std::uint64_t seed);
long long parameter_count(const ScaleNetwork&);
// Width of the shared latent that has as many parameters as latents of each vertex, g's first layer included.
int shared_latent_width(const ScaleShape&);

// Scales and their derivatives by the distance [1/m].
struct Scales {
  std::vector<double> alpha, slope;
};

// For one pose, shape and style. z is worked out once; of k only the rows of the vertices that are asked for.
class ScaleEvaluator {
 public:
  // Keeps a reference to the network. Throws Error for another number of inputs.
  ScaleEvaluator(const ScaleNetwork&, std::span<const float> inputs);
  // `distances` [m] of the vertices, which must be the garment's (assert).
  Scales operator()(std::span<const int> vertices, std::span<const double> distances) const;

 private:
  const ScaleNetwork& network_;
  std::vector<float> latent_;  // z, or the shared latent
};

// What g reads, for training: latents of the vertices and their distances, a row a vertex.
FeatureRows scale_inputs(const ScaleNetwork&, const FeatureRows& latents, std::span<const double> distances);
// A network g that reads so many numbers, of two layers of 10 and one, whose scales begin near 1.02.
PlainNetwork make_scale_end(int inputs, ScaleRange, std::uint64_t seed);
// The output activation of g, and its derivative with respect to its argument `sum`.
double scale_end(ScaleRange, double sum);
double scale_end_slope(ScaleRange, double sum);

}  // namespace selvedge
