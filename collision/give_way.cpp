#include "collision/give_way.hpp"

#include <algorithm>
#include <cmath>

#include "collision/cell_grid.hpp"
#include "collision/disjoint_sets.hpp"
#include "collision/intersections.hpp"
#include "collision/untangle.hpp"

namespace selvedge {
namespace {

constexpr double opposed = -0.3;   // cosine of two normals, at most, of surfaces that face each other
constexpr double closer = 0.5;     // of their distance at rest: what is nearer has come together
constexpr double rest_room = 0.3;  // of that distance: the room asked for at most, for a fold has a bottom
constexpr double deepest = 0.7;    // of a part's thickness, that another is in it: beyond, it comes out behind
constexpr int sweeps = 12, press_rings = 6;
constexpr double smoothing = 0.5;
constexpr int mend_rings = 1;        // round what crosses, that are mended together
constexpr int few = 60, many = 250;  // pairs in one place: worth mending once pressed, as skinned
constexpr double overshoot = 1.5;    // of the farthest way, by mending
constexpr int mend_iterations = 40;
constexpr double mend_gap = 0.1, mend_far = 0.5;  // in mean edge lengths

// How thick the body is under each vertex: to the nearest one behind it that looks the other way, at most `most` [m].
std::vector<double> thicknesses(const Surface& body, const Points& x, double most) {
  const Points normals = vertex_normals(body, x);
  const CellGrid grid(x, most / 2);
  std::vector<double> thickness(static_cast<std::size_t>(body.vertex_count), most);
  for (int v = 0; v < body.vertex_count; ++v)
    grid.for_each_near(row(x, v), most, [&](int w) {
      const Vec3 way = row(x, v) - row(x, w);
      const double distance = way.norm(), deep = way.dot(row(normals, v));
      if (distance < thickness[v] && deep > 0.7 * distance && row(normals, w).dot(row(normals, v)) < opposed)
        thickness[v] = distance;
    });
  return thickness;
}

// Marked vertices that hang together along edges or by a pair of triangles.
std::vector<std::vector<int>> places_of(const std::vector<char>& marked, const Surface& body,
                                        const std::vector<std::pair<int, int>>& pairs) {
  DisjointSets sets(body.vertex_count);
  const auto join = [&](int a, int b) {
    if (marked[a] && marked[b]) sets.join(a, b);
  };
  for (const auto& edge : body.edges.rowwise()) join(edge[0], edge[1]);
  for (const auto& [a, b] : pairs) join(body.triangles(a, 0), body.triangles(b, 0));
  std::vector<std::vector<int>> places;
  std::vector<int> number(marked.size(), -1);
  for (int v = 0; v < body.vertex_count; ++v) {
    if (!marked[v]) continue;
    int& place = number[sets.root(v)];
    if (place < 0) {
      place = static_cast<int>(places.size());
      places.emplace_back();
    }
    places[place].push_back(v);
  }
  return places;
}

// The triangles among some vertices.
Surface part_of(const Surface& body, const std::vector<int>& vertices) {
  std::vector<int> number(body.vertex_count, -1);
  for (std::size_t i = 0; i < vertices.size(); ++i) number[vertices[i]] = static_cast<int>(i);
  Triangles triangles(body.triangles.rows(), 3);
  int count = 0;
  for (const auto& corners : body.triangles.rowwise()) {
    const Eigen::RowVector3i t(number[corners[0]], number[corners[1]], number[corners[2]]);
    if (t.minCoeff() >= 0) triangles.row(count++) = t;
  }
  return make_surface(static_cast<int>(vertices.size()), triangles.topRows(count));
}

}  // namespace

GiveWay::GiveWay(Surface body, const Points& rest, const GiveWayOptions& options)
    : body_(std::move(body)),
      shape_(keep_shape(body_, rest)),
      options_(options),
      thickness_(thicknesses(body_, rest, 2 * options.most + options.room)) {}

// The nearest vertex of a part that faces it and that was farther at rest; -1: none.
int GiveWay::facing(int v, const CellGrid& grid, const Points& x, const Points& normals) const {
  const double reach = 2 * options_.most + options_.room;
  int found = -1;
  double nearest = reach * reach;
  grid.for_each_near(row(x, v), reach, [&](int w) {
    const Vec3 way = row(x, v) - row(x, w);
    const double square = way.squaredNorm();
    if (square >= nearest || row(normals, w).dot(row(normals, v)) > opposed) return;
    const double thin = deepest * std::min(thickness_[v], thickness_[w]);
    if (square >= thin * thin && way.dot(row(normals, w)) < 0) return;
    if (square >= closer * closer * (shape_.x0.row(v) - shape_.x0.row(w)).squaredNorm()) return;
    nearest = square;
    found = w;
  });
  return found;
}

std::vector<GiveWay::Meeting> GiveWay::meetings(const Points& x) const {
  const Points normals = vertex_normals(body_, x);
  const CellGrid grid(x, options_.most + options_.room / 2);
  std::vector<Meeting> found;
  for (int v = 0; v < body_.vertex_count; ++v) {
    const int w = facing(v, grid, x, normals);
    if (w < 0) continue;
    const Vec3 apart = (row(normals, w) - row(normals, v)).normalized(), way = row(x, v) - row(x, w);
    const double gap = way.dot(apart), aside = (way - gap * apart).norm();
    const double least = std::min(options_.room, rest_room * (shape_.x0.row(v) - shape_.x0.row(w)).norm());
    // What passes it by, an edge or more aside, is not over it; either goes half the way.
    const double share = 0.5 * std::clamp(2 - aside / shape_.edge_length[v], 0.0, 1.0);
    if (gap < least && share > 0) found.push_back({v, w, apart, least, share});
  }
  return found;
}

// Each vertex of a meeting goes its share, and what lies round it goes along, less and less.
Points GiveWay::pressed(const Points& x) const {
  const std::vector<Meeting> found = meetings(x);
  if (found.empty()) return x;
  std::vector<char> meets(static_cast<std::size_t>(body_.vertex_count), 0);
  for (const Meeting& m : found) meets[m.vertex] = 1;
  const std::vector<char> near = within_rings(shape_, meets, press_rings);
  std::vector<int> moving;
  for (int v = 0; v < body_.vertex_count; ++v)
    if (near[v]) moving.push_back(v);
  Points to = x;
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    smooth_displacement(shape_, x, moving, smoothing, to);
    const Points from = to;
    for (const Meeting& m : found) {
      const double missing = m.least - m.apart.dot(row(from, m.vertex) - row(from, m.partner));
      if (missing <= 0) continue;
      const Vec3 way = row(from, m.vertex) + m.share * missing * m.apart - row(x, m.vertex);
      to.row(m.vertex) = (row(x, m.vertex) + way * std::min(1.0, options_.most / way.norm())).transpose();
    }
  }
  return to;
}

// Untangles a place and what lies round it; false, and nothing done, where it stays tangled or goes too far.
bool GiveWay::mend(const std::vector<int>& place, const Points& from, const Points& x, Points& result) const {
  UntangleOptions mending;
  mending.iterations = mend_iterations;
  mending.gap = mend_gap;
  mending.far_limit = mend_far;
  const UntangleResult parted = untangle(part_of(body_, place), from(place, Eigen::all), {}, mending);
  const double way = (parted.x - x(place, Eigen::all)).rowwise().norm().maxCoeff();
  if (parted.pairs_after > 0 || way > overshoot * options_.most) return false;
  result(place, Eigen::all) = parted.x;
  return true;
}

Points GiveWay::operator()(const Points& x) const {
  Points result = pressed(x);
  IntersectionCache cache;
  const auto left = intersecting_pairs(body_, result, cache);
  if (left.empty()) return result;
  auto pairs = intersecting_pairs(body_, x, cache);
  std::vector<char> crosses(static_cast<std::size_t>(body_.vertex_count), 0);
  std::vector<int> was(crosses.size(), 0), is(crosses.size(), 0);
  for (const auto& [a, b] : pairs) ++was[body_.triangles(a, 0)];
  for (const auto& [a, b] : left) ++is[body_.triangles(a, 0)];
  pairs.insert(pairs.end(), left.begin(), left.end());
  for (const auto& [a, b] : pairs)
    for (const int t : {a, b})
      for (const int v : body_.triangles.row(t)) crosses[v] = 1;
  for (const std::vector<int>& core : places_of(within_rings(shape_, crosses, mend_rings), body_, pairs)) {
    int before = 0, after = 0;
    std::vector<char> marked(crosses.size(), 0);
    for (const int v : core) {
      before += was[v];
      after += is[v];
      marked[v] = 1;
    }
    if (after == 0) continue;
    const std::vector<char> near = within_rings(shape_, marked, press_rings);
    std::vector<int> place;
    for (int v = 0; v < body_.vertex_count; ++v)
      if (near[v]) place.push_back(v);
    if (after <= few && mend(place, Points(result), x, result)) continue;
    if (before <= many && mend(place, x, x, result)) continue;
    if (after > before) result(place, Eigen::all) = x(place, Eigen::all);
  }
  return result;
}

}  // namespace selvedge
