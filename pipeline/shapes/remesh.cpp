#include "pipeline/shapes/remesh.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "collision/geometry/surface.hpp"
#include "pipeline/shapes/generate.hpp"

namespace selvedge {
namespace {

// A mesh whose triangles may be marked as removed (corner -1) until it is packed.
struct Work {
  std::vector<Vec3> x;
  std::vector<std::array<int, 3>> triangles;
  Surface surface;
  std::vector<char> boundary;          // of each vertex
  const std::vector<Border>& borders;  // in which the boundary lies
  std::vector<std::uint32_t> lies_in;  // of each boundary vertex, one bit per border

  const Vec3& at(int vertex) const { return x[vertex]; }
  std::array<int, 3>& triangle(int t) { return triangles[t]; }
  const std::array<int, 3>& triangle(int t) const { return triangles[t]; }
  double length(int edge) const { return (at(surface.edges(edge, 1)) - at(surface.edges(edge, 0))).norm(); }
  Vec3 middle(int edge) const { return 0.5 * (at(surface.edges(edge, 0)) + at(surface.edges(edge, 1))); }
  bool is_boundary(int edge) const { return surface.edge_triangles[edge][1] < 0; }
  std::uint32_t borders_of(int vertex) const { return lies_in[vertex]; }
  bool is_corner(int vertex) const { return std::popcount(borders_of(vertex)) > 1; }
  int opposite(int t, int a, int b) const {
    for (const int v : triangle(t))
      if (v != a && v != b) return v;
    return -1;
  }
};

Vec3 normal(const Work& work, const std::array<int, 3>& t) {
  return (work.at(t[1]) - work.at(t[0])).cross(work.at(t[2]) - work.at(t[0]));
}

// The borders of a boundary vertex: those on which it is up to rounding, or else the nearest.
std::uint32_t borders_at(const Work& work, const Vec3& x) {
  constexpr double rounding = 1e-7;
  std::uint32_t bits = 0;
  std::size_t nearest = 0;
  for (std::size_t k = 0; k < work.borders.size(); ++k) {
    const double distance = std::abs(work.borders[k].value(x));
    if (distance < rounding) bits |= std::uint32_t{1} << k;
    if (distance < std::abs(work.borders[nearest].value(x))) nearest = k;
  }
  return bits != 0 ? bits : std::uint32_t{1} << nearest;
}

Vec3 onto_borders(const Work& work, std::uint32_t bits, Vec3 x) {
  for (std::size_t k = 0; k < work.borders.size(); ++k)
    if (bits >> k & 1) x = work.borders[k].onto(x);
  return x;
}

// The middle of an edge; for a boundary edge moved onto the borders of both ends.
Vec3 middle_on_borders(const Work& work, int edge) {
  const std::uint32_t common = work.is_boundary(edge) ? work.borders_of(work.surface.edges(edge, 0)) &
                                                            work.borders_of(work.surface.edges(edge, 1))
                                                      : 0;
  return onto_borders(work, common, work.middle(edge));
}

// Removes marked triangles and vertices without triangles, and makes the topology anew.
void pack(Work& work) {
  std::erase_if(work.triangles, [](const auto& t) { return t[0] < 0; });
  std::vector<int> number(work.x.size(), -1);
  for (const auto& t : work.triangles)
    for (const int v : t) number[v] = 0;
  int count = 0;
  for (std::size_t v = 0; v < number.size(); ++v)
    if (number[v] == 0) {
      work.x[count] = work.x[v];
      number[v] = count++;
    }
  work.x.resize(static_cast<std::size_t>(count));
  for (auto& t : work.triangles)
    for (int& v : t) v = number[v];
  work.surface = make_surface(count, to_triangles(work.triangles));
  work.boundary.assign(work.x.size(), 0);
  for (int e = 0; e < work.surface.edges.rows(); ++e)
    if (work.is_boundary(e))
      for (const int k : {0, 1}) work.boundary[work.surface.edges(e, k)] = 1;
  work.lies_in.assign(work.x.size(), 0);
  for (std::size_t v = 0; v < work.x.size(); ++v)
    if (work.boundary[v]) work.lies_in[v] = borders_at(work, work.x[v]);
}

// Neighbours of a vertex, sorted.
std::vector<int> ring(const Work& work, int vertex) {
  std::vector<int> found;
  for (const int t : work.surface.triangles_of(vertex))
    for (const int v : work.triangle(t))
      if (v != vertex) found.push_back(v);
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

// Edges with a key below the bound, by ascending key.
template <class Key>
std::vector<int> edges_below(const Work& work, double bound, const Key& key) {
  std::vector<std::pair<double, int>> list;
  for (int e = 0; e < work.surface.edges.rows(); ++e)
    if (const double value = key(e); value < bound) list.emplace_back(value, e);
  std::sort(list.begin(), list.end());
  std::vector<int> edges;
  for (const auto& entry : list) edges.push_back(entry.second);
  return edges;
}

double relative_length(const Work& work, const RemeshTarget& target, int edge) {
  return work.length(edge) / target.edge(work.middle(edge));
}

// Each round splits edges that share no triangle. Rounds of other passes also work on separate neighbourhoods.
bool split_round(Work& work, const RemeshTarget& target, double longest) {
  std::vector<char> used(work.triangles.size(), 0);
  const auto chosen = edges_below(work, -longest, [&](int e) { return -relative_length(work, target, e); });
  bool changed = false;
  for (const int e : chosen) {
    const auto sides = work.surface.edge_triangles[e];
    if (std::any_of(sides.begin(), sides.end(), [&](int t) { return t >= 0 && used[t]; })) continue;
    const int a = work.surface.edges(e, 0), b = work.surface.edges(e, 1), fresh = static_cast<int>(work.x.size());
    work.x.push_back(middle_on_borders(work, e));
    for (const int t : sides) {
      if (t < 0) continue;
      used[t] = 1;
      auto half = work.triangle(t);
      std::replace(half.begin(), half.end(), a, fresh);
      std::replace(work.triangle(t).begin(), work.triangle(t).end(), b, fresh);
      work.triangles.push_back(half);
    }
    changed = true;
  }
  if (changed) pack(work);
  return changed;
}

// Whether vertex `gone` may move to `to` and become `kept`: neighbours stay in reach and no triangle turns over.
bool may_move(const Work& work, const RemeshTarget& target, int vertex, int other, const Vec3& to, double longest) {
  for (const int t : work.surface.triangles_of(vertex)) {
    const auto& corners = work.triangle(t);
    if (std::find(corners.begin(), corners.end(), other) != corners.end()) continue;
    std::array<Vec3, 3> p;
    for (std::size_t k = 0; k < 3; ++k) p[k] = corners[k] == vertex ? to : work.at(corners[k]);
    const Vec3 after = (p[1] - p[0]).cross(p[2] - p[0]), before = normal(work, corners);
    if (after.dot(before) < 0.7 * after.norm() * before.norm()) return false;
    for (std::size_t k = 0; k < 3; ++k)
      if ((p[k] - to).norm() > longest * target.edge(0.5 * (p[k] + to))) return false;
  }
  return true;
}

// A corner must stay, unless it is joined to one of the same borders: there must be only one corner where borders meet,
// though a cut may have left several.
bool may_vanish(const Work& work, int gone, int kept) {
  return !work.is_corner(gone) || (work.borders_of(gone) & ~work.borders_of(kept)) == 0;
}

bool collapse_round(Work& work, const RemeshTarget& target, double shortest, double longest) {
  std::vector<char> used(work.x.size(), 0);
  const auto chosen = edges_below(work, shortest, [&](int e) { return relative_length(work, target, e); });
  bool changed = false;
  for (const int e : chosen) {
    int kept = work.surface.edges(e, 0), gone = work.surface.edges(e, 1);
    if (work.boundary[gone]) std::swap(kept, gone);
    const bool both = work.boundary[gone];
    if (both && !work.is_boundary(e)) continue;
    if (!may_vanish(work, gone, kept)) std::swap(kept, gone);
    if (!may_vanish(work, gone, kept)) continue;
    const auto is_used = [&](int v) { return used[v] != 0; };
    if (is_used(kept) || is_used(gone)) continue;
    const auto around_gone = ring(work, gone), around_kept = ring(work, kept);
    if (std::any_of(around_gone.begin(), around_gone.end(), is_used) ||
        std::any_of(around_kept.begin(), around_kept.end(), is_used))
      continue;
    std::vector<int> common;
    std::set_intersection(around_gone.begin(), around_gone.end(), around_kept.begin(), around_kept.end(),
                          std::back_inserter(common));
    if (common.size() != (work.is_boundary(e) ? 1u : 2u)) continue;  // the link condition
    // No edge across the half may join two boundary vertices: its mirror image would be the same edge.
    const bool kept_at_boundary = work.boundary[kept];
    if (kept_at_boundary && !both && std::any_of(around_gone.begin(), around_gone.end(), [&](int v) {
          return v != kept && work.boundary[v] && !std::binary_search(around_kept.begin(), around_kept.end(), v);
        }))
      continue;
    const Vec3 to = (kept_at_boundary && !both) || work.is_corner(kept) ? work.at(kept) : middle_on_borders(work, e);
    if (!may_move(work, target, gone, kept, to, longest) || !may_move(work, target, kept, gone, to, longest)) continue;
    for (const int t : work.surface.triangles_of(gone)) {
      auto& corners = work.triangle(t);
      if (std::find(corners.begin(), corners.end(), kept) != corners.end())
        corners = {-1, -1, -1};
      else
        std::replace(corners.begin(), corners.end(), gone, kept);
    }
    work.x[kept] = to;
    for (const auto* list : {&around_gone, &around_kept})
      for (const int v : *list) used[v] = 1;
    used[kept] = used[gone] = 1;
    changed = true;
  }
  if (changed) pack(work);
  return changed;
}

double cosine_at(const Vec3& corner, const Vec3& a, const Vec3& b) {
  return (a - corner).dot(b - corner) / ((a - corner).norm() * (b - corner).norm());
}

// The change by a flip; below zero is a gain: in squared deviations from valence 6 (4 at the boundary), or in cosines
// of the opposite angles, whose sum is negative if they exceed pi together.
double flip_gain(const Work& work, const std::vector<int>& valence, int e, bool by_angles) {
  const auto [s, t] = work.surface.edge_triangles[e];
  if (t < 0) return 0;
  const int a = work.surface.edges(e, 0), b = work.surface.edges(e, 1);
  const int c = work.opposite(s, a, b), d = work.opposite(t, a, b);
  if (by_angles)
    return cosine_at(work.at(c), work.at(a), work.at(b)) + cosine_at(work.at(d), work.at(a), work.at(b)) + 0.02;
  const auto deviation = [&](int v, int change) {
    const int off = valence[v] + change - (work.boundary[v] ? 4 : 6);
    return off * off;
  };
  int gain = 0;
  for (const int v : {a, b}) gain += deviation(v, -1) - deviation(v, 0);
  for (const int v : {c, d}) gain += deviation(v, 1) - deviation(v, 0);
  return gain;
}

bool flip_round(Work& work, bool by_angles) {
  std::vector<int> valence(work.x.size(), 0);
  for (int e = 0; e < work.surface.edges.rows(); ++e)
    for (const int k : {0, 1}) ++valence[work.surface.edges(e, k)];
  std::vector<char> used(work.x.size(), 0);
  bool changed = false;
  for (const int e : edges_below(work, 0, [&](int edge) { return flip_gain(work, valence, edge, by_angles); })) {
    const auto [s, t] = work.surface.edge_triangles[e];
    const int a = work.surface.edges(e, 0), b = work.surface.edges(e, 1);
    const int c = work.opposite(s, a, b), d = work.opposite(t, a, b);
    bool free = !(work.boundary[c] && work.boundary[d]);
    for (const int v : {a, b, c, d}) free = free && !used[v];
    if (!free) continue;
    const auto around = ring(work, c);
    if (std::binary_search(around.begin(), around.end(), d)) continue;
    auto first = work.triangle(s), second = work.triangle(t);
    const Vec3 before = normal(work, first).normalized() + normal(work, second).normalized();
    std::replace(first.begin(), first.end(), b, d);
    std::replace(second.begin(), second.end(), a, c);
    const Vec3 n0 = normal(work, first), n1 = normal(work, second);
    if (n0.dot(before) < 0.7 * n0.norm() * before.norm() || n1.dot(before) < 0.7 * n1.norm() * before.norm()) continue;
    work.triangle(s) = first;
    work.triangle(t) = second;
    for (const int v : {a, b, c, d}) used[v] = 1;
    changed = true;
  }
  if (changed) pack(work);
  return changed;
}

// Moves vertices toward the mean of their neighbours, weighted by the triangles' size relative to the wanted size, then
// back onto the surface.
void relax(Work& work, const RemeshTarget& target) {
  std::vector<Vec3> sum(work.x.size(), Vec3::Zero());
  std::vector<double> weight(work.x.size(), 0);
  for (const auto& t : work.triangles) {
    const Vec3 centre = (work.at(t[0]) + work.at(t[1]) + work.at(t[2])) / 3;
    const double edge = target.edge(centre), share = normal(work, t).norm() / (edge * edge);
    for (const int v : t)
      if (!work.boundary[v]) {
        sum[v] += share * centre;
        weight[v] += share;
      }
  }
  for (int e = 0; e < work.surface.edges.rows(); ++e)
    if (work.is_boundary(e))
      for (const int k : {0, 1}) {
        const auto v = static_cast<std::size_t>(work.surface.edges(e, k));
        sum[v] += work.middle(e);
        weight[v] += 1;
      }
  for (std::size_t v = 0; v < work.x.size(); ++v) {
    if (work.is_corner(static_cast<int>(v))) continue;
    work.x[v] = onto_borders(work, work.lies_in[v], target.surface(sum[v] / weight[v]));
  }
}

}  // namespace

Shape remeshed(const Shape& shape, const RemeshTarget& target, int rounds) {
  constexpr double longest = 4.0 / 3, shortest = 4.0 / 5;
  constexpr int most = 30;  // rounds of one pass; the rest is left to the next pass
  Work work{{}, {}, {}, {}, target.borders, {}};
  for (int v = 0; v < shape.x.rows(); ++v) work.x.push_back(row(shape.x, v));
  for (const auto& t : shape.triangles.rowwise()) work.triangles.push_back({t[0], t[1], t[2]});
  pack(work);
  const auto repeat = [&](const auto& pass) {
    for (int i = 0; i < most && pass(); ++i) {
    }
  };
  for (int round = 0; round < rounds; ++round) {
    repeat([&] { return split_round(work, target, longest); });
    repeat([&] { return collapse_round(work, target, shortest, longest); });
    repeat([&] { return flip_round(work, false); });
    for (int i = 0; i < 3; ++i) relax(work, target);
    repeat([&] { return flip_round(work, true); });
  }
  for (int i = 0; i < 5; ++i) {
    relax(work, target);
    repeat([&] { return flip_round(work, true); });
  }
  return {to_points(work.x), work.surface.triangles};
}

}  // namespace selvedge
