#include "collision/untangle/untangle.hpp"

#include <algorithm>
#include <deque>
#include <limits>

#include "collision/contour/buried.hpp"
#include "collision/contour/find_contours.hpp"
#include "collision/geometry/floating_point.hpp"
#include "collision/geometry/stop_scope.hpp"
#include "collision/search/bvh.hpp"
#include "collision/untangle/input_shape.hpp"
#include "collision/untangle/let_through.hpp"
#include "collision/untangle/repulsion.hpp"
#include "collision/untangle/separation.hpp"

namespace selvedge {
namespace {

struct Tangle {
  Segments found;
  std::vector<Contour> contours;
  std::vector<Region> regions;
  std::vector<char> enclosed;  // vertices of the cloth on the wrong side
  int pairs = 0, vertex_pairs = 0;
  int inside = 0;     // vertices inside closed obstacles, with or without contours
  double length = 0;  // of all contours [m]
  double merit = 0;   // length, plus a mean edge for each vertex inside a closed obstacle [m]

  int wrong() const { return pairs + vertex_pairs + inside; }
  bool clean() const { return wrong() == 0; }
  bool better_than(const Tangle& other) const {
    return wrong() != other.wrong() ? wrong() < other.wrong() : merit < other.merit;
  }
};

std::vector<SheetView> with_cloth(const Surface& cloth, const Points& x, std::span<const SheetView> obstacles) {
  std::vector<SheetView> sheets{{&cloth, &x}};
  sheets.insert(sheets.end(), obstacles.begin(), obstacles.end());
  return sheets;
}

// Obstacles with their trees and buried triangles. Both are made once, since obstacles stand still.
struct StillObstacles {
  std::vector<Bvh> trees;
  std::vector<std::vector<char>> buried;
  std::vector<SheetView> views;

  explicit StillObstacles(std::span<const SheetView> obstacles) : views(obstacles.begin(), obstacles.end()) {
    std::vector<Box> boxes;
    for (const SheetView& obstacle : obstacles) {
      triangle_boxes(*obstacle.surface, *obstacle.x, *obstacle.x, 0, boxes);
      trees.push_back(build_bvh(boxes));
    }
    for (std::size_t k = 0; k < trees.size(); ++k) {
      views[k].tree = &trees[k];
      buried.push_back(buried_triangles(*views[k].surface, *views[k].x, find_segments({&views[k], 1})));
    }
  }
  StillObstacles(const StillObstacles&) = delete;  // the views point to the trees
  StillObstacles& operator=(const StillObstacles&) = delete;
};

Segments segments_that_count(std::span<const SheetView> sheets, const UntangleOptions& options) {
  Segments found = find_segments(sheets);
  drop_let_through(sheets, options.let_through, found);
  return found;
}

// found: from segments_that_count.
Tangle tangle_of(std::span<const SheetView> sheets, Segments found, const InputShape& shape,
                 const UntangleOptions& options) {
  const std::vector<int>& layers = options.layers;
  const std::vector<char>& through = options.let_through;
  Tangle tangle;
  tangle.found = std::move(found);
  tangle.contours = find_contours(sheets, tangle.found);
  tangle.regions = enclosed_regions(sheets, tangle.found, tangle.contours);
  if (!layers.empty()) order_layers(sheets, tangle.found, tangle.contours, layers, tangle.regions);
  tangle.pairs = intersecting_pairs(tangle.found);
  for (const Segment& segment : tangle.found.segments) tangle.vertex_pairs += segment.at_vertex();
  for (const Contour& contour : tangle.contours) tangle.length += contour.length;
  std::vector<char> inside = inside_obstacles(sheets);
  for (std::size_t v = 0; v < through.size(); ++v) inside[v] = inside[v] && !through[v];
  for (Region& region : tangle.regions)
    if (region.sheet == 0 && region.partner_sheet != 0 && !through.empty())
      std::erase_if(region.vertices, [&](int v) { return through[v] != 0; });
  tangle.inside = static_cast<int>(std::count(inside.begin(), inside.end(), 1));
  tangle.merit = tangle.length + tangle.inside * shape.mean_edge;
  tangle.enclosed = inside;
  for (const Region& region : tangle.regions)
    if (region.sheet == 0)
      for (int v : region.vertices) tangle.enclosed[v] = 1;
  return tangle;
}

// Vertices of the cloth on contours, in touching triangles, or enclosed.
std::vector<char> tangled_vertices(std::span<const SheetView> sheets, const Tangle& tangle) {
  std::vector<char> marked = tangle.enclosed;
  const auto mark = [&](int t) {
    for (int v : sheets[0].surface->triangles.row(t)) marked[v] = 1;
  };
  for (const Contour& contour : tangle.contours)
    for (const ContourSide& side : contour.sides)
      if (side.sheet == 0)
        for (int t : side.triangles) mark(t);
  for (const auto& [a, sheet, b] : tangle.found.touching) {
    mark(a);
    if (sheet == 0) mark(b);
  }
  return marked;
}

void satisfy(std::span<const Separation> separations, const std::vector<double>& reach, Points& x) {
  for (const Separation& s : separations) {
    double value = 0, square = 0;
    for (int i = 0; i < s.count; ++i) {
      value += s.weight[i] * s.direction.dot(row(x, s.vertex[i]));
      if (reach[s.vertex[i]] > 0) square += s.weight[i] * s.weight[i];
    }
    if (value >= s.least || square == 0) continue;
    // Limits the motion where only a node with a small weight may move.
    const double size = (s.least - value) / std::max(square, 0.1);
    for (int i = 0; i < s.count; ++i)
      if (reach[s.vertex[i]] > 0) x.row(s.vertex[i]) += size * s.weight[i] * s.direction.transpose();
  }
}

// Which vertices may move, and how far from the input [m].
struct Freedom {
  std::vector<double> reach;
  std::vector<int> vertices, triangles;
};

// The unit of far_limit: a vertex' own mean edge, or the mesh's if that is shorter [m].
double far_unit(const InputShape& shape, int vertex) { return std::min(shape.edge_length[vertex], shape.mean_edge); }

// The triangles with a vertex that counts.
template <class Counts>
std::vector<int> triangles_at(const Surface& surface, const Counts& counts) {
  std::vector<int> triangles;
  for (int t = 0; t < surface.triangles.rows(); ++t)
    if (std::ranges::any_of(surface.triangles.row(t), counts)) triangles.push_back(t);
  return triangles;
}

Freedom make_freedom(const InputShape& shape, const std::vector<char>& tangled, const UntangleOptions& options) {
  const std::vector<char> near = within_rings(shape, tangled, options.rings);
  const std::vector<char> around = within_rings(shape, near, 2 * options.rings);
  Freedom freedom;
  freedom.reach.assign(shape.surface->vertex_count, 0);
  for (int v = 0; v < shape.surface->vertex_count; ++v) {
    if (!around[v] || (!options.held.empty() && options.held[v])) continue;
    freedom.reach[v] = near[v] ? std::numeric_limits<double>::infinity() : options.far_limit * far_unit(shape, v);
    freedom.vertices.push_back(v);
  }
  freedom.triangles = triangles_at(*shape.surface, [&](int v) { return around[v] != 0; });
  return freedom;
}

// Vertices round contours that are new since the start may move by far_limit too.
void widen(const InputShape& shape, const std::vector<char>& tangled, const UntangleOptions& options,
           Freedom& freedom) {
  const Freedom more = make_freedom(shape, tangled, options);
  bool wider = false;
  for (int v : more.vertices)
    if (freedom.reach[v] == 0) {
      freedom.reach[v] = options.far_limit * far_unit(shape, v);
      freedom.vertices.push_back(v);
      wider = true;
    }
  if (!wider) return;
  std::sort(freedom.vertices.begin(), freedom.vertices.end());
  freedom.triangles = triangles_at(*shape.surface, [&](int v) { return freedom.reach[v] > 0; });
}

Points propose(const InputShape& shape, const Freedom& freedom, std::span<const Separation> separations,
               std::span<const Separation> repulsions, const UntangleOptions& options, const Points& from) {
  const StretchRange range{options.least_stretch, options.largest_stretch};
  Points x = from;
  for (int i = 0; i < options.sweeps; ++i) {
    check_stop();
    smooth_displacement(shape, shape.x0, freedom.vertices, 0.3, x);
    limit_stretch(shape, freedom.triangles, freedom.reach, range, x);
    satisfy(repulsions, freedom.reach, x);
    satisfy(separations, freedom.reach, x);
    limit_displacement(shape, freedom.vertices, freedom.reach, x);
  }
  for (int i = 0; i < 10; ++i) {
    check_stop();
    limit_stretch(shape, freedom.triangles, freedom.reach, range, x);
    limit_displacement(shape, freedom.vertices, freedom.reach, x);
  }
  return x;
}

// Moves vertices back toward `before` until no pair meets whose vertices were all untangled there, and stretches are in
// range. Returns the tangle of x.
Tangle keep_clean(const InputShape& shape, const Freedom& freedom, std::span<const SheetView> obstacles,
                  const std::vector<char>& tangled, const UntangleOptions& options, const Points& before, Points& x) {
  const Surface& cloth = *shape.surface;
  const StretchRange range{0.97 * options.least_stretch, 1.03 * options.largest_stretch};
  std::vector<char> offends(cloth.vertex_count, 0);
  for (int round = 0;; ++round) {
    hold_back(shape, freedom.triangles, range, before, x);
    const std::vector<SheetView> sheets = with_cloth(cloth, x, obstacles);
    Segments found = segments_that_count(sheets, options);
    bool clean = true;
    const auto judge = [&](int a, int sheet, int b) {
      std::vector<int> vertices;
      for (int v : cloth.triangles.row(a)) vertices.push_back(v);
      if (sheet == 0)
        for (int v : cloth.triangles.row(b)) vertices.push_back(v);
      if (std::any_of(vertices.begin(), vertices.end(), [&](int v) { return tangled[v] != 0; })) return;
      for (int v : vertices) {
        clean = clean && x.row(v) == before.row(v);
        offends[v] = 1;
      }
    };
    for (const Segment& s : found.segments) judge(s.triangle[0], s.sheet[1], s.triangle[1]);
    for (const auto& [a, sheet, b] : found.touching) judge(a, sheet, b);
    if (clean) return tangle_of(sheets, std::move(found), shape, options);
    take_back(offends, round, before, x);
  }
}

// Lets stretched triangles of a clean cloth recover their shape as far as that makes no new contours.
void relax(const InputShape& shape, const Freedom& freedom, std::span<const SheetView> obstacles, Repulsion& repulsion,
           const UntangleOptions& options, Points& x) {
  const std::vector<char> none(shape.surface->vertex_count, 0);
  UntangleOptions tighter = options;
  tighter.least_stretch = std::max(options.least_stretch, 0.75);
  tighter.largest_stretch = std::min(options.largest_stretch, 1.35);
  for (int i = 0; i < options.relaxations; ++i) {
    const StretchRange now = extreme_stretch(shape, x);
    if (now.least >= tighter.least_stretch && now.largest <= tighter.largest_stretch) return;
    std::vector<Separation> repulsions =
        repulsion.find(x, none, freedom.reach, options.gap * shape.mean_edge, options.horizon * shape.mean_edge, false);
    drop_let_through(options.let_through, repulsions);
    Points next = propose(shape, freedom, {}, repulsions, tighter, x);
    if (!keep_clean(shape, freedom, obstacles, none, options, x, next).clean()) return;
    x = next;
  }
}

void measure(const InputShape& shape, const std::vector<char>& near, UntangleResult& result) {
  double sum = 0;
  for (int v = 0; v < shape.surface->vertex_count; ++v) {
    const double moved = (result.x.row(v) - shape.x0.row(v)).norm();
    if (!near[v] && shape.edge_length[v] > 0) result.far_move = std::max(result.far_move, moved / far_unit(shape, v));
    if (moved <= 1e-6 * shape.mean_edge) continue;
    ++result.moved;
    sum += moved / shape.mean_edge;
    result.max_move = std::max(result.max_move, moved / shape.mean_edge);
  }
  result.mean_edge = shape.mean_edge;
  if (result.moved > 0) result.mean_move = sum / result.moved;
  const StretchRange stretch = extreme_stretch(shape, result.x);
  result.least_stretch = stretch.least;
  result.largest_stretch = stretch.largest;
}

struct Attempt {
  Points x;  // the best state so far
  Tangle tangle;
  Freedom freedom;
  int iterations = 0;
};

// Untangles from the input. wide: the second rule of repulsion, without pairs that have a tangled vertex.
Attempt attempt(const InputShape& shape, const StillObstacles& standing, const Tangle& input, Freedom freedom,
                bool wide, Repulsion& repulsion, const UntangleOptions& options) {
  const Surface& cloth = *shape.surface;
  const std::span<const SheetView> obstacles = standing.views;
  const double gap = options.gap * shape.mean_edge, reach = options.horizon * shape.mean_edge;
  Attempt best{shape.x0, input, {}, 0};
  Points x = shape.x0;
  Tangle tangle = input;
  std::deque<double> merits{tangle.merit};
  int iteration = 0;
  for (int since_best = 0; iteration < options.iterations && !tangle.clean() && since_best < options.patience;
       ++iteration) {
    if (stopped(options.stop)) break;
    if (options.progress) options.progress({iteration, tangle.pairs, tangle.length});
    const std::vector<SheetView> sheets = with_cloth(cloth, x, obstacles);
    const std::vector<char> tangled = tangled_vertices(sheets, tangle);
    widen(shape, tangled, options, freedom);
    std::vector<Separation> repulsions = repulsion.find(x, tangled, freedom.reach, gap, reach, wide);
    drop_let_through(options.let_through, repulsions);
    const double bound = *std::max_element(merits.begin(), merits.end());
    double step = options.step * shape.mean_edge;
    Points next;
    Tangle after;
    for (int shorter = 0; shorter < 3; ++shorter, step *= 0.4) {
      std::vector<Separation> separations =
          part_contours(sheets, tangle.found, tangle.contours, tangle.regions, {gap, step}, standing.buried);
      drop_let_through(options.let_through, separations);
      next = propose(shape, freedom, separations, repulsions, options, x);
      after = keep_clean(shape, freedom, obstacles, tangled, options, x, next);
      if (after.merit <= bound) break;
    }
    x = next;
    tangle = std::move(after);
    merits.push_back(tangle.merit);
    if (std::ssize(merits) > options.remembered) merits.pop_front();
    ++since_best;
    if (!tangle.better_than(best.tangle)) continue;
    best.tangle = tangle;
    best.x = x;
    since_best = 0;
  }
  best.freedom = std::move(freedom);
  best.iterations = iteration;
  return best;
}

}  // namespace

UntangleResult untangle(const Surface& cloth, const Points& x, std::span<const SheetView> around,
                        const UntangleOptions& options) {
  restore_standard_arithmetic();
  const StillObstacles standing(around);
  const std::span<const SheetView> obstacles = standing.views;
  const InputShape shape = input_shape(cloth, x);
  const std::vector<SheetView> sheets = with_cloth(cloth, x, obstacles);
  const Tangle input = tangle_of(sheets, segments_that_count(sheets, options), shape, options);
  const std::vector<char> tangled = tangled_vertices(sheets, input);
  const Freedom freedom = make_freedom(shape, tangled, options);
  Repulsion repulsion(cloth, obstacles, shape);
  // Where the first rule of repulsion gets stuck, the second may not.
  Attempt best = attempt(shape, standing, input, freedom, false, repulsion, options);
  int iterations = best.iterations;
  if (!best.tangle.clean() && options.second_rule) {
    Attempt other = attempt(shape, standing, input, freedom, true, repulsion, options);
    iterations += other.iterations;
    if (other.tangle.better_than(best.tangle)) best = std::move(other);
  }
  UntangleResult result;
  result.iterations = iterations;
  if (best.tangle.clean())
    relax(shape, best.freedom, obstacles, repulsion, options, best.x);
  else
    result.left = explain_remainders(with_cloth(cloth, best.x, obstacles), best.tangle.found, best.tangle.contours,
                                     shape, best.freedom.reach, {options.least_stretch, options.largest_stretch});
  result.x = std::move(best.x);
  result.pairs_before = input.pairs;
  result.vertex_pairs_before = input.vertex_pairs;
  result.length_before = input.length;
  result.pairs_after = best.tangle.pairs;
  result.vertex_pairs_after = best.tangle.vertex_pairs;
  result.length_after = best.tangle.length;
  measure(shape, within_rings(shape, tangled, options.rings), result);
  return result;
}

}  // namespace selvedge
