#include "collision/exact/outward_faces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>

#include "collision/exact/inside.hpp"
#include "collision/geometry/corners.hpp"
#include "collision/geometry/turned_alike.hpp"
#include "collision/geometry/welded_surface.hpp"

namespace selvedge {
namespace {

// Measures of a shell, turned so that most of its area faces as given.
struct Measured {
  std::vector<int> triangles;
  std::vector<int> vertices;
  Vec3 lo, hi;        // its box in the first frame
  double volume = 0;  // [m3]; 0 if it has no volume or no inside
};

void turn(Triangles& triangles, int t) { std::swap(triangles(t, 1), triangles(t, 2)); }

double volume_to(const Vec3& origin, const Vec3& a, const Vec3& b, const Vec3& c) {
  return (a - origin).dot((b - origin).cross(c - origin)) / 6;
}

// Of each triangle the first one at the same places that faces the same way; -1 if it has fewer than three places.
std::vector<int> first_alike(const Triangles& triangles, const std::vector<int>& places) {
  std::map<std::array<int, 3>, int> seen;
  std::vector<int> first;
  for (int t = 0; t < static_cast<int>(triangles.rows()); ++t) {
    const std::optional<std::array<int, 3>> at = placed_corners(triangles, t, places);
    first.push_back(at ? seen.emplace(*at, t).first->second : -1);
  }
  return first;
}

// The welded surface without repeated triangles, and its shells. `faced`: its triangles, in each shell turned as most
// of them are.
struct Shells {
  std::vector<int> kept;  // numbers of the given triangles
  Surface surface;
  TurnedAlike alike;
  Triangles faced;
  std::vector<Shell> shells;
  std::vector<Measured> measured;
};

void count_edges(Shells& all) {
  const std::vector<int> uses = face_counts(all.surface);
  for (std::size_t e = 0; e < uses.size(); ++e) {
    Shell& shell = all.shells[all.alike.part[all.surface.edge_owner[e]]];
    shell.open_edges += uses[e] == 1;
    shell.branching_edges += uses[e] > 2;
  }
}

// Turns each shell so that most of its area faces as it did.
void face_as_most(const Points& x, Shells& all) {
  const auto count = static_cast<int>(all.alike.turn.size());
  std::vector<double> vote(all.shells.size(), 0);
  for (int t = 0; t < count; ++t)
    vote[all.alike.part[t]] += all.alike.turn[t] * twice_area(all.surface.triangles, x, t).norm();
  all.faced = all.surface.triangles;
  for (int t = 0; t < count; ++t) {
    if (vote[all.alike.part[t]] < 0) all.alike.turn[t] = static_cast<signed char>(-all.alike.turn[t]);
    if (all.alike.turn[t] < 0) turn(all.faced, t);
  }
}

// Sets `opening` and returns the volume of the fans over the holes.
double close_holes(const Shells& all, const Measured& part, const Points& x, const Vec3& origin, Shell& shell) {
  const Surface open = make_surface(all.surface.vertex_count, all.faced(part.triangles, Eigen::all));
  double area = 0, opening = 0, volume = 0;
  for (const int t : part.triangles) area += 0.5 * twice_area(all.faced, x, t).norm();
  for (const std::vector<int>& loop : boundary_loops(open)) {
    Vec3 centre = Vec3::Zero();
    for (const int v : loop) centre += row(x, v) / static_cast<double>(loop.size());
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Vec3 a = row(x, loop[(i + 1) % loop.size()]), b = row(x, loop[i]);
      opening += 0.5 * (a - centre).cross(b - centre).norm();
      volume += volume_to(origin, a, b, centre);
    }
  }
  shell.opening = area > 0 ? opening / area : std::numeric_limits<double>::infinity();
  return volume;
}

void measure(const Points& x, const Shells& all, Measured& part, Shell& shell) {
  part.lo = part.hi = row(x, all.faced(part.triangles.front(), 0));
  for (const int t : part.triangles)
    for (const int v : all.faced.row(t)) {
      part.vertices.push_back(v);
      part.lo = part.lo.cwiseMin(row(x, v));
      part.hi = part.hi.cwiseMax(row(x, v));
    }
  sort_once(part.vertices);
  if (shell.branching_edges > 0 || !shell.orientable) return;
  const Vec3 origin = 0.5 * (part.lo + part.hi);
  double volume = 0;
  for (const int t : part.triangles)
    volume += volume_to(origin, row(x, all.faced(t, 0)), row(x, all.faced(t, 1)), row(x, all.faced(t, 2)));
  if (shell.open_edges > 0) volume += close_holes(all, part, x, origin, shell);
  constexpr double rounding = 1e-12;  // relative to the volume of a cube round the shell
  const bool has_inside = shell.closed() || shell.nearly_closed();
  if (has_inside && std::abs(volume) > rounding * std::pow((part.hi - part.lo).norm(), 3)) part.volume = volume;
}

Surface joined(int vertex_count, Triangles triangles, const std::vector<int>& places) {
  Surface surface = make_surface(vertex_count, triangles);
  const std::optional<WeldedSurface> welded = welded_surface(surface, places);
  if (!welded) return surface;
  for (int& corner : triangles.reshaped()) corner = welded->joined[corner];
  return make_surface(vertex_count, triangles);
}

Shells find_shells(const Triangles& triangles, const std::vector<int>& first, std::span<const Points> frames,
                   const std::vector<int>& places) {
  Shells all;
  for (int t = 0; t < static_cast<int>(triangles.rows()); ++t)
    if (first[t] == t) all.kept.push_back(t);
  if (all.kept.empty()) return all;
  all.surface = joined(static_cast<int>(frames[0].rows()), triangles(all.kept, Eigen::all), places);
  all.alike = turned_alike(all.surface);
  all.shells.resize(static_cast<std::size_t>(all.alike.parts()));
  all.measured.resize(all.shells.size());
  for (std::size_t k = 0; k < all.shells.size(); ++k) all.shells[k].orientable = all.alike.orientable[k] != 0;
  for (std::size_t t = 0; t < all.kept.size(); ++t) {
    Shell& shell = all.shells[all.alike.part[t]];
    if (shell.triangles++ == 0) shell.vertex = triangles(all.kept[t], 0);
    all.measured[all.alike.part[t]].triangles.push_back(static_cast<int>(t));
  }
  count_edges(all);
  face_as_most(frames[0], all);
  for (std::size_t k = 0; k < all.shells.size(); ++k) measure(frames[0], all, all.measured[k], all.shells[k]);
  return all;
}

bool all_inside(const Shells& all, const Measured& a, const Measured& b, const Points& x, bool wanted) {
  const Surface round = make_surface(all.surface.vertex_count, all.faced(b.triangles, Eigen::all));
  const Points at = x(a.vertices, Eigen::all);
  const std::vector<char> in = inside(round, x, at);
  return std::ranges::all_of(in, [&](char one) { return (one != 0) == wanted; });
}

// Does shell a lie within shell b, which is closed, in all frames?
bool lies_within(const Shells& all, std::size_t a, std::size_t b, std::span<const Points> frames) {
  const Measured &inner = all.measured[a], &outer = all.measured[b];
  if ((inner.lo.array() <= outer.lo.array()).any() || (inner.hi.array() >= outer.hi.array()).any()) return false;
  return std::ranges::all_of(frames, [&](const Points& x) {
    return all_inside(all, inner, outer, x, true) && all_inside(all, outer, inner, x, false);
  });
}

// Of each shell: +1 if it is to face outwards, -1 inwards, 0 if it has no volume.
std::vector<int> wanted_sides(const Shells& all, std::span<const Points> frames) {
  std::vector<int> wanted(all.shells.size(), 0);
  std::vector<std::size_t> order(all.shells.size());
  std::iota(order.begin(), order.end(), 0);
  const auto size = [&](std::size_t k) { return std::abs(all.measured[k].volume); };
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return size(a) > size(b); });
  const bool all_alike = std::ranges::all_of(all.measured, [](const Measured& m) { return m.volume >= 0; });
  for (std::size_t i = 0; i < order.size() && size(order[i]) > 0; ++i) {
    const std::size_t shell = order[i];
    wanted[shell] = 1;
    if (all_alike || !all.shells[shell].closed()) continue;
    for (std::size_t j = i; j-- > 0;) {  // finds the smallest shell round it
      const std::size_t round = order[j];
      if (!all.shells[round].closed() || !lies_within(all, shell, round, frames)) continue;
      const bool alike = (all.measured[shell].volume > 0) == (all.measured[round].volume > 0);
      if (wanted[round] > 0 && !alike) wanted[shell] = -1;
      break;
    }
  }
  return wanted;
}

}  // namespace

bool OutwardFaces::turned() const {
  return std::ranges::any_of(shells, [](const Shell& s) { return s.over || s.odd > 0; });
}

OutwardFaces face_outward(const Triangles& triangles, std::span<const Points> frames, const std::vector<int>& places) {
  if (frames.empty() || triangles.rows() == 0) return {triangles, {}};
  const std::vector<int> first = first_alike(triangles, places);
  Shells all = find_shells(triangles, first, frames, places);
  const std::vector<int> wanted = wanted_sides(all, frames);
  OutwardFaces result{triangles, all.shells};
  std::vector<char> turned(static_cast<std::size_t>(triangles.rows()), 0);
  for (std::size_t k = 0; k < all.shells.size(); ++k) {
    if (wanted[k] == 0) continue;
    Shell& shell = result.shells[k];
    const int side = all.measured[k].volume > 0 ? 1 : -1;
    shell.cavity = wanted[k] < 0;
    shell.over = side != wanted[k];
    for (const int t : all.measured[k].triangles) {
      shell.odd += all.alike.turn[t] < 0;
      turned[all.kept[t]] = all.alike.turn[t] * side * wanted[k] < 0;
    }
  }
  for (int t = 0; t < static_cast<int>(triangles.rows()); ++t)
    if (first[t] >= 0 && turned[first[t]]) turn(result.triangles, t);
  return result;
}

}  // namespace selvedge
