#include <catch2/catch.hpp>

#include <algorithm>
#include <map>
#include <random>
#include <set>

#include "collision/audit/audit_pair.hpp"
#include "collision/contour/segments.hpp"
#include "collision/exact/symbolic_orientation.hpp"
#include "collision/search/bvh.hpp"
#include "tests/collision/sheets.hpp"

namespace selvedge::test_segments {

namespace {

__extension__ using Wide = __int128;
using Whole = Eigen::Matrix<long, 3, 1>;

// The determinant of the moved points as a polynomial, term by term from Leibniz' formula: the coefficient of each
// product of infinitesimals, by the number that has the bits of its factors. The first one that is not zero decides.
int reference_side(const std::array<Whole, 4>& p, const std::array<int, 4>& rank) {
  std::array<int, 4> place{};
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) place[i] += rank[j] < rank[i];
  std::map<int, Wide> coefficients;
  std::array<int, 4> column{0, 1, 2, 3};
  do {
    int sign = -1;
    for (int i = 0; i < 4; ++i)
      for (int j = i + 1; j < 4; ++j)
        if (column[i] > column[j]) sign = -sign;
    for (int moved = 0; moved < 16; ++moved) {
      Wide product = sign;
      int bits = 0;
      for (int i = 0; i < 4; ++i) {
        if (moved >> i & 1) {
          if (column[i] == 3)
            product = 0;
          else
            bits |= 1 << (3 * place[i] + 2 - column[i]);
        } else {
          product *= column[i] == 3 ? 1 : p[i][column[i]];
        }
      }
      if (product != 0) coefficients[bits] += product;
    }
  } while (std::next_permutation(column.begin(), column.end()));
  for (const auto& [bits, coefficient] : coefficients)
    if (coefficient != 0) return coefficient > 0 ? 1 : -1;
  return 0;
}

Wide volume(const Whole& a, const Whole& b, const Whole& c, const Whole& d) {
  const Whole u = b - a, v = c - a, w = d - a;
  return Wide(u[0]) * (Wide(v[1]) * w[2] - Wide(v[2]) * w[1]) - Wide(u[1]) * (Wide(v[0]) * w[2] - Wide(v[2]) * w[0]) +
         Wide(u[2]) * (Wide(v[0]) * w[1] - Wide(v[1]) * w[0]);
}

struct WholeMesh {
  std::vector<Whole> x;
  Triangles triangles;
};

Points real(const WholeMesh& mesh) {
  Points x(static_cast<Eigen::Index>(mesh.x.size()), 3);
  for (std::size_t v = 0; v < mesh.x.size(); ++v)
    x.row(static_cast<Eigen::Index>(v)) = mesh.x[v].cast<double>().transpose();
  return x;
}

// Edge p q through face f, by whole numbers and the definition alone; ranks are vertex numbers.
bool reference_crossing(const WholeMesh& m, int p, int q, const std::array<int, 3>& f) {
  for (int v : f)
    if (v == p || v == q) return false;
  const auto side = [&](int a, int b, int c, int d) {
    return reference_side({m.x[a], m.x[b], m.x[c], m.x[d]}, {a, b, c, d});
  };
  if (side(f[0], f[1], f[2], p) == side(f[0], f[1], f[2], q)) return false;
  const int first = side(p, q, f[0], f[1]);
  return first == side(p, q, f[1], f[2]) && first == side(p, q, f[2], f[0]);
}

std::array<int, 3> corners(const Triangles& t, int i) { return {t(i, 0), t(i, 1), t(i, 2)}; }

void check_parameters(const WholeMesh& mesh, const Surface& surface, const Crossing& c) {
  const Whole p = mesh.x[surface.edges(c.edge, 0)], q = mesh.x[surface.edges(c.edge, 1)];
  const auto f = corners(surface.triangles, c.face);
  const Wide below = volume(mesh.x[f[0]], mesh.x[f[1]], mesh.x[f[2]], p);
  const Wide above = volume(mesh.x[f[0]], mesh.x[f[1]], mesh.x[f[2]], q);
  double sum = 0;
  for (double w : c.weight) {
    REQUIRE(w >= 0);
    sum += w;
  }
  REQUIRE(sum == Approx(1));
  REQUIRE(c.s >= 0);
  REQUIRE(c.s <= 1);
  if (below == above) return;
  REQUIRE(std::abs(c.s - double(below) / double(below - above)) < 1e-15);
  Vec3 at = Vec3::Zero();
  for (int k = 0; k < 3; ++k) at += c.weight[k] * mesh.x[f[k]].cast<double>();
  REQUIRE((at - ((1 - c.s) * p.cast<double>() + c.s * q.cast<double>())).norm() <
          1e-14 * (1 + p.cast<double>().norm() + q.cast<double>().norm()));
}

// Against all pairs of triangles, each by the definition.
int check_mesh(const WholeMesh& mesh) {
  const Surface surface = make_surface(static_cast<int>(mesh.x.size()), mesh.triangles);
  const Points x = real(mesh);
  const Segments found = find_segments(std::array{SheetView{&surface, &x}});
  KeptBvh tree;  // whatever it went through
  std::vector<Box> boxes;
  for (const double turn : {-1.0, 1.0}) {
    triangle_boxes(surface, turn * x, turn * x, 0, boxes);
    update(tree, boxes);
  }
  const Segments by_tree = find_segments(std::array{SheetView{&surface, &x, &tree.bvh}});
  REQUIRE(by_tree.crossings == found.crossings);
  REQUIRE(by_tree.touching == found.touching);
  REQUIRE(std::ranges::equal(by_tree.segments, found.segments, [](const Segment& a, const Segment& b) {
    return a.sheet == b.sheet && a.triangle == b.triangle && a.end == b.end;
  }));

  std::map<std::pair<int, int>, std::set<std::pair<int, int>>> expected;  // triangles -> (edge, face)
  std::set<std::pair<int, int>> touching;
  for (int a = 0; a < mesh.triangles.rows(); ++a)
    for (int b = a + 1; b < mesh.triangles.rows(); ++b) {
      std::set<std::pair<int, int>> crossings;
      for (const auto& [of, face] : {std::pair{a, b}, {b, a}})
        for (int k = 0; k < 3; ++k)
          if (reference_crossing(mesh, mesh.triangles(of, k), mesh.triangles(of, (k + 1) % 3),
                                 corners(mesh.triangles, face)))
            crossings.insert({surface.triangle_edges(of, k), face});
      std::set<int> vertices;
      for (int k = 0; k < 3; ++k) vertices.insert({mesh.triangles(a, k), mesh.triangles(b, k)});
      if (!crossings.empty()) expected[{a, b}] = crossings;
      const auto corner = [&](int t, int k) { return row(x, mesh.triangles(t, k)); };
      if (vertices.size() == 6 && crossings.empty() &&
          triangles_intersect(corner(a, 0), corner(a, 1), corner(a, 2), corner(b, 0), corner(b, 1), corner(b, 2)))
        touching.insert({a, b});
    }

  REQUIRE(found.segments.size() == expected.size());
  std::vector<int> uses(found.crossings.size(), 0);
  for (const Segment& segment : found.segments) {
    std::set<std::pair<int, int>> crossings;
    for (int end : segment.end)
      if (end >= 0) {
        crossings.insert({found.crossings[end].edge, found.crossings[end].face});
        ++uses[end];
      }
    REQUIRE(crossings == expected.at({segment.triangle[0], segment.triangle[1]}));
    REQUIRE(crossings.size() == (segment.at_vertex() ? 1 : 2));
  }
  for (std::size_t i = 0; i < uses.size(); ++i) {
    check_parameters(mesh, surface, found.crossings[i]);
    int triangles_at_edge = 0;
    for (int edge : surface.triangle_edges.reshaped()) triangles_at_edge += edge == found.crossings[i].edge;
    REQUIRE(uses[i] == triangles_at_edge);
  }
  REQUIRE(found.touching.size() == touching.size());
  for (const auto& [a, sheet, b] : found.touching) REQUIRE(touching.count({a, b}) == 1);
  return static_cast<int>(found.segments.size());
}

// Triangles on few lattice points, so that they share vertices, touch, overlap and coincide.
WholeMesh soup(std::mt19937& random, int size, int depth, int vertices, int triangles) {
  std::uniform_int_distribution<long> at(-size, size), deep(-depth, depth);
  std::uniform_int_distribution<int> pick(0, vertices - 1);
  WholeMesh mesh;
  for (int v = 0; v < vertices; ++v) {
    const Whole p(at(random), at(random), deep(random));
    mesh.x.push_back(v % 3 == 0 ? Whole(p[2], p[0], p[1]) : p);
  }
  std::set<std::set<int>> made;
  while (static_cast<int>(made.size()) < triangles) {
    const std::set<int> t{pick(random), pick(random), pick(random)};
    if (t.size() == 3) made.insert(t);
  }
  mesh.triangles.resize(triangles, 3);
  int next = 0;
  for (const std::set<int>& t : made) mesh.triangles.row(next++) << *t.begin(), *std::next(t.begin()), *t.rbegin();
  return mesh;
}

}  // namespace

TEST_CASE("segments: the symbolic side is that of points moved by infinitesimals", "[segments]") {
  std::mt19937 random(1);
  int zero = 0;
  for (int round = 0; round < 20000; ++round) {
    std::uniform_int_distribution<long> at(-(round % 4), round % 4);
    std::array<Whole, 4> p;
    for (Whole& point : p) point = Whole(at(random), at(random), at(random));
    if (round % 3 == 0) p[2] = p[1];
    if (round % 9 == 0) p[3] = p[0];
    std::array<int, 4> rank{2, 3, 5, 7};
    std::shuffle(rank.begin(), rank.end(), random);
    std::array<Vec3, 4> real;
    for (int i = 0; i < 4; ++i) real[i] = p[i].cast<double>();
    const auto side = [&](int a, int b, int c, int d) {
      bool exact_zero = false;
      const int result = symbolic_orient3d({&real[a], rank[a]}, {&real[b], rank[b]}, {&real[c], rank[c]},
                                           {&real[d], rank[d]}, exact_zero);
      REQUIRE(exact_zero == (volume(p[0], p[1], p[2], p[3]) == 0));
      zero += exact_zero;
      return result;
    };
    REQUIRE(side(0, 1, 2, 3) == reference_side(p, rank));
    REQUIRE(side(1, 0, 2, 3) == -reference_side(p, rank));
    REQUIRE(side(3, 1, 0, 2) == reference_side({p[3], p[1], p[0], p[2]}, {rank[3], rank[1], rank[0], rank[2]}));
  }
  CHECK(zero > 20000);
}

TEST_CASE("segments: triangle soups on small lattices agree with brute force in whole numbers", "[segments]") {
  std::mt19937 random(2);
  int segments = 0;
  for (int round = 0; round < 2500; ++round) {
    const int size = 1 + round % 5, depth = round % 3 == 0 ? 0 : round % 3 == 1 ? 1 : size;
    segments += check_mesh(soup(random, size, depth, 6 + round % 5, 3 + round % 5));
  }
  CHECK(segments > 2500);
}

TEST_CASE("segments: sheets on large lattices agree with brute force in whole numbers", "[segments]") {
  std::mt19937 random(3);
  std::uniform_int_distribution<long> at(-100000, 100000);
  int segments = 0;
  for (int round = 0; round < 60; ++round) {
    const testing::Sheet sheets = testing::join(testing::sheet(2, 1, 0), testing::sheet(2, 1, 0));
    WholeMesh mesh;
    mesh.triangles = sheets.triangles;
    for (int v = 0; v < sheets.x.rows(); ++v) mesh.x.emplace_back(at(random), at(random), at(random));
    segments += check_mesh(mesh);
  }
  CHECK(segments > 1000);
}

TEST_CASE("segments: sheets that coincide, or share lines and planes, join all the same", "[segments]") {
  for (int variant = 0; variant < 48; ++variant) {
    // Two sheets of 3 x 3 quads on a lattice, the second turned and shifted onto vertices, edges or faces of the first.
    const testing::Sheet one = testing::sheet(3, 6, 0);
    WholeMesh mesh;
    mesh.triangles = testing::join(one, one).triangles;
    for (int half = 0; half < 2; ++half)
      for (int v = 0; v < one.x.rows(); ++v) {
        Whole p = one.x.row(v).transpose().array().round().cast<long>();
        if (half == 1) {
          if (variant % 4 == 1) p = Whole(p[0], p[2], p[1]);
          if (variant % 4 == 2) p = Whole(p[0], p[0], p[2]);
          if (variant % 4 == 3) p = Whole(p[1], p[0] + p[2], p[2]);
          p += Whole(variant / 4 % 3, 0, variant / 12 % 2);
        }
        mesh.x.push_back(half == 1 && variant / 24 == 1 ? Whole(p[0] + 1, p[1], p[2]) : p);
      }
    check_mesh(mesh);
  }
}

TEST_CASE("segments: obstacles come after the cloth and are not tested against themselves", "[segments]") {
  const testing::Sheet cloth = testing::sheet(4, 1, 0);
  testing::Sheet wall = testing::sheet(1, 0.4, 0);
  for (int v = 0; v < wall.x.rows(); ++v) wall.x.row(v) << wall.x(v, 0) + 0.03, wall.x(v, 2) + 0.01, 0.02;
  const testing::Sheet walls = testing::join(wall, wall);  // twice the same
  const Surface a = make_surface(static_cast<int>(cloth.x.rows()), cloth.triangles);
  const Surface b = make_surface(static_cast<int>(walls.x.rows()), walls.triangles);
  const std::array sheets{SheetView{&a, &cloth.x}, SheetView{&b, &walls.x}};
  const Segments found = find_segments(sheets);
  double length = 0;
  for (const Segment& segment : found.segments) {
    REQUIRE(segment.sheet == std::array{0, 1});
    length += (end_point(sheets, found, segment, 0) - end_point(sheets, found, segment, 1)).norm();
  }
  CHECK(length == Approx(2 * 0.4));
  CHECK(intersecting_pairs(found) == static_cast<int>(found.segments.size()));
}

TEST_CASE("segments: one and two runs give the same", "[segments]") {
  std::mt19937 random(5);
  const WholeMesh mesh = soup(random, 40, 40, 60, 90);
  const Surface surface = make_surface(60, mesh.triangles);
  const Points x = real(mesh);
  const std::array sheets{SheetView{&surface, &x}};
  const Segments a = find_segments(sheets), b = find_segments(sheets);
  REQUIRE(a.segments.size() == b.segments.size());
  REQUIRE(a.crossings.size() == b.crossings.size());
  for (std::size_t i = 0; i < a.crossings.size(); ++i) {
    REQUIRE(a.crossings[i] == b.crossings[i]);
    REQUIRE(a.crossings[i].s == b.crossings[i].s);
  }
  for (std::size_t i = 0; i < a.segments.size(); ++i) REQUIRE(a.segments[i].end == b.segments[i].end);
}

}  // namespace selvedge::test_segments
