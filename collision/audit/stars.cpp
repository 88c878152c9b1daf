#include "collision/audit/stars.hpp"

#include <algorithm>
#include <array>
#include <optional>

namespace selvedge {
namespace {

constexpr int most_triangles = 12;  // A star of more is not proven to be clean.
constexpr int most_nodes = most_triangles + 2;

// The nodes round a vertex. Seen from its outside, triangle i goes from node i to node next[i].
struct Star {
  int triangles = 0, nodes = 0;
  std::array<int, most_nodes> node{}, next{};
  int first = -1;  // at a boundary: the node at which it begins, while it ends at the last one; -1: it is closed
};

// None if triangles meet at the vertex in another way than round it, once, in one orientation.
std::optional<Star> star_of(const Surface& surface, int v) {
  const auto round = surface.triangles_of(v);
  if (round.empty() || round.size() > most_triangles) return {};
  Star star;
  std::array<int, most_triangles> end;
  for (const int t : round) {
    const int k = surface.corner_of(t, v);
    star.node[star.triangles] = surface.triangles(t, (k + 1) % 3);
    end[star.triangles++] = surface.triangles(t, (k + 2) % 3);
  }
  star.nodes = star.triangles;
  std::array<int, most_triangles> come{};  // how many triangles end at each node
  for (int i = 0; i < star.triangles; ++i) {
    int found = -1;
    for (int j = 0; j < star.triangles; ++j) {
      if (j != i && (star.node[j] == star.node[i] || end[j] == end[i])) return {};
      if (star.node[j] == end[i]) found = j;
    }
    star.next[i] = found;
    if (found >= 0) {
      ++come[found];
      continue;
    }
    if (star.nodes > star.triangles) return {};
    star.next[i] = star.triangles;
    star.node[star.nodes++] = end[i];
  }
  if (star.nodes > star.triangles)
    star.first = static_cast<int>(std::find(come.begin(), come.begin() + star.triangles, 0) - come.begin());
  return star;
}

// The nodes seen along a direction, relative to the vertex, at the start and at the end of the motion.
struct Seen {
  std::array<Vec2, most_nodes> start, end;
};

// Do nodes i and j turn to the left by more than the slack all the time? The product is of second order in time, and
// these are its coefficients in Bernstein's basis.
bool turns_left(const Seen& seen, int i, int j, double slack) {
  return cross(seen.start[i], seen.start[j]) > slack && cross(seen.end[i], seen.end[j]) > slack &&
         0.5 * (cross(seen.start[i], seen.end[j]) + cross(seen.end[i], seen.start[j])) > slack;
}

// A point in the middle of the gap that a star at a boundary leaves, from its last node to the first.
Vec2 in_gap(const Seen& seen, int last, int first) {
  const Vec2 a = (seen.start[last] + seen.end[last]).normalized(),
             b = (seen.start[first] + seen.end[first]).normalized();
  const Vec2 across = a - b;
  return Vec2(-across[1], across[0]).normalized();
}

bool is_clean(Star star, const MovingBody& cloth, int v, double reach) {
  const Vec3 start = row(*cloth.x0, v), end = row(*cloth.x1, v);
  std::array<Vec3, most_nodes> from, to;
  for (int i = 0; i < star.nodes; ++i) {
    from[i] = row(*cloth.x0, star.node[i]) - start;
    to[i] = row(*cloth.x1, star.node[i]) - end;
  }
  Vec3 along = Vec3::Zero();
  for (int i = 0; i < star.triangles; ++i) along += (from[i] + to[i]).cross(from[star.next[i]] + to[star.next[i]]);
  if (!along.allFinite()) return false;
  int axis = 0;
  along.cwiseAbs().minCoeff(&axis);
  const Vec3 right = along.cross(Vec3::Unit(axis)).normalized(), up = along.cross(right).normalized();
  Seen seen;
  double size = 0;
  for (int i = 0; i < star.nodes; ++i) {
    seen.start[i] = {right.dot(from[i]), up.dot(from[i])};
    seen.end[i] = {right.dot(to[i]), up.dot(to[i])};
    size = std::max({size, seen.start[i].cwiseAbs().maxCoeff(), seen.end[i].cwiseAbs().maxCoeff()});
  }
  // A relative node moves by twice the reach, and by less than four times as seen. The rest is far above rounding.
  const double slack = 1e-9 * size * size + 40 * reach * (size + reach);
  if (star.first >= 0) {
    const int gap = star.nodes, last = gap - 1;
    seen.start[gap] = seen.end[gap] = size * in_gap(seen, last, star.first);
    if (!turns_left(seen, last, gap, slack) || !turns_left(seen, gap, star.first, slack)) return false;
    star.next[last] = gap;
    star.next[gap] = star.first;
    star.nodes = gap + 1;
  }
  int times_round = 0;  // how often it passes the axis to the right
  for (int i = 0; i < star.nodes; ++i) {
    if (i < star.triangles && !turns_left(seen, i, star.next[i], slack)) return false;
    times_round += seen.start[i][1] < 0 && seen.start[star.next[i]][1] >= 0;
  }
  return times_round == 1;
}

}  // namespace

std::vector<char> clean_stars(const MovingBody& cloth, double reach) {
  const int count = cloth.surface->vertex_count;
  std::vector<char> clean(static_cast<std::size_t>(count), 0);
#pragma omp parallel for schedule(static) if (count > 1000)
  for (int v = 0; v < count; ++v)
    if (const std::optional<Star> star = star_of(*cloth.surface, v)) clean[v] = is_clean(*star, cloth, v, reach);
  return clean;
}

}  // namespace selvedge
