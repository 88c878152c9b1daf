#include "pipeline/patterns/flip_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "collision/exact/orientation.hpp"

namespace selvedge {
namespace {

constexpr double clearly = 1e-9;  // relative to the scale of an in-circle determinant: larger values are not rounding

// Whether d is inside the circle through a, b, c (counter-clockwise) by more than rounding.
bool within_circle(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const Vec2 p = a - d, q = b - d, r = c - d;
  const double pp = p.squaredNorm(), qq = q.squaredNorm(), rr = r.squaredNorm();
  const double det = pp * cross(q, r) - qq * cross(p, r) + rr * cross(p, q);
  const double scale = std::max({pp, qq, rr});
  return det > clearly * scale * scale;
}

}  // namespace

double smallest_angle(const Vec2& a, const Vec2& b, const Vec2& c) {
  const auto angle = [](const Vec2& at, const Vec2& p, const Vec2& q) {
    const Vec2 u = p - at, v = q - at;
    return std::atan2(std::abs(cross(u, v)), u.dot(v));
  };
  return std::min({angle(a, b, c), angle(b, c, a), angle(c, a, b)});
}

FlipMesh::FlipMesh(const std::vector<Vec2>& outline, const std::vector<std::array<int, 3>>& corners)
    : points(outline), fixed(static_cast<int>(outline.size())) {
  std::map<std::array<int, 2>, int> by_edge;
  for (const std::array<int, 3>& corner : corners) {
    const int t = static_cast<int>(triangles.size());
    for (std::size_t k = 0; k < 3; ++k) by_edge[{corner[k], corner[(k + 1) % 3]}] = t;
    triangles.push_back({corner, {-1, -1, -1}});
  }
  for (FlipTriangle& triangle : triangles)
    for (std::size_t k = 0; k < 3; ++k)
      if (const auto other = by_edge.find({triangle.corner[(k + 1) % 3], triangle.corner[k]}); other != by_edge.end())
        triangle.beyond[k] = other->second;
}

int FlipMesh::sign(int t) const {
  const auto& c = triangles[t].corner;
  return orient2d(points[c[0]], points[c[1]], points[c[2]]);
}

bool FlipMesh::is_sound() const {
  for (int t = 0; t < static_cast<int>(triangles.size()); ++t)
    if (sign(t) <= 0) return false;
  return true;
}

int FlipMesh::edge_to(int t, int other) const {
  const auto& beyond = triangles[t].beyond;
  return static_cast<int>(std::ranges::find(beyond, other) - beyond.begin());
}

void FlipMesh::rejoin(int t, int k) {
  const FlipTriangle& triangle = triangles[t];
  const int other = triangle.beyond[k];
  if (other < 0) return;
  FlipTriangle& far = triangles[other];
  const int end = triangle.corner[(k + 1) % 3];
  for (std::size_t m = 0; m < 3; ++m)
    if (far.corner[m] == end && far.corner[(m + 1) % 3] == triangle.corner[k]) far.beyond[m] = t;
}

bool FlipMesh::is_chord(int t, int k) const {
  const FlipTriangle& triangle = triangles[t];
  return triangle.beyond[k] >= 0 && triangle.corner[k] < fixed && triangle.corner[(k + 1) % 3] < fixed;
}

double FlipMesh::angle_if_flipped(int t, int k) const {
  const FlipTriangle& near = triangles[t];
  const int u = near.beyond[k];
  if (u < 0) return 0;
  const int m = edge_to(u, t);
  const int c = near.corner[(k + 2) % 3], d = triangles[u].corner[(m + 2) % 3];
  if (!may_make_chords && c < fixed && d < fixed) return 0;
  const Vec2 &pa = points[near.corner[k]], &pb = points[near.corner[(k + 1) % 3]], &pc = points[c], &pd = points[d];
  if (orient2d(pa, pd, pc) <= 0 || orient2d(pd, pb, pc) <= 0) return 0;
  return std::min(smallest_angle(pa, pd, pc), smallest_angle(pd, pb, pc));
}

bool FlipMesh::wants_flip(int t, int k) const {
  const FlipTriangle& near = triangles[t];
  const int u = near.beyond[k];
  if (u < 0) return false;
  const int d = triangles[u].corner[(edge_to(u, t) + 2) % 3];
  const auto& c = near.corner;
  return within_circle(points[c[0]], points[c[1]], points[c[2]], points[d]) && angle_if_flipped(t, k) > 0;
}

// Triangles (a b c) and (b a d) become (a d c) and (d b c).
void FlipMesh::flip(int t, int k) {
  FlipTriangle& near = triangles[t];
  const int u = near.beyond[k], m = edge_to(u, t);
  FlipTriangle& far = triangles[u];
  const auto at = [](int i) { return static_cast<std::size_t>(i % 3); };
  const int a = near.corner[at(k)], b = near.corner[at(k + 1)], c = near.corner[at(k + 2)], d = far.corner[at(m + 2)];
  const int bc = near.beyond[at(k + 1)], ca = near.beyond[at(k + 2)], ad = far.beyond[at(m + 1)],
            db = far.beyond[at(m + 2)];
  near = {{a, d, c}, {ad, u, ca}};
  far = {{d, b, c}, {db, bc, t}};
  rejoin(t, 0);
  rejoin(u, 0);
  rejoin(u, 1);
}

void FlipMesh::cut(int t, int k) {
  const auto at = [](int i) { return static_cast<std::size_t>(i % 3); };
  const FlipTriangle near = triangles[t];
  const int u = near.beyond[at(k)], m = edge_to(u, t);
  const FlipTriangle far = triangles[u];
  const int a = near.corner[at(k)], b = near.corner[at(k + 1)], c = near.corner[at(k + 2)], d = far.corner[at(m + 2)];
  const int p = static_cast<int>(points.size()), v = static_cast<int>(triangles.size()), w = v + 1;
  points.push_back((points[a] + points[b]) / 2);
  triangles.resize(triangles.size() + 2);
  triangles[t] = {{a, p, c}, {u, v, near.beyond[at(k + 2)]}};
  triangles[v] = {{p, b, c}, {w, near.beyond[at(k + 1)], t}};
  triangles[u] = {{p, a, d}, {t, far.beyond[at(m + 1)], w}};
  triangles[w] = {{b, p, d}, {v, u, far.beyond[at(m + 2)]}};
  rejoin(v, 1);
  rejoin(w, 2);
}

void FlipMesh::make_delaunay() {
  bool flipped = true;
  for (int round = 0; flipped && round < 1000; ++round) {
    flipped = false;
    for (int t = 0; t < static_cast<int>(triangles.size()); ++t)
      for (int k = 0; k < 3; ++k)
        if (wants_flip(t, k)) {
          flip(t, k);
          flipped = true;
        }
  }
}

int FlipMesh::find(const Vec2& p) const {
  // The first edge of a triangle that has p on its outer side; -1: none.
  const auto way_out = [&](int t) {
    const auto& c = triangles[t].corner;
    for (int k = 0; k < 3; ++k)
      if (orient2d(points[c[k]], points[c[(k + 1) % 3]], p) < 0) return k;
    return -1;
  };
  int t = std::min(last_, static_cast<int>(triangles.size()) - 1);
  // The walk may hit the outline of a polygon that is not convex; then every triangle is tested.
  for (std::size_t step = 0; step < triangles.size(); ++step) {
    const int out = way_out(t);
    if (out < 0) return last_ = t;
    t = triangles[t].beyond[out];
    if (t < 0) break;
  }
  for (t = 0; t < static_cast<int>(triangles.size()); ++t)
    if (way_out(t) < 0) return last_ = t;
  return -1;
}

void FlipMesh::insert(const Vec2& p) {
  const int t = find(p);
  if (t < 0) return;
  const FlipTriangle old = triangles[t];
  for (std::size_t k = 0; k < 3; ++k)
    if (orient2d(points[old.corner[k]], points[old.corner[(k + 1) % 3]], p) == 0) return;
  const int v = static_cast<int>(points.size()), second = static_cast<int>(triangles.size()), third = second + 1;
  points.push_back(p);
  triangles.resize(triangles.size() + 2);
  triangles[t] = {{old.corner[0], old.corner[1], v}, {old.beyond[0], second, third}};
  triangles[second] = {{old.corner[1], old.corner[2], v}, {old.beyond[1], third, t}};
  triangles[third] = {{old.corner[2], old.corner[0], v}, {old.beyond[2], t, second}};
  for (const int made : {t, second, third}) rejoin(made, 0);
  settle({t, second, third});
}

// Flips edges opposite the newest point, and those that become opposite to it.
void FlipMesh::settle(std::vector<int> fan) {
  const int v = static_cast<int>(points.size()) - 1;
  for (std::size_t i = 0; i < fan.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      const FlipTriangle triangle = triangles[fan[i]];
      if (triangle.corner[(k + 2) % 3] != v || !wants_flip(fan[i], k)) continue;
      flip(fan[i], k);
      fan.push_back(fan[i]);
      fan.push_back(triangle.beyond[k]);
      break;
    }
}

std::vector<std::vector<int>> FlipMesh::triangles_round_vertices() const {
  std::vector<std::vector<int>> around(points.size());
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (const int v : triangles[t].corner) around[v].push_back(static_cast<int>(t));
  return around;
}

}  // namespace selvedge
