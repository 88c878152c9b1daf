#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

#include "collision/audit/audit.hpp"
#include "collision/geometry/cell_grid.hpp"
#include "collision/untangle/give_way.hpp"

namespace selvedge::test_give_way {

namespace {

constexpr double radius = 0.06;

struct Arm {
  Surface surface;
  Points straight;
};

// A closed rod along x, from -0.5 to 0.5, with its normals outward.
Arm arm() {
  constexpr int rings = 60, around = 24;
  Points x(rings * around + 2, 3);
  Triangles triangles(2 * rings * around, 3);
  int count = 0;
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < around; ++j) {
      const double at = (i + 0.5) / rings - 0.5, angle = 2 * std::numbers::pi * j / around;
      const double r = radius * std::min(1.0, std::sqrt((0.5 - std::abs(at)) / 0.06));
      x.row(i * around + j) << at, r * std::cos(angle), r * std::sin(angle);
      const int next = (j + 1) % around, a = i * around + j, b = i * around + next;
      if (i + 1 < rings) {
        triangles.row(count++) << a, b, a + around;
        triangles.row(count++) << b, b + around, a + around;
      }
    }
  const int first = rings * around, last = first + 1;
  x.row(first) << -0.5, 0, 0;
  x.row(last) << 0.5, 0, 0;
  for (int j = 0; j < around; ++j) {
    const int next = (j + 1) % around;
    triangles.row(count++) << first, next, j;
    triangles.row(count++) << last, (rings - 1) * around + j, (rings - 1) * around + next;
  }
  return {make_surface(static_cast<int>(x.rows()), triangles.topRows(count)), x};
}

// Skinned to two bones that meet at the origin, the second one turned about z.
Points bent(const Points& straight, double angle) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle, Vec3::UnitZ()).toRotationMatrix();
  Points x = straight;
  for (int v = 0; v < x.rows(); ++v) {
    const double t = std::clamp((x(v, 0) + 0.08) / 0.16, 0.0, 1.0), w = t * t * (3 - 2 * t);
    const Vec3 at = row(straight, v);
    x.row(v) = ((1 - w) * at + w * (turn * at)).transpose();
  }
  return x;
}

// Two rods, parts of one body.
Surface twice(const Surface& rod) {
  Triangles triangles(2 * rod.triangles.rows(), 3);
  triangles << rod.triangles, (rod.triangles.array() + rod.vertex_count).matrix();
  return make_surface(2 * rod.vertex_count, triangles);
}

// The second one moved by `up` along y, after it has been scaled.
Points beside(const Points& rod, double up, double scale = 1) {
  Points x(2 * rod.rows(), 3);
  x << rod, scale * rod;
  x.bottomRows(rod.rows()).col(1).array() += up;
  return x;
}

// From the lower part up to the upper one.
double gap_between(const Points& x) {
  return x.bottomRows(x.rows() / 2).col(1).minCoeff() - x.topRows(x.rows() / 2).col(1).maxCoeff();
}

int crossings(const Surface& surface, const Points& x) { return audit(surface, x, {}).intersecting_pairs(); }

double farthest(const Points& a, const Points& b) { return (a - b).rowwise().norm().maxCoeff(); }

}  // namespace

TEST_CASE("soft tissue in the bend of a limb gives way", "[give_way]") {
  const Arm rod = arm();
  const Points normals = vertex_normals(rod.surface, rod.straight);
  for (int v = 0; v < rod.surface.vertex_count; ++v) REQUIRE(row(normals, v).dot(row(rod.straight, v)) > 0);
  const GiveWayOptions options;
  const GiveWay give(rod.surface, rod.straight, options);
  for (const double degrees : {100.0, 110.0, 120.0}) {
    CAPTURE(degrees);
    const Points x = bent(rod.straight, degrees * std::numbers::pi / 180);
    const Points y = give(x);
    CHECK(crossings(rod.surface, x) > 0);
    CHECK(crossings(rod.surface, y) == 0);
    CHECK(farthest(x, y) < 1.5 * options.most);
    for (int v = 0; v < x.rows(); ++v)
      if (std::abs(rod.straight(v, 0)) > 0.4) REQUIRE(y.row(v) == x.row(v));
    CHECK(give(x) == y);
  }
}

TEST_CASE("parts that come together leave room for cloth", "[give_way]") {
  const Arm rod = arm();
  const Points x = bent(rod.straight, 2.1);
  for (const double room : {0.0, 0.005, 0.01}) {
    CAPTURE(room);
    const GiveWay give(rod.surface, rod.straight, {.room = room});
    const Points y = give(x);
    // Inner sides of the two halves, well before the fold's bottom.
    double least = 1;
    for (int v = 0; v < x.rows(); ++v)
      for (int w = 0; w < x.rows(); ++w)
        if (rod.straight(v, 0) < -0.12 && rod.straight(w, 0) > 0.12)
          least = std::min(least, (y.row(v) - y.row(w)).norm());
    CHECK(crossings(rod.surface, y) == 0);
    CHECK(least > 0.8 * room);
  }
}

TEST_CASE("what has been mended leaves room as well", "[give_way]") {
  const Arm rod = arm();
  const Surface both = twice(rod.surface);
  const GiveWayOptions options{.room = 0.01};
  const GiveWay give(both, beside(rod.straight, 0.5, 0.4), options);
  // A thin rod across a thick one, through its skin and all but through its middle.
  for (const double deep : {0.01, 0.02, 0.036, 0.04}) {
    CAPTURE(deep);
    Points x = beside(rod.straight, 0, 0.4);
    for (int v = rod.surface.vertex_count; v < x.rows(); ++v)
      x.row(v) = Eigen::RowVector3d(x(v, 2), x(v, 1) + 1.4 * radius - deep, -x(v, 0));
    const Points y = give(x);
    REQUIRE(crossings(both, x) > 0);
    CHECK(crossings(both, y) == 0);
    double least = 1;
    for (int v = 0; v < rod.surface.vertex_count; ++v)
      least =
          std::min(least, (y.bottomRows(rod.surface.vertex_count).rowwise() - y.row(v)).rowwise().norm().minCoeff());
    CHECK(least > 0.7 * options.room);
  }
}

TEST_CASE("soft tissue says that nothing crosses only where nothing does", "[give_way]") {
  const Arm rod = arm();
  const Surface both = twice(rod.surface);
  const GiveWay give(both, beside(rod.straight, 0.5), {.room = 0.01, .most = 0.003});
  int said = 0, crossed = 0;
  for (double gap = 0.004; gap > -0.014; gap -= 0.001) {
    CAPTURE(gap);
    bool apart = false;
    const Points x = beside(rod.straight, 2 * radius + gap);
    const Points y = give(x, &apart);
    CHECK(give(x) == y);
    const bool crosses = crossings(both, y) > 0;
    CHECK_FALSE((apart && crosses));
    said += apart;
    crossed += crosses;
  }
  CHECK(said > 3);
  CHECK(crossed > 3);
}

TEST_CASE("two parts that come together go half the way each, as far as they may", "[give_way]") {
  const Arm rod = arm();
  const Surface both = twice(rod.surface);
  const double gap = 0.004;
  const Points rest = beside(rod.straight, 0.5), x = beside(rod.straight, 2 * radius + gap);
  for (const double room : {0.0, 0.008, 0.02})
    for (const double most : {0.003, 0.045}) {
      CAPTURE(room, most);
      const Points y = GiveWay(both, rest, {.room = room, .most = most})(x);
      const double missing = std::max(0.0, room - gap), way = std::min(most, missing / 2);
      CHECK(gap_between(y) == Approx(gap + 2 * way).margin(0.1 * missing));
      CHECK(farthest(x, y) == Approx(way).epsilon(1e-3));
      // Their far sides.
      CHECK(y.col(1).minCoeff() == x.col(1).minCoeff());
      CHECK(y.col(1).maxCoeff() == x.col(1).maxCoeff());
    }
  // Less room where they are near at rest.
  const Points y = GiveWay(both, beside(rod.straight, 2 * radius + 0.02), {.room = 0.02})(x);
  CHECK(gap_between(y) == Approx(0.3 * 0.02).margin(1e-4));
}

TEST_CASE("parts leave room or pass through each other, and do not merely touch", "[give_way]") {
  const Arm rod = arm();
  const Surface both = twice(rod.surface);
  const GiveWayOptions options{.room = 0.01, .most = 0.003};
  const GiveWay give(both, beside(rod.straight, 0.5), options);
  int through = 0;
  double before = 1;
  for (double gap = 0.004; gap > -0.014; gap -= 0.001) {
    CAPTURE(gap);
    const Points y = give(beside(rod.straight, 2 * radius + gap));
    const double left = gap_between(y);
    const double least = 0.39 * options.room;  // or all that the skin is through
    CHECK((left > least || left < -least || left == Approx(gap)));
    CHECK((crossings(both, y) > 0) == (left < 0));
    CHECK(left < before + 1e-3);  // the deeper the skin, the deeper what gives way, but for rounds of smoothing
    through += left < 0;
    before = left;
  }
  CHECK(through > 5);
  CHECK(through < 15);
}

TEST_CASE("what lies round a spot that gives way goes along", "[give_way]") {
  const Arm rod = arm();
  const Surface both = twice(rod.surface);
  Points x = beside(rod.straight, 2 * radius + 0.002);
  for (int v = rod.surface.vertex_count; v < x.rows(); ++v)
    x.row(v) = Eigen::RowVector3d(x(v, 2), x(v, 1), -x(v, 0));  // across
  const Points way = GiveWay(both, beside(rod.straight, 0.5))(x) - x;
  const double most = way.rowwise().norm().maxCoeff();
  CHECK(most > 0.003);
  for (const auto& edge : both.edges.rowwise()) REQUIRE((way.row(edge[0]) - way.row(edge[1])).norm() < 0.6 * most);
}

TEST_CASE("neither the other side of a part is met nor what looks the same way", "[give_way]") {
  const Arm rod = arm();
  // Squeezed, but to more than half its thickness.
  const Points thin = 0.5 * rod.straight;
  Points squeezed = thin;
  squeezed.col(1) *= 0.6;
  CHECK(farthest(GiveWay(rod.surface, thin)(squeezed), squeezed) == 0);
  // The middle of a thin part that is deep within another one: the near skin looks its way, from the far one it would
  // come out behind.
  const Surface both = twice(rod.surface);
  const Points x = beside(rod.straight, 0.034, 0.3), y = GiveWay(both, beside(rod.straight, 0.5, 0.3))(x);
  CHECK(crossings(both, x) == 0);
  for (int v = 0; v < x.rows(); ++v)
    if (std::abs(x(v, 0)) < 0.03) REQUIRE(y.row(v) == x.row(v));
}

TEST_CASE("a body without parts that come together is left as it is", "[give_way]") {
  const Arm rod = arm();
  const GiveWay give(rod.surface, rod.straight);
  CHECK(give(rod.straight) == rod.straight);
  const Points x = bent(rod.straight, 0.5);
  CHECK(give(x) == x);
}

TEST_CASE("where too much would have to give way the body passes through itself", "[give_way]") {
  const Arm rod = arm();
  const GiveWay give(rod.surface, rod.straight);
  const Points x = bent(rod.straight, std::numbers::pi);  // both halves in one place
  const Points y = give(x);
  CHECK(y.allFinite());
  CHECK(crossings(rod.surface, y) > 0);
  CHECK(farthest(x, y) < 0.07);
}

TEST_CASE("what gives way moves as smoothly as the pose", "[give_way]") {
  const Arm rod = arm();
  const GiveWay give(rod.surface, rod.straight);
  double jump = 0;
  Points before;
  for (double angle = 1.5; angle < 1.95; angle += 0.01) {
    const Points x = bent(rod.straight, angle), way = give(x) - x;
    if (before.rows() > 0) jump = std::max(jump, farthest(way, before));
    before = way;
  }
  CHECK(jump < 0.015);
}

TEST_CASE("a grid of cells misses no neighbour", "[give_way]") {
  const Points x = 0.3 * bent(arm().straight, 1);
  const CellGrid grid(x, 0.02);
  for (const int v : {0, 77, 400, 1100}) {
    const Vec3 at = row(x, v) + Vec3(0.01, -0.4 * (v == 77), 0);
    const double reach = 0.033;
    std::vector<int> seen;
    grid.for_each_near(at, reach, [&](int w) { seen.push_back(w); });
    for (int w = 0; w < x.rows(); ++w)
      if ((row(x, w) - at).norm() <= reach) REQUIRE(std::count(seen.begin(), seen.end(), w) == 1);
    CHECK(seen.size() < 0.5 * x.rows());
  }
  CHECK_NOTHROW(CellGrid(Points(0, 3), 1).for_each_near(Vec3::Zero(), 1, [](int) { FAIL("none is there"); }));
}

TEST_CASE("grid: a point that is thrown far away makes the cubes larger, and near points are still found") {
  Points x = Points::Random(100, 3);
  for (const double far : {1e4, 1e9, -1e30}) {
    x(17, 1) = far;
    const CellGrid grid(x, 0.01);
    CHECK(grid.cubes() <= CellGrid::most_cubes);
    for (int a = 0; a < x.rows(); ++a) {
      std::vector<int> found;
      grid.for_each_near(x.row(a).transpose(), 0.5, [&](int b) {
        if ((x.row(a) - x.row(b)).norm() < 0.5) found.push_back(b);
      });
      std::sort(found.begin(), found.end());
      std::vector<int> near;
      for (int b = 0; b < x.rows(); ++b)
        if ((x.row(a) - x.row(b)).norm() < 0.5) near.push_back(b);
      CHECK(found == near);
    }
  }
}

}  // namespace selvedge::test_give_way
