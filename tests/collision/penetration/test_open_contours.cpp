#include <catch2/catch.hpp>

#include "collision/penetration/penetration_loss.hpp"
#include "tests/collision/penetration/closed_shapes.hpp"

// Contours between two garments that end at their rims, where fans would have to meet another garment.

namespace selvedge::test_open_contours {

using namespace closed;

namespace {

constexpr double radius = 0.5;

// A tube along x from 3 to where rim(y, z) ends it.
template <class Rim>
Solid sleeve(const Rim& rim) {
  return rings(15, 12, [&](int j, double angle) {
    const double y = radius * std::cos(angle + 0.1), z = radius * std::sin(angle + 0.1), part = j / 11.0;
    return Vec3((1 - part) * 3 + part * rim(y, z), y, z);
  });
}

// Its hem has gone through the plane x = 1 where y < -0.2, up to 0.09 deep.
Solid slanted_sleeve() {
  return sleeve([](double y, double) { return 1 + 0.3 * (y + 0.2); });
}

// All of it has gone through that plane where z > -0.1.
Solid deep_sleeve() {
  return sleeve([](double, double z) { return 1 - 2 * (z + 0.1); });
}

Solid without_triangles(const Solid& solid, const std::vector<int>& left_out) {
  Solid result{solid.x, Triangles(solid.triangles.rows() - static_cast<int>(left_out.size()), 3)};
  int t = 0;
  for (int k = 0; k < solid.triangles.rows(); ++k)
    if (std::ranges::find(left_out, k) == left_out.end()) result.triangles.row(t++) = solid.triangles.row(k);
  return result;
}

// A box with a wall at x = 1 that is open above y = 0.1.
Solid open_box() { return without_triangles(box(Vec3(-2, -2, -2), Vec3(1, 0.1, 2)), {6, 7}); }

// A wall at x = 1 with a hole halfway between the ends of the slanted sleeve's contour, and what goes back from its
// rim.
Solid holed_wall() {
  return rings(24, 6, [](int j, double angle) {
    const std::array<double, 6> out{0.1, 0.3, 0.6, 1, 2, 2};
    return Vec3(j < 5 ? 1 : -2, -0.2 + out[j] * std::cos(angle), out[j] * std::sin(angle));
  });
}

// The sleeve's section.
std::vector<Vec2> section_corners() {
  std::vector<Vec2> corners;
  for (int i = 0; i < 15; ++i) {
    const double angle = 2 * 3.14159265358979323846 * i / 15 + 0.1;
    corners.push_back(radius * Vec2(std::cos(angle), std::sin(angle)));
  }
  return corners;
}

// Integral of a linear function over the part of a polygon in which it is above 0.
template <class Height>
double integral_above(const std::vector<Vec2>& polygon, const Height& height) {
  std::vector<Vec2> part;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 p = polygon[i], q = polygon[(i + 1) % polygon.size()];
    const double hp = height(p), hq = height(q);
    if (hp >= 0) part.push_back(p);
    if ((hp > 0) != (hq > 0)) part.push_back(p + (q - p) * (hp / (hp - hq)));
  }
  double sum = 0;
  for (std::size_t i = 1; i + 1 < part.size(); ++i) {
    const Vec2 a = part[0], b = part[i] - a, c = part[i + 1] - a;
    sum += 0.5 * (b.x() * c.y() - b.y() * c.x()) * height(a + (b + c) / 3);
  }
  return sum;
}

struct Found {
  ClosedSurface closed;
  Points x;
  Penetration penetration;
  double value = 0;
  Points gradient;  // by the cloth

  explicit Found(const Solid& solid, const PenetrationLossOptions& options = {PenetrationMeasure::volume, {}, 1.0 / 6})
      : closed(close_surface(solid.surface())), x(closed_positions(closed, solid.x)) {
    penetration = find_penetration(closed, x);
    Points by_closed;
    value = penetration_loss(closed, x, penetration, options, &by_closed);
    gradient = by_cloth_positions(closed, by_closed);
  }
  bool is_one_region() const {
    return penetration.regions.size() == 1 && penetration.regions[0].closing && penetration.contours.size() == 1 &&
           penetration.contours[0] == ContourVolume::enclosed;
  }
};

void check_gradient(const Solid& solid, unsigned seed) {
  const Found found(solid);
  REQUIRE(found.is_one_region());
  REQUIRE(found.value > 1e-3);
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  for (int k = 0; k < 3; ++k) {
    Points direction = solid.x;
    for (double& d : direction.reshaped()) d = normal(random);
    direction /= direction.norm();
    const double h = 2e-5;
    const auto there = [&](double by) { return Found({solid.x + by * direction, solid.triangles}).value; };
    const double slope = (there(h) - there(-h)) / (2 * h);
    CHECK(found.gradient.cwiseProduct(direction).sum() ==
          Approx(slope).epsilon(1e-6).margin(1e-7 * found.gradient.norm()));
  }
  CHECK(found.gradient.colwise().sum().norm() < 1e-12 * found.gradient.norm());
}

// Rough, so that nothing is special.
Solid shaken(Solid solid, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> by(-0.01, 0.01);
  for (double& x : solid.x.reshaped()) x += by(random);
  return solid;
}

}  // namespace

TEST_CASE("open contours: a hem that has gone through a wall has the volume behind the wall", "[penetration]") {
  const double expected = integral_above(section_corners(), [](const Vec2& at) { return -0.3 * (at.x() + 0.2); });
  const Solid sleeve = slanted_sleeve(), wall = box(Vec3(-2, -2, -2), Vec3(1, 2, 2));
  for (const Solid& first : {sleeve, flipped(sleeve)})
    for (const Solid& second : {wall, flipped(wall)})
      for (const Solid& solid :
           {both(first, second), both(second, first), moved(both(first, second), Vec3(50, 7, 9))}) {
        const Found found(solid);
        REQUIRE(found.is_one_region());
        CHECK(found.value == Approx(expected).epsilon(1e-9));
      }
}

TEST_CASE("open contours: where a straight way meets a hole, another is found", "[penetration]") {
  const double expected = integral_above(section_corners(), [](const Vec2& at) { return -0.3 * (at.x() + 0.2); });
  const Found found(both(slanted_sleeve(), holed_wall()));
  REQUIRE(found.is_one_region());
  CHECK(found.penetration.regions[0].closing->paths[1].kind == ClosingKind::middles);
  CHECK(found.value == Approx(expected).epsilon(1e-9));
}

TEST_CASE("open contours: with ends at both rims they have the volume up to a plane through the ends",
          "[penetration]") {
  for (const Solid& wall : {open_box(), flipped(open_box())}) {
    const Found found(both(deep_sleeve(), wall));
    REQUIRE(found.is_one_region());
    const ContourClosing& closing = *found.penetration.regions[0].closing;
    const auto end = [&](CurvePoint point) {
      return position_of(found.closed.surface, found.x, found.penetration.crossings, point);
    };
    const Vec3 from = end(closing.paths[0].points.front()), to = end(closing.paths[0].points.back());
    const Vec3 normal = (to - from).cross(up_of_plane(found.closed, found.x, closing));
    const double sign = normal.y() * (0 - from.y()) + normal.z() * (0 - from.z()) > 0 ? -1 : 1;
    const double expected = integral_above(section_corners(), [&](const Vec2& at) {
      return sign * (normal.y() * (at.x() - from.y()) + normal.z() * (at.y() - from.z())) / std::abs(normal.x());
    });
    CHECK(found.value > 1e-3);
    CHECK(found.value == Approx(expected).epsilon(1e-9));
  }
}

TEST_CASE("open contours: the exact gradient is that of the value", "[penetration]") {
  Solid large = ball(2);
  large.x *= 2;
  check_gradient(shaken(both(slanted_sleeve(), moved(large, Vec3(-0.85, 0.02, 0.03))), 1), 2);
  check_gradient(shaken(both(deep_sleeve(), open_box()), 3), 4);
  check_gradient(shaken(both(slanted_sleeve(), holed_wall()), 5), 6);
}

TEST_CASE("open contours: frozen gradients are those of their surrogates", "[penetration]") {
  const Found found(shaken(both(deep_sleeve(), open_box()), 5));
  REQUIRE(found.is_one_region());
  for (const CrossingMotion motion : {CrossingMotion::frozen_on_edge, CrossingMotion::frozen_on_face}) {
    const PenetrationLossOptions options{PenetrationMeasure::volume, motion, 1.0 / 6};
    Points gradient;
    CHECK(penetration_loss(found.closed, found.x, found.penetration, options, &gradient) == Approx(found.value));
    const Points direction = Points::Random(found.x.rows(), 3);
    const auto there = [&](double by) {
      return penetration_loss(found.closed, found.x + by * direction, found.penetration, options);
    };
    CHECK(gradient.cwiseProduct(direction).sum() == Approx((there(1e-5) - there(-1e-5)) / 2e-5).epsilon(1e-6));
  }
}

TEST_CASE("open contours: what goes through a sheet from end to end stays open", "[penetration]") {
  // A tube that is cut along its whole length: its contours run from one hole to the other.
  const Solid tube = sleeve([](double, double) { return -1.0; }), wall = box(Vec3(-4, -0.3, -3), Vec3(5, 4, 3));
  const Found found(both(tube, wall));
  REQUIRE(found.penetration.contours.size() == 2);
  for (const ContourVolume contour : found.penetration.contours) CHECK(contour == ContourVolume::open);
  CHECK(found.value == 0);
}

}  // namespace selvedge::test_open_contours
