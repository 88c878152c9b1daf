#include <catch2/catch.hpp>

#include <limits>
#include <numbers>
#include <random>
#include <set>

#include "collision/audit/audit_pair.hpp"
#include "collision/exact/orientation.hpp"
#include "collision/search/quiet.hpp"
#include "tests/collision/tangles.hpp"

namespace selvedge::test_quiet {

using testing::Tangle;
using testing::tangles;

namespace {

struct Marked {
  Bvh tree;
  QuietParts parts;
};

Marked marked(const Surface& surface, const Points& built_at, const Points& x) {
  Marked m;
  std::vector<Box> boxes;
  triangle_boxes(surface, built_at, built_at, 0, boxes);
  m.tree = build_bvh(boxes);
  find_parts(surface, m.tree, m.parts);
  mark_quiet(surface, x, m.tree, m.parts);
  return m;
}

std::vector<int> triangles_below(const Bvh& tree, int node) {
  if (const int child = tree.nodes[node].child; child >= 0) {
    std::vector<int> all = triangles_below(tree, child), more = triangles_below(tree, child + 1);
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  std::vector<int> items;
  for (const int t : tree.leaves[~tree.nodes[node].child].item)
    if (t >= 0) items.push_back(t);
  return items;
}

// Share more than the edge or the vertex that they have in common?
bool clash(const Tangle& m, int s, int t) {
  const auto corner = [&](int triangle, int k) { return row(m.x, m.surface.triangles(triangle, k % 3)); };
  std::vector<std::pair<int, int>> shared;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (m.surface.triangles(s, i) == m.surface.triangles(t, j)) shared.emplace_back(i, j);
  if (shared.empty())
    return triangles_intersect(corner(s, 0), corner(s, 1), corner(s, 2), corner(t, 0), corner(t, 1), corner(t, 2));
  if (shared.size() == 1) {
    const auto [i, j] = shared[0];
    return triangles_cross_at_vertex(corner(s, i), corner(s, i + 1), corner(s, i + 2), corner(t, j + 1),
                                     corner(t, j + 2));
  }
  return false;
}

// Exact: do two edges of the closed polygon share more than a common end?
bool is_simple(const std::vector<Vec2>& p) {
  const int n = static_cast<int>(p.size());
  const auto in_box = [](const Vec2& q, const Vec2& a, const Vec2& b) {
    return (q.array() >= a.array().min(b.array())).all() && (q.array() <= a.array().max(b.array())).all();
  };
  for (int i = 0; i < n; ++i)
    for (int j = i + 1; j < n; ++j) {
      const Vec2 &a = p[i], &b = p[(i + 1) % n], &c = p[j], &d = p[(j + 1) % n];
      const int oc = orient2d(a, b, c), od = orient2d(a, b, d), oa = orient2d(c, d, a), ob = orient2d(c, d, b);
      if (j == i + 1 || (i == 0 && j == n - 1)) {
        const Vec2 &before = j == i + 1 ? a : c, &corner = j == i + 1 ? b : a, &after = j == i + 1 ? d : b;
        if (orient2d(before, corner, after) == 0 && (corner - before).dot(after - corner) <= 0) return false;
        continue;
      }
      if ((oc == 0 && in_box(c, a, b)) || (od == 0 && in_box(d, a, b)) || (oa == 0 && in_box(a, c, d)) ||
          (ob == 0 && in_box(b, c, d)) || (oc * od < 0 && oa * ob < 0))
        return false;
    }
  return true;
}

}  // namespace

TEST_CASE("quiet: nothing within a quiet part intersects, vertex neighbours included", "[quiet]") {
  int quiet_parts = 0;
  for (const Tangle& m : tangles(16)) {
    INFO(m.name);
    const Marked found = marked(m.surface, m.x, m.x);
    int wrong = 0;
    for (int node = 0; node < static_cast<int>(found.tree.nodes.size()); ++node) {
      if (!found.parts.quiet[node]) continue;
      ++quiet_parts;
      const std::vector<int> triangles = triangles_below(found.tree, node);
      for (std::size_t i = 0; i < triangles.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) wrong += clash(m, triangles[i], triangles[j]);
    }
    CHECK(wrong == 0);
  }
  CHECK(quiet_parts > 20);
}

TEST_CASE("quiet: what is flat is one quiet part, what winds over itself is not", "[quiet]") {
  const std::set<std::string> whole{"flat", "flat and tilted", "wavy", "far away", "sheared"};
  const std::set<std::string> never{
      "folded onto itself", "flat spiral", "shallow spiral", "double cover", "collapsed to a segment",
      "half collapsed",     "tube"};
  int seen = 0;
  for (const Tangle& m : tangles(16)) {
    INFO(m.name);
    const Marked found = marked(m.surface, m.x, m.x);
    if (whole.count(m.name)) CHECK(found.parts.quiet[0] == 1);
    if (never.count(m.name)) CHECK(found.parts.quiet[0] == 0);
    seen += static_cast<int>(whole.count(m.name) + never.count(m.name));
  }
  CHECK(seen == static_cast<int>(whole.size() + never.size()));
}

TEST_CASE("quiet: a boundary that meets itself is seen by the boundary alone", "[quiet]") {
  // The ribbon of the flat spiral, its tree built where it does not wind, so that the root is a disk with one normal.
  const auto ribbon = [](double turns) {
    return testing::grid_surface("ribbon", 64, 2, [=](double u, double v) {
      const double angle = 2 * std::numbers::pi * turns * u, radius = 1 + 0.2 * v;
      return Vec3(radius * std::cos(angle), 0, radius * std::sin(angle));
    });
  };
  const Tangle open = ribbon(0.9), closed = ribbon(1.1);
  REQUIRE(marked(open.surface, open.x, open.x).parts.part_of[0] >= 0);
  CHECK(marked(open.surface, open.x, open.x).parts.quiet[0] == 1);
  const Marked wound = marked(open.surface, open.x, closed.x);
  REQUIRE(wound.parts.part_of[0] >= 0);
  CHECK(wound.parts.quiet[0] == 0);
  // Ends that just touch.
  Tangle touching = ribbon(1);
  CHECK(marked(open.surface, open.x, touching.x).parts.quiet[0] == 0);
  // Undefined coordinates are never quiet.
  touching = open;
  touching.x(5, 0) = std::numeric_limits<double>::quiet_NaN();
  CHECK(marked(open.surface, open.x, touching.x).parts.quiet[0] == 0);
}

TEST_CASE("quiet: one vertex pushed over an edge by next to nothing is seen", "[quiet]") {
  const Tangle flat = testing::grid_surface("flat", 16, 16, [](double u, double v) { return Vec3(u, 0, v); });
  const int middle = 8 * 17 + 8;  // its star is the square of its eight neighbours
  const auto is_quiet = [&](double beyond) {
    Tangle pushed = flat;
    pushed.x.row(middle) += Eigen::RowVector3d(1.0 / 16 + beyond, 0, 0.5 / 16);
    return marked(flat.surface, flat.x, pushed.x).parts.quiet[0] == 1;
  };
  CHECK(is_quiet(-1e-3));
  for (double beyond : {0.0, 1e-15, 1e-13, 1e-9, 1e-3}) {
    INFO(beyond);
    CHECK_FALSE(is_quiet(beyond));
  }
}

TEST_CASE("quiet: what is flat is quiet at any scale", "[quiet]") {
  for (double scale : {1e-6, 1e6}) {
    const Points x = scale * tangles(16)[1].x;
    const Surface surface = tangles(16)[1].surface;
    CHECK(marked(surface, x, x).parts.quiet[0] == 1);
  }
}

TEST_CASE("quiet: only disks are parts", "[quiet]") {
  const auto root_is_part = [](const Surface& s, const Points& x) { return marked(s, x, x).parts.part_of[0] >= 0; };
  const Tangle sheet = tangles(16)[0];
  CHECK(root_is_part(sheet.surface, sheet.x));
  const Tangle ring = testing::tube(32, 8, 1, 1);
  CHECK_FALSE(root_is_part(ring.surface, ring.x));
  // A hole, a turned triangle, a second sheet, one more triangle on an inner edge, two sheets that hang on one vertex.
  const Triangles& t = sheet.surface.triangles;
  const int n = sheet.surface.vertex_count, m = static_cast<int>(t.rows());
  Triangles holed(m - 1, 3);
  holed << t.topRows(m / 2 + 8), t.bottomRows(m - m / 2 - 9);
  CHECK_FALSE(root_is_part(make_surface(n, holed), sheet.x));
  Triangles turned = t;
  std::swap(turned(m / 2, 0), turned(m / 2, 1));
  CHECK_FALSE(root_is_part(make_surface(n, turned), sheet.x));
  Points twice(2 * n, 3);
  twice << sheet.x, sheet.x.rowwise() + Vec3(2, 0, 0).transpose();
  Triangles two(2 * m, 3);
  two << t, t.array() + n;
  CHECK_FALSE(root_is_part(make_surface(2 * n, two), twice));
  Triangles hanging = two;
  for (int& v : hanging.reshaped())
    if (v == n) v = n - 1;
  CHECK_FALSE(root_is_part(make_surface(2 * n, hanging), twice));
  // A torus with a hole has one boundary too; a sheet beside a whole torus has one and the right Euler characteristic.
  const Tangle ring12 = testing::tube(12, 12, 1, 1);
  Triangles torus = ring12.surface.triangles;
  for (int& v : torus.reshaped())
    if (v % 13 == 12) v -= 12;
  CHECK_FALSE(root_is_part(make_surface(ring12.surface.vertex_count, torus.bottomRows(torus.rows() - 1)), ring12.x));
  Points beside(n + ring12.x.rows(), 3);
  beside << sheet.x, ring12.x;
  Triangles with_torus(m + torus.rows(), 3);
  with_torus << t, (torus.array() + n).matrix();
  CHECK_FALSE(root_is_part(make_surface(static_cast<int>(beside.rows()), with_torus), beside));
  Triangles fin(m + 1, 3);
  fin << t, Triangles::Constant(1, 3, 0);
  fin.row(m) << t(m / 2, 0), t(m / 2, 1), 0;
  CHECK_FALSE(root_is_part(make_surface(n, fin), sheet.x));
}

TEST_CASE("quiet: a polygon that is called simple is", "[quiet]") {
  std::mt19937 random(21);
  std::uniform_int_distribution<int> count(3, 9), lattice(-3, 3);
  std::uniform_real_distribution<double> place(-1, 1);
  int simple = 0, called = 0, wrong = 0;
  for (int i = 0; i < 40000; ++i) {
    std::vector<Vec2> p(count(random));
    const int n = static_cast<int>(p.size());
    for (int k = 0; k < n; ++k) {
      const double angle = 2 * std::numbers::pi * k / n;
      if (i % 3 == 0) p[k] = Vec2(lattice(random), lattice(random));
      if (i % 3 == 1) p[k] = Vec2(place(random), place(random));
      if (i % 3 == 2) p[k] = Vec2(std::cos(angle), std::sin(angle)) * (0.7 + 0.5 * place(random));
    }
    const bool is = is_simple(p), said = surely_simple(p, 0);
    simple += is;
    called += said;
    wrong += said && !is;
  }
  CHECK(wrong == 0);
  CHECK(simple > 10000);
  CHECK(called > 0.99 * simple);
}

}  // namespace selvedge::test_quiet
