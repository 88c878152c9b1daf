#pragma once

#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "collision/distance/signed_distance.hpp"
#include "collision/geometry/adjacency.hpp"
#include "learned/repulsion/layer_order.hpp"
#include "learned/repulsion/scale_network.hpp"

namespace selvedge {

// The layer of ReFU (Tan et al. 2022, equations 2-5). A garment vertex with f(x) < 0 moves to x - alpha f n, where n is
// the direction of the distance's gradient and alpha depends on the vertex and f. Others stay.

// Signed distances of points, exact or by a network. A network's gradients need not have unit length.
using AskDistance = std::function<void(const Points& at, std::vector<SignedDistance>& found)>;
// Scales of vertices at these distances.
using AskScale = std::function<Scales(std::span<const int> vertices, std::span<const double> distances)>;
Scales constant_scale(std::span<const int> vertices, double alpha);

struct RepulsionOptions {
  // How many times pushed vertices are queried again. Those still inside are projected, with half the margin each time,
  // because a narrow gap has no room for all of it. The paper: 0.
  int recheck = 0;
  double deep = 0.03;  // deeper vertices take their neighbours' mean direction [m]; infinity: none does
  double margin = 0;   // added to every push [m]; the paper: 0
  // No scale takes a vertex farther out of the body than this [m], however deep it was. Scale networks are evaluated at
  // depths that they were not trained on. The paper has no such bound.
  double most_beyond = std::numeric_limits<double>::infinity();
  LayerOrder order = {};  // cloth over pushed vertices moves with them; the paper: it does not
};

// A vertex that was moved.
struct PushedVertex {
  int vertex = 0;
  double alpha = 1, slope = 0;    // the scale and its derivative by the distance [1/m]
  bool bounded = false;           // `most_beyond` limits the push, so the scale has no influence
  SignedDistance at;              // distance before the push
  Vec3 direction = Vec3::Zero();  // direction of the push, unit length
};

// The numbers of moved vertices, and their distances before.
struct PushedOnes {
  std::vector<int> vertices;
  std::vector<double> distances;
};
PushedOnes pushed_ones(std::span<const PushedVertex>);

struct Repelled {
  Points x;
  std::vector<PushedVertex> pushed;  // ascending
  int deep = 0;                      // number of them deeper than the options' `deep`
  int torn = 0;                      // edges whose ends were pushed in directions over 90 degrees apart
  int carried = 0;                   // vertices outside that moved with pushed ones
  int projected = 0;                 // vertices still inside at a recheck, sum over rechecks
  int inside = 0;                    // vertices inside at the end, if there were rechecks; else 0
};

// `ring` joins neighbouring vertices; `order` needs gradients of unit length. Vertices marked in `held`, which may be
// empty, stay. A vertex inside whose gradient vanishes stays.
Repelled repel(const Points& x, const Adjacency& ring, const AskDistance&, const AskScale&, const RepulsionOptions&,
               std::span<const char> held = {});

// Derivative of a pushed vertex's new position by its old one. full: I - alpha (I - P) - f alpha' n n^T, with P the
// derivative of the closest point: I - n n^T on a face, t t^T on an edge, 0 at a vertex. frozen: n is a constant,
// I - (alpha + f alpha') n n^T.
Mat3 full_jacobian(const SignedDistance&, double alpha, double slope);
Mat3 frozen_jacobian(const SignedDistance&, double alpha, double slope);

}  // namespace selvedge
