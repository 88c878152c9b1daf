#include "collision/geometry/turned_frames.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "collision/geometry/area_normal.hpp"

namespace selvedge {
namespace {

// The corner of the triangle that follows the vertex.
int next_corner(const Surface& surface, int triangle, int vertex) {
  const int* v = surface.triangles.data() + 3 * triangle;
  return v[0] == vertex ? v[1] : v[1] == vertex ? v[2] : v[0];
}

// Columns: the normal, an edge perpendicular to it, and their product. False: there is no such frame.
bool frame_at(const Surface& surface, const Points& x, int vertex, Mat3& frame) {
  Vec3 normal = area_normal(surface, x, vertex);
  const double size = normal.norm();
  if (!(size > 0)) return false;
  normal /= size;
  const Vec3 edge = row(x, next_corner(surface, surface.triangles_of(vertex).front(), vertex)) - row(x, vertex);
  const Vec3 along = edge - normal.dot(edge) * normal;
  const double length = along.norm();
  if (!(length > 0)) return false;
  frame << normal, along / length, normal.cross(along / length);
  return frame.allFinite();
}

}  // namespace

std::vector<Mat3> turned_frames(const Surface& surface, const Points& before, const Points& after) {
  std::vector<Mat3> turned(static_cast<std::size_t>(surface.vertex_count), Mat3::Identity());
#pragma omp parallel for schedule(static, 256)
  for (int v = 0; v < surface.vertex_count; ++v) {
    Mat3 from, to;
    if (frame_at(surface, before, v, from) && frame_at(surface, after, v, to))
      turned[static_cast<std::size_t>(v)] = to * from.transpose();
  }
  return turned;
}

Mat3 turn_about_vertical(const Points& from, const Points& to) {
  Vec3 mean_from = Vec3::Zero(), mean_to = Vec3::Zero();
  int count = 0;
  const auto counts = [&](Eigen::Index v) { return from.row(v).allFinite() && to.row(v).allFinite(); };
  for (Eigen::Index v = 0; v < from.rows(); ++v) {
    if (!counts(v)) continue;
    mean_from += from.row(v).transpose();
    mean_to += to.row(v).transpose();
    ++count;
  }
  mean_from /= std::max(count, 1);
  mean_to /= std::max(count, 1);
  double along = 0, across = 0;
  for (Eigen::Index v = 0; v < from.rows(); ++v) {
    if (!counts(v)) continue;
    const Vec3 a = from.row(v).transpose() - mean_from, b = to.row(v).transpose() - mean_to;
    along += a[0] * b[0] + a[2] * b[2];
    across += a[2] * b[0] - a[0] * b[2];
  }
  return Eigen::AngleAxisd(std::atan2(across, along), Vec3::UnitY()).toRotationMatrix();
}

}  // namespace selvedge
