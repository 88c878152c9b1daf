#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "pipeline/shapes/generate.hpp"

namespace selvedge {
namespace {

constexpr int steps_a_piece = 64;  // of the polyline between two points of the smooth line

// The smooth line as a polyline with its length so far.
struct Polyline {
  std::vector<Vec3> at, normal;
  std::vector<double> length;
};

Vec3 between(const Vec3& a, double ta, const Vec3& b, double tb, double t) {
  return ((tb - t) * a + (t - ta) * b) / (tb - ta);
}

// The piece from b to c of the centripetal Catmull-Rom spline a b c d, s in 0..1 (Barry and Goldman 1988).
Vec3 catmull_rom(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, double s) {
  const double tb = std::sqrt((b - a).norm()), tc = tb + std::sqrt((c - b).norm()), td = tc + std::sqrt((d - c).norm());
  const double t = tb + s * (tc - tb);
  const Vec3 ab = between(a, 0, b, tb, t), bc = between(b, tb, c, tc, t), cd = between(c, tc, d, td, t);
  return between(between(ab, 0, bc, tc, t), tb, between(bc, tb, cd, td, t), tc, t);
}

Polyline smooth(const std::vector<LinePoint>& line) {
  assert(line.size() >= 2);
  const std::size_t last = line.size() - 1;
  Polyline result;
  const auto add = [&](const Vec3& at, const Vec3& normal) {
    result.length.push_back(result.at.empty() ? 0 : result.length.back() + (at - result.at.back()).norm());
    result.at.push_back(at);
    result.normal.push_back(normal.normalized());
  };
  for (std::size_t k = 0; k < last; ++k) {
    const Vec3 &b = line[k].at, &c = line[k + 1].at;
    const Vec3 a = k > 0 ? line[k - 1].at : Vec3(2 * b - c), d = k + 1 < last ? line[k + 2].at : Vec3(2 * c - b);
    for (int i = 0; i < steps_a_piece; ++i) {
      const double s = static_cast<double>(i) / steps_a_piece;
      add(catmull_rom(a, b, c, d, s), (1 - s) * line[k].normal.normalized() + s * line[k + 1].normal.normalized());
    }
  }
  add(line[last].at, line[last].normal);
  return result;
}

// Direction of the line at its k-th corner.
Vec3 tangent(const Polyline& line, std::size_t k) {
  const std::size_t before = k > 0 ? k - 1 : 0, after = std::min(k + 1, line.at.size() - 1);
  return (line.at[after] - line.at[before]).normalized();
}

}  // namespace

double line_length(const std::vector<LinePoint>& line) { return smooth(line).length.back(); }

double least_normal_angle(const std::vector<LinePoint>& line) {
  const Polyline polyline = smooth(line);
  double least = std::numbers::pi / 2;
  for (std::size_t k = 0; k < polyline.at.size(); ++k)
    least = std::min(least, std::asin(std::min(1.0, polyline.normal[k].cross(tangent(polyline, k)).norm())));
  return least;
}

Mesh make_ribbon(const std::vector<LinePoint>& line, double width, int along, int across, const SheetOptions& options) {
  const Polyline polyline = smooth(line);
  const double length = polyline.length.back();
  Mesh mesh = make_rectangle({length, width}, along, across, options);
  for (Eigen::Index v = 0; v < mesh.x.rows(); ++v) {
    const double s = std::clamp(mesh.uv(v, 0) + length / 2, 0.0, length);
    const auto after = std::upper_bound(polyline.length.begin() + 1, polyline.length.end() - 1, s);
    const auto k = static_cast<std::size_t>(after - polyline.length.begin());
    const double part = (s - polyline.length[k - 1]) / (polyline.length[k] - polyline.length[k - 1]);
    const auto mixed = [&](const Vec3& a, const Vec3& b) { return Vec3((1 - part) * a + part * b); };
    const Vec3 forward = mixed(tangent(polyline, k - 1), tangent(polyline, k));
    const Vec3 left = mixed(polyline.normal[k - 1], polyline.normal[k]).cross(forward).normalized();
    mesh.x.row(v) = (mixed(polyline.at[k - 1], polyline.at[k]) + mesh.uv(v, 1) * left).transpose();
  }
  const double half_edge = 0.51 * length / (along - 1);
  std::vector<int> middle;
  for (int v = 0; v < mesh.uv.rows(); ++v)
    if (std::abs(mesh.uv(v, 0)) <= half_edge) middle.push_back(v);
  const auto group = [&](const char* name) {
    return std::find_if(mesh.groups.begin(), mesh.groups.end(), [&](const auto& g) { return g.first == name; })->second;
  };
  mesh.groups = {
      {"start", group("left")}, {"end", group("right")}, {"middle", middle}, {"boundary", group("boundary")}};
  return mesh;
}

}  // namespace selvedge
