#include "learned/losses/cloth_losses.hpp"

#include <cmath>

#include "physics/energies/hinge_lanes.hpp"
#include "physics/energies/joints.hpp"
#include "physics/energies/membrane_lanes.hpp"

namespace selvedge {
namespace {

// A face's plane and what its derivative needs. The distance of p is normal . (p - third corner).
struct TurningPlane {
  Vec3 normal, side_a, side_b;  // sides: from the first corner to the second and the third
  double twice_area = 0;
};

TurningPlane plane_of_face(const Points& x, const int* corner) {
  TurningPlane plane;
  const Vec3 origin = row(x, corner[0]);
  plane.side_a = row(x, corner[1]) - origin;
  plane.side_b = row(x, corner[2]) - origin;
  const Vec3 across = plane.side_a.cross(plane.side_b);
  plane.twice_area = across.norm();
  plane.normal = across / plane.twice_area;
  return plane;
}

// Adds `pull` times the derivative of the vertex' distance by the vertex and all corners.
void add_distance_slope(const TurningPlane& plane, const int* corner, int vertex, const Vec3& from_third,
                        double distance, double pull, Points& gradient) {
  const Vec3 lever = (from_third - distance * plane.normal) / plane.twice_area;  // of the rotation of the normal
  const Vec3 second = plane.side_b.cross(lever), third = lever.cross(plane.side_a);
  gradient.row(vertex) += (pull * plane.normal).transpose();
  gradient.row(corner[0]) -= (pull * (second + third)).transpose();
  gradient.row(corner[1]) += (pull * second).transpose();
  gradient.row(corner[2]) += (pull * (third - plane.normal)).transpose();
}

}  // namespace

double stretching_loss(const LossGarment& garment, const Points& x, Points* gradient) {
  double sum = 0;
  MembraneLanes lanes;
  std::span<const MembraneElement> rest = garment.membranes;
  for (; !rest.empty(); rest = rest.subspan(static_cast<std::size_t>(lanes.count))) {
    const auto group = rest.first(static_cast<std::size_t>(together(garment.materials, rest)));
    membrane_energies(garment.materials, group, x, lanes);
    for (int l = 0; l < lanes.count; ++l) sum += lanes.energy[l];
    if (!gradient) continue;
    membrane_derivatives(garment.materials, group, x, false, false, lanes);
    for (int l = 0; l < lanes.count; ++l) {
      const std::array<int, 3>& node = group[static_cast<std::size_t>(l)].nodes;
      for (int k = 0; k < 3; ++k) {
        const double second = lanes.force[k][l], third = lanes.force[3 + k][l];
        (*gradient)(node[0], k) -= second + third;
        (*gradient)(node[1], k) += second;
        (*gradient)(node[2], k) += third;
      }
    }
  }
  return sum;
}

double bending_loss(const LossGarment& garment, const Points& x, Points* gradient) {
  double sum = 0;
  HingeLanes lanes;
  std::span<const Hinge> rest = garment.hinges;
  for (; !rest.empty(); rest = rest.subspan(static_cast<std::size_t>(lanes.count))) {
    hinge_energies(rest, x, gradient != nullptr, lanes);
    for (int l = 0; l < lanes.count; ++l) {
      sum += lanes.energy[l];
      if (!gradient) continue;
      const std::array<int, 4>& node = rest[static_cast<std::size_t>(l)].nodes;
      for (int i = 0; i < 4; ++i)
        for (int k = 0; k < 3; ++k) (*gradient)(node[i], k) += lanes.force[3 * i + k][l];
    }
  }
  return sum;
}

double spring_loss(const LossGarment& garment, const Points& x, Points* gradient) {
  double sum = 0;
  for (const Spring& spring : garment.springs) {
    Vec6 own;
    sum += joint_derivatives(spring, x, own, nullptr);
    if (!gradient) continue;
    gradient->row(spring.a) += own.head<3>().transpose();
    gradient->row(spring.b) += own.tail<3>().transpose();
  }
  return sum;
}

double gravity_loss(const LossGarment& garment, double strength, const Points& x, Points* gradient) {
  double sum = 0;
  for (Eigen::Index v = 0; v < x.rows(); ++v) {
    const double mass = garment.mass[static_cast<std::size_t>(v)];
    if (!(mass > 0)) continue;
    sum += mass * strength * x(v, 1);
    if (gradient) (*gradient)(v, 1) += mass * strength;
  }
  return sum;
}

double inertia_loss(const LossGarment& garment, const Points& now, const Points& velocity, double dt, const Points& x,
                    Points* gradient) {
  double sum = 0;
  for (Eigen::Index v = 0; v < x.rows(); ++v) {
    const double stiffness = garment.mass[static_cast<std::size_t>(v)] / (dt * dt);
    if (!(stiffness > 0)) continue;
    const Eigen::RowVector3d off = x.row(v) - (now.row(v) + velocity.row(v));
    sum += 0.5 * stiffness * off.squaredNorm();
    if (gradient) gradient->row(v) += stiffness * off;
  }
  return sum;
}

double repulsion_loss(const LossGarment& garment, const RepulsionLoss& options, std::span<const ClothPair> pairs,
                      const Points& now, const Points& x, Points* gradient) {
  double sum = 0;
  for (const ClothPair& pair : pairs) {
    const int* corner = garment.surface.triangles.data() + 3 * pair.face;
    const TurningPlane before = plane_of_face(now, corner), after = plane_of_face(x, corner);
    const double was = before.normal.dot(row(now, pair.vertex) - row(now, corner[2]));
    if (!(std::abs(was) < options.correspondence) || !(after.twice_area > 0)) continue;
    const double side = was > 0 ? 1 : was < 0 ? -1 : 0;
    const Vec3 from_third = row(x, pair.vertex) - row(x, corner[2]);
    const double distance = after.normal.dot(from_third), depth = options.thickness - side * distance;
    if (!(depth > 0)) continue;
    const auto is_pinned = [&](int v) { return garment.pinned[static_cast<std::size_t>(v)] != 0; };
    const bool pinned = is_pinned(pair.vertex) || is_pinned(corner[0]) || is_pinned(corner[1]) || is_pinned(corner[2]);
    const double factor = pinned ? options.pinned_factor : 1, cube_of = factor * depth;
    sum += cube_of * cube_of * cube_of;
    if (gradient)
      add_distance_slope(after, corner, pair.vertex, from_third, distance, -3 * factor * cube_of * cube_of * side,
                         *gradient);
  }
  return sum;
}

double target_loss(const LossGarment& garment, const Points& target, const Points& x, Points* gradient) {
  constexpr double millimetres = 1000;
  const auto mass_of = [&](Eigen::Index v) {
    return garment.pinned[static_cast<std::size_t>(v)] ? 0 : garment.mass[static_cast<std::size_t>(v)];
  };
  double mass = 0, squares = 0;
  for (Eigen::Index v = 0; v < x.rows(); ++v) {
    mass += mass_of(v);
    squares += mass_of(v) * (x.row(v) - target.row(v)).squaredNorm();
  }
  if (!(mass > 0)) return 0;
  const double distance = std::sqrt(squares / mass);
  if (gradient && distance > 0)
    for (Eigen::Index v = 0; v < x.rows(); ++v)
      gradient->row(v) += millimetres * mass_of(v) / (mass * distance) * (x.row(v) - target.row(v));
  return millimetres * distance;
}

}  // namespace selvedge
