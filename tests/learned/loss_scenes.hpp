#pragma once

#include <random>

#include "learned/losses/objective.hpp"

// Small garments and bodies for the losses.
namespace selvedge::testing {

// The authors' options, with iterations as fractions of the run. ContourCraft's stages 1 and 2 have 56,000 and do not
// see contours. Its stage 3 has 11,000, and the contour loss rises in the first 5,000. The released ContourCraft trains
// without friction.
inline LossOptions contourcraft_losses() {
  LossOptions options;
  options.collision.thickness = 3e-3;
  options.collision.matching = BodyMatching::nearest_face;
  options.collision.weight = {5e3, 1e6, 30.0 / 56, 40.0 / 56};
  options.repulsion.weight = {0, 2e6, 30.0 / 56, 40.0 / 56};
  return options;
}
inline LossOptions contourcraft_final_losses() {
  LossOptions options = contourcraft_losses();
  options.collision.weight = {1e6, 1e6};
  options.repulsion.weight = {2e6, 2e6};
  options.contours.weight = {0, 1e7, 0, 5.0 / 11};
  return options;
}

// Two sheets of n x n cells that cross each other, the second one upright, near a block below.
struct LossScene {
  Surface cloth, body;
  LossGarment garment;
  Points rest, x, velocity, predicted, body_previous, body_now, body_next;
  std::vector<ClothPair> pairs;

  explicit LossScene(int n = 3, double noise = 0.004) {
    const int side = n + 1, sheet = side * side;
    rest.resize(2 * sheet, 3);
    Triangles triangles(4 * n * n, 3);
    int next = 0;
    for (int part = 0; part < 2; ++part)
      for (int i = 0; i < side; ++i)
        for (int j = 0; j < side; ++j) {
          const int v = part * sheet + i * side + j;
          const double u = 0.03 * i, w = 0.03 * j;
          if (part == 0)
            rest.row(v) << u, 0.004, w;
          else
            rest.row(v) << 0.041, 0.03 + u - 0.06, w + 0.011;
          if (i == n || j == n) continue;
          triangles.row(next++) << v, v + 1, v + side;
          triangles.row(next++) << v + 1, v + side + 1, v + side;
        }
    cloth = make_surface(2 * sheet, triangles);
    std::vector<char> pinned(static_cast<std::size_t>(2 * sheet), 0);
    pinned[0] = 1;
    garment = make_loss_garment(cloth, rest, pinned, VertexMaterial{});
    make_body();
    std::mt19937 random(5);
    std::uniform_real_distribution<double> jitter(-noise, noise);
    const auto shaken = [&](const Points& points) {
      Points y = points;
      for (Eigen::Index i = 0; i < y.size(); ++i) y.data()[i] += jitter(random);
      return y;
    };
    x = shaken(rest);
    velocity = shaken(Points::Zero(x.rows(), 3));
    predicted = shaken(x);
    body_now = shaken(body_previous);
    body_next = shaken(body_now);
    for (int v = 0; v < sheet; ++v)
      for (int f = 2 * n * n; f < 4 * n * n; f += 3) pairs.push_back({v, f});
  }

  LossInputs inputs() const {
    LossInputs in;
    in.garment = &garment;
    in.x = &x;
    in.velocity = &velocity;
    in.predicted = &predicted;
    in.body = &body;
    in.body_previous = &body_previous;
    in.body_now = &body_now;
    in.body_next = &body_next;
    in.repulsion = pairs;
    return in;
  }

 private:
  void make_body() {  // a pyramid, its top face up, a little below the first sheet
    body_previous.resize(5, 3);
    body_previous << -0.05, 0, -0.05, 0.15, 0, -0.05, 0.15, 0, 0.15, -0.05, 0, 0.15, 0.05, -0.2, 0.05;
    Triangles faces(6, 3);
    faces << 0, 2, 1, 0, 3, 2, 0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4;
    body = make_surface(5, faces);
  }
};

// Every loss at once, with weights that make each one matter.
inline LossOptions all_losses() {
  LossOptions options = hood_losses();
  options.collision.weight = {5e3, 5e5, 0, 1};
  options.collision.thickness = 6e-3;
  options.repulsion.weight = {2e3, 2e3};
  options.repulsion.thickness = 1.5e-2;
  options.repulsion.correspondence = 2e-2;
  options.contours.weight = {30, 30};
  return options;
}

}  // namespace selvedge::testing
