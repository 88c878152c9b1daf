#pragma once

#include <span>
#include <vector>

#include "collision/distance/signed_distance.hpp"
#include "learned/repulsion/plain_network.hpp"

namespace selvedge {

// Signed distance by a network that reads a query and the body's numbers (Tan et al. 2022, equation 10). The query is
// the point itself, or the point in the frame of each bone. It is an affine function of the point, so that derivatives
// by the point can be computed.
struct QueryMap {
  Eigen::Matrix<float, Eigen::Dynamic, 3> linear;
  Eigen::VectorXf offset;
  int size() const { return static_cast<int>(offset.size()); }
};
QueryMap point_query();
// `frames` map a point of space into the frame of each bone (3 x 4).
QueryMap bone_query(const std::vector<Eigen::Matrix<double, 3, 4>>& frames);

struct NeuralDistanceShape {
  int query = 3, condition = 82;  // numbers of the query (the point) and of the body (shape 10, pose 72)
  int layers = 9, width = 1024;
  double beta = 100;    // of softplus
  int again_layer = 3;  // this layer reads the query again
};
PlainNetwork make_neural_distance(const NeuralDistanceShape&, std::uint64_t seed);

// The distance to one body. The body's numbers are folded into the layer that reads them.
class NeuralDistance {
 public:
  // Throws Error where query and condition do not fit the network's inputs.
  NeuralDistance(const PlainNetwork&, const QueryMap&, std::span<const float> condition);
  // Values and gradients. Gradients need not have unit length, and every place is a face. Points must be finite.
  void ask(const Points& at, std::vector<SignedDistance>& found) const;

 private:
  PlainNetwork network_;  // reads the query only
  QueryMap query_;
};

// Distance samples of several bodies.
struct DistanceSamples {
  Points points;
  std::vector<float> distance;  // true values [m]
  FeatureRows normals;          // of points on the surface, n x 3; zero elsewhere
  std::vector<char> on_surface;
  std::vector<int> body;          // row of each sample's body
  std::vector<QueryMap> queries;  // one per body
  FeatureRows conditions;         // one row per body
};

// Equations 11 to 14: value * mean |f - s| + surface_gradient * mean over surface points |grad f - n| + eikonal * mean
// over the others (|grad f| - 1)^2.
struct DistanceLossWeights {
  double value = 2, surface_gradient = 1, eikonal = 0.1;
};
struct DistanceLosses {
  double value = 0, surface_gradient = 0, eikonal = 0, total = 0;  // the first three without weights
  std::vector<float> gradient;                                     // by the network's parameters
};
DistanceLosses distance_losses(const PlainNetwork&, const DistanceSamples&, const DistanceLossWeights&);

// absolute, near: mean |f - s| over all samples, and over those within 5 cm of the surface [m]. relative: mean |f - s|
// / |s| [%] over samples with |s| >= 0.1 mm (equation 15). wrong_side: near samples with the wrong sign [%].
struct DistanceErrors {
  double absolute = 0, near = 0, relative = 0, wrong_side = 0;
};
DistanceErrors distance_errors(const PlainNetwork&, const DistanceSamples&);

// Number of multiplications and additions of one forward pass.
double forward_operations(const PlainNetwork&, double rows);

}  // namespace selvedge
