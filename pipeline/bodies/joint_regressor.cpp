#include "pipeline/bodies/joint_regressor.hpp"

#include "collision/geometry/box_diagonal.hpp"
#include "collision/geometry/error.hpp"
#include "collision/geometry/factorisations.hpp"

namespace selvedge {
namespace {

constexpr double farthest_miss = 1e-4;  // largest distance of a joint from its place [m]

// For each vertex its weight for the joint times that for the joint's parent (for the root: its children). It is large
// where the surface bends at the joint.
Eigen::VectorXd bends_at(const Eigen::MatrixXd& weights, const std::vector<int>& parents, int joint) {
  Eigen::VectorXd others = Eigen::VectorXd::Zero(weights.rows());
  for (int other = 0; other < weights.cols(); ++other)
    if (other == parents[joint] || (parents[joint] < 0 && parents[other] == joint)) others += weights.col(other);
  return weights.col(joint).cwiseProduct(others);
}

// Weights of any sign that sum to 1, with the weighted mean of the vertices at the point: those with the least norm.
// The vertices must not lie in one plane.
Eigen::VectorXd exact_mean(const Points& x, const Vec3& point) {
  const Vec3 mean = x.colwise().mean().transpose();
  const Points off = x.rowwise() - mean.transpose();
  const Vec3 pull = solve_symmetric(off.transpose() * off, point - mean);
  return (off * pull).array() + 1.0 / static_cast<double>(x.rows());
}

}  // namespace

void meet(const Points& x, const std::vector<int>& vertices, const Vec3& point, Eigen::VectorXd& weights) {
  Eigen::Matrix4Xd conditions(4, weights.size());
  for (std::size_t k = 0; k < vertices.size(); ++k)
    conditions.col(static_cast<Eigen::Index>(k)) << 1, row(x, vertices[k]) - point;
  for (int round = 0; round < 20; ++round) {
    Eigen::Vector4d missing(1, 0, 0, 0);
    Eigen::Matrix4d system = Eigen::Matrix4d::Zero();
    for (Eigen::Index k = 0; k < weights.size(); ++k) {
      const Eigen::Vector4d condition = conditions.col(k);
      missing -= weights[k] * condition;
      system += weights[k] * condition * condition.transpose();
    }
    const Eigen::Vector4d multipliers = system.ldlt().solve(missing);
    for (Eigen::Index k = 0; k < weights.size(); ++k) weights[k] += weights[k] * conditions.col(k).dot(multipliers);
    if (weights.minCoeff() >= 0) return;
    weights = weights.cwiseMax(0);
  }
}

SkinWeights joint_regressor(const BodyModel& body, const std::vector<std::optional<Vec3>>& places,
                            const RegressorFiles& files) {
  const Points& rest = body.skin.rest;
  const Eigen::MatrixXd weights = body.skin.weights;
  std::vector<Eigen::Triplet<double>> entries;
  for (int j = 0; j < static_cast<int>(body.joints.size()); ++j) {
    const std::string& name = body.joints[j];
    const Eigen::VectorXd bends = bends_at(weights, body.parents, j);
    std::vector<int> vertices;
    for (int v = 0; v < bends.size(); ++v)
      if (bends[v] > 0) vertices.push_back(v);
    if (vertices.empty())
      throw Error(
          "has no vertex that moves with both the joint " + name + " and its parent", files.weights,
          "give weights that pass smoothly from bone to bone, or places of joints between which some of the body lies");
    Eigen::VectorXd share = bends(vertices) / bends.sum();
    const std::optional<Vec3>& place = places[j];
    if (place) meet(rest, vertices, *place, share);
    const Vec3 mean = rest(vertices, Eigen::all).transpose() * share;
    if (place && !((mean - *place).norm() < farthest_miss))
      throw Error("puts the joint " + name + " outside the vertices that move with it and its parent", files.places,
                  "give the files of one body, or a place nearer to the middle of the limb");
    for (std::size_t k = 0; k < vertices.size(); ++k)
      if (share[static_cast<Eigen::Index>(k)] > 0)
        entries.emplace_back(j, vertices[k], share[static_cast<Eigen::Index>(k)]);
  }
  return from_entries(std::ssize(body.joints), rest.rows(), entries);
}

SkinWeights exact_regressor(const Points& x, const Points& joints, const std::string& where) {
  std::vector<Eigen::Triplet<double>> entries;
  const double size = box_diagonal(x);
  for (int j = 0; j < joints.rows(); ++j) {
    const Eigen::VectorXd weights = exact_mean(x, row(joints, j));
    if (!weights.allFinite() || !((x.transpose() * weights - row(joints, j)).norm() <= 1e-6 * size))
      throw Error("lies in one plane", where, "give the surface of a body");
    for (int v = 0; v < weights.size(); ++v) entries.emplace_back(j, v, weights[v]);
  }
  return from_entries(joints.rows(), x.rows(), entries);
}

}  // namespace selvedge
