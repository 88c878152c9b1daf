#include <catch2/catch.hpp>

#include <limits>
#include <random>

#include "collision/distance/signed_distance.hpp"
#include "collision/exact/inside.hpp"
#include "collision/geometry/distance.hpp"
#include "collision/geometry/error.hpp"
#include "tests/collision/solids.hpp"
#include "tests/threads.hpp"

namespace selvedge::test_signed_distance {

using testing::Solid;

namespace {

// Every triangle, the lowest of the nearest.
struct Brute {
  double distance;
  int triangle;
};
Brute brute_nearest(const Solid& solid, const Vec3& p) {
  Brute best{std::numeric_limits<double>::infinity(), -1};
  for (int t = 0; t < solid.surface.triangles.rows(); ++t) {
    const auto corner = [&](int k) { return row(solid.x, solid.surface.triangles(t, k)); };
    const double squared = point_triangle(p, corner(0), corner(1), corner(2)).squared_distance;
    if (squared < best.distance) best = {squared, t};
  }
  best.distance = std::sqrt(best.distance);
  return best;
}

// All over the box, near the surface, on faces, edges and vertices.
Points queries(const Solid& solid, int count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  std::normal_distribution<double> normal(0, 1);
  const auto pick = [&](Eigen::Index size) { return std::min<int>(static_cast<int>(unit(random) * size), size - 1); };
  const Vec3 lo = solid.x.colwise().minCoeff(), hi = solid.x.colwise().maxCoeff();
  Points at(count, 3);
  for (int i = 0; i < count; ++i) {
    const int t = pick(solid.surface.triangles.rows());
    const auto corner = [&](int k) { return row(solid.x, solid.surface.triangles(t, k)); };
    double u = unit(random), v = unit(random);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    if (i % 7 == 1) v = 0;
    if (i % 7 == 2) u = v = 0;
    const Vec3 on = corner(0) + u * (corner(1) - corner(0)) + v * (corner(2) - corner(0));
    const double off = i % 7 < 3 ? 0 : i % 7 == 3 ? 1e-6 : i % 7 == 4 ? 1e-3 : 0.05;
    Vec3 p = on + off * Vec3(normal(random), normal(random), normal(random));
    if (i % 7 == 6)
      p = lo + Vec3(unit(random), unit(random), unit(random)).cwiseProduct(1.4 * (hi - lo)) - 0.2 * (hi - lo);
    at.row(i) = p.transpose();
  }
  return at;
}

struct Difference {
  double distance = 0;
  int wrong_sides = 0, wrong_triangles = 0, wrong_lengths = 0;
};

Difference against_brute_force(const Solid& solid, BodyShape shape, int count) {
  DistanceField field(solid.surface, shape);
  field.move_to(solid.x);
  const Points at = queries(solid, count, 11);
  const std::vector<SignedDistance> found = field.ask(at);
  const std::vector<int> winding = winding_numbers(solid.surface, solid.x, at);
  Difference result;
  for (int i = 0; i < count; ++i) {
    const Brute expected = brute_nearest(solid, row(at, i));
    result.distance = std::max(result.distance, std::abs(std::abs(found[i].value) - expected.distance));
    result.wrong_triangles += found[i].triangle != expected.triangle;
    if (expected.distance > 1e-9) {
      result.wrong_sides += (found[i].value < 0) != (winding[i] > 0);
      result.wrong_lengths += std::abs(found[i].gradient.norm() - 1) > 1e-9;
    }
  }
  return result;
}

void check_equal(const Difference& d) {
  CHECK(d.distance < 1e-12);
  CHECK(d.wrong_sides == 0);
  CHECK(d.wrong_triangles == 0);
  CHECK(d.wrong_lengths == 0);
}

}  // namespace

TEST_CASE("signed distance: equal to brute force on closed bodies, needles among them", "[distance]") {
  check_equal(against_brute_force(testing::blob(14), BodyShape::raw, 3000));
  check_equal(against_brute_force(testing::blob(10), BodyShape::united, 1000));
  check_equal(against_brute_force(testing::block({-1, 0, 2}, {1, 0.2, 2.3}, 3), BodyShape::united, 2000));
  check_equal(against_brute_force(testing::rod(60, 0.02, 2), BodyShape::united, 2000));
  Solid far = testing::blob(8);
  far.x = (far.x.array() * 0.3 + 200.0).matrix();
  check_equal(against_brute_force(far, BodyShape::raw, 1000));
}

TEST_CASE("signed distance: an open body's side is told by the winding number", "[distance]") {
  const Solid solid = testing::without_some(testing::blob(12), 40);
  DistanceField field(solid.surface);
  field.move_to(solid.x);
  REQUIRE_FALSE(field.is_closed());
  const Points at = queries(solid, 1500, 3);
  const std::vector<SignedDistance> found = field.ask(at);
  int wrong = 0, inside = 0;
  for (int i = 0; i < at.rows(); ++i) {
    if (std::abs(found[i].value) < 1e-9) continue;
    wrong += (found[i].value < 0) != (exact_winding(solid.surface, solid.x, row(at, i)) > 0.5);
    inside += found[i].value < 0;
  }
  CHECK(wrong == 0);
  CHECK(inside > 300);
}

namespace {

// Distance of a point from the outside of two axis-aligned boxes taken together: the boundary is made of rectangles of
// the grid that all their planes make.
double distance_from_boxes(const std::array<std::array<Vec3, 2>, 2>& boxes, const Vec3& p) {
  std::array<std::array<double, 4>, 3> planes;
  for (int k = 0; k < 3; ++k) {
    planes[k] = {boxes[0][0][k], boxes[0][1][k], boxes[1][0][k], boxes[1][1][k]};
    std::sort(planes[k].begin(), planes[k].end());
  }
  const auto covers = [&](const Vec3& q) {
    for (const auto& [lo, hi] : boxes)
      if ((q.array() > lo.array()).all() && (q.array() < hi.array()).all()) return true;
    return false;
  };
  double nearest = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (const double plane : planes[axis])
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
          Vec3 middle, closest;
          middle[axis] = plane;
          middle[u] = 0.5 * (planes[u][i] + planes[u][i + 1]);
          middle[v] = 0.5 * (planes[v][j] + planes[v][j + 1]);
          Vec3 before = middle, behind = middle;
          before[axis] -= 1e-7;
          behind[axis] += 1e-7;
          if (covers(before) == covers(behind)) continue;
          closest[axis] = plane;
          closest[u] = std::clamp(p[u], planes[u][i], planes[u][i + 1]);
          closest[v] = std::clamp(p[v], planes[v][j], planes[v][j + 1]);
          nearest = std::min(nearest, (p - closest).norm());
        }
  }
  return covers(p) ? -nearest : nearest;
}

}  // namespace

TEST_CASE("signed distance: the union of bodies that pass through each other", "[distance]") {
  const Mat3 turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  const std::vector<std::array<std::array<Vec3, 2>, 2>> cases{
      {{{Vec3(-1, -0.5, -0.4), Vec3(0.6, 0.5, 0.4)}, {Vec3(0.1, -0.8, -0.2), Vec3(1.3, 0.3, 0.7)}}},
      {{{Vec3(-1, -1, -1), Vec3(1, 1, 1)}, {Vec3(-0.3, -0.2, -2), Vec3(0.3, 0.4, 2)}}},
      {{{Vec3(-1, -1, -1), Vec3(1, 1, 1)}, {Vec3(-0.3, -0.2, -0.5), Vec3(0.3, 0.4, 0.5)}}}};  // inside the other
  for (const auto& boxes : cases)
    for (const int n : {1, 3}) {
      Solid solid =
          testing::both(testing::block(boxes[0][0], boxes[0][1], n), testing::block(boxes[1][0], boxes[1][1], n));
      const Points at = queries(solid, 1200, 5);
      solid.x = testing::rotated(solid.x, turn);
      DistanceField field(solid.surface);
      field.move_to(solid.x);
      CHECK(field.crosses_itself());
      const std::vector<SignedDistance> found = field.ask(testing::rotated(at, turn));
      double worst = 0;
      int deeper_than_raw = 0, not_unit = 0;
      DistanceField raw(solid.surface, BodyShape::raw);
      raw.move_to(solid.x);
      const std::vector<SignedDistance> plain = raw.ask(testing::rotated(at, turn));
      for (int i = 0; i < at.rows(); ++i) {
        worst = std::max(worst, std::abs(found[i].value - distance_from_boxes(boxes, row(at, i))));
        deeper_than_raw += found[i].value < -1e-6 && found[i].value < -std::abs(plain[i].value) - 1e-6;
        not_unit += std::abs(found[i].value) > 1e-9 && std::abs(found[i].gradient.norm() - 1) > 1e-9;
      }
      INFO("squares a side: " << n);
      CHECK(worst < 1e-9);
      CHECK(not_unit == 0);
      CHECK(deeper_than_raw > 20);
    }
}

TEST_CASE("signed distance: its gradient is that of its differences, its place the kind of its Jacobian",
          "[distance]") {
  const Solid solid = testing::blob(10);
  DistanceField field(solid.surface);
  field.move_to(solid.x);
  const Points at = queries(solid, 400, 17);
  const std::vector<SignedDistance> found = field.ask(at);
  constexpr double step = 1e-6;
  int places[3] = {};
  for (int k = 0; k < 3; ++k) {
    Points forth = at, back = at;
    forth.col(k).array() += step;
    back.col(k).array() -= step;
    const auto after = field.ask(forth), before = field.ask(back);
    for (int i = 0; i < at.rows(); ++i) {
      if (std::abs(found[i].value) < 1e-4 || after[i].triangle != before[i].triangle) continue;
      CHECK(std::abs((after[i].value - before[i].value) / (2 * step) - found[i].gradient[k]) < 1e-5);
      ++places[static_cast<int>(found[i].place)];
    }
  }
  for (const int count : places) CHECK(count > 20);
  for (const SignedDistance& d : found) CHECK(d.along.norm() == Approx(d.place == SurfacePlace::edge ? 1 : 0));
}

TEST_CASE("signed distance: where the search begins, threads and refitting change nothing", "[distance]") {
  Solid solid = testing::blob(14);
  const Points at = queries(solid, 2000, 23);
  DistanceField field(solid.surface);
  field.move_to((solid.x.array() * 1.5).matrix());
  std::vector<int> faces;
  std::vector<SignedDistance> one, other;
  field.ask(at, faces, one);
  field.move_to(solid.x);
  with_threads(1, [&] { field.ask(at, faces, one); });
  faces.clear();
  with_threads(3, [&] { field.ask(at, faces, other); });
  const std::vector<SignedDistance> fresh = [&] {
    DistanceField made(solid.surface);
    made.move_to(solid.x);
    return made.ask(at);
  }();
  for (std::size_t i = 0; i < one.size(); ++i) {
    REQUIRE(one[i].value == other[i].value);
    REQUIRE(one[i].triangle == other[i].triangle);
    REQUIRE(one[i].gradient == other[i].gradient);
    REQUIRE(one[i].value == fresh[i].value);
    REQUIRE(one[i].triangle == fresh[i].triangle);
  }
}

TEST_CASE("signed distance: ties go to the lowest triangle; singular input is finite or one clear error",
          "[distance]") {
  const Solid cube = testing::block({-1, -1, -1}, {1, 1, 1}, 1);
  DistanceField field(cube.surface);
  CHECK_THROWS_AS(field.ask(Points::Zero(1, 3)), Error);
  field.move_to(cube.x);
  const SignedDistance middle = field.ask(Points::Zero(1, 3)).front();
  CHECK(middle.value == Approx(-1));
  CHECK(middle.triangle == brute_nearest(cube, Vec3::Zero()).triangle);

  Points at(3, 3);
  at << 1, 0.25, 0.5, 1, 1, 0.5, 1, 1, 1;  // on a face, an edge, a vertex
  for (const SignedDistance& d : field.ask(at)) {
    CHECK(d.value == 0);
    CHECK(d.gradient.norm() == Approx(1));
  }
  at(1, 2) = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(field.ask(at), Error);
  Points broken = cube.x;
  broken(2, 0) = std::numeric_limits<double>::infinity();
  CHECK_THROWS_AS(field.move_to(broken), Error);
  const Surface nothing = make_surface(3, Triangles(0, 3));
  CHECK_THROWS_AS(DistanceField(nothing), Error);

  Solid flat = testing::block({-1, -1, 0}, {1, 1, 0}, 2);
  DistanceField pancake(flat.surface);
  pancake.move_to(flat.x);
  Points beside(3, 3);
  beside << 0.1, 0.2, 0.3, 0.1, 0.2, 0, 3, 0, 0;
  const auto found = pancake.ask(beside);
  CHECK(found[0].value == Approx(0.3));
  CHECK(found[1].value == 0);
  CHECK(found[2].value == Approx(2));
  for (const SignedDistance& d : found) CHECK(d.gradient.allFinite());
  Solid point = cube;
  point.x.setConstant(0.5);
  DistanceField dot(point.surface);
  dot.move_to(point.x);
  CHECK(dot.ask(beside)[2].value == Approx(std::sqrt(6.75)));
}

}  // namespace selvedge::test_signed_distance
