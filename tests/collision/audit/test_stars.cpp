#include <catch2/catch.hpp>

#include <array>
#include <numbers>
#include <random>

#include "collision/audit/audit_pair.hpp"
#include "collision/audit/stars.hpp"
#include "tests/collision/sheets.hpp"

namespace selvedge::test_stars {

namespace {

// `count` triangles round vertex 0, closed or open, with the others at the given angles and height 0.
struct Fan {
  Surface surface;
  Points x;

  Fan(int count, bool closed, double angle) {
    const int rim = closed ? count : count + 1;
    Triangles triangles(count, 3);
    for (int i = 0; i < count; ++i) triangles.row(i) << 0, 1 + i, 1 + (i + 1) % rim;
    surface = make_surface(rim + 1, triangles);
    x = Points::Zero(rim + 1, 3);
    for (int i = 0; i < rim; ++i)
      x.row(1 + i) << 0.02 * std::cos(angle * i / count), 0.02 * std::sin(angle * i / count), 0;
  }
  bool is_clean(const Points& to, double reach = 0) const { return clean_stars({&surface, &x, &to}, reach)[0] != 0; }
  bool is_clean() const { return is_clean(x); }
};

constexpr double turn = 2 * std::numbers::pi;

// Do two triangles of a surface share more than their common vertices and edges? By exact signs.
bool cross(const Surface& surface, const Points& x, int a, int b) {
  std::vector<int> common, of_a, of_b;
  for (const int v : surface.triangles.row(a))
    ((surface.triangles.row(b).array() == v).any() ? common : of_a).push_back(v);
  for (const int v : surface.triangles.row(b))
    if ((surface.triangles.row(a).array() != v).all()) of_b.push_back(v);
  const auto at = [&](int v) { return row(x, v); };
  if (common.size() == 1)
    return triangles_cross_at_vertex(at(common[0]), at(of_a[0]), at(of_a[1]), at(of_b[0]), at(of_b[1]));
  // With a common edge: does a vertex that only one of them has lie on the other?
  const auto on = [&](int v, int t) {
    const auto& corners = surface.triangles.row(t);
    return triangles_intersect(at(v), at(v), at(v), at(corners[0]), at(corners[1]), at(corners[2]));
  };
  return on(of_a[0], b) || on(of_b[0], a);
}

}  // namespace

TEST_CASE("stars: flat ones are clean, folded ones and those that go round twice are not", "[stars]") {
  CHECK(Fan(6, true, turn).is_clean());
  CHECK(Fan(3, true, turn).is_clean());
  CHECK(Fan(3, false, turn / 2).is_clean());
  CHECK(Fan(5, false, 0.9 * turn).is_clean());
  CHECK(Fan(1, false, turn / 6).is_clean());
  CHECK_FALSE(Fan(9, true, 2 * turn).is_clean());
  CHECK_FALSE(Fan(9, false, 1.5 * turn).is_clean());
  CHECK_FALSE(Fan(20, true, turn).is_clean());  // more triangles than are looked at
  Fan folded(6, true, turn);
  folded.x.row(2) = 1.5 * folded.x.row(3);
  CHECK_FALSE(folded.is_clean());
}

TEST_CASE("stars: two fans with one vertex, or of clashing orientation, are none", "[stars]") {
  Triangles triangles(2, 3);
  triangles << 0, 1, 2, 0, 3, 4;
  const Surface apart = make_surface(5, triangles);
  Points x(5, 3);
  x << 0, 0, 0, 1, 0, 0, 1, 1, 0, -1, 0, 0, -1, -1, 0;
  CHECK(clean_stars({&apart, &x, &x}, 0) == std::vector<char>{0, 1, 1, 1, 1});
  triangles << 0, 1, 2, 0, 1, 4;
  const Surface clashing = make_surface(5, triangles);
  CHECK(clean_stars({&clashing, &x, &x}, 0) == std::vector<char>{0, 0, 1, 0, 1});
}

TEST_CASE("stars: one that is flat at both ends but not between is not clean", "[stars]") {
  const Fan fan(6, true, turn);
  Points half_turned = fan.x;
  half_turned.leftCols(2) *= -1;
  CHECK(Fan(fan).is_clean(fan.x.rowwise() + Eigen::RowVector3d(0.3, 0.1, 0)));
  CHECK_FALSE(fan.is_clean(half_turned));

  // The first node, which goes outward, overtakes the second one, which comes in. The others go ahead.
  Fan open(3, false, turn / 4);
  Points to = open.x;
  for (int i = 1; i <= 4; ++i) {
    const double degree = turn / 360, from_angle = std::array{0, 45, 75, 105}[i - 1] * degree;
    open.x.row(i) << std::cos(from_angle), std::sin(from_angle), 0;
    to.row(i) << std::cos(from_angle + 90 * degree), std::sin(from_angle + 90 * degree), 0;
    (i == 1 ? to : open.x).row(i) *= 10;
  }
  CHECK(open.is_clean());
  CHECK(clean_stars({&open.surface, &to, &to}, 0)[0] == 1);
  CHECK_FALSE(open.is_clean(to));
}

TEST_CASE("stars: rounding of the end is allowed for", "[stars]") {
  Fan fan(6, true, turn);
  fan.x.row(2) = 0.999 * fan.x.row(3);
  fan.x(2, 1) += 1e-6;
  fan.x(2, 0) += 1e-6;
  REQUIRE(fan.is_clean());
  CHECK_FALSE(fan.is_clean(fan.x, 1e-6));
  Fan undefined(6, true, turn);
  undefined.x(3, 1) = std::numeric_limits<double>::quiet_NaN();
  CHECK_FALSE(undefined.is_clean());
}

TEST_CASE("stars: triangles of clean ones never cross, by exact signs at many times", "[stars]") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  int clean = 0, not_clean = 0, crossing = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const testing::Sheet sheet = testing::sheet(3, 0.06, 0);
    const Surface surface = sheet.surface();
    const double noise = 0.001 * (1 + trial % 16);
    const auto shaken = [&](Points x) {
      for (double& c : x.reshaped()) c += noise * unit(random);
      return x;
    };
    const double angle = unit(random);
    const Points from = shaken(sheet.x), to = shaken(sheet.x) * Eigen::AngleAxisd(angle, Vec3::UnitX()).matrix();
    const std::vector<char> found = clean_stars({&surface, &from, &to}, 1e-7);
    for (int v = 0; v < surface.vertex_count; ++v) {
      bool crosses = false;
      const auto round = surface.triangles_of(v);
      for (int k = 0; k <= 8; ++k) {
        const Points x = from * (1 - k / 8.0) + to * (k / 8.0);
        for (std::size_t i = 0; i < round.size(); ++i)
          for (std::size_t j = i + 1; j < round.size(); ++j) crosses = crosses || cross(surface, x, round[i], round[j]);
      }
      if (found[v]) CHECK_FALSE(crosses);
      clean += found[v];
      not_clean += !found[v];
      crossing += crosses;
    }
  }
  CAPTURE(clean, not_clean, crossing);
  CHECK(clean > 2000);
  CHECK(not_clean > 1000);
  CHECK(crossing > 100);
}

}  // namespace selvedge::test_stars
