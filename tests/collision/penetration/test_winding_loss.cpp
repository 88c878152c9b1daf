#include <catch2/catch.hpp>

#include <numbers>
#include <numeric>
#include <random>

#include "collision/penetration/dipole_tree.hpp"
#include "collision/penetration/face_cells.hpp"
#include "collision/penetration/penetration_loss.hpp"
#include "collision/penetration/winding_loss.hpp"
#include "tests/collision/penetration/closed_shapes.hpp"

namespace selvedge::test_winding_loss {

using namespace closed;

namespace {

constexpr double pi = std::numbers::pi;

Segments segments_of(const ClosedSurface& closed, const Points& x) {
  const SheetView sheet{&closed.surface, &x};
  return penetration_segments(closed, find_segments(std::span(&sheet, 1)));
}

struct Winding {
  WindingReport report;
  Points gradient;
  int pairs = 0;
};

Winding winding_of(const Solid& solid) {
  const ClosedSurface closed = close_surface(solid.surface());
  const Points x = closed_positions(closed, solid.x);
  Winding result;
  const Segments segments = segments_of(closed, x);
  result.pairs = static_cast<int>(segments.segments.size());
  Points by_closed;
  result.report = winding_loss(closed, x, segments, {}, &by_closed);
  result.gradient = by_cloth_positions(closed, by_closed);
  return result;
}

double winding_at(const DipoleTree& tree, const Vec3& at, int left_out = -1) {
  const WindingPoint point{at, left_out};
  return winding_numbers(tree, std::span(&point, 1))[0];
}

// By definition: the solid angles of all triangles, for tests.
double winding_by_definition(const Solid& solid, const Vec3& at) {
  double angle = 0;
  for (const auto& t : solid.triangles.rowwise()) {
    const Vec3 a = (row(solid.x, t[0]) - at).normalized(), b = (row(solid.x, t[1]) - at).normalized(),
               c = (row(solid.x, t[2]) - at).normalized();
    const double half = std::atan2(a.dot(b.cross(c)), 1 + a.dot(b) + b.dot(c) + c.dot(a));
    angle += 2 * half;
  }
  return angle / (4 * pi);
}

// Weight x integral of the cost over a box, by points on a grid.
double cost_on_grid(const Solid& solid, const Vec3& lo, const Vec3& hi) {
  double sum = 0;
  for (int i = 0; i < 48; ++i)
    for (int j = 0; j < 10; ++j)
      for (int k = 0; k < 10; ++k) {
        const Vec3 share((i + 0.5) / 48, (j + 0.5 + 0.05 * k) / 10.5, (k + 0.5) / 10);
        sum += winding_cost(winding_by_definition(solid, lo + share.cwiseProduct(hi - lo)));
      }
  return 1.8e5 * sum * (hi - lo).prod() / 4800;
}

// A skirt the front of which has gone through the back by `depth` [m], up to a hand's breadth from the hem; open above
// and below.
Solid skirt(double depth) {
  return rings(56, 20, [=](int j, double angle) {
    const double down = j / 19.0, low = 1 / (1 + std::exp(30 * (down - 0.5))), wide = 0.25;
    const double turn = std::remainder(angle - 0.02, 2 * pi), front = std::exp(-2 * std::pow(turn, 4));
    return Vec3(wide * std::cos(angle) - (2 * wide + depth) * low * front, 0.2 * std::sin(angle), 0.5 * down);
  });
}

// A hem that is rolled up inwards, one turn and a quarter.
Solid rolled_hem() {
  return rings(40, 26, [](int j, double angle) {
    const double way = j < 16 ? 1 - j / 16.0 : 0, turn = 2.5 * pi * way, r = 0.06 - 0.04 * way;
    const double out = 0.24 + r * std::cos(turn), up = -r * std::sin(turn) + (j < 16 ? 0 : 0.03 * (j - 15));
    return Vec3(out * std::cos(angle), out * std::sin(angle), up + 0.001 * std::sin(5 * angle + 0.3));
  });
}

Solid bent_bar(double overlap) {
  const int count = 40;
  return rings(9, count, [=](int j, double angle) {
    const double way = (2 * pi + overlap) * j / (count - 1), r = 0.3 + (j == 0 || j == count - 1 ? -0.29 : 0.0);
    const Vec3 out(std::cos(way), std::sin(way), 0);
    return Vec3(out * (1 + r * std::cos(angle) + 0.05 * way) + Vec3(0, 0, r * std::sin(angle) + 0.03 * way));
  });
}

}  // namespace

TEST_CASE("winding: the cost has a dead band", "[penetration]") {
  for (const double w : {-0.5, -0.23, 0.0, 1.0, 1.5}) CHECK(winding_cost(w) == 0);
  CHECK(winding_cost(2) == Approx(1));
  CHECK(winding_cost(-1) == Approx(1));
  CHECK(winding_cost(1.75) == Approx(0.5));
  CHECK(winding_cost(3) == Approx(2));
}

TEST_CASE("winding: the tree is close to the definition", "[penetration]") {
  const Solid solid = both(ball(2), moved(skirt(0.02), Vec3(0.5, 0.2, 0.9)));
  const Surface surface = solid.surface();
  std::vector<int> faces;
  for (int t = 0; t < surface.triangles.rows(); ++t) faces.push_back(t);
  const std::vector<signed char> turn(faces.size(), 1);
  const DipoleTree tree = make_dipole_tree(surface, solid.x, faces, turn, 2);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(-1.5, 1.5);
  double worst = 0, squares = 0;
  for (int i = 0; i < 500; ++i) {
    Vec3 at;
    for (int k = 0; k < 3; ++k) at[k] = place(random);  // in this order with every compiler
    const double off = std::abs(winding_at(tree, at) - winding_by_definition(solid, at));
    worst = std::max(worst, off);
    squares += off * off;
  }
  CHECK(std::sqrt(squares / 500) < 0.003);
  CHECK(worst < 0.03);
  CHECK(winding_at(make_dipole_tree(surface, solid.x, faces, turn, 1e9), Vec3(0.1, 0.2, 0.3)) ==
        Approx(winding_by_definition(solid, Vec3(0.1, 0.2, 0.3))).epsilon(1e-12));
}

TEST_CASE("winding: points do not depend on their company", "[penetration]") {
  const Solid solid = both(ball(2), moved(skirt(0.02), Vec3(0.5, 0.2, 0.9)));
  const Surface surface = solid.surface();
  std::vector<int> faces(static_cast<std::size_t>(surface.triangles.rows()));
  std::iota(faces.begin(), faces.end(), 0);
  const std::vector<signed char> turn(faces.size(), 1);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> share(0, 1);
  std::vector<WindingPoint> points;  // on faces, near them and far from them, in any order
  for (int i = 0; i < 203; ++i) {
    const int face = static_cast<int>(random() % faces.size());
    const double u = share(random) / 2, v = share(random) / 2, height = std::pow(10.0, -static_cast<double>(i % 5));
    const Vec3 a = row(solid.x, surface.triangles(face, 0)), b = row(solid.x, surface.triangles(face, 1)) - a,
               c = row(solid.x, surface.triangles(face, 2)) - a;
    points.push_back({a + u * b + v * c + (i % 3 ? height : 0.0) * b.cross(c).normalized(), i % 3 ? -1 : face});
  }
  for (const double far : {2.0, 1e9}) {
    const DipoleTree tree = make_dipole_tree(surface, solid.x, faces, turn, far);
    const std::vector<double> together = winding_numbers(tree, points);
    for (std::size_t i = 0; i < points.size(); ++i) {
      CHECK(together[i] == winding_at(tree, points[i].at, points[i].left_out));
      Solid others = solid;
      if (const int out = points[i].left_out; out >= 0) others.triangles.row(out).setConstant(others.triangles(out, 0));
      if (far > 2) CHECK(together[i] == Approx(winding_by_definition(others, points[i].at)).margin(1e-11));
    }
  }
}

TEST_CASE("winding: cells of a face are what chords leave of it", "[penetration]") {
  CHECK(face_cells({}).size() == 1);
  // Across, from one edge to another, and a short one that ends inside.
  const std::vector<FaceChord> chords{{Vec2(0, 0.5), Vec2(0.5, 0.5)}, {Vec2(0.2, 0), Vec2(0.2, 0.2)}};
  const std::vector<FaceCell> cells = face_cells(chords);
  CHECK(cells.size() == 3);
  std::array<double, 3> sum{};
  for (const FaceCell& cell : cells)
    for (int k = 0; k < 3; ++k) sum[k] += cell.moment[k];
  for (const double moment : sum) CHECK(moment == Approx(1.0 / 6));
}

TEST_CASE("winding: on a closed surface it is the enclosed volume", "[penetration]") {
  for (const double overlap : {0.2, 0.4}) {
    const Solid solid = bent_bar(overlap);
    const ClosedSurface closed = close_surface(solid.surface());
    const Points x = closed_positions(closed, solid.x);
    Segments segments;
    const Penetration found = find_penetration(closed, x, {}, &segments);
    REQUIRE(found.regions.size() == 1);
    Points exact;
    const double value = penetration_loss(closed, x, found, {}, &exact);
    exact = by_cloth_positions(closed, exact);
    const Winding winding = winding_of(solid);
    INFO("value " << winding.report.value << " for " << value << ", gradient apart "
                  << (winding.gradient - exact).norm() / exact.norm() << ", rim " << winding.report.rim_share);
    CHECK(winding.report.value == Approx(value).epsilon(0.02));
    CHECK((winding.gradient - exact).norm() < 0.02 * exact.norm());
  }
}

TEST_CASE("winding: what does not cross itself costs nothing", "[penetration]") {
  const auto is_zero = [](const Solid& solid) {
    const Winding winding = winding_of(solid);
    return winding.report.value == 0 && winding.gradient.isZero(0);
  };
  CHECK(is_zero(skirt(-0.1)));
  const Solid scroll = rings(3, 61, [](int j, double angle) {
    const double way = 2 * pi * 3.2 * j / 60, r = 0.1 + 0.02 * way / pi;
    return Vec3(r * std::cos(way), r * std::sin(way), angle);
  });
  Solid sheet{scroll.x, Triangles(240, 3)};  // the scroll without what would close its rings
  int t = 0;
  for (int j = 0; j < 60; ++j)
    for (int i = 0; i < 2; ++i) {
      const int a = 3 * j + i;
      sheet.triangles.row(t++) << a, a + 1, a + 3;
      sheet.triangles.row(t++) << a + 1, a + 4, a + 3;
    }
  CHECK(is_zero(sheet));

  // A hem rolled up inside its skirt crosses no cloth, but it does cross the fan that closes the skirt.
  const Solid lifted = rolled_hem();
  const Winding winding = winding_of(lifted);
  CHECK(winding.pairs > 0);
  CHECK(winding.report.value == 0);
  CHECK(winding.gradient.isZero(0));
  const ClosedSurface closed = close_surface(lifted.surface());
  const Points x = closed_positions(closed, lifted.x);
  CHECK(penetration_loss(closed, x, find_penetration(closed, x)) > 0);
}

TEST_CASE("winding: a front hem through the back", "[penetration]") {
  const Winding winding = winding_of(skirt(0.02));
  REQUIRE(winding.pairs > 0);
  CHECK(winding.report.rim_share < 0.4);
  // Deeper by two millimetres, against a grid.
  const double h = 2e-3;
  const Vec3 lo(-0.3, -0.15, -0.1), hi(-0.17, 0.15, 0.35);
  const double more = cost_on_grid(skirt(0.02 + h), lo, hi), less = cost_on_grid(skirt(0.02 - h), lo, hi);
  const double slope = (more - less) / (2 * h);
  const double predicted = winding.gradient.cwiseProduct((skirt(0.02 + h).x - skirt(0.02 - h).x) / (2 * h)).sum();
  WARN("slope " << slope << ", predicted " << predicted << ", rim " << winding.report.rim_share << ", value "
                << winding.report.value << " of " << 0.5 * (more + less));
  CHECK(slope > 0);
  CHECK(predicted == Approx(slope).epsilon(0.35));
}

}  // namespace selvedge::test_winding_loss
