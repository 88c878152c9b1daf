#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <set>

#include "collision/contour/contour_regions.hpp"
#include "collision/contour/edge_parity.hpp"
#include "collision/contour/find_contours.hpp"
#include "tests/collision/sheets.hpp"

namespace selvedge::test_contour {

using testing::bent;
using testing::flat;
using testing::round_tube;

namespace {

const Vec2 jitter(0.011, 0.013);

struct Case {
  testing::Sheet mesh;
  Surface surface;
  Segments segments;
  std::vector<Contour> contours;
  std::vector<Region> regions;

  explicit Case(testing::Sheet sheet)
      : mesh(std::move(sheet)), surface(make_surface(static_cast<int>(mesh.x.rows()), mesh.triangles)) {
    const std::array sheets{SheetView{&surface, &mesh.x}};
    segments = find_segments(sheets);
    contours = find_contours(sheets, segments);
    regions = enclosed_regions(sheets, segments, contours);
    std::size_t all = 0;
    for (const Contour& contour : contours) {
      all += contour.segments.size();
      REQUIRE(contour.points.size() == contour.segments.size() + (contour.closed ? 0 : 1));
      std::size_t crossed = 0;
      for (const ContourSide& side : contour.sides) {
        REQUIRE(side.triangles.size() == contour.segments.size());
        crossed += side.edges.size();
        for (int t : side.triangles) REQUIRE(surface.component[surface.triangles(t, 0)] == side.component);
      }
      std::size_t crossings = 0;
      for (int point : contour.points) crossings += point >= 0;
      REQUIRE(crossed == crossings);
    }
    REQUIRE(all == segments.segments.size());
  }

  std::vector<int> inside(int component, int partner) const {
    for (const Region& region : regions)
      if (region.component == component && region.partner_component == partner) return region.vertices;
    return {};
  }
  // The vertices of a component for which `holds` is true of the place in the plane that they were made from.
  template <class Holds>
  std::vector<int> where(int component, Holds holds) const {
    std::vector<int> vertices;
    for (int v = 0; v < surface.vertex_count; ++v)
      if (surface.component[v] == component && holds(row(mesh.x, v))) vertices.push_back(v);
    return vertices;
  }
};

const ContourSide& side_of(const Contour& contour, int component) {
  return contour.sides[0].component == component ? contour.sides[0] : contour.sides[1];
}

int side_number(const Contour& contour, int component) { return contour.sides[0].component == component ? 0 : 1; }

double half(double, double) { return 0.5; }
double bump(double a, double b) { return 0.3 * std::exp(-12 * (a * a + b * b)) - 0.1; }

}  // namespace

TEST_CASE("contour: cloth through cloth is closed and cuts both", "[contour]") {
  const Case c(
      testing::join(flat(12, jitter), bent(14, jitter, [](double a, double b) { return Vec3(a, bump(a, b), b); })));
  REQUIRE(c.contours.size() == 1);
  const Contour& contour = c.contours.front();
  CHECK(contour.closed);
  CHECK_FALSE(contour.one_trace);
  CHECK(contour.ends == std::array{ContourEnd::none, ContourEnd::none});
  CHECK(side_of(contour, 0).cuts);
  CHECK(side_of(contour, 1).cuts);
  const std::vector<int> poking = c.where(1, [](const Vec3& p) { return p.y() > 0; });
  REQUIRE(poking.size() > 5);
  CHECK(side_of(contour, 1).inside == poking);
  CHECK(c.inside(1, 0) == poking);
  const double radius = std::sqrt(std::log(3.0) / 12);
  CHECK(contour.length == Approx(2 * std::numbers::pi * radius).epsilon(0.05));
  for (int v : c.inside(0, 1)) CHECK(row(c.mesh.x, v).norm() < radius + 0.05);
  CHECK(c.inside(0, 1).size() > 3);
}

TEST_CASE("contour: a bump within one triangle is inside without vertices on the other sheet", "[contour]") {
  testing::Sheet coarse = testing::sheet(1, 8, 0);
  coarse.x.col(0).array() += 1;
  const Case c(testing::join(coarse, bent(14, jitter, [](double a, double b) { return Vec3(a, bump(a, b), b); })));
  REQUIRE(c.contours.size() == 1);
  CHECK(side_of(c.contours[0], 0).edges.empty());
  CHECK(side_of(c.contours[0], 0).cuts);
  CHECK(side_of(c.contours[0], 0).inside.empty());
  CHECK(side_of(c.contours[0], 1).cuts);
}

TEST_CASE("contour: a corner through a sheet is open and cuts the corner off", "[contour]") {
  const auto upright = [](double a, double b) { return Vec3(0.6 * (a - b), 0.6 * (a + b) + 0.9, 0.1 + 0.05 * a); };
  const Case c(testing::join(flat(9, jitter), bent(10, jitter, upright)));
  REQUIRE(c.contours.size() == 1);
  const Contour& contour = c.contours.front();
  CHECK_FALSE(contour.closed);
  CHECK(contour.ends == std::array{ContourEnd::boundary, ContourEnd::boundary});
  const int corner = side_number(contour, 1);
  CHECK(contour.end_side == std::array{corner, corner});
  CHECK(contour.sides[corner].cuts);
  CHECK_FALSE(contour.sides[1 - corner].cuts);
  const std::vector<int> through = c.where(1, [](const Vec3& p) { return p.y() < 0; });
  CHECK(contour.sides[corner].inside == through);
  CHECK(c.inside(1, 0) == through);
  CHECK(c.inside(0, 1).empty());
  for (const Region& region : c.regions) CHECK(region.cut == (region.component == 1));
  // The paper's rule: all of the corner, and of the other sheet the triangles on the way.
  const std::vector<char> marked = unrepelled_vertices(std::array{SheetView{&c.surface, &c.mesh.x}}, c.contours);
  std::set<int> expected(through.begin(), through.end());
  for (int t : contour.sides[1 - corner].triangles)
    for (int k = 0; k < 3; ++k) expected.insert(c.surface.triangles(t, k));
  for (int v = 0; v < c.surface.vertex_count; ++v) CHECK((marked[v] != 0) == (expected.count(v) > 0));
}

TEST_CASE("contour: sheet through a boundary cuts neither", "[contour]") {
  const Case c(
      testing::join(flat(9, jitter), bent(10, jitter, [](double a, double b) { return Vec3(0.03 * b, a, b - 0.7); })));
  REQUIRE(c.contours.size() == 1);
  const Contour& contour = c.contours.front();
  CHECK(contour.ends == std::array{ContourEnd::boundary, ContourEnd::boundary});
  CHECK(contour.end_side[0] != contour.end_side[1]);
  CHECK_FALSE(contour.sides[0].cuts);
  CHECK_FALSE(contour.sides[1].cuts);
  CHECK(contour.length == Approx(1.3).epsilon(0.03));
  for (const Region& region : c.regions) {
    CHECK(region.vertices.empty());
    CHECK_FALSE(region.cut);
  }
}

TEST_CASE("contour: of two layers that change places the smaller part of the way round is wrong, on both",
          "[contour]") {
  const Case c(testing::tucked());
  REQUIRE(c.contours.size() == 2);
  for (const Contour& contour : c.contours) {
    CHECK(contour.end_side[0] != contour.end_side[1]);
    CHECK_FALSE(contour.sides[0].cuts);
    CHECK_FALSE(contour.sides[1].cuts);
  }
  const double radius = 0.32 * std::cos(std::numbers::pi / 48);
  REQUIRE(c.regions.size() == 2);
  for (const Region& region : c.regions) {
    CHECK_FALSE(region.cut);
    std::vector<char> wrong(c.surface.vertex_count, 0);
    for (const int v : region.vertices) wrong[v] = 1;
    for (int v = 0; v < c.surface.vertex_count; ++v) {
      if (c.surface.component[v] != region.component) {
        CHECK_FALSE(wrong[v]);
        continue;
      }
      const Vec3 p = row(c.mesh.x, v);
      const double outside = 0.312 + 0.02 * p.y() / p.tail<2>().norm() - 0.5 * (0.32 + radius);
      if (std::abs(p.x() - 0.35) < 0.11 && std::abs(outside) > 0.004) CHECK((wrong[v] != 0) == (outside > 0));
      if (std::abs(p.x() - 0.35) > 0.2) CHECK_FALSE(wrong[v]);
    }
  }
}

TEST_CASE("contour: a fold through itself runs between loop vertices and encloses one region", "[contour]") {
  // (u, v^2, v (v^2 + u^2 - 1)) crosses itself where u^2 + v^2 = 1, at v and -v.
  std::vector<double> from_origin;
  const Case c(bent(15, jitter, [&](double a, double b) {
    const double u = 1.6 * a, v = 1.6 * b + 0.01;
    from_origin.push_back(std::hypot(u, v));
    return Vec3(u, v * v, v * (v * v + u * u - 1));
  }));
  REQUIRE(c.contours.size() == 1);
  const Contour& contour = c.contours.front();
  CHECK(contour.ends == std::array{ContourEnd::vertex, ContourEnd::vertex});
  CHECK(contour.sides[0].cuts);
  CHECK(contour.sides[0].inside == contour.sides[1].inside);
  REQUIRE(c.regions.size() == 1);
  CHECK(c.regions[0].cut);
  CHECK(c.regions[0].vertices == contour.sides[0].inside);
  std::vector<char> inside(c.surface.vertex_count, 0);
  for (int v : c.regions[0].vertices) inside[v] = 1;
  for (int v = 0; v < c.surface.vertex_count; ++v) {
    if (from_origin[v] < 0.75) CHECK(inside[v]);
    if (from_origin[v] > 1.25) CHECK_FALSE(inside[v]);
  }
}

TEST_CASE("contour: a pinch that runs out of the sheet ends at a loop vertex and at the boundary", "[contour]") {
  const Case c(bent(15, jitter, [](double a, double b) { return Vec3(a * (b - 0.3), a, (b - 0.3) * (b - 0.3)); }));
  REQUIRE(c.contours.size() == 1);
  const Contour& contour = c.contours.front();
  CHECK(std::set{contour.ends[0], contour.ends[1]} == std::set{ContourEnd::vertex, ContourEnd::boundary});
  CHECK_FALSE(contour.sides[0].cuts);
  CHECK_FALSE(contour.sides[1].cuts);
}

TEST_CASE("contour: nested ones", "[contour]") {
  // A dome whose top falls through again: rings of radius 0.3 and 0.7.
  const auto crater = [](double a, double b) {
    const double r = std::hypot(a, b);
    return Vec3(a, -3 * (r - 0.3) * (r - 0.7), b);
  };
  const Case c(testing::join(flat(16, jitter), bent(17, jitter, crater)));
  REQUIRE(c.contours.size() == 2);
  const int inner = c.contours[0].length < c.contours[1].length ? 0 : 1;
  for (int component = 0; component < 2; ++component) {
    CHECK(side_of(c.contours[inner], component).cuts);
    CHECK(side_of(c.contours[inner], component).nested);
    CHECK(side_of(c.contours[1 - inner], component).cuts);
    CHECK_FALSE(side_of(c.contours[1 - inner], component).nested);
  }
  // Together they enclose the ring between them; the paper's rule takes the whole disc.
  const std::vector<int> ring = c.where(1, [](const Vec3& p) { return p.y() > 0; });
  CHECK(c.inside(1, 0) == ring);
  const std::vector<int>& disc = side_of(c.contours[1 - inner], 1).inside;
  CHECK(disc.size() > ring.size());
  CHECK(std::includes(disc.begin(), disc.end(), ring.begin(), ring.end()));
}

TEST_CASE("contour: tube through tube needs all contours together", "[contour]") {
  const auto bulge = [](double x, double) { return 0.45 + 0.1 * std::exp(-20 * (x + 0.03) * (x + 0.03)); };
  const Case c(testing::join(round_tube(20, 17, 0, half, 1), round_tube(24, 17, 0.3, bulge, 1)));
  REQUIRE(c.contours.size() == 2);
  const std::vector<int> middle = c.where(1, [](const Vec3& p) { return p.tail<2>().norm() > 0.502; });
  REQUIRE_FALSE(middle.empty());
  for (const Contour& contour : c.contours) {
    CHECK(contour.closed);
    CHECK(side_of(contour, 1).cuts);
    CHECK_FALSE(std::includes(side_of(contour, 1).inside.begin(), side_of(contour, 1).inside.end(), middle.begin(),
                              middle.end()));
  }
  const std::vector<int> inside = c.inside(1, 0);
  CHECK(std::includes(inside.begin(), inside.end(), middle.begin(), middle.end()));
  for (int v : inside) CHECK(std::abs(c.mesh.x(v, 0)) < 0.35);
  for (int v : c.inside(0, 1)) CHECK(std::abs(c.mesh.x(v, 0)) < 0.35);
  CHECK_FALSE(c.inside(0, 1).empty());
}

TEST_CASE("contour: a tube across another one", "[contour]") {
  testing::Sheet across = round_tube(
      22, 14, 0.1, [](double, double) { return 0.21; }, 1);
  for (int v = 0; v < across.x.rows(); ++v) {
    const Vec3 p = row(across.x, v);
    across.x.row(v) << p.z() + 0.02, p.x(), p.y() + 0.03;
  }
  const Case c(testing::join(round_tube(21, 19, 0, half, 1), across));
  REQUIRE(c.contours.size() == 2);
  CHECK(c.inside(1, 0) == c.where(1, [](const Vec3& p) { return p.tail<2>().norm() < 0.495; }));
  for (int v : c.inside(0, 1)) CHECK(std::hypot(c.mesh.x(v, 0) - 0.02, c.mesh.x(v, 2) - 0.03) < 0.21);
}

TEST_CASE("contour: a pocket pushed through the sheet that it is sewn on", "[contour]") {
  testing::Sheet c0 = flat(16, jitter);
  // A patch on the middle 8 x 8 quads that shares the vertices of its rim: edges of three triangles.
  std::vector<int> number(c0.x.rows(), -1);
  std::vector<Vec3> added;
  const auto patch = [&](int v) {
    const int i = v % 17, j = v / 17;
    if (i == 4 || i == 12 || j == 4 || j == 12) return v;
    if (number[v] < 0) {
      number[v] = static_cast<int>(c0.x.rows() + static_cast<long>(added.size()));
      const double height = 0.1 - 0.25 * std::exp(-20 * (c0.x(v, 0) * c0.x(v, 0) + c0.x(v, 2) * c0.x(v, 2)));
      added.emplace_back(c0.x(v, 0) + 0.01, height, c0.x(v, 2) + 0.007);
    }
    return number[v];
  };
  std::vector<std::array<int, 3>> more;
  for (int t = 0; t < c0.triangles.rows(); ++t) {
    const int quad = t / 2, i = quad % 16, j = quad / 16;
    if (i >= 4 && i < 12 && j >= 4 && j < 12)
      more.push_back({patch(c0.triangles(t, 0)), patch(c0.triangles(t, 1)), patch(c0.triangles(t, 2))});
  }
  testing::Sheet all{Points(c0.x.rows() + static_cast<long>(added.size()), 3),
                     Triangles(c0.triangles.rows() + static_cast<long>(more.size()), 3)};
  all.x.topRows(c0.x.rows()) = c0.x;
  all.triangles.topRows(c0.triangles.rows()) = c0.triangles;
  for (std::size_t i = 0; i < added.size(); ++i) all.x.row(c0.x.rows() + static_cast<long>(i)) = added[i].transpose();
  for (std::size_t i = 0; i < more.size(); ++i)
    all.triangles.row(c0.triangles.rows() + static_cast<long>(i)) << more[i][0], more[i][1], more[i][2];
  const Case c(all);
  REQUIRE(c.surface.component_count == 1);
  REQUIRE(c.surface.nonmanifold_edges > 0);
  REQUIRE(c.contours.size() == 1);
  CHECK(c.contours[0].closed);
  CHECK(c.contours[0].sides[0].cuts);
  CHECK(c.contours[0].sides[1].cuts);
  CHECK(c.contours[0].sides[0].inside != c.contours[0].sides[1].inside);
  // Both discs are inside with respect to the other.
  std::set<int> discs(c.contours[0].sides[0].inside.begin(), c.contours[0].sides[0].inside.end());
  discs.insert(c.contours[0].sides[1].inside.begin(), c.contours[0].sides[1].inside.end());
  CHECK(c.inside(0, 0) == std::vector<int>(discs.begin(), discs.end()));
}

TEST_CASE("contour: three sheets through one place keep their contours apart", "[contour]") {
  const auto a = bent(7, jitter, [](double u, double v) { return Vec3(u, 0.02 * u, v); });
  const auto b = bent(8, jitter, [](double u, double v) { return Vec3(0.03 * v, 0.9 * u, 0.9 * v); });
  const auto d = bent(9, jitter, [](double u, double v) { return Vec3(0.8 * u, 0.8 * v, 0.05 * u); });
  const Case c(testing::join(testing::join(a, b), d));
  REQUIRE(c.surface.component_count == 3);
  REQUIRE(c.contours.size() == 3);
  std::set<std::set<int>> partners;
  for (const Contour& contour : c.contours) {
    CHECK_FALSE(contour.closed);
    partners.insert({contour.sides[0].component, contour.sides[1].component});
    CHECK(contour.length > 1.4);
  }
  CHECK(partners.size() == 3);
  CHECK(c.regions.size() == 6);
}

TEST_CASE("contour: cloth through a body that is an obstacle", "[contour]") {
  const testing::Sheet cloth = flat(12, jitter),
                       body = bent(14, jitter, [](double a, double b) { return Vec3(a, bump(a, b), b); });
  const Surface s0 = make_surface(static_cast<int>(cloth.x.rows()), cloth.triangles);
  const Surface s1 = make_surface(static_cast<int>(body.x.rows()), body.triangles);
  const std::array sheets{SheetView{&s0, &cloth.x}, SheetView{&s1, &body.x}};
  const Segments found = find_segments(sheets);
  const std::vector<Contour> contours = find_contours(sheets, found);
  REQUIRE(contours.size() == 1);
  CHECK(contours[0].sides[0].sheet == 0);
  CHECK(contours[0].sides[1].sheet == 1);
  CHECK(contours[0].sides[0].cuts);
  CHECK(contours[0].sides[1].cuts);
  const std::vector<Region> regions = enclosed_regions(sheets, found, contours);
  REQUIRE(regions.size() == 2);
  for (const Region& region : regions) CHECK(region.vertices == contours[0].sides[region.sheet].inside);
}

TEST_CASE("contour: the smaller part, grown from its curve, is the rarer colour of the whole component", "[contour]") {
  testing::Sheet crumpled = testing::join(flat(12, jitter), flat(9, jitter));
  std::mt19937 random(5);
  std::normal_distribution<double> normal(0, 0.2);
  for (double& coordinate : crumpled.x.reshaped()) coordinate += normal(random);
  const Case c(crumpled);
  const std::vector<int> sizes = component_sizes(c.surface);
  CHECK(sizes == std::vector<int>{169, 100});
  int parted = 0, neither = 0;
  const auto compare = [&](const EdgeParity& parity, int component) {
    std::vector<char> colours;
    std::vector<int> ones;
    std::optional<std::vector<int>> expected;
    if (parity.colour(component, colours)) {
      for (int v = 0; v < c.surface.vertex_count; ++v)
        if (colours[v] == 1) ones.push_back(v);
      if (2 * static_cast<int>(ones.size()) < sizes[component]) expected = ones;
    }
    REQUIRE(parity.smaller_part(component, sizes[component]) == expected);
    expected ? ++parted : ++neither;
  };
  EdgeParity all(c.surface);
  for (const Contour& contour : c.contours)
    for (int k = 0; k < 2; ++k) {
      EdgeParity alone(c.surface);
      alone.add(contour, k);
      compare(alone, contour.sides[k].component);
      if (!ends_outside(contour, 0) || !ends_outside(contour, 1)) continue;
      all.add(contour, k);
      for (const int component : {0, 1}) compare(all, component);
    }
  CHECK(parted > 20);
  CHECK(neither > 20);
}

}  // namespace selvedge::test_contour
