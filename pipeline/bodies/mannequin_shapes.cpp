#include <algorithm>
#include <cmath>

#include "pipeline/bodies/mannequin.hpp"
#include "pipeline/bodies/mannequin_form.hpp"
#include "pipeline/bodies/mannequin_skin.hpp"

namespace selvedge {
namespace {

// Input of the fields below for a vertex at x >= 0: its place, and how much it belongs to each part.
struct Place {
  Vec3 p;
  double head, arm, hand, leg, foot, trunk;  // parts of 1
};

double bump(double value, double middle, double reach) {  // smooth, 1 in the middle and 0 beyond its reach
  return 1 - smooth_step(std::abs(value - middle), 0, reach);
}

// Along a limb from 0 to 1, linear with rounded ends.
double along(double value, double from, double to) {
  const double t = (value - from) / (to - from), soft = 0.1;
  const auto rounded = [&](double s) { return s <= -soft ? 0 : s >= soft ? s : (s + soft) * (s + soft) / (4 * soft); };
  return rounded(t) - rounded(t - 1);
}

// Vectors from the limbs' axes outward. The thigh's axis is near its inner side, so that thighs grow away from each
// other.
Vec3 from_arm_axis(const Vec3& p) { return {0, p.y() - 1.385, p.z() + 0.019}; }
Vec3 from_leg_axis(const Vec3& p) {
  const double x = 0.134 - 0.016 * along(p.y(), 0.085, 0.475) - 0.080 * smooth_step(p.y(), 0.48, 0.74);
  return {p.x() - x, 0, p.z() + 0.02 * smooth_step(0.40 - p.y(), 0, 0.15)};
}
Vec3 from_trunk_axis(const Vec3& p) { return {p.x(), 0, p.z() + 0.005}; }

Vec3 height(const Place& at) { return 0.035 * (at.p - mannequin_joints().front().position); }

Vec3 weight(const Place& at) {
  const Vec3 trunk = from_trunk_axis(at.p);
  const double belly = bump(at.p.y(), 1.03, 0.24), front = smooth_step(at.p.z(), -0.02, 0.08);
  Vec3 d = at.trunk * (0.062 + 0.022 * belly) * trunk;
  d.z() += at.trunk * belly * front * 0.011 * bump(at.p.x(), 0, 0.16);
  d += at.leg * (0.032 + 0.040 * smooth_step(at.p.y(), 0.42, 0.70)) * (1 - 0.8 * at.foot) * from_leg_axis(at.p);
  d += at.arm * (0.06 - 0.035 * smooth_step(at.p.x(), 0.30, 0.62)) * (1 - 0.8 * at.hand) * from_arm_axis(at.p);
  d += at.head * 0.03 * (1 - smooth_step(at.p.y(), 1.54, 1.66)) * Vec3(at.p.x(), 0, at.p.z() + 0.01);
  return d;
}

Vec3 leg_length(const Place& at) {
  const double longer = 0.016;
  const double y = at.leg * along(-at.p.y(), -0.80, -0.10) + along(at.p.y(), 0.97, 1.28);
  return {0, -longer * y, 0};
}

Vec3 arm_length(const Place& at) { return {0.013 * at.arm * along(at.p.x(), 0.20, 0.85), 0, 0}; }

Vec3 shoulder_width(const Place& at) {
  return {0.010 * along(at.p.x(), 0.02, 0.18) * smooth_step(at.p.y(), 1.06, 1.34) * (1 - at.head), 0, 0};
}

Vec3 hip_width(const Place& at) {
  const double hips = bump(at.p.y(), 0.87, 0.22);
  return {0.011 * hips * along(at.p.x(), 0.0, 0.17), 0, -0.005 * hips * smooth_step(-at.p.z(), -0.02, 0.10)};
}

Vec3 waist(const Place& at) { return 0.065 * at.trunk * bump(at.p.y(), 1.08, 0.17) * from_trunk_axis(at.p); }

Vec3 chest(const Place& at) {
  const double ribs = bump(at.p.y(), 1.25, 0.18);
  const double side = (at.p.x() - 0.075) / 0.11, up = (at.p.y() - 1.262) / 0.12;
  const double breast = 1 - smooth_step(side * side + up * up, 0, 1);
  return at.trunk * (0.024 * ribs * from_trunk_axis(at.p) +
                     0.0068 * breast * smooth_step(at.p.z(), 0, 0.07) * Vec3(0.1, -0.15, 1));
}

Vec3 muscle(const Place& at) {
  const double upper_arm = bump(at.p.x(), 0.27, 0.18), forearm = bump(at.p.x(), 0.52, 0.14);
  const double thigh = bump(at.p.y(), 0.66, 0.20), calf = bump(at.p.y(), 0.34, 0.16);
  Vec3 d = at.arm * (0.055 * upper_arm + 0.045 * forearm) * from_arm_axis(at.p);
  d += at.leg * (0.03 * thigh + 0.045 * calf) * from_leg_axis(at.p);
  const double chest = bump(at.p.y(), 1.30, 0.16), seat = bump(at.p.y(), 0.88, 0.12) * smooth_step(-at.p.z(), 0, 0.1);
  d += at.trunk * (0.03 * chest + 0.02 * seat) * from_trunk_axis(at.p);
  d += 0.03 * bump(at.p.y(), 1.46, 0.08) * (1 - at.arm) * Vec3(at.p.x(), 0, at.p.z() + 0.03);  // neck
  return d;
}

Vec3 head_size(const Place& at) { return 0.03 * at.head * (at.p - Vec3(0, 1.515, -0.004)); }

// In the order of mannequin_shapes.
constexpr std::array fields{height,    weight, leg_length, arm_length, shoulder_width,
                            hip_width, waist,  chest,      muscle,     head_size};
static_assert(fields.size() == mannequin_shapes.size());

Place place_of(const MirroredMesh& mesh, const Eigen::MatrixXd& weights, int vertex) {
  const auto joints = mannequin_joints();
  const auto sum = [&](std::initializer_list<std::string> parts) {
    double total = 0;
    for (std::size_t j = 0; j < joints.size(); ++j) {
      const std::string name = joints[j].name;
      if (std::find(parts.begin(), parts.end(), name.substr(name.find('_') + 1)) != parts.end())
        total += weights(vertex, static_cast<Eigen::Index>(j));
    }
    return total;
  };
  Place at{row(mesh.shape.x, vertex),
           sum({"head"}),
           sum({"shoulder", "elbow", "wrist", "hand"}),
           sum({"wrist", "hand"}),
           sum({"hip", "knee", "ankle", "foot"}),
           sum({"ankle", "foot"}),
           0};
  at.trunk = std::max(0.0, 1 - at.head - at.arm - at.leg - sum({"neck"}));
  return at;
}

}  // namespace

Eigen::MatrixXd mannequin_directions(const MirroredMesh& mesh, const Eigen::MatrixXd& weights) {
  Eigen::MatrixXd directions(3 * mesh.shape.x.rows(), static_cast<Eigen::Index>(fields.size()));
  for (int v = 0; v < mesh.half; ++v) {
    const Place at = place_of(mesh, weights, v);
    const int twin = mesh.twin[v];
    for (std::size_t k = 0; k < fields.size(); ++k) {
      Vec3 d = fields[k](at);
      if (twin == v) d.x() = 0;
      directions.col(static_cast<Eigen::Index>(k)).segment<3>(3 * v) = d;
      directions.col(static_cast<Eigen::Index>(k)).segment<3>(3 * twin) << (twin == v ? 0 : -d.x()), d.y(), d.z();
    }
  }
  return directions;
}

}  // namespace selvedge
