#include "pipeline/joint_regressor.hpp"

namespace selvedge {

void meet(const Points& x, const std::vector<int>& vertices, const Vec3& point, Eigen::VectorXd& weights) {
  Eigen::MatrixXd conditions(4, weights.size());
  for (std::size_t k = 0; k < vertices.size(); ++k)
    conditions.col(static_cast<Eigen::Index>(k)) << 1, row(x, vertices[k]) - point;
  for (int round = 0; round < 20; ++round) {
    const Eigen::MatrixXd scaled = conditions * weights.asDiagonal();
    const Eigen::Vector4d missing = Eigen::Vector4d(1, 0, 0, 0) - conditions * weights;
    const Eigen::Matrix4d system = scaled * conditions.transpose();
    weights += scaled.transpose() * system.ldlt().solve(missing);
    if (weights.minCoeff() >= 0) return;
    weights = weights.cwiseMax(0);
  }
}

}  // namespace selvedge
