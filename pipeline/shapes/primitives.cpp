#include "pipeline/shapes/primitives.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>
#include <numbers>

#include "pipeline/shapes/generate.hpp"

namespace selvedge {
namespace {

using TriangleList = std::vector<std::array<int, 3>>;

int pieces(double length, double edge) { return std::max(1, static_cast<int>(std::ceil(length / edge - 1e-9))); }

struct Icosahedron {
  std::vector<Vec3> corners;
  TriangleList faces;
};

Icosahedron icosahedron() {
  const double p = std::numbers::phi;
  Icosahedron ico;
  for (const double s : {-1.0, 1.0})
    for (const double t : {-p, p}) {
      ico.corners.emplace_back(0, s, t);
      ico.corners.emplace_back(s, t, 0);
      ico.corners.emplace_back(t, 0, s);
    }
  // Faces are the triples of corners at mutual distance 2.
  const auto near = [&](int a, int b) { return std::abs((ico.corners[a] - ico.corners[b]).norm() - 2) < 1e-9; };
  for (int a = 0; a < 12; ++a)
    for (int b = a + 1; b < 12; ++b)
      for (int c = b + 1; c < 12; ++c) {
        if (!near(a, b) || !near(b, c) || !near(a, c)) continue;
        const double outward = ico.corners[a].dot(ico.corners[b].cross(ico.corners[c]));
        ico.faces.push_back(outward > 0 ? std::array{a, b, c} : std::array{a, c, b});
      }
  return ico;
}

struct Ring {
  double radius, y;
  int count;
};

// Rings from the south to the north pole; a ring of one vertex is a pole. Closed: the last is joined to the first.
Shape revolved(const std::vector<Ring>& rings, bool closed = false) {
  std::vector<Vec3> x;
  TriangleList triangles;
  std::vector<int> previous;
  std::vector<double> u_previous;
  for (std::size_t r = 0; r < rings.size() + closed; ++r) {
    const Ring& ring = rings[r % rings.size()];
    std::vector<int> row;
    std::vector<double> u;
    const int first = r < rings.size() ? static_cast<int>(x.size()) : 0;
    for (int i = 0; i < ring.count && r < rings.size(); ++i) {
      const double angle = 2 * std::numbers::pi * i / ring.count;
      x.emplace_back(ring.radius * std::sin(angle), ring.y, ring.radius * std::cos(angle));
    }
    for (int i = 0; i <= (ring.count == 1 ? 0 : ring.count); ++i) {
      row.push_back(first + i % ring.count);
      u.push_back(static_cast<double>(i) / ring.count);
    }
    if (!previous.empty()) add_strip(triangles, previous, u_previous, row, u);
    previous = std::move(row);
    u_previous = std::move(u);
  }
  return {to_points(x), to_triangles(triangles)};
}

}  // namespace

double vertices_for(double area, double edge) { return area / (edge * edge); }

Shape make_plane(const Vec2& size, double edge) {
  const Mesh sheet = make_rectangle(size, pieces(size.x(), edge) + 1, pieces(size.y(), edge) + 1, {});
  return {sheet.x, sheet.triangles};
}

Shape make_sphere(double radius, double edge) {
  assert(radius > 0 && edge > 0);
  const Icosahedron ico = icosahedron();
  // The longest geodesic edge is 1.26 radius / n for large n.
  const int n = pieces(1.26 * radius, edge);
  std::map<std::array<std::pair<int, int>, 3>, int> index;  // corner and weight of the three corners, sorted
  std::vector<Vec3> x;
  TriangleList triangles;
  for (const auto& face : ico.faces) {
    const auto vertex = [&](int i, int j) {
      std::array<std::pair<int, int>, 3> key{{{face[0], n - i - j}, {face[1], i}, {face[2], j}}};
      Vec3 p = Vec3::Zero();
      for (auto& [corner, weight] : key) {
        p += weight * ico.corners[corner];
        if (weight == 0) corner = -1;
      }
      std::sort(key.begin(), key.end());
      const auto [entry, fresh] = index.emplace(key, static_cast<int>(x.size()));
      if (fresh) x.push_back(radius * p.normalized());
      return entry->second;
    };
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n - j; ++i) {
        triangles.push_back({vertex(i, j), vertex(i + 1, j), vertex(i, j + 1)});
        if (i + j < n - 1) triangles.push_back({vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
      }
  }
  return {to_points(x), to_triangles(triangles)};
}

Shape make_capsule(double radius, double length, double edge) {
  assert(radius > 0 && length >= 0 && edge > 0);
  const int around = std::max(8, pieces(2 * std::numbers::pi * radius, edge));
  const int cap = std::max(2, pieces(std::numbers::pi / 2 * radius, edge));
  const int side = length > 0 ? pieces(length, edge) : 0;
  const auto cap_ring = [&](int k) {  // k = 0 the pole, k = cap the equator
    const double angle = std::numbers::pi / 2 * k / cap;
    const int count = std::max(6, static_cast<int>(std::ceil(around * std::sin(angle) - 1e-9)));
    return Ring{k == 0 ? 0 : radius * std::sin(angle), radius * std::cos(angle), k == 0 ? 1 : count};
  };
  std::vector<Ring> rings;
  for (int k = 0; k <= cap; ++k) rings.push_back({cap_ring(k).radius, -length / 2 - cap_ring(k).y, cap_ring(k).count});
  for (int k = 1; k < side; ++k) rings.push_back({radius, -length / 2 + length * k / side, around});
  for (int k = side > 0 ? cap : cap - 1; k >= 0; --k)
    rings.push_back({cap_ring(k).radius, length / 2 + cap_ring(k).y, cap_ring(k).count});
  return revolved(rings);
}

Shape make_revolution(const std::vector<Vec2>& profile, bool closed, double edge) {
  assert(profile.size() >= 2 && edge > 0);
  const std::size_t count = profile.size();
  double doubled_area = 0;  // of the profile closed along the axis; positive: it runs up on the outside
  for (std::size_t k = 0; k < count; ++k) doubled_area += cross(profile[k], profile[(k + 1) % count]);
  std::vector<Vec2> line = profile;
  if (doubled_area < 0) std::reverse(line.begin(), line.end());
  std::vector<Ring> rings;
  const auto add_ring = [&](const Vec2& p) {
    const int around = std::max(8, pieces(2 * std::numbers::pi * p.x(), edge));
    rings.push_back({p.x(), p.y(), p.x() > 0 ? around : 1});
  };
  for (std::size_t k = 0; k + !closed < count; ++k) {
    const Vec2 &a = line[k], &b = line[(k + 1) % count];
    const int n = pieces((b - a).norm(), edge);
    for (int i = 0; i < n; ++i) add_ring(a + (b - a) * i / n);
  }
  if (!closed) add_ring(line.back());
  return revolved(rings, closed);
}

Shape make_box(const Vec3& size, double edge) {
  assert(size.minCoeff() > 0 && edge > 0);
  const std::array<int, 3> n{pieces(size.x(), edge), pieces(size.y(), edge), pieces(size.z(), edge)};
  std::map<std::array<int, 3>, int> index;
  std::vector<Vec3> x;
  TriangleList triangles;
  const auto vertex = [&](const std::array<int, 3>& at) {
    const auto [entry, fresh] = index.emplace(at, static_cast<int>(x.size()));
    if (fresh)
      x.emplace_back(size.x() * (at[0] / double(n[0]) - 0.5), size.y() * (at[1] / double(n[1]) - 0.5),
                     size.z() * (at[2] / double(n[2]) - 0.5));
    return entry->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (const bool far : {false, true})
      for (int j = 0; j < n[v]; ++j)
        for (int i = 0; i < n[u]; ++i) {
          const auto at = [&](int du, int dv) {
            std::array<int, 3> p{};
            p[axis] = far ? n[axis] : 0;
            p[u] = i + du;
            p[v] = j + dv;
            return vertex(p);
          };
          const int a = at(0, 0), b = at(1, 0), c = at(1, 1), d = at(0, 1);
          triangles.push_back(far ? std::array{a, b, c} : std::array{a, c, b});
          triangles.push_back(far ? std::array{a, c, d} : std::array{a, d, c});
        }
  }
  return {to_points(x), to_triangles(triangles)};
}

}  // namespace selvedge
