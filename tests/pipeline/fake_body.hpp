#pragma once

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "pipeline/bodies/body.hpp"

namespace selvedge::fake {

struct Dice {
  std::mt19937 engine;
  double number(double low, double high) {  // the same on every machine, unlike the standard's distributions
    return low + (high - low) * static_cast<double>(engine()) / 4294967296.0;
  }
  int index(int count) { return static_cast<int>(engine() % static_cast<unsigned>(count)); }
  Eigen::MatrixXd matrix(Eigen::Index rows, Eigen::Index cols, double size) {
    Eigen::MatrixXd m(rows, cols);
    for (Eigen::Index k = 0; k < m.size(); ++k) m.data()[k] = number(-size, size);
    return m;
  }
};

// A body without a shape: random points, triangles, tree, weights and directions. Weights are sparse, as real ones are.
inline BodyModel body(int joints, int vertices, int shapes, bool corrections, unsigned seed = 1) {
  Dice dice{std::mt19937(seed)};
  BodyModel body;
  body.name = "random";
  body.skin.rest = dice.matrix(vertices, 3, 1);
  body.skin.triangles.resize(vertices, 3);
  for (int t = 0; t < vertices; ++t) body.skin.triangles.row(t) << t, (t + 1) % vertices, (t + 2) % vertices;
  body.skin.shape_directions = dice.matrix(3 * vertices, shapes, 0.05);
  if (corrections) body.skin.pose_directions = dice.matrix(3 * vertices, 9 * (joints - 1), 0.02);
  std::vector<Eigen::Triplet<double>> weights, regressor;
  for (int v = 0; v < vertices; ++v) {
    std::vector<double> share(static_cast<std::size_t>(std::min(joints, 4)));
    double sum = 0;
    for (double& s : share) sum += s = dice.number(0.1, 1);
    const int first = dice.index(joints);
    for (std::size_t k = 0; k < share.size(); ++k)
      weights.emplace_back(v, (first + 7 * static_cast<int>(k)) % joints, share[k] / sum);
  }
  for (int j = 0; j < joints; ++j) {
    body.joints.push_back("joint_" + std::to_string(j));
    body.parents.push_back(j == 0 ? -1 : dice.index(j));
    for (int k = 0; k < 3; ++k) regressor.emplace_back(j, (7 * j + k) % vertices, 0.5 - 0.25 * (k > 0));
  }
  body.skin.weights.resize(vertices, joints);
  body.skin.weights.setFromTriplets(weights.begin(), weights.end());
  body.regressor.resize(joints, vertices);
  body.regressor.setFromTriplets(regressor.begin(), regressor.end());
  return body;
}

inline BodyPose pose(int joints, unsigned seed = 2, double size = 2) {
  Dice dice{std::mt19937(seed)};
  BodyPose pose;
  pose.rotations = dice.matrix(joints, 3, size);
  pose.translation = dice.matrix(3, 1, 1);
  return pose;
}

}  // namespace selvedge::fake
