#pragma once

#include <functional>
#include <span>
#include <vector>

#include "collision/distance/signed_distance.hpp"
#include "learned/repulsion/plain_network.hpp"

namespace selvedge {

// Signed distance by a network that reads a query and the body's numbers (Tan et al. 2022, equation 10). The query is
// the point itself, or the point in the frame of each bone: an affine function of the point, so that derivatives by the
// point go through it.
struct QueryMap {
  Eigen::Matrix<float, Eigen::Dynamic, 3> linear;
  Eigen::VectorXf offset;
  int size() const { return static_cast<int>(offset.size()); }
};
QueryMap point_query();
// `frames` take a point of space into a bone's frame (3 x 4 each).
QueryMap bone_query(const std::vector<Eigen::Matrix<double, 3, 4>>& frames);

struct NeuralDistanceShape {
  int query = 3, condition = 82;  // numbers that say where the point is, and which body (shape 10, pose 72)
  int layers = 9, width = 1024;
  double beta = 100;    // of softplus
  int again_layer = 3;  // the fourth reads the query again
};
PlainNetwork make_neural_distance(const NeuralDistanceShape&, std::uint64_t seed);

// For one body: its numbers are folded into the layer that reads them.
class NeuralDistance {
 public:
  // Throws Error where query and condition are not what the network reads.
  NeuralDistance(const PlainNetwork&, const QueryMap&, std::span<const float> condition);
  // Values and gradients, which need not have unit length; every place counts as a face. Points must be finite.
  void ask(const Points& at, std::vector<SignedDistance>& found) const;

 private:
  PlainNetwork network_;  // of the query alone
  QueryMap query_;
};

// Samples of distances of several bodies.
struct DistanceSamples {
  Points points;
  std::vector<float> distance;  // true values [m]
  FeatureRows normals;          // of points on the surface, else zero; n x 3
  std::vector<char> on_surface;
  std::vector<int> body;          // a row each
  std::vector<QueryMap> queries;  // by body
  FeatureRows conditions;         // a row a body
};

// Equations 11 to 14: value * mean |f - s| + surface_gradient * mean over surface points |grad f - n|
// + eikonal * mean over the others (|grad f| - 1)^2.
struct DistanceLossWeights {
  double value = 2, surface_gradient = 1, eikonal = 0.1;
};
struct DistanceLosses {
  double value = 0, surface_gradient = 0, eikonal = 0, total = 0;  // the three without weights
  std::vector<float> gradient;                                     // by the network's parameters
};
DistanceLosses distance_losses(const PlainNetwork&, const DistanceSamples&, const DistanceLossWeights&);

// Mean |f - s| of all samples, of those on the surface or nearer to it than 5 cm [m], and mean |f - s| / |s| [%] over
// samples with |s| of 0.1 mm and more (equation 15); of the near ones, how many are told to lie on the wrong side [%].
struct DistanceErrors {
  double absolute = 0, near = 0, relative = 0, wrong_side = 0;
};
DistanceErrors distance_errors(const PlainNetwork&, const DistanceSamples&);

// Multiplications and additions of one forward pass.
double forward_operations(const PlainNetwork&, double rows);

}  // namespace selvedge
