#include <catch2/catch.hpp>

#include "collision/geometry/nearest_point.hpp"

using namespace selvedge;

namespace {

// By looking at all points.
NearestPoint of_all(const Points& x, const Vec3& at) {
  Eigen::Index point = 0;
  const double squared = (x.rowwise() - at.transpose()).rowwise().squaredNorm().minCoeff(&point);
  return {static_cast<int>(point), squared};
}

void check_same(const CellGrid& grid, const Points& x, const Vec3& at) {
  const NearestPoint found = nearest_point(grid, x, at), expected = of_all(x, at);
  CHECK(found.point == expected.point);
  CHECK(found.squared_distance == Approx(expected.squared_distance).epsilon(1e-14));
}

}  // namespace

TEST_CASE("nearest_point: finds what a look at all points finds, near, far and between cubes", "[nearest_point]") {
  std::srand(3);
  Points x = Points::Random(700, 3);
  x.rowwise().normalize();  // a sphere
  x.col(1) *= 3;
  const Points near = 1.5 * Points::Random(200, 3), far = 1e3 * Points::Random(50, 3);
  for (const double edge : {0.01, 0.3, 20.0}) {
    const CellGrid grid(x, edge);
    for (int k = 0; k < 200; ++k) check_same(grid, x, near.row(k).transpose());
    for (int k = 0; k < 50; ++k) check_same(grid, x, far.row(k).transpose());
  }
  for (int k = 0; k < 700; ++k) check_same(grid_of(x), x, x.row(k).transpose());
}

TEST_CASE("nearest_point: the first of equally near points, of repeated points and of points on a line",
          "[nearest_point]") {
  Points square(4, 3);
  square << 1, 0, 1, -1, 0, 1, -1, 0, -1, 1, 0, -1;
  CHECK(nearest_point(grid_of(square), square, Vec3::Zero()).point == 0);
  CHECK(nearest_point(grid_of(square), square, {-5, 0, 0}).point == 1);
  const Points repeated = Points::Constant(9, 3, 0.25);
  CHECK(nearest_point(grid_of(repeated), repeated, {4, 4, 4}).point == 0);
  Points line = Points::Zero(100, 3);
  for (int k = 0; k < 100; ++k) line(k, 2) = 1e-6 * k;
  for (int k = 0; k < 100; k += 7) check_same(grid_of(line), line, {1e-7, 0, 1e-6 * k + 4e-7});
  CHECK(nearest_point(grid_of(Points(0, 3)), Points(0, 3), Vec3::Zero()).point == -1);
}
