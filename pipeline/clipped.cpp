#include "pipeline/clipped.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <utility>
#include <vector>

#include "collision/surface.hpp"
#include "pipeline/generate.hpp"

namespace selvedge {
namespace {

struct Cutter {
  std::vector<Vec3> x;
  std::vector<double> side;  // signed distance of each vertex, zero where it was moved onto the border
  std::map<std::pair<int, int>, int> crossings;
  std::vector<std::array<int, 3>> triangles;

  bool is_in(int v) const { return side[static_cast<std::size_t>(v)] <= 0; }
  int crossing(int a, int b, const Border& border) {
    if (a > b) std::swap(a, b);
    const auto [entry, fresh] = crossings.emplace(std::pair{a, b}, static_cast<int>(x.size()));
    if (fresh) {
      const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
      const double t = side[i] / (side[i] - side[j]);
      x.push_back(border.onto((1 - t) * x[i] + t * x[j]));
    }
    return entry->second;
  }
};

void cut(Cutter& cutter, const std::array<int, 3>& corners, const Border& border) {
  std::vector<int> kept;  // the part inside, a triangle or a quadrangle
  for (std::size_t k = 0; k < 3; ++k) {
    const int a = corners[k], b = corners[(k + 1) % 3];
    if (cutter.is_in(a)) kept.push_back(a);
    const double sa = cutter.side[static_cast<std::size_t>(a)], sb = cutter.side[static_cast<std::size_t>(b)];
    if (sa * sb < 0) kept.push_back(cutter.crossing(a, b, border));
  }
  for (std::size_t k = 2; k < kept.size(); ++k) cutter.triangles.push_back({kept[0], kept[k - 1], kept[k]});
}

// Without the vertices that no triangle has.
Shape packed(const std::vector<Vec3>& x, std::vector<std::array<int, 3>> triangles) {
  std::vector<int> number(x.size(), -1);
  int count = 0;
  for (auto& t : triangles)
    for (int& v : t) {
      int& fresh = number[static_cast<std::size_t>(v)];
      if (fresh < 0) fresh = count++;
      v = fresh;
    }
  Shape kept{Points(count, 3), to_triangles(triangles)};
  for (std::size_t v = 0; v < number.size(); ++v)
    if (number[v] >= 0) kept.x.row(number[v]) = x[v].transpose();
  return kept;
}

}  // namespace

Shape clipped(const Shape& shape, const Border& border, double snap) {
  Cutter cutter;
  for (int v = 0; v < shape.x.rows(); ++v) {
    const Vec3 p = row(shape.x, v);
    const double distance = border.value(p);
    const bool on = std::abs(distance) < snap;
    cutter.x.push_back(on ? border.onto(p) : p);
    cutter.side.push_back(on ? 0 : distance);
  }
  for (const auto& t : shape.triangles.rowwise()) {
    const std::array<int, 3> corners{t[0], t[1], t[2]};
    bool any_inside = false;  // one whose corners are all on the border or beyond has no part inside
    for (const int v : corners) any_inside = any_inside || cutter.side[static_cast<std::size_t>(v)] < 0;
    if (any_inside) cut(cutter, corners, border);
  }
  return packed(cutter.x, std::move(cutter.triangles));
}

Shape largest_component(const Shape& shape) {
  const Surface surface = make_surface(static_cast<int>(shape.x.rows()), shape.triangles);
  std::vector<int> size(static_cast<std::size_t>(surface.component_count), 0);
  for (const int component : surface.component) ++size[static_cast<std::size_t>(component)];
  const auto largest = static_cast<int>(std::max_element(size.begin(), size.end()) - size.begin());
  std::vector<Vec3> x;
  for (int v = 0; v < shape.x.rows(); ++v) x.push_back(row(shape.x, v));
  std::vector<std::array<int, 3>> kept;
  for (const auto& t : shape.triangles.rowwise())
    if (surface.component[static_cast<std::size_t>(t[0])] == largest) kept.push_back({t[0], t[1], t[2]});
  return packed(x, std::move(kept));
}

}  // namespace selvedge
