#include <cmath>

#include "pipeline/bodies/joint_regressor.hpp"
#include "pipeline/bodies/mannequin_form.hpp"
#include "pipeline/bodies/mannequin_skin.hpp"

namespace selvedge {
namespace {

// The vertices for a joint: within `band` of it along a coordinate, and within `reach` of it [m].
struct Band {
  int axis;
  double band, reach;
};

Band band_of(const std::string& joint) {
  const std::string part = joint.substr(joint.find('_') + 1);
  if (part == "hip") return {1, 0.06, 0.13};
  if (part == "knee") return {1, 0.04, 0.09};
  if (part == "ankle") return {1, 0.03, 0.08};
  if (part == "foot") return {2, 0.025, 0.08};
  if (part == "collar") return {0, 0.05, 0.13};
  if (part == "shoulder") return {0, 0.05, 0.10};
  if (part == "elbow") return {0, 0.04, 0.08};
  if (part == "wrist" || part == "hand") return {0, 0.025, 0.07};
  if (part == "neck" || part == "head") return {1, 0.03, 0.13};
  return {1, 0.04, 0.20};
}

}  // namespace

SkinWeights mannequin_regressor(const Points& x) {
  const auto joints = mannequin_joints();
  std::vector<Eigen::Triplet<double>> entries;
  for (int j = 0; j < static_cast<int>(joints.size()); ++j) {
    const std::string name = joints[j].name;
    const Vec3& point = joints[j].position;
    const Band band = band_of(name);
    std::vector<int> vertices;
    std::vector<double> weights;
    for (int v = 0; v < x.rows(); ++v) {
      const Vec3 q = row(x, v) - point;
      const double along = q[band.axis] / band.band, far = q.norm() / band.reach;
      const bool same_side = point.x() == 0 || point.x() * x(v, 0) > 0;
      if (!same_side || std::abs(along) >= 1 || far >= 1) continue;
      vertices.push_back(v);
      weights.push_back((1 - along * along) * (1 - along * along) * (1 - far * far));
    }
    Eigen::VectorXd w = Eigen::Map<Eigen::VectorXd>(weights.data(), static_cast<Eigen::Index>(weights.size()));
    w /= w.sum();
    meet(x, vertices, point, w);
    for (std::size_t k = 0; k < vertices.size(); ++k)
      if (w[static_cast<Eigen::Index>(k)] > 0) entries.emplace_back(j, vertices[k], w[static_cast<Eigen::Index>(k)]);
  }
  return from_entries(std::ssize(joints), x.rows(), entries);
}

}  // namespace selvedge
