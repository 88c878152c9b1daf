#include "pipeline/garments/garment.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "collision/geometry/error.hpp"
#include "collision/geometry/nearest_point.hpp"

namespace selvedge {
namespace {

// The body vertices that a garment vertex follows, with their shares, which sum to 1.
using Shares = std::vector<std::pair<int, double>>;

// A third of the area of the triangles round each vertex [m2].
Eigen::VectorXd vertex_areas(const SkinnedSurface& skin) {
  Eigen::VectorXd areas = Eigen::VectorXd::Zero(skin.rest.rows());
  for (Eigen::Index t = 0; t < skin.triangles.rows(); ++t) {
    const auto corner = [&](int k) { return row(skin.rest, skin.triangles(t, k)); };
    const double area = (corner(1) - corner(0)).cross(corner(2) - corner(0)).norm() / 2;
    for (int k = 0; k < 3; ++k) areas[skin.triangles(t, k)] += area / 3;
  }
  return areas;
}

// width: of the Gaussian [m]; absent: the distance of p from the body. The grid is of the body at rest.
Shares shares_of(const Vec3& p, const SkinnedSurface& body, const CellGrid& grid, const Eigen::VectorXd& areas, Fit fit,
                 std::optional<double> width = {}) {
  constexpr double reach = 3;  // standard deviations
  const auto [nearest, least] = nearest_point(grid, body.rest, p);
  const double variance = width ? *width * *width : least;
  if (fit == Fit::tight || !(variance > 0)) return {{nearest, 1.0}};
  Shares shares;
  grid.for_each_near(p, std::sqrt(least + reach * reach * variance) * (1 + 1e-9), [&](int v) {
    const double beyond = ((body.rest.row(v) - p.transpose()).squaredNorm() - least) / variance;
    if (beyond <= reach * reach) shares.emplace_back(v, areas[v] * std::exp(-beyond / 2));
  });
  std::ranges::sort(shares);
  double sum = 0;
  for (const auto& [vertex, share] : shares) sum += share;
  if (!(sum > 0)) return {{nearest, 1.0}};
  for (auto& [vertex, share] : shares) share /= sum;
  return shares;
}

std::vector<Shares> all_shares(const Points& x, const SkinnedSurface& body, Fit fit, std::optional<double> width = {}) {
  const Eigen::VectorXd areas = vertex_areas(body);
  const CellGrid grid = grid_of(body.rest);
  std::vector<Shares> shares(static_cast<std::size_t>(x.rows()));
#pragma omp parallel for schedule(static)
  for (Eigen::Index v = 0; v < x.rows(); ++v)
    shares[v] = shares_of(x.row(v).transpose(), body, grid, areas, fit, width);
  return shares;
}

// Mixes rows of `from`, 3 per vertex, by these shares.
void mix(const Eigen::MatrixXd& from, const std::vector<Shares>& shares, Eigen::MatrixXd& to) {
  const auto count = static_cast<Eigen::Index>(shares.size());
  to.setZero(3 * count, from.cols());
  if (from.cols() == 0) return;
#pragma omp parallel for schedule(static)
  for (Eigen::Index v = 0; v < count; ++v)
    for (const auto& [source, share] : shares[v])
      to.middleRows(3 * v, 3) += share * from.middleRows(3 * static_cast<Eigen::Index>(source), 3);
}

SkinWeights mixed_weights(const SkinWeights& from, const std::vector<Shares>& shares) {
  constexpr double least = 1e-4;  // smaller shares are left out
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t v = 0; v < shares.size(); ++v) {
    Eigen::VectorXd weights = Eigen::VectorXd::Zero(from.cols());
    for (const auto& [source, share] : shares[v])
      for (SkinWeights::InnerIterator entry(from, source); entry; ++entry)
        weights[entry.col()] += share * entry.value();
    weights = (weights.array() < least).select(0, weights).eval();
    weights /= weights.sum();
    for (Eigen::Index j = 0; j < weights.size(); ++j)
      if (weights[j] > 0) entries.emplace_back(static_cast<int>(v), static_cast<int>(j), weights[j]);
  }
  return from_entries(std::ssize(shares), from.cols(), entries);
}

}  // namespace

SkinnedSurface attached(const Points& x, const Triangles& triangles, const BodyModel& body, Fit fit) {
  if (x.rows() == 0) throw Error("has no vertices", "garment", "give a mesh with vertices and faces");
  const std::vector<Shares> shares = all_shares(x, body.skin, fit);
  SkinnedSurface skin{x, triangles, mixed_weights(body.skin.weights, shares), {}, {}};
  mix(body.skin.shape_directions, shares, skin.shape_directions);
  mix(body.skin.pose_directions, shares, skin.pose_directions);
  return skin;
}

SkinWeights shares_of_body(const Points& x, const BodyModel& body, double width) {
  std::vector<Eigen::Triplet<double>> entries;
  const std::vector<Shares> shares = all_shares(x, body.skin, Fit::loose, width);
  for (std::size_t v = 0; v < shares.size(); ++v)
    for (const auto& [vertex, share] : shares[v]) entries.emplace_back(static_cast<int>(v), vertex, share);
  return from_entries(x.rows(), body.skin.rest.rows(), entries);
}

Points skinned(const Garment& garment, const BodyModel& body, const Eigen::VectorXd& shape, const BodyPose& pose) {
  return posed(garment.skin, shape, pose, joint_transforms(body, joint_positions(body, shape), pose));
}

Points rest_shape(const Garment& garment, const BodyModel& body, const Eigen::VectorXd& shape) {
  return garment.made_in.rotations.rows() == 0 ? shaped(garment.skin, shape)
                                               : skinned(garment, body, shape, garment.made_in);
}

}  // namespace selvedge
