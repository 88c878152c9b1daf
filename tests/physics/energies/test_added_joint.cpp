#include <catch2/catch.hpp>

#include "physics/energies/joints.hpp"

// The energy of docs/extending.md.
namespace selvedge::test_added_joint {

using Vec9 = Eigen::Matrix<double, 9, 1>;
using Mat9 = Eigen::Matrix<double, 9, 9>;

// Boning: three vertices in a row that would lie straight and evenly spaced.
struct Bone {
  std::array<int, 3> nodes{};
  double stiffness = 10;  // [N/m]
};

std::array<int, 3> nodes_of(const Bone& bone) { return bone.nodes; }
void renumber(const std::array<int, 3>& nodes, Bone& bone) { bone.nodes = nodes; }

// k |a - 2 b + c|^2 / 2 [J].
double joint_derivatives(const Bone& bone, const Points& x, Vec9& gradient, Mat9* hessian, bool) {
  const auto& [a, b, c] = bone.nodes;
  const Vec3 bent = row(x, a) - 2 * row(x, b) + row(x, c);
  const Eigen::Matrix<double, 3, 9> slope =
      (Eigen::Matrix<double, 3, 9>() << Mat3::Identity(), -2 * Mat3::Identity(), Mat3::Identity()).finished();
  gradient = bone.stiffness * slope.transpose() * bent;
  if (hessian) *hessian = bone.stiffness * slope.transpose() * slope;
  return 0.5 * bone.stiffness * bent.squaredNorm();
}

double joint_energy(const Bone& bone, const Points& x) {
  Vec9 gradient;
  return joint_derivatives(bone, x, gradient, nullptr, true);
}

TEST_CASE("extending: an added energy has the derivatives of its value, and forces that cancel", "[springs]") {
  Points x(4, 3);
  x << 0, 0, 0, 0.1, 0.02, 0, 9, 9, 9, 0.2, 0, 0.01;
  Bone bone;
  renumber({0, 1, 3}, bone);
  Vec9 gradient, above, below;
  Mat9 hessian;
  CHECK(joint_derivatives(bone, x, gradient, &hessian, true) == joint_energy(bone, x));
  const double step = 1e-5;
  for (int i = 0; i < 9; ++i) {
    Points up = x, down = x;
    up(nodes_of(bone)[static_cast<std::size_t>(i / 3)], i % 3) += step;
    down(nodes_of(bone)[static_cast<std::size_t>(i / 3)], i % 3) -= step;
    CHECK((joint_energy(bone, up) - joint_energy(bone, down)) / (2 * step) == Approx(gradient[i]).margin(1e-9));
    joint_derivatives(bone, up, above, nullptr, true);
    joint_derivatives(bone, down, below, nullptr, true);
    CHECK(((above - below) / (2 * step) - hessian.col(i)).norm() < 1e-6);
  }
  CHECK((gradient.segment<3>(0) + gradient.segment<3>(3) + gradient.segment<3>(6)).norm() < 1e-14);
}

}  // namespace selvedge::test_added_joint
