#include <algorithm>
#include <cmath>
#include <numbers>

#include "physics/energies/bending.hpp"

// The angle's second derivative splits into one part a triangle ("wing"), and each part couples only motion along the
// wing's normal (nu) with motion in its plane (xi along the edge, eta across it). With L the edge length, h the wing's
// height, r = (-(1 - t), -t, 1) the height of the tip over the edge and q = (-1, 1, 0) the edge itself, over the
// corners e0, e1, tip:
//   d theta = -r.nu / h,   d2 theta = 2 [ (r.nu)(r.eta) / h^2 + (q.nu)(r.xi) / (h L) + (q.nu)(q.eta) / (2 L^2) ].
// That is [0 B; B^T 0] with B = Y Z^T of rank two, whose absolute value is sqrt(B B^T) + sqrt(B^T B): two square roots
// of 2 x 2 matrices. Hence a PSD projection in closed form: half the sum of the part and its absolute value, for each
// wing on its own, beside the Gauss-Newton part. The sum bounds the true Hessian from above.
namespace selvedge {
namespace {

// Heights below this fraction of the edge count as this fraction: a sliver's force stays bounded.
constexpr double smallest_height = 1e-4;

struct Wing {
  Vec3 normal, across;  // unit; across lies in the plane, from the edge to the tip
  double height = 0;
  Eigen::Vector3d rise;  // r
  int tip = 2;           // its place in Hinge::nodes
};

bool make_wing(const Vec3& edge, double length, const Vec3& tip, int slot, Wing& wing) {
  const double t = tip.dot(edge) / (length * length);
  const Vec3 up = tip - t * edge;
  const double height = up.norm();
  if (!(height > 0)) return false;
  wing.across = up / height;
  wing.height = std::max(height, smallest_height * length);
  wing.normal = (slot == 2 ? edge.cross(wing.across) : wing.across.cross(edge)) / length;
  wing.rise = {t - 1, -t, 1};
  wing.tip = slot;
  return true;
}

// Square root of a 2 x 2 symmetric PSD matrix, given the root of its determinant.
Eigen::Matrix2d square_root(const Eigen::Matrix2d& m, double root) {
  const double trace = m.trace() + 2 * root;
  if (!(trace > 0)) return Eigen::Matrix2d::Zero();
  return (m + root * Eigen::Matrix2d::Identity()) / std::sqrt(trace);
}

// Orthonormal columns Q and upper triangular R with Q R = m (n x 2).
template <int n>
Eigen::Matrix2d orthonormalise(Eigen::Matrix<double, n, 2>& m) {
  Eigen::Matrix2d r = Eigen::Matrix2d::Zero();
  r(0, 0) = m.col(0).norm();
  m.col(0) /= r(0, 0);
  r(0, 1) = m.col(0).dot(m.col(1));
  m.col(1) -= r(0, 1) * m.col(0);
  r(1, 1) = m.col(1).norm();
  m.col(1) /= r(1, 1);
  return r;
}

// Adds scale * d2 theta of one wing, projected to PSD or not, to the Hessian of e0, e1, a, b.
void add_wing(const Wing& wing, const Vec3& along, double length, double scale, bool psd, Mat12& hessian) {
  const Eigen::Vector3d edge_difference(-1, 1, 0);
  const double h = wing.height;
  Eigen::Matrix<double, 3, 2> normal_part;  // Y
  Eigen::Matrix<double, 6, 2> plane_part;   // Z: xi of the three corners, then eta
  normal_part << wing.rise, edge_difference;
  plane_part << Eigen::Vector3d::Zero(), wing.rise / (h * length), wing.rise / (h * h),
      edge_difference / (2 * length * length);
  const Eigen::Matrix<double, 3, 6> mixed = scale * normal_part * plane_part.transpose();
  Eigen::Matrix<double, 9, 9> local = Eigen::Matrix<double, 9, 9>::Zero();
  local.topRightCorner<3, 6>() = mixed;
  local.bottomLeftCorner<6, 3>() = mixed.transpose();
  if (psd) {
    const Eigen::Matrix2d ry = orthonormalise<3>(normal_part), rz = orthonormalise<6>(plane_part);
    const Eigen::Matrix2d core = scale * ry * rz.transpose();
    const double root = std::abs(core.determinant());
    local.topLeftCorner<3, 3>() = normal_part * square_root(core * core.transpose(), root) * normal_part.transpose();
    local.bottomRightCorner<6, 6>() = plane_part * square_root(core.transpose() * core, root) * plane_part.transpose();
    local *= 0.5;
  }
  Mat3 frame;
  frame << wing.normal, along, wing.across;
  const std::array<int, 3> slots{0, 1, wing.tip};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      Mat3 block;
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) block(a, b) = local(3 * a + i, 3 * b + j);
      hessian.block<3, 3>(3 * slots[i], 3 * slots[j]) += frame * block * frame.transpose();
    }
}

double rest_length(const RestTriangle& rest, int corner) {
  return (rest.col((corner + 1) % 3) - rest.col(corner)).norm();
}

// The corner of triangle t from which `edge` starts.
int corner_of_edge(const Surface& surface, int t, int edge) {
  int k = 0;
  while (surface.triangle_edges(t, k) != edge) ++k;
  return k;
}

double angle_at(const Hinge& hinge, const Points& x) {
  return dihedral_angle(row(x, hinge.nodes[0]), row(x, hinge.nodes[1]), row(x, hinge.nodes[2]), row(x, hinge.nodes[3]));
}

// The difference to the rest angle, in [-pi, pi].
double wrapped_difference(const Hinge& hinge, const Points& x) {
  const double difference = angle_at(hinge, x) - hinge.rest_angle;
  return std::abs(difference) <= std::numbers::pi ? difference : std::remainder(difference, 2 * std::numbers::pi);
}

// What 1/2 difference^2 is multiplied by [N m].
double weight_of(const Hinge& hinge, double squared_length) {
  return hinge.length == HingeLength::current ? hinge.weight * squared_length : hinge.weight;
}

// Adds what the current length does to the Hessian, beside the weight: with c = Hinge::weight, d the difference, a and
// b the derivatives of the angle and of the squared length,
//   c d (a b^T + b a^T) + c d^2 [I, -I; -I, I].
// The first part is indefinite, and a and b are perpendicular. Of the second, what lies along the edge is c d^2 / (4
// l^2) b b^T; four times as much makes a perfect square of it together with the Gauss-Newton part c l^2 a a^T.
void add_length_terms(const Hinge& hinge, const Vec3& edge, double difference, const Vec12& angle_slope, bool psd,
                      Mat12& hessian) {
  Vec12 length_slope = Vec12::Zero();
  length_slope.segment<3>(0) = -2 * edge;
  length_slope.segment<3>(3) = 2 * edge;
  const double mixed = hinge.weight * difference, own = mixed * difference;
  hessian += mixed * (angle_slope * length_slope.transpose() + length_slope * angle_slope.transpose());
  const Mat3 block = own * Mat3::Identity();
  hessian.block<3, 3>(0, 0) += block;
  hessian.block<3, 3>(3, 3) += block;
  hessian.block<3, 3>(0, 3) -= block;
  hessian.block<3, 3>(3, 0) -= block;
  if (psd) hessian += 0.75 * own / edge.squaredNorm() * length_slope * length_slope.transpose();
}

}  // namespace

std::vector<Hinge> hinges(const Scene& scene) {
  const Surface& surface = scene.surface;
  std::vector<double> stiffness(surface.vertex_count, 0);
  std::vector<HingeLength> length_of(surface.vertex_count, HingeLength::rest);
  for (const Cloth& cloth : scene.cloths)
    if (cloth.material.bending_model == BendingModel::hinge && cloth.material.bending > 0) {
      std::fill_n(stiffness.begin() + cloth.first_vertex, cloth.vertex_count, cloth.material.bending);
      std::fill_n(length_of.begin() + cloth.first_vertex, cloth.vertex_count, cloth.material.hinge_length);
    }
  std::vector<Hinge> result;
  for (int e = 0; e < surface.edges.rows(); ++e) {
    const double k = stiffness[surface.edges(e, 0)];
    const auto [first, second] = surface.edge_triangles[e];
    if (!(k > 0) || second < 0) continue;
    const int i = corner_of_edge(surface, first, e), j = corner_of_edge(surface, second, e);
    const RestTriangle &rest0 = scene.rest_triangle[first], &rest1 = scene.rest_triangle[second];
    const double areas = std::abs(area(rest0)) + std::abs(area(rest1));
    const double length = 0.5 * (rest_length(rest0, i) + rest_length(rest1, j));
    if (!(areas > 1e-12 * length * length)) continue;
    Hinge hinge;
    hinge.nodes = {surface.triangles(first, i), surface.triangles(first, (i + 1) % 3),
                   surface.triangles(first, (i + 2) % 3), surface.triangles(second, (j + 2) % 3)};
    hinge.length = length_of[surface.edges(e, 0)];
    hinge.weight = k * (hinge.length == HingeLength::current ? 1 : length * length) / (4 * areas);
    if (!scene.rest_is_flat) hinge.rest_angle = angle_at(hinge, scene.rest);
    result.push_back(hinge);
  }
  return result;
}

double dihedral_angle(const Vec3& e0, const Vec3& e1, const Vec3& a, const Vec3& b) {
  const Vec3 edge = e1 - e0, n0 = edge.cross(a - e0), n1 = (b - e0).cross(edge);
  const double length = edge.norm();
  return length > 0 ? std::atan2(edge.dot(n0.cross(n1)) / length, n0.dot(n1)) : 0;
}

double hinge_energy(const Hinge& hinge, const Points& x) {
  const double difference = wrapped_difference(hinge, x);
  const double squared = (row(x, hinge.nodes[1]) - row(x, hinge.nodes[0])).squaredNorm();
  return 0.5 * weight_of(hinge, squared) * difference * difference;
}

double hinge_derivatives(const Hinge& hinge, const Points& x, Vec12& gradient, Mat12* hessian, bool psd) {
  gradient.setZero();
  if (hessian) hessian->setZero();
  const Vec3 origin = row(x, hinge.nodes[0]), edge = row(x, hinge.nodes[1]) - origin;
  const double length = edge.norm(), difference = wrapped_difference(hinge, x);
  const double weight = weight_of(hinge, edge.squaredNorm()), energy = 0.5 * weight * difference * difference;
  if (!(length > 0)) return energy;

  std::array<Wing, 2> wings;
  for (int w = 0; w < 2; ++w)
    if (!make_wing(edge, length, row(x, hinge.nodes[2 + w]) - origin, 2 + w, wings[w])) return energy;
  for (const Wing& wing : wings) {
    const Vec3 slope = -wing.normal / wing.height;
    gradient.segment<3>(0) += wing.rise[0] * slope;
    gradient.segment<3>(3) += wing.rise[1] * slope;
    gradient.segment<3>(3 * wing.tip) += slope;
  }
  const bool current = hinge.length == HingeLength::current;
  if (hessian) {
    *hessian = weight * gradient * gradient.transpose();
    for (const Wing& wing : wings) add_wing(wing, edge / length, length, weight * difference, psd, *hessian);
    if (current) add_length_terms(hinge, edge, difference, gradient, psd, *hessian);
  }
  gradient *= weight * difference;
  if (current) {
    const Vec3 pull = hinge.weight * difference * difference * edge;
    gradient.segment<3>(0) -= pull;
    gradient.segment<3>(3) += pull;
  }
  return energy;
}

}  // namespace selvedge
