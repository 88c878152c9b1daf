#pragma once

#include "learned/repulsion/repulsive_layer.hpp"

namespace selvedge {

// Two baselines of the layer. The naive one is `repel` with a constant scale of 1. The other moves the whole garment
// smoothly, so that penetrating vertices come out (as in DRAPE, Guan et al. 2012). It minimises over u: sum over
// penetrating i of (n_i . (x_i + u_i - c_i) - gap)^2 + smoothness * sum over i of |u_i - mean of its neighbours' u|^2 +
// damping * sum over i of |u_i|^2, with nearest points c_i and normals n_i. This is repeated `rounds` times from the
// last result. The paper's weights could not be confirmed.
struct SmoothPushOptions {
  double gap = 0.003;  // [m]
  double smoothness = 4, damping = 0.8;
  int rounds = 3;
  double tolerance = 1e-8;  // relative residual of the linear solves
  int most_iterations = 500;
};

struct SmoothlyPushed {
  Points x;
  int penetrating = 0;  // vertices inside at the start
  int iterations = 0;   // of conjugate gradients, over all rounds
};

// Vertices marked in `held`, which may be empty, have u = 0.
SmoothlyPushed push_smoothly(const Points& x, const Adjacency& ring, const AskDistance&, const SmoothPushOptions&,
                             std::span<const char> held = {});

}  // namespace selvedge
