#include <algorithm>
#include <cmath>

#include "collision/geometry/surface.hpp"
#include "pipeline/bodies/mannequin_form.hpp"
#include "pipeline/bodies/mannequin_skin.hpp"

namespace selvedge {
namespace {

// The share of a point p that follows the joint instead of its parent, for central and left joints. p may be on the
// right, where the other side's joint takes its part.
double share(const std::string& joint, const Vec3& at, const Vec3& p) {
  const Vec3 q = p - at;
  if (joint == "spine1") return smooth_step(q.y(), -0.07, 0.05);
  if (joint == "spine2") return smooth_step(q.y(), -0.06, 0.06);
  if (joint == "spine3") return smooth_step(q.y(), -0.05, 0.05);
  if (joint == "neck") {  // the slopes toward the shoulders belong to the trunk
    const double width = std::abs(p.x()) - 2 * std::max(0.0, p.y() - 1.46);
    return smooth_step(q.y() + 0.3 * q.z(), -0.04, 0.04) * (1 - smooth_step(width, 0.07, 0.12));
  }
  if (joint == "head") return smooth_step(0.95 * q.y() + 0.3 * q.z(), -0.03, 0.03);
  if (joint == "left_hip") {
    // The crease rises outward and to the front; between the legs both sides share the part near the middle.
    const double crease = at.y() - 0.015 + 0.25 * q.x() + 0.25 * q.z();
    const double middle = 0.001 + 0.03 * std::clamp((p.y() - 0.70) / 0.08, 0.0, 1.0);
    return smooth_step(crease - p.y(), -0.085, 0.085) * smooth_step(p.x(), -middle, middle);
  }
  if (joint == "left_knee") return smooth_step(-q.y(), -0.07, 0.07);
  if (joint == "left_ankle") return smooth_step(0.3 * q.z() - 0.95 * q.y(), -0.04, 0.04);
  if (joint == "left_foot") return smooth_step(q.z(), -0.035, 0.035);
  if (joint == "left_collar")
    return smooth_step(p.x(), 0.02, 0.13) * smooth_step(p.y() + std::max(0.0, p.x() - 0.15), 1.25, 1.38) *
           (1 - smooth_step(p.y(), 1.44, 1.50));
  if (joint == "left_shoulder") {  // the flank below the arm belongs to the trunk
    const double inner = 0.163 + 0.6 * std::max(0.0, 1.37 - p.y());
    return smooth_step(p.x(), inner - 0.07, inner + 0.07);
  }
  if (joint == "left_elbow") return smooth_step(q.x(), -0.055, 0.055);
  if (joint == "left_wrist") return smooth_step(q.x(), -0.03, 0.03);
  if (joint == "left_hand")
    return smooth_step(q.x(), -0.03, 0.03) * (1 - smooth_step(p.z(), 0.022, 0.04));  // without the thumb
  return 1;
}

// The joint on the other side: left_knee for right_knee; central joints map to themselves.
std::vector<int> other_sides(const std::vector<MannequinJoint>& joints) {
  std::vector<int> other;
  for (const MannequinJoint& joint : joints) {
    std::string name = joint.name;
    if (name.starts_with("left_"))
      name = "right_" + name.substr(5);
    else if (name.starts_with("right_"))
      name = "left_" + name.substr(6);
    const auto found = std::find_if(joints.begin(), joints.end(), [&](const auto& j) { return name == j.name; });
    other.push_back(static_cast<int>(found - joints.begin()));
  }
  return other;
}

Eigen::RowVectorXd shares_of_tree(const std::vector<MannequinJoint>& joints, const std::vector<int>& other,
                                  const Vec3& p) {
  const Vec3 mirrored(-p.x(), p.y(), p.z());
  Eigen::RowVectorXd weights = Eigen::RowVectorXd::Zero(static_cast<Eigen::Index>(joints.size()));
  Eigen::RowVectorXd subtree = weights;
  subtree[0] = weights[0] = 1;
  for (std::size_t j = 1; j < joints.size(); ++j) {
    const MannequinJoint& joint = joints[j];
    const bool right = std::string(joint.name).starts_with("right_");
    const MannequinJoint& left = right ? joints[other[j]] : joint;
    const double part = subtree[joint.parent] * share(left.name, left.position, right ? mirrored : p);
    subtree[static_cast<Eigen::Index>(j)] = part;
    weights[static_cast<Eigen::Index>(j)] += part;
    weights[joint.parent] -= part;
  }
  return weights.cwiseMax(0) / weights.cwiseMax(0).sum();
}

// The mean of a vertex' own weights and the mean of its neighbours'.
Eigen::MatrixXd averaged(const Surface& surface, const Eigen::MatrixXd& weights) {
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(weights.rows(), weights.cols());
  Eigen::VectorXd count = Eigen::VectorXd::Zero(weights.rows());
  for (Eigen::Index e = 0; e < surface.edges.rows(); ++e)
    for (const int k : {0, 1}) {
      sum.row(surface.edges(e, k)) += weights.row(surface.edges(e, 1 - k));
      ++count[surface.edges(e, k)];
    }
  return 0.5 * weights + 0.5 * count.cwiseInverse().asDiagonal() * sum;
}

// Keeps the `most` largest weights, without negligible ones.
void thin_out(Eigen::Ref<Eigen::RowVectorXd> weights, int most) {
  std::vector<double> sorted(weights.begin(), weights.end());
  std::sort(sorted.begin(), sorted.end(), std::greater<>());
  const double least = std::max(sorted[most], 1e-3);
  weights = (weights.array() > least).select(weights, 0);
  weights /= weights.sum();
}

}  // namespace

Eigen::MatrixXd mannequin_weights(const MirroredMesh& mesh) {
  constexpr int rounds = 4, most = 6;
  const auto joints = mannequin_joints();
  const auto other = other_sides(joints);
  Eigen::MatrixXd weights(mesh.shape.x.rows(), static_cast<Eigen::Index>(joints.size()));
  for (int v = 0; v < mesh.shape.x.rows(); ++v) weights.row(v) = shares_of_tree(joints, other, row(mesh.shape.x, v));
  const Surface surface = make_surface(static_cast<int>(mesh.shape.x.rows()), mesh.shape.triangles);
  for (int i = 0; i < rounds; ++i) weights = averaged(surface, weights);
  for (int v = 0; v < mesh.half; ++v) {
    const int twin = mesh.twin[v];
    Eigen::RowVectorXd own = weights.row(v), image = own(other);
    if (twin == v) own = 0.5 * (own + image);
    thin_out(own, most);
    weights.row(twin) = own(other);
    weights.row(v) = own;
  }
  return weights;
}

}  // namespace selvedge
