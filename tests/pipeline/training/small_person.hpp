#pragma once

#include <array>
#include <cmath>
#include <numbers>

#include "pipeline/bodies/body_smpl.hpp"
#include "pipeline/bodies/smpl_joints.hpp"
#include "pipeline/formats/mesh.hpp"
#include "tests/pipeline/fake_skeleton.hpp"

// A body with SMPL's joints and a skirt for it, small enough that tests of training read, dress and skin them quickly.
namespace selvedge::fake {

// A surface about the vertical axis: rings of `columns` vertices at these heights with these radii. `closed` adds a
// vertex at either end.
inline Mesh turned(const std::vector<double>& heights, const std::vector<double>& radii, int columns, bool closed) {
  const auto rings = static_cast<int>(heights.size());
  Mesh mesh;
  mesh.x.resize(rings * columns + (closed ? 2 : 0), 3);
  std::vector<std::array<int, 3>> triangles;
  const auto at = [&](int ring, int column) { return ring * columns + column % columns; };
  for (int r = 0; r < rings; ++r)
    for (int c = 0; c < columns; ++c) {
      const double angle = 2 * std::numbers::pi * c / columns;
      const auto k = static_cast<std::size_t>(r);
      mesh.x.row(at(r, c)) << radii[k] * std::sin(angle), heights[k], radii[k] * std::cos(angle);
      if (r + 1 == rings) continue;
      triangles.push_back({at(r, c), at(r, c + 1), at(r + 1, c)});
      triangles.push_back({at(r, c + 1), at(r + 1, c + 1), at(r + 1, c)});
    }
  for (int c = 0; closed && c < columns; ++c) {
    triangles.push_back({at(0, c), rings * columns, at(0, c + 1)});
    triangles.push_back({at(rings - 1, c), at(rings - 1, c + 1), rings * columns + 1});
  }
  if (closed) {
    mesh.x.row(rings * columns) << 0, heights.front() - 0.02, 0;
    mesh.x.row(rings * columns + 1) << 0, heights.back() + 0.02, 0;
  }
  mesh.triangles.resize(std::ssize(triangles), 3);
  for (std::size_t t = 0; t < triangles.size(); ++t)
    mesh.triangles.row(static_cast<Eigen::Index>(t)) << triangles[t][0], triangles[t][1], triangles[t][2];
  return mesh;
}

// A skittle of 290 vertices with the pelvis at the origin: head, waist and both legs in one. Its joints are those of
// the upright skeleton. Its first shape makes it larger.
inline BodyModel small_body() {
  const Mesh mesh = turned(
      {-0.92, -0.8, -0.65, -0.5, -0.35, -0.2, -0.08, 0.05, 0.15, 0.25, 0.35, 0.42, 0.5, 0.56, 0.62, 0.68, 0.74, 0.78},
      {0.05, 0.08, 0.09, 0.11, 0.13, 0.15, 0.16, 0.14, 0.11, 0.12, 0.14, 0.13, 0.08, 0.06, 0.07, 0.08, 0.07, 0.04}, 16,
      true);
  BodyModel body;
  body.name = "small";
  body.skin.rest = mesh.x;
  body.skin.triangles = mesh.triangles;
  body.joints = smpl_joint_names(24);
  body.parents = smpl_joint_parents();
  Points joints = skeleton();
  joints.rowwise() -= Eigen::RowVector3d(joints.row(0));
  const auto n = mesh.x.rows();
  std::vector<Eigen::Triplet<double>> weights, regressor;
  for (int v = 0; v < n; ++v) {
    Eigen::VectorXd share = (joints.rowwise() - mesh.x.row(v)).rowwise().squaredNorm() / (0.08 * 0.08);
    share = (share.minCoeff() - share.array()).exp();
    share = (share.array() < 0.02).select(0, share).eval();
    share /= share.sum();
    for (int j = 0; j < 24; ++j)
      if (share[j] > 0) weights.emplace_back(v, j, share[j]);
  }
  // A joint is an affine combination of four vertices round the waist and at the head.
  const std::array<int, 4> of{8 * 16, 8 * 16 + 4, 8 * 16 + 8, static_cast<int>(n) - 1};
  Eigen::Matrix4d corners;
  for (int k = 0; k < 4; ++k) corners.col(k) << mesh.x.row(of[static_cast<std::size_t>(k)]).transpose(), 1;
  for (int j = 0; j < 24; ++j) {
    Eigen::Vector4d place;
    place << joints.row(j).transpose(), 1;
    const Eigen::Vector4d shares = corners.inverse() * place;
    for (int k = 0; k < 4; ++k) regressor.emplace_back(j, of[static_cast<std::size_t>(k)], shares[k]);
  }
  body.skin.weights.resize(n, 24);
  body.skin.weights.setFromTriplets(weights.begin(), weights.end());
  body.regressor.resize(24, n);
  body.regressor.setFromTriplets(regressor.begin(), regressor.end());
  body.skin.shape_directions = Eigen::MatrixXd::Zero(3 * n, 10);
  body.skin.shape_directions.col(0) = 0.02 * Eigen::Map<const Eigen::VectorXd>(mesh.x.data(), mesh.x.size());
  return body;
}

// The skirt of the small body, from the waist down [m].
inline Mesh small_skirt() {
  return turned({-0.4, -0.33, -0.26, -0.19, -0.12, -0.05, 0.02, 0.08, 0.13},
                {0.26, 0.245, 0.23, 0.215, 0.195, 0.18, 0.165, 0.145, 0.125}, 20, false);
}

}  // namespace selvedge::fake
