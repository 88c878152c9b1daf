#include "collision/untangle/give_way.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>

#include "collision/geometry/cell_grid.hpp"
#include "collision/geometry/disjoint_sets.hpp"
#include "collision/geometry/stop_scope.hpp"
#include "collision/search/intersections.hpp"
#include "collision/untangle/facing.hpp"
#include "collision/untangle/input_shape.hpp"
#include "collision/untangle/untangle.hpp"

namespace selvedge {
namespace {

using Pairs = std::vector<std::pair<int, int>>;  // of triangles that cross

// The thickness of the body under each vertex: the distance to the nearest vertex behind it that faces the other way,
// at most `most` [m].
std::vector<double> thicknesses(const Surface& body, const Points& x, double most, double through) {
  const Points normals = vertex_normals(body, x);
  const CellGrid grid(x, most / 2);
  std::vector<double> thickness(static_cast<std::size_t>(body.vertex_count), most);
  for (int v = 0; v < body.vertex_count; ++v)
    grid.for_each_near(row(x, v), most, [&](int w) {
      const Vec3 offset = row(x, v) - row(x, w);
      const double distance = offset.norm(), deep = offset.dot(row(normals, v));
      if (distance < thickness[v] && deep > through * distance && row(normals, w).dot(row(normals, v)) < facing_cosine)
        thickness[v] = distance;
    });
  return thickness;
}

// The triangles with all corners among these vertices, renumbered.
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

// Caches for detection. Calls at one time have one each; a later call finds a tree that fits a pose like its own.
class CrossingCaches {
 public:
  IntersectionCache take(const IntersectionCache& otherwise) {
    const std::lock_guard lock(mutex_);
    if (idle_.empty()) return otherwise;
    IntersectionCache cache = std::move(idle_.back());
    idle_.pop_back();
    return cache;
  }
  void give_back(IntersectionCache cache) {
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(cache));
  }

 private:
  std::mutex mutex_;
  std::vector<IntersectionCache> idle_;
};

// What depends only on the body at rest.
struct SoftTissue {
  SoftTissue(const Surface& surface, const Points& rest, const GiveWayOptions& o)
      : body(surface),
        shape(input_shape(body, rest)),
        options(o),
        reach(2 * o.most + o.room),
        thickness(thicknesses(body, rest, reach, o.through)) {
    intersecting_pairs(body, rest, at_rest);
  }
  SoftTissue(const SoftTissue&) = delete;
  SoftTissue& operator=(const SoftTissue&) = delete;

  const Surface& body;
  InputShape shape;
  GiveWayOptions options;
  double reach;                   // largest distance of vertices that meet: both move by `most` and leave room [m]
  std::vector<double> thickness;  // under each vertex [m]
  IntersectionCache at_rest;      // its tree is refitted for poses
  mutable CrossingCaches caches;
};

namespace {

// A vertex and the vertex of another part of the body that it meets.
struct Meeting {
  int vertex, partner;
  Vec3 apart;    // direction of its motion, unit length
  double least;  // distance wanted along it [m]
  double share;  // of the missing distance by which the vertex moves
};

double gap_of(const Meeting& m, const Points& x) { return m.apart.dot(row(x, m.vertex) - row(x, m.partner)); }

// A body in a pose and the vertices that meet in it.
struct Meetings {
  Facing facing;
  std::vector<Meeting> close;
};

// `before`, of a pose from which few vertices have moved, saves time.
Meetings meetings(const SoftTissue& tissue, const Points& x, const Facing* before) {
  const Points& rest = tissue.shape.x0;
  Meetings met{facing_vertices({rest, tissue.thickness, tissue.reach}, x, vertex_normals(tissue.body, x), before), {}};
  const Points& normals = met.facing.normals;
  for (int v = 0; v < tissue.body.vertex_count; ++v) {
    const int w = met.facing.partner[v];
    if (w < 0) continue;
    const Vec3 apart = (row(normals, w) - row(normals, v)).normalized(), offset = row(x, v) - row(x, w);
    const double gap = offset.dot(apart), aside = (offset - gap * apart).norm();
    const double least = std::min(tissue.options.room, tissue.options.rest_room * (rest.row(v) - rest.row(w)).norm());
    // Each moves half of what is missing; less if it is beside the other, from an edge to two edges off.
    const double share = 0.5 * std::clamp(2 - aside / tissue.shape.edge_length[v], 0.0, 1.0);
    if (gap < least && share > 0) met.close.push_back({v, w, apart, least, share});
  }
  return met;
}

// The marked vertices and those round them that move along.
std::vector<int> with_surroundings(const SoftTissue& tissue, const std::vector<char>& marked) {
  const std::vector<char> near = within_rings(tissue.shape, marked, tissue.options.press_rings);
  std::vector<int> vertices;
  for (std::size_t v = 0; v < near.size(); ++v)
    if (near[v]) vertices.push_back(static_cast<int>(v));
  return vertices;
}

// Moves each vertex of a meeting from x by its share. Its distance from the skinned position stays below `most`, or
// below what it was in x. Vertices round it move along, less with distance.
Points pressed(const SoftTissue& tissue, const Points& skinned, const Points& x, const std::vector<Meeting>& found) {
  if (found.empty()) return x;
  std::vector<char> meets(static_cast<std::size_t>(tissue.body.vertex_count), 0);
  for (const Meeting& m : found) meets[m.vertex] = 1;
  const std::vector<int> moving = with_surroundings(tissue, meets);
  Points to = x;
  for (int sweep = 0; sweep < tissue.options.press_sweeps; ++sweep) {
    check_stop();
    smooth_displacement(tissue.shape, x, moving, tissue.options.smoothing, to);
    const Points from = to;
    for (const Meeting& m : found) {
      const double missing = m.least - gap_of(m, from);
      if (missing <= 0) continue;
      const Vec3 at = row(skinned, m.vertex), displacement = row(from, m.vertex) + m.share * missing * m.apart - at;
      const double most = std::max(tissue.options.most, (row(x, m.vertex) - at).norm());
      to.row(m.vertex) = (at + displacement * std::min(1.0, most / displacement.norm())).transpose();
    }
  }
  return to;
}

// A place where a pressed body still crosses itself.
struct Place {
  std::vector<int> vertices;        // that cross, skinned or pressed, and those round them
  std::ptrdiff_t skinned, pressed;  // how many pairs of triangles cross there
};

// Crossing triangles that are connected, along edges or by a pair, are one place.
std::vector<Place> places_of(const SoftTissue& tissue, const Pairs& skinned, const Pairs& pressed) {
  const Surface& body = tissue.body;
  DisjointSets sets(body.vertex_count);
  std::vector<char> crosses(static_cast<std::size_t>(body.vertex_count), 0);
  for (const Pairs* pairs : {&skinned, &pressed})
    for (const auto& [a, b] : *pairs) {
      sets.join(body.triangles(a, 0), body.triangles(b, 0));
      for (const int t : {a, b})
        for (const int v : body.triangles.row(t)) crosses[v] = 1;
    }
  const std::vector<char> near = within_rings(tissue.shape, crosses, tissue.options.mend_rings);
  for (const auto& edge : body.edges.rowwise())
    if (near[edge[0]] && near[edge[1]]) sets.join(edge[0], edge[1]);
  std::vector<Place> places;
  for (int root = 0; root < body.vertex_count; ++root) {
    if (!near[root] || sets.root(root) != root) continue;
    check_stop();
    const auto is_here = [&](const auto& pair) { return sets.root(body.triangles(pair.first, 0)) == root; };
    std::vector<char> core(near.size());
    for (int v = 0; v < body.vertex_count; ++v) core[v] = sets.root(v) == root;
    const auto left = std::ranges::count_if(pressed, is_here);
    if (left > 0) places.push_back({with_surroundings(tissue, core), std::ranges::count_if(skinned, is_here), left});
  }
  return places;
}

// A place untangled by itself, starting at `from`; none if it stays tangled or a vertex ends too far from x.
std::optional<Points> mended(const SoftTissue& tissue, const Place& place, const Points& from, const Points& x) {
  UntangleOptions mending;
  mending.iterations = tissue.options.mend_iterations;
  mending.gap = tissue.options.mend_gap;
  mending.far_limit = tissue.options.mend_far;
  const UntangleResult parted =
      untangle(part_of(tissue.body, place.vertices), from(place.vertices, Eigen::all), {}, mending);
  const double farthest = (parted.x - x(place.vertices, Eigen::all)).rowwise().norm().maxCoeff();
  if (parted.pairs_after > 0 || farthest > tissue.options.overshoot * tissue.options.most) return {};
  return parted.x;
}

// Presses again where there is too little room: mending leaves hardly any, and vertices that came from deep inside may
// meet others than at first. If this makes crossings in a small spot, as at the bottom of a fold, the spot is mended.
// Larger places are pressed less, or stay as they were.
Points opened(const SoftTissue& tissue, const Points& skinned, const Points& x, const std::vector<Meeting>& found,
              const Pairs& left, IntersectionCache& cache) {
  Points to = pressed(tissue, skinned, x, found);
  for (int halving = 0; halving <= tissue.options.press_halvings; ++halving) {
    const Pairs anew = intersecting_pairs(tissue.body, to, cache);
    if (anew.size() <= left.size()) return to;
    const double share = halving < tissue.options.press_halvings ? 0.5 : 0;
    for (const Place& place : places_of(tissue, left, anew)) {
      std::optional<Points> better;
      if (place.pressed <= tissue.options.mend_spot) better = mended(tissue, place, to, skinned);
      if (!better) {
        const Points from = x(place.vertices, Eigen::all);
        better = from + share * (to(place.vertices, Eigen::all) - from);
      }
      to(place.vertices, Eigen::all) = *better;
    }
  }
  return intersecting_pairs(tissue.body, to, cache).size() <= left.size() ? to : x;
}

// Meetings with a gap near zero, positive or negative, of vertices that have moved.
std::vector<Meeting> pinches_of(const SoftTissue& tissue, const std::vector<Meeting>& found, const Points& x,
                                const Points& to) {
  const double pinched = tissue.options.pinched_part * tissue.options.room;
  const auto moves = [&](int v) { return to.row(v) != x.row(v); };
  std::vector<Meeting> pinches = found;
  std::erase_if(pinches, [&](const Meeting& m) {
    return std::abs(gap_of(m, to)) > pinched || m.least < tissue.options.room / 2 ||
           !(moves(m.vertex) || moves(m.partner));
  });
  return pinches;
}

// Sets of vertices that move together: moving vertices along edges, and vertices that meet.
DisjointSets moved_together(const SoftTissue& tissue, const Points& from, const Points& to,
                            std::initializer_list<const std::vector<Meeting>*> meetings) {
  const auto moves = [&](int v) { return to.row(v) != from.row(v); };
  DisjointSets sets(tissue.body.vertex_count);
  for (const auto& edge : tissue.body.edges.rowwise())
    if (moves(edge[0]) && moves(edge[1])) sets.join(edge[0], edge[1]);
  for (const std::vector<Meeting>* met : meetings)
    for (const Meeting& m : *met) sets.join(m.vertex, m.partner);
  return sets;
}

// The body pressed from `once` to `twice`. Sets that move together and get more pinches stay as in `once`, and so does
// the whole body if more than `most_pairs` pairs would cross.
Meetings where_it_opens(const SoftTissue& tissue, const Points& skinned, const Meetings& once, const Points& twice,
                        std::size_t most_pairs, IntersectionCache& cache) {
  const Points& x = once.facing.x;
  Meetings next = meetings(tissue, twice, &once.facing);
  DisjointSets sets = moved_together(tissue, x, twice, {&once.close, &next.close});
  Eigen::VectorXi more = Eigen::VectorXi::Zero(tissue.body.vertex_count);  // pinches, by set
  for (const Meeting& m : pinches_of(tissue, once.close, skinned, x)) --more[sets.root(m.vertex)];
  for (const Meeting& m : pinches_of(tissue, next.close, skinned, twice)) ++more[sets.root(m.vertex)];
  if (more.maxCoeff() <= 0) return next;
  Points to = twice;
  for (int v = 0; v < tissue.body.vertex_count; ++v)
    if (more[sets.root(v)] > 0) to.row(v) = x.row(v);
  if (to == x || intersecting_pairs(tissue.body, to, cache).size() > most_pairs) return once;
  return meetings(tissue, to, &next.facing);
}

// If hardly any room is left between parts over some area, faces that touch would hold cloth that has no room. There
// vertices that move together give way less, so that the parts pass through each other. Returns whether any do.
bool let_through(const SoftTissue& tissue, const std::vector<Meeting>& pinches, const Points& x, Points& to) {
  const double pinched = tissue.options.pinched_part * tissue.options.room;
  if (static_cast<int>(pinches.size()) < tissue.options.many_pinched) return false;
  DisjointSets sets = moved_together(tissue, x, to, {&pinches});
  Eigen::VectorXi count = Eigen::VectorXi::Zero(tissue.body.vertex_count);  // pinches, by set
  Eigen::VectorXd share = Eigen::VectorXd::Ones(tissue.body.vertex_count);  // of its displacements
  for (const Meeting& m : pinches) {
    const double now = gap_of(m, to), skinned = gap_of(m, x);
    const int set = sets.root(m.vertex);
    ++count[set];
    if (now > skinned) share[set] = std::min(share[set], std::clamp((-pinched - skinned) / (now - skinned), 0.0, 1.0));
  }
  for (int v = 0; v < tissue.body.vertex_count; ++v)
    if (const int set = sets.root(v); count[set] >= tissue.options.many_pinched)
      to.row(v) = (x.row(v) + share[set] * (to.row(v) - x.row(v))).eval();
  return count.maxCoeff() >= tissue.options.many_pinched;
}

}  // namespace

// The soft tissue is made by the first pose: a run whose poses are all known from a store needs none.
class GiveWay::Rest {
 public:
  Rest(Surface body, const Points& x, const GiveWayOptions& options)
      : body_(std::move(body)), x_(x), options_(options) {}
  const SoftTissue& tissue() {
    std::call_once(once_, [&] { made_.emplace(body_, x_, options_); });
    return *made_;
  }

 private:
  const Surface body_;
  const Points x_;
  const GiveWayOptions options_;
  std::once_flag once_;
  std::optional<SoftTissue> made_;
};

GiveWay::GiveWay(Surface body, const Points& rest, const GiveWayOptions& options)
    : rest_(std::make_shared<Rest>(std::move(body), rest, options)) {}

// Presses parts apart where they meet. Places that still cross are untangled one by one: from the pressed shape, or
// from the skinned one, or else left in the one with fewer crossings. Then presses for more room, where this makes no
// further pinches.
Points GiveWay::operator()(const Points& x, bool* apart) const {
  const SoftTissue& tissue = rest_->tissue();
  Meetings body = meetings(tissue, x, nullptr);
  Points to = pressed(tissue, x, x, body.close);
  IntersectionCache cache = tissue.caches.take(tissue.at_rest);
  Pairs left = intersecting_pairs(tissue.body, to, cache);
  if (!left.empty()) {
    for (const Place& place : places_of(tissue, intersecting_pairs(tissue.body, x, cache), left)) {
      std::optional<Points> better;
      if (place.pressed <= tissue.options.mend_pressed) better = mended(tissue, place, to, x);
      if (!better && place.skinned <= tissue.options.mend_skinned) better = mended(tissue, place, x, x);
      if (!better && place.pressed > place.skinned) better = x(place.vertices, Eigen::all);
      if (better) to(place.vertices, Eigen::all) = *better;
    }
    left = intersecting_pairs(tissue.body, to, cache);
  }
  if (to != x) body = meetings(tissue, to, &body.facing);
  const auto is_tight = [&](const Meeting& m) {
    return gap_of(m, to) < tissue.options.tight_part * m.least &&
           (row(to, m.vertex) - row(x, m.vertex)).norm() < tissue.options.tight_part * tissue.options.most;
  };
  for (int press = 0; press < tissue.options.presses && std::ranges::any_of(body.close, is_tight); ++press) {
    const Points more = opened(tissue, x, to, body.close, left, cache);
    body = where_it_opens(tissue, x, body, more, left.size(), cache);
    if (body.facing.x == to) break;
    to = body.facing.x;
  }
  tissue.caches.give_back(std::move(cache));
  const bool through = let_through(tissue, pinches_of(tissue, body.close, x, to), x, to);
  if (apart) *apart = left.empty() && !through;  // presses add no pairs to those that are left
  return to;
}

}  // namespace selvedge
