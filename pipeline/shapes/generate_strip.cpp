#include "pipeline/shapes/generate_strip.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <map>
#include <numbers>

namespace selvedge {
namespace {

constexpr double snap = 0.35;          // of an element: vertices nearer to an edge of the strip are moved onto it
constexpr double strip_jitter = 0.25;  // of an element, of unstructured strips

struct Flat {
  std::vector<Vec2> uv;
  std::vector<std::array<int, 3>> triangles;
};

// The pattern over a square of 2 n x 2 n cells about the origin, turned by the angle.
Flat lattice(const Vec2& cell, double angle, int n, Triangulation triangulation) {
  Flat flat;
  const Vec2 a = cell.x() * Vec2(std::cos(angle), std::sin(angle)),
             b = cell.y() * Vec2(-std::sin(angle), std::cos(angle));
  const int row = 2 * n + 1;
  for (int j = -n; j <= n; ++j)
    for (int i = -n; i <= n; ++i) flat.uv.emplace_back(i * a + j * b);
  for (int j = 0; j + 1 < row; ++j)
    for (int i = 0; i + 1 < row; ++i) {
      const int p = j * row + i;
      add_quad(flat.triangles, p, p + 1, p + 1 + row, p + row, cut_from_a(triangulation, i, j));
    }
  return flat;
}

// Keeps the part with normal . p >= offset: moves near vertices onto the line, then cuts triangles that still cross it.
void keep_side(Flat& flat, const Vec2& normal, double offset, double near) {
  std::vector<double> height(flat.uv.size());
  for (std::size_t v = 0; v < flat.uv.size(); ++v) {
    height[v] = normal.dot(flat.uv[v]) - offset;
    if (std::abs(height[v]) >= near) continue;
    flat.uv[v] -= height[v] * normal;
    height[v] = 0;
  }
  std::map<std::pair<int, int>, int> cuts;
  const auto cut = [&](int from, int to) {
    const auto [place, is_new] = cuts.try_emplace(std::minmax(from, to), static_cast<int>(flat.uv.size()));
    if (is_new) {
      const double part = height[from] / (height[from] - height[to]);
      flat.uv.emplace_back(flat.uv[from] + part * (flat.uv[to] - flat.uv[from]));
    }
    return place->second;
  };
  std::vector<std::array<int, 3>> kept;
  for (const auto& triangle : flat.triangles) {
    std::vector<int> polygon;
    for (int k = 0; k < 3; ++k) {
      const int v = triangle[k], next = triangle[(k + 1) % 3];
      if (height[v] >= 0) polygon.push_back(v);
      if (height[v] * height[next] < 0) polygon.push_back(cut(v, next));
    }
    const bool inside = std::any_of(triangle.begin(), triangle.end(), [&](int v) { return height[v] > 0; });
    for (std::size_t k = 2; inside && k < polygon.size(); ++k) kept.push_back({polygon[0], polygon[k - 1], polygon[k]});
  }
  flat.triangles = std::move(kept);
}

// Removes unused vertices, and joins vertices that were moved to the same corner.
void compact(Flat& flat, double edge) {
  std::map<std::pair<long, long>, int> places;
  std::vector<Vec2> used;
  std::vector<std::array<int, 3>> kept;
  for (const auto& triangle : flat.triangles) {
    std::array<int, 3> corners{};
    for (int k = 0; k < 3; ++k) {
      const Vec2 cell = 1e6 / edge * flat.uv[triangle[k]];
      const auto [place, is_new] =
          places.try_emplace({std::lround(cell.x()), std::lround(cell.y())}, static_cast<int>(used.size()));
      if (is_new) used.push_back(flat.uv[triangle[k]]);
      corners[k] = place->second;
    }
    if (corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0]) kept.push_back(corners);
  }
  flat.uv = std::move(used);
  flat.triangles = std::move(kept);
}

// Vertices at u, in the order of v.
std::vector<int> column(const Points2& uv, double u, double rounding) {
  std::vector<int> found;
  for (int v = 0; v < uv.rows(); ++v)
    if (std::abs(uv(v, 0) - u) <= rounding) found.push_back(v);
  std::sort(found.begin(), found.end(), [&uv](int a, int b) { return uv(a, 1) < uv(b, 1); });
  return found;
}

// Adds a row of elements beside a column of vertices, on the side given by the sign of `move`; returns the new
// vertices.
std::vector<int> extrude(Mesh& mesh, const std::vector<int>& line, double move) {
  const int first = static_cast<int>(mesh.uv.rows()), count = static_cast<int>(line.size());
  mesh.uv.conservativeResize(first + count, 2);
  std::vector<std::array<int, 3>> added;
  std::vector<int> row;
  for (int k = 0; k < count; ++k) {
    row.push_back(first + k);
    mesh.uv.row(first + k) << mesh.uv(line[k], 0) + move, mesh.uv(line[k], 1);
    if (k == 0) continue;
    const std::vector<int>&left = move < 0 ? row : line, &right = move < 0 ? line : row;
    added.push_back({left[k - 1], right[k - 1], right[k]});
    added.push_back({left[k - 1], right[k], left[k]});
  }
  const Triangles more = to_triangles(added), before = mesh.triangles;
  mesh.triangles.resize(before.rows() + more.rows(), 3);
  mesh.triangles << before, more;
  return row;
}

Mesh cut_out(const StripShape& shape, double edge) {
  const double quarter = shape.angle / (std::numbers::pi / 2);
  const bool straight = std::abs(quarter - std::round(quarter)) < 1e-9;
  const double height = straight ? shape.width / std::max(1.0, std::round(shape.width / edge)) : edge;
  const bool on_side = straight && std::lround(quarter) % 2 != 0;
  const Vec2 cell = on_side ? Vec2(height, edge) : Vec2(edge, height);
  const int reach = static_cast<int>(std::ceil(std::hypot(shape.length, shape.width) / std::min(edge, height))) + 2;
  Flat flat = lattice(cell, shape.angle, reach, shape.sheet.triangulation);
  keep_side(flat, {1, 0}, 0, snap * edge);
  keep_side(flat, {-1, 0}, -shape.length, snap * edge);
  keep_side(flat, {0, 1}, 0, snap * edge);
  keep_side(flat, {0, -1}, -shape.width, snap * edge);
  compact(flat, edge);
  Mesh mesh;
  mesh.uv.resize(static_cast<Eigen::Index>(flat.uv.size()), 2);
  for (std::size_t v = 0; v < flat.uv.size(); ++v) mesh.uv.row(static_cast<Eigen::Index>(v)) = flat.uv[v].transpose();
  mesh.triangles = to_triangles(flat.triangles);
  make_delaunay(mesh.uv, mesh.triangles);
  return mesh;
}

// The largest extent of an edge of a unit cell along or across the strip.
double widest_span(double angle) {
  const double c = std::abs(std::cos(angle)), s = std::abs(std::sin(angle));
  return c + s;  // of a diagonal; legs span max(c, s)
}

}  // namespace

Mesh make_strip(const StripShape& shape) {
  assert(shape.along >= 1 && shape.length > 0 && shape.width > 0);
  const double quarter = shape.angle / (std::numbers::pi / 2);
  const double span = std::abs(quarter - std::round(quarter)) < 1e-9 ? 1 : widest_span(shape.angle);
  const double edge = shape.length / shape.along / span, rounding = 1e-9 * edge;
  Mesh mesh = cut_out(shape, edge);
  if (shape.sheet.triangulation == Triangulation::unstructured) {
    std::vector<bool> fixed;
    for (int v = 0; v < mesh.uv.rows(); ++v) {
      const double u = mesh.uv(v, 0), w = mesh.uv(v, 1);
      fixed.push_back(std::min({u, shape.length - u, w, shape.width - w}) <= rounding);
    }
    make_unstructured(mesh.uv, mesh.triangles, fixed, strip_jitter * edge, shape.sheet.seed);
  }
  const std::vector<int> root = column(mesh.uv, 0, rounding), tip = column(mesh.uv, shape.length, rounding);
  std::vector<int> clamp = root, grip, side;
  if (shape.clamp)
    for (const int v : extrude(mesh, root, -edge)) clamp.push_back(v);
  if (shape.grip) grip = extrude(mesh, tip, edge);
  std::sort(clamp.begin(), clamp.end());
  for (int v = 0; v < mesh.uv.rows(); ++v)
    if (mesh.uv(v, 1) <= rounding) side.push_back(v);
  mesh.groups = {{"clamp", clamp}, {"root", root}, {"tip", tip}, {"grip", grip}, {"side", side}};
  mesh.uv_triangles = mesh.triangles;
  mesh.x = Points::Zero(mesh.uv.rows(), 3);
  mesh.x.leftCols(2) = mesh.uv;
  return mesh;
}

}  // namespace selvedge
