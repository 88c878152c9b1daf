#include <catch2/catch.hpp>

#include <numeric>

#include "collision/exact/outward_faces.hpp"
#include "collision/geometry/same_places.hpp"
#include "tests/collision/solids.hpp"

namespace selvedge::test_outward_faces {

using testing::ball;
using testing::block;
using testing::both;
using testing::Solid;

namespace {

Triangles flipped(Triangles triangles, int begin, int end) {
  for (int t = begin; t < end; ++t) std::swap(triangles(t, 1), triangles(t, 2));
  return triangles;
}

int count(const Solid& solid) { return static_cast<int>(solid.surface.triangles.rows()); }

Solid at(Solid solid, double scale, const Vec3& place) {
  solid.x = (scale * solid.x).rowwise() + place.transpose();
  return solid;
}

OutwardFaces faced(const Triangles& triangles, const std::vector<Points>& frames) {
  return face_outward(triangles, frames, same_places(frames));
}

// Every corner of every triangle is a vertex of its own.
Solid soup(const Solid& solid) {
  Solid made;
  const std::vector<int> corners(solid.surface.triangles.reshaped<Eigen::RowMajor>().begin(),
                                 solid.surface.triangles.reshaped<Eigen::RowMajor>().end());
  made.x = solid.x(corners, Eigen::all);
  Triangles triangles(solid.surface.triangles.rows(), 3);
  std::iota(triangles.reshaped<Eigen::RowMajor>().begin(), triangles.reshaped<Eigen::RowMajor>().end(), 0);
  made.surface = make_surface(static_cast<int>(corners.size()), triangles);
  return made;
}

}  // namespace

TEST_CASE("outward: what faces outwards stays, what faces inwards is turned, seams or not", "[outward_faces]") {
  const Solid one = ball(8), parted = soup(one);
  for (const Solid& solid : {one, parted}) {
    const Triangles& right = solid.surface.triangles;
    const OutwardFaces same = faced(right, {solid.x});
    CHECK(same.triangles == right);
    CHECK_FALSE(same.turned());
    REQUIRE(same.shells.size() == 1);
    CHECK(same.shells[0].closed());
    const OutwardFaces turned = faced(flipped(right, 0, count(solid)), {solid.x});
    CHECK(turned.triangles == right);
    CHECK((turned.shells[0].over && turned.shells[0].odd == 0));
    const OutwardFaces mixed = faced(flipped(right, 10, 25), {solid.x});
    CHECK(mixed.triangles == right);
    CHECK((!mixed.shells[0].over && mixed.shells[0].odd == 15));
    const OutwardFaces mostly = faced(flipped(right, 20, count(solid)), {solid.x});
    CHECK(mostly.triangles == right);
    CHECK((mostly.shells[0].over && mostly.shells[0].odd == 20));
  }
}

TEST_CASE("outward: each of several shells by its own volume", "[outward_faces]") {
  const Solid two = both(ball(8), at(ball(6), 1, {1.2, 0, 0}));
  const Triangles& right = two.surface.triangles;
  const int first = count(ball(8));
  CHECK(faced(flipped(right, 0, first), {two.x}).triangles == right);
  const OutwardFaces second = faced(flipped(right, first, count(two)), {two.x});
  CHECK(second.triangles == right);
  REQUIRE(second.shells.size() == 2);
  CHECK((!second.shells[0].over && second.shells[1].over && !second.shells[1].cavity));
  CHECK(faced(flipped(right, 0, count(two)), {two.x}).triangles == right);
}

TEST_CASE("outward: a shell within another that faces the other way bounds a cavity", "[outward_faces]") {
  const Solid two = both(ball(8), at(ball(6), 0.3, {0.2, 0, 0}));
  const int first = count(ball(8)), all = count(two);
  const Triangles& parts = two.surface.triangles;
  CHECK(faced(parts, {two.x}).triangles == parts);  // a part inside of the body

  const Triangles hollow = flipped(parts, first, all);
  const OutwardFaces kept = faced(hollow, {two.x});
  CHECK(kept.triangles == hollow);
  CHECK((kept.shells[1].cavity && !kept.shells[1].over && !kept.turned()));
  CHECK(faced(flipped(hollow, 0, all), {two.x}).triangles == hollow);  // the hollow body inside out
  CHECK(faced(flipped(parts, 0, all), {two.x}).triangles == parts);    // the solid one inside out

  Points later = two.x;  // it comes out: no cavity
  later.bottomRows(ball(6).x.rows()).col(0).array() += 1;
  CHECK(faced(hollow, {two.x, later}).triangles == parts);

  // An island in the cavity is solid, whichever way it faces.
  const Solid three = both(two, at(ball(6), 0.1, {0.2, 0, 0}));
  const Triangles island = flipped(three.surface.triangles, first, all);
  CHECK(faced(island, {three.x}).triangles == island);
  CHECK(faced(flipped(island, all, count(three)), {three.x}).triangles == island);
}

TEST_CASE("outward: open surfaces stay, nearly closed ones are turned by what they hold", "[outward_faces]") {
  const Solid whole = ball(16);
  const auto without_cap = [&](double above) {
    std::vector<int> left;
    for (int t = 0; t < count(whole); ++t)
      if (whole.x(whole.surface.triangles.row(t).transpose(), 2).maxCoeff() < above) left.push_back(t);
    return Triangles(whole.surface.triangles(left, Eigen::all));
  };
  const Triangles neck = without_cap(0.95), bowl = without_cap(0.1);
  const OutwardFaces turned = faced(flipped(neck, 0, static_cast<int>(neck.rows())), {whole.x});
  CHECK(turned.triangles == neck);
  CHECK((turned.shells[0].nearly_closed() && turned.shells[0].open_edges == 32));
  const Triangles inward = flipped(bowl, 0, static_cast<int>(bowl.rows()));
  const OutwardFaces open = faced(inward, {whole.x});
  CHECK(open.triangles == inward);
  CHECK((!open.shells[0].closed() && !open.shells[0].nearly_closed()));
  CHECK(open.shells[0].opening > 0.4);
}

TEST_CASE("outward: a face that comes again goes with the first one, a doubled sheet holds nothing",
          "[outward_faces]") {
  const Solid one = block({0, 0, 0}, {1, 1, 1}, 2);
  Solid again = soup(one);  // a patch of it lies there twice
  again.x.conservativeResize(again.x.rows() + 6, 3);
  again.x.bottomRows(6) = again.x.topRows(6).eval();
  Triangles triangles(again.surface.triangles.rows() + 2, 3);
  const int n = static_cast<int>(again.surface.triangles.rows());
  triangles << again.surface.triangles, (again.surface.triangles.topRows(2).array() + 3 * n).matrix();
  CHECK(faced(flipped(triangles, 0, n + 2), {again.x}).triangles == triangles);

  Triangles sheet(2, 3);  // both sides of one triangle
  sheet << 0, 1, 2, 3, 5, 4;
  Points x(6, 3);
  x << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0;
  CHECK(faced(sheet, {x}).triangles == sheet);
  Triangles slivers(1, 3);
  slivers << 0, 3, 1;
  CHECK(faced(slivers, {x}).triangles == slivers);
}

}  // namespace selvedge::test_outward_faces
