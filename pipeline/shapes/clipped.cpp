#include "pipeline/shapes/clipped.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "collision/geometry/surface.hpp"
#include "pipeline/shapes/generate.hpp"

namespace selvedge {
namespace {

struct Cutter {
  const Border& border;
  std::span<const Border> earlier;
  std::vector<Vec3> x;
  std::vector<double> side;  // value of each vertex, 0 if it was moved onto the border
  std::map<std::pair<int, int>, int> crossings;
  std::vector<std::array<int, 3>> triangles;
};

// Moves p onto the border, and onto the earlier borders on which both a and b lie.
Vec3 onto_all(const Cutter& cutter, const Vec3& a, const Vec3& b, Vec3 p) {
  constexpr double rounding = 1e-7;
  constexpr int most = 20;  // two borders that cross at a right angle need few
  std::vector<const Border*> borders;
  for (const Border& one : cutter.earlier)
    if (std::abs(one.value(a)) < rounding && std::abs(one.value(b)) < rounding) borders.push_back(&one);
  borders.push_back(&cutter.border);
  for (int k = 0; k < (borders.size() > 1 ? most : 1); ++k)
    for (const Border* one : borders) p = one->onto(p);
  return p;
}

int crossing(Cutter& cutter, int a, int b) {
  if (a > b) std::swap(a, b);
  const auto [entry, fresh] = cutter.crossings.emplace(std::pair{a, b}, static_cast<int>(cutter.x.size()));
  if (fresh) {
    const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
    const double t = cutter.side[i] / (cutter.side[i] - cutter.side[j]);
    const Vec3 from = cutter.x[i], to = cutter.x[j];
    cutter.x.push_back(onto_all(cutter, from, to, (1 - t) * from + t * to));
  }
  return entry->second;
}

void cut(Cutter& cutter, const std::array<int, 3>& corners) {
  std::vector<int> kept;  // the part inside, a triangle or a quadrangle
  for (std::size_t k = 0; k < 3; ++k) {
    const int a = corners[k], b = corners[(k + 1) % 3];
    const double sa = cutter.side[a], sb = cutter.side[b];
    if (sa <= 0) kept.push_back(a);
    if (sa * sb < 0) kept.push_back(crossing(cutter, a, b));
  }
  for (std::size_t k = 2; k < kept.size(); ++k) cutter.triangles.push_back({kept[0], kept[k - 1], kept[k]});
}

// A shape without unused vertices.
Shape packed(const std::vector<Vec3>& x, std::vector<std::array<int, 3>> triangles) {
  std::vector<int> number(x.size(), -1);
  int count = 0;
  for (auto& t : triangles)
    for (int& v : t) {
      int& fresh = number[v];
      if (fresh < 0) fresh = count++;
      v = fresh;
    }
  Shape kept{Points(count, 3), to_triangles(triangles)};
  for (std::size_t v = 0; v < number.size(); ++v)
    if (number[v] >= 0) kept.x.row(number[v]) = x[v].transpose();
  return kept;
}

}  // namespace

Shape clipped(const Shape& shape, const Border& border, std::span<const Border> earlier, double snap) {
  Cutter cutter{border, earlier, {}, {}, {}, {}};
  for (int v = 0; v < shape.x.rows(); ++v) {
    const Vec3 p = row(shape.x, v);
    const double distance = border.value(p);
    const bool on = std::abs(distance) < snap;
    cutter.x.push_back(on ? onto_all(cutter, p, p, p) : p);
    cutter.side.push_back(on ? 0 : distance);
  }
  for (const auto& t : shape.triangles.rowwise()) {
    const std::array<int, 3> corners{t[0], t[1], t[2]};
    bool any_inside = false;  // a triangle with all corners on the border or beyond has no part inside
    for (const int v : corners) any_inside = any_inside || cutter.side[v] < 0;
    if (any_inside) cut(cutter, corners);
  }
  return packed(cutter.x, std::move(cutter.triangles));
}

Shape largest_component(const Shape& shape) {
  const Surface surface = make_surface(static_cast<int>(shape.x.rows()), shape.triangles);
  std::vector<int> size(static_cast<std::size_t>(surface.component_count), 0);
  for (const int component : surface.component) ++size[component];
  const auto largest = static_cast<int>(std::max_element(size.begin(), size.end()) - size.begin());
  std::vector<Vec3> x;
  for (int v = 0; v < shape.x.rows(); ++v) x.push_back(row(shape.x, v));
  std::vector<std::array<int, 3>> kept;
  for (const auto& t : shape.triangles.rowwise())
    if (surface.component[t[0]] == largest) kept.push_back({t[0], t[1], t[2]});
  return packed(x, std::move(kept));
}

}  // namespace selvedge
