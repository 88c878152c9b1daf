#include <catch2/catch.hpp>

#include "collision/exact/inside.hpp"
#include "collision/penetration/penetration_regions.hpp"
#include "tests/collision/penetration/closed_shapes.hpp"
#include "tests/collision/penetration/cone_volumes.hpp"

namespace selvedge::test_penetration_volume {

using namespace closed;

namespace {

Penetration penetration_of(const Solid& solid, const PenetrationOptions& options = {},
                           std::span<const int> garments = {}) {
  const ClosedSurface closed = close_surface(solid.surface(), garments);
  return find_penetration(closed, closed_positions(closed, solid.x), options);
}

double volume_of(const Penetration& found) {
  double sum = 0;
  for (const PenetrationRegion& region : found.regions) sum += std::abs(region.volume);
  return sum;
}

bool all_enclosed(const Penetration& found) {
  return std::ranges::all_of(found.contours, [](ContourVolume c) { return c == ContourVolume::enclosed; });
}

// Is what is inside on the part that has vertices [first, last) within the other part? All of a part's contours agree.
bool inner_is_within(const Penetration& found, const Solid& part, int first, const Solid& other) {
  std::vector<char> listed(static_cast<std::size_t>(part.x.rows()), 0);
  for (const PenetrationRegion& region : found.regions)
    for (const int v : region.vertices)
      if (v >= first && v < first + part.x.rows()) listed[v - first] = 1;
  return inside(other.surface(), other.x, part.x)[0] == listed[0];
}

// The volume of the sector that the sides name, by brute force.
double expected_volume(const Penetration& found, const Solid& a, const Solid& b) {
  const double common = common_volume(cones_of(a.x, a.triangles, Vec3(0.01, 0.02, 0.03)),
                                      cones_of(b.x, b.triangles, Vec3(-0.02, 0.01, -0.013)));
  const double of_a = mesh_volume(a.x, a.triangles), of_b = mesh_volume(b.x, b.triangles);
  const bool a_in_b = inner_is_within(found, a, 0, b),
             b_in_a = inner_is_within(found, b, static_cast<int>(a.x.rows()), a);
  if (a_in_b && b_in_a) return common;
  if (!a_in_b && b_in_a) return of_a - common;
  if (a_in_b && !b_in_a) return of_b - common;
  return of_a + of_b - common;
}

// Random pairs; returns how many crossed.
int check_pairs(int count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> place(-0.6, 0.6);
  int crossed = 0;
  for (int i = 0; i < count; ++i) {
    const auto any = [&] { return Vec3(place(random), place(random), place(random)); };
    const auto shape = [&]() -> Solid {
      if (i % 4 == 0) return tetrahedron({any(), any(), any(), any()});
      return moved(star(i % 4 == 3 ? 1 : 0, 0.4, random), any());
    };
    const Solid a = shape(), b = shape();
    const Penetration found = penetration_of(both(a, i % 2 ? flipped(b) : b));
    if (found.contours.empty()) continue;
    ++crossed;
    const double expected = expected_volume(found, a, b);
    INFO("pair " << i);
    CHECK(all_enclosed(found));
    CHECK(volume_of(found) == Approx(expected).margin(1e-9));
  }
  return crossed;
}

}  // namespace

TEST_CASE("penetration: two closed surfaces enclose what brute force finds", "[penetration]") {
  CHECK(check_pairs(120, 1) > 60);
}

TEST_CASE("penetration: two thousand pairs of closed surfaces enclose what brute force finds", "[penetration][.long]") {
  CHECK(check_pairs(2000, 2) > 1000);
}

TEST_CASE("penetration: a surface with itself encloses half the integral of w^2 - w", "[penetration]") {
  // A bent bar of many rings whose ends overlap.
  for (const double overlap : {0.1, 0.3, 0.5}) {
    const int count = 40;
    const auto place = [&](int j, double angle) {
      const double way = (2 * 3.14159265358979 + overlap) * j / (count - 1), r = 0.3;
      const Vec3 out(std::cos(way), std::sin(way), 0);
      return Vec3(out * (1 + r * std::cos(angle) + 0.05 * way) + Vec3(0, 0, r * std::sin(angle) + 0.03 * way));
    };
    Solid bar = rings(7, count, place);
    const ClosedSurface closed = close_surface(bar.surface());
    REQUIRE(closed.loops.size() == 2);
    const Points x = closed_positions(closed, bar.x);
    const Triangles& triangles = closed.surface.triangles;
    const double squares =
        common_volume(cones_of(x, triangles, Vec3(0.01, 0.02, 0.03)), cones_of(x, triangles, Vec3(0.3, 0.02, 0.1)));
    const double sign = mesh_volume(x, triangles) < 0 ? -1 : 1;
    const double expected = (squares - sign * mesh_volume(x, triangles)) / 2;
    const Penetration found = find_penetration(closed, x);
    CHECK(all_enclosed(found));
    CHECK(expected > 0.005);
    CHECK(volume_of(found) == Approx(expected).epsilon(1e-9));
  }
}

TEST_CASE("penetration: a bar through a bar encloses what they have in common", "[penetration]") {
  const double a = 0.3, b = 0.5;
  const Solid thin = box(Vec3(-2, -a / 2 + 0.01, -a / 2), Vec3(2.1, a / 2 + 0.01, a / 2)),
              thick = box(Vec3(-b / 2, -b / 2, -2), Vec3(b / 2, b / 2, 2.2));
  for (const Solid& second : {thick, flipped(thick)}) {
    const Penetration found = penetration_of(both(thin, second));
    REQUIRE(found.contours.size() == 2);
    CHECK(found.regions.size() == 1);
    CHECK(volume_of(found) == Approx(a * a * b).epsilon(1e-12));
    // One at a time, what lies beyond the second contour counts too.
    const Penetration single = penetration_of(both(thin, second), {RegionRule::single, SmallerSide::area});
    CHECK(single.regions.size() == 2);
    CHECK(volume_of(single) > 2 * a * a * b);
  }
}

TEST_CASE("penetration: three boxes enclose what each two have in common", "[penetration]") {
  const Vec3 size(1, 1.1, 0.9), second(0.6, 0.47, 0.31), third(0.23, -0.41, 0.52);
  const auto common = [&](const Vec3& by) { return (size - by.cwiseAbs()).prod(); };
  const Solid first = box(Vec3::Zero(), size);
  const Penetration found = penetration_of(both(both(first, moved(first, second)), moved(first, third)));
  CHECK(all_enclosed(found));
  CHECK(found.regions.size() == 3);
  CHECK(volume_of(found) == Approx(common(second) + common(third) + common(third - second)).epsilon(1e-12));
}

TEST_CASE("penetration: spheres approach their lens at second order", "[penetration]") {
  const double distance = 1.2, height = 1 - distance / 2;
  const double lens = 2 * 3.14159265358979 * height * height * (3 - height) / 3;
  double last = 0;
  for (const int times : {1, 2, 3}) {
    const Solid first = turned(ball(times), Vec3(1, 2, 3), 0.4);
    const Penetration found =
        penetration_of(both(first, moved(first, Vec3(distance, 0.01, 0.02).normalized() * distance)));
    REQUIRE(found.regions.size() == 1);
    const double error = lens - volume_of(found);
    CHECK(error > 0);
    if (last > 0) CHECK(last / error == Approx(4).epsilon(0.25));
    last = error;
  }
  CHECK(last < 0.02 * lens);
}

TEST_CASE("penetration: the value does not depend on place, size, orientation and numbering", "[penetration]") {
  std::mt19937 random(3);
  const Solid a = star(2, 0.7, random), b = moved(star(2, 0.7, random), Vec3(0.9, 0.3, 0.2));
  const Solid solid = both(a, b);
  const double value = volume_of(penetration_of(solid));
  REQUIRE(value > 0.1);
  CHECK(volume_of(penetration_of(moved(solid, Vec3(100, -100, 100)))) == Approx(value).epsilon(1e-9));
  Solid large = solid;
  large.x *= 100;
  CHECK(volume_of(penetration_of(large)) == Approx(1e6 * value).epsilon(1e-9));
  CHECK(volume_of(penetration_of(both(flipped(a), b))) == Approx(value).epsilon(1e-9));
  CHECK(volume_of(penetration_of(both(flipped(a), flipped(b)))) == Approx(value).epsilon(1e-9));
  CHECK(volume_of(penetration_of(both(b, a))) == Approx(value).epsilon(1e-9));
  Solid mixed = solid;
  std::vector<int> order(static_cast<std::size_t>(solid.x.rows()));
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
  std::shuffle(order.begin(), order.end(), random);
  for (int v = 0; v < solid.x.rows(); ++v) mixed.x.row(order[v]) = solid.x.row(v);
  for (int& v : mixed.triangles.reshaped()) v = order[v];
  for (int t = 0; t < mixed.triangles.rows(); ++t)
    mixed.triangles.row(t).swap(mixed.triangles.row((7 * t) % mixed.triangles.rows()));
  CHECK(volume_of(penetration_of(mixed)) == Approx(value).epsilon(1e-9));
}

TEST_CASE("penetration: an inner layer that pokes through an outer one", "[penetration]") {
  // Tubes of two garments: the inner one bulges out. What is between its bulge and the outer layer counts, whatever
  // the layers' orientations.
  const auto tube = [](double radius, double bulge) {
    return rings(48, 25, [=](int j, double angle) {
      const double z = 0.05 * (j - 12) + 0.003, out = bulge * std::exp(-40 * (z * z + (angle - 3) * (angle - 3) / 4));
      return Vec3((radius + out) * std::cos(angle + 0.02), (radius + out) * std::sin(angle + 0.02), z);
    });
  };
  const Solid inner = tube(0.45, 0.12), outer = rings(40, 21, [](int j, double angle) {
                                          return Vec3(0.5 * std::cos(angle), 0.5 * std::sin(angle), 0.06 * (j - 10));
                                        });
  std::vector<double> values;
  for (const Solid& first : {inner, flipped(inner)})
    for (const Solid& second : {outer, flipped(outer)}) {
      const Penetration found = penetration_of(both(first, second));
      REQUIRE(found.regions.size() == 1);
      CHECK(all_enclosed(found));
      values.push_back(volume_of(found));
      const Penetration far = penetration_of(moved(both(first, second), Vec3(50, 50, 50)));
      CHECK(volume_of(far) == Approx(values.back()).epsilon(1e-9));
    }
  for (const double value : values) CHECK(value == Approx(values.front()).epsilon(1e-9));
  // By quadrature over the bulge, to the accuracy of the meshes.
  double expected = 0;
  for (double z = -0.6; z < 0.6; z += 0.002)
    for (double angle = 2; angle < 4; angle += 0.002) {
      const double r = 0.45 + 0.12 * std::exp(-40 * (z * z + (angle - 3) * (angle - 3) / 4));
      if (r > 0.5) expected += 0.5 * (r * r - 0.25) * 0.002 * 0.002;
    }
  CHECK(values.front() == Approx(expected).epsilon(0.1));
}

}  // namespace selvedge::test_penetration_volume
