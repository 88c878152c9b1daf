#include <catch2/catch.hpp>

#include <numeric>

#include "collision/audit/audit.hpp"
#include "collision/contact/pins_give_way.hpp"
#include "tests/collision/sheets.hpp"

namespace selvedge::test_pins_give_way {

using testing::join;
using testing::Sheet;
using testing::sheet;

namespace {

struct Moved {
  Points x1, wanted;
  int pins = 0, searches = 0, crossing = 0;  // of all triangles with each other at the end
};

// All vertices of the first sheet are pinned, and move by `way`; the second is an obstacle, or a cloth pinned too.
Moved moved(const Vec3& way, const Vec3& way_of_other, bool obstacle) {
  const Sheet cloth = sheet(4, 0.1, 0.01), other = sheet(2, 0.3, 0);
  const Sheet both = join(cloth, other);
  const Surface first = obstacle ? cloth.surface() : both.surface(), second = other.surface();
  const ContactWorld world =
      make_contact_world(first, obstacle ? std::vector<const Surface*>{&second} : std::vector<const Surface*>{}, true);
  Moved m{both.x, {}};
  m.x1.topRows(25).rowwise() += way.transpose();
  m.x1.bottomRows(9).rowwise() += way_of_other.transpose();
  m.wanted = m.x1;
  std::vector<int> pins(static_cast<std::size_t>(first.vertex_count));
  std::iota(pins.begin(), pins.end(), 0);
  PairSearch search(world);
  ResolveReport report;
  m.pins = pins_give_way(search, world, pins, {}, both.x, m.x1, report);
  m.searches = search.tally().searches;
  m.crossing = audit(both.surface(), m.x1, {}).intersecting_pairs();
  return m;
}

const Vec3 still = Vec3::Zero();

}  // namespace

TEST_CASE("pins that are driven into an obstacle that stands still slide along it", "[pins_give_way]") {
  const Moved m = moved({0.03, -0.05, 0}, still, true);
  CHECK(m.pins == 25);
  CHECK(m.crossing == 0);
  CHECK(m.x1.bottomRows(9) == m.wanted.bottomRows(9));
  CHECK(m.x1.topRows(25).col(1).minCoeff() > 1e-4);
  CHECK(m.x1.topRows(25).col(1).maxCoeff() < 2e-3);
  CHECK((m.x1 - m.wanted).topRows(25).col(0).cwiseAbs().maxCoeff() < 1e-9);
}

TEST_CASE("pins give way to an obstacle that comes to them, under way and at rest", "[pins_give_way]") {
  const Moved met = moved({0, -0.05, 0}, {0, 1e-3, 0}, true), hit = moved(still, {0.01, 0.05, 0}, true);
  for (const Moved* m : {&met, &hit}) {
    CHECK(m->pins == 25);
    CHECK(m->crossing == 0);
    CHECK(m->x1.bottomRows(9) == m->wanted.bottomRows(9));
    const double lowest = m->x1.topRows(25).col(1).minCoeff() - m->wanted(25, 1);
    CHECK(lowest > 1e-4);
    CHECK(lowest < 2e-3);
  }
}

TEST_CASE("pins whose way is free, or that an obstacle carries with it, are left as they are", "[pins_give_way]") {
  const Vec3 far(0.3, 0.2, -0.1);
  const Moved away = moved({0, 0.05, 0}, still, true), along = moved({0, -0.004, 0}, still, true),
              rests = moved(still, still, true), carried = moved(far, far, true);
  for (const Moved* m : {&away, &along, &rests, &carried}) {
    CHECK(m->pins == 0);
    CHECK(m->x1 == m->wanted);
  }
  CHECK(away.searches == 0);
  CHECK(rests.searches == 0);
}

TEST_CASE("pins of two cloths that are driven through each other meet, and those at rest stay", "[pins_give_way]") {
  const Moved one = moved({0, -0.05, 0}, still, false), two = moved({0, -0.05, 0}, {0, 0.05, 0}, false);
  CHECK(one.pins == 25);
  CHECK(one.crossing == 0);
  CHECK(one.x1.bottomRows(9) == one.wanted.bottomRows(9));
  CHECK(one.x1.topRows(25).col(1).minCoeff() > 1e-4);
  CHECK(two.pins > 9);
  CHECK(two.crossing == 0);
}

TEST_CASE("two pins of one cloth that are brought to one place stay apart, and slide past each other",
          "[pins_give_way]") {
  const Sheet cloth = sheet(4, 0.1, 0);
  const Surface surface = cloth.surface();
  const ContactWorld world = make_contact_world(surface, {}, true, &cloth.x);
  const ResolveOptions options;
  const std::vector<int> corners{0, 4};
  PairSearch search(world);
  const auto moved_to = [&](const Vec3& first, const Vec3& second, const Points& x0, int& held) {
    Points x1 = x0;
    x1.row(0) = first.transpose();
    x1.row(4) = second.transpose();
    ResolveReport report;
    held = pins_give_way(search, world, corners, options, x0, x1, report);
    return x1;
  };
  const auto apart = [](const Points& x) { return (x.row(0) - x.row(4)).norm(); };
  const Vec3 a = row(cloth.x, 0), b = row(cloth.x, 4), middle = 0.5 * (a + b);
  int held = 0;
  Points x = moved_to(middle, middle, cloth.x, held);
  CHECK(held == 2);
  CHECK(apart(x) == Approx(2 * options.separation));
  x = moved_to(middle, middle, x, held);  // and again from there
  CHECK(held == 2);
  CHECK(apart(x) == Approx(2 * options.separation));
  // One that rests stays, and the other does not go through it.
  x = moved_to(a, a + Vec3(-0.01, 0.0001, 0), cloth.x, held);
  CHECK(held == 1);
  CHECK(row(x, 0) == a);
  CHECK(apart(x) >= (1 - 1e-5) * 2 * options.separation);
  // Those that come near, but not so near, are where they are wanted.
  x = moved_to(middle - Vec3(0.0003, 0, 0), middle + Vec3(0.0003, 0, 0), cloth.x, held);
  CHECK(held == 0);
  // Pins that an edge joins are one piece, however short it becomes.
  const std::vector<int> neighbours{0, 1};
  Points x1 = cloth.x;
  x1.row(1) = x1.row(0) + Eigen::RowVector3d(1e-4, 0, 0);
  ResolveReport report;
  CHECK(pins_give_way(search, world, neighbours, options, cloth.x, x1, report) == 0);
}

}  // namespace selvedge::test_pins_give_way
