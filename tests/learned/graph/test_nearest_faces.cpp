#include <catch2/catch.hpp>

#include <random>

#include "collision/geometry/distance.hpp"
#include "learned/graph/nearest_faces.hpp"
#include "tests/threads.hpp"

namespace selvedge::test_nearest_faces {
namespace {

// Loose triangles in a box, and points round it.
struct Cloud {
  Surface surface;
  Points x, points;

  explicit Cloud(unsigned seed, int faces = 200) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> anywhere(-1, 1), near(-0.2, 0.2);
    Triangles triangles(faces, 3);
    x.resize(3 * faces, 3);
    for (int f = 0; f < faces; ++f) {
      triangles.row(f) << 3 * f, 3 * f + 1, 3 * f + 2;
      const Vec3 at(anywhere(random), anywhere(random), anywhere(random));
      for (int k = 0; k < 3; ++k)
        x.row(3 * f + k) << at.x() + near(random), at.y() + near(random), at.z() + near(random);
    }
    surface = make_surface(3 * faces, triangles);
    points.resize(150, 3);
    for (double& value : points.reshaped()) value = 1.3 * anywhere(random);
  }

  Vec3 corner(int f, int k) const { return row(x, surface.triangles(f, k)); }
  double to_centroid(int v, int f) const {
    return ((corner(f, 0) + corner(f, 1) + corner(f, 2)) / 3 - row(points, v)).squaredNorm();
  }
  double to_face(int v, int f) const {
    return point_triangle(row(points, v), corner(f, 0), corner(f, 1), corner(f, 2)).squared_distance;
  }
};

template <class SquaredOf>
std::vector<int> by_all(const Cloud& cloud, const std::vector<char>& left_out, double squared,
                        const SquaredOf& squared_of) {
  std::vector<int> nearest;
  for (int v = 0; v < cloud.points.rows(); ++v) {
    double best = squared;
    nearest.push_back(-1);
    for (int f = 0; f < cloud.surface.triangles.rows(); ++f)
      if (left_out.empty() || !left_out[static_cast<std::size_t>(f)])
        if (const double there = squared_of(v, f); there < best) {
          best = there;
          nearest.back() = f;
        }
  }
  return nearest;
}

}  // namespace

TEST_CASE("nearest faces: as by trying all, with some left out, and from old guesses", "[graph]") {
  NearestFaces by_centroid, by_face;
  std::vector<char> left_out;
  for (unsigned seed = 0; seed < 6; ++seed) {
    const Cloud cloud(seed);
    if (seed > 2) left_out.assign(200, 0);
    for (std::size_t f = seed; f < left_out.size(); f += 3) left_out[f] = 1;
    CHECK(nearest_centroids(cloud.surface, cloud.x, left_out, cloud.points, by_centroid) ==
          by_all(cloud, left_out, HUGE_VAL, [&](int v, int f) { return cloud.to_centroid(v, f); }));
    const std::vector<int> faces = by_all(cloud, left_out, 0.01, [&](int v, int f) { return cloud.to_face(v, f); });
    CHECK(nearest_faces(cloud.surface, cloud.x, left_out, 0.1, cloud.points, by_face) == faces);
    CHECK(std::ranges::count(faces, -1) > 0);
    CHECK(nearest_faces(cloud.surface, cloud.x, left_out, 0.1, cloud.points, by_face) == faces);  // asked again
    Cloud moved = cloud;  // the same faces and other points
    moved.points.array() += 0.05;
    CHECK(nearest_centroids(cloud.surface, cloud.x, left_out, moved.points, by_centroid) ==
          by_all(moved, left_out, HUGE_VAL, [&](int v, int f) { return moved.to_centroid(v, f); }));
    CHECK(nearest_faces(cloud.surface, cloud.x, left_out, 0.1, moved.points, by_face) ==
          by_all(moved, left_out, 0.01, [&](int v, int f) { return moved.to_face(v, f); }));
  }
}

TEST_CASE("nearest faces: without faces, with all left out, and of a point that is undefined", "[graph]") {
  NearestFaces search;
  Cloud cloud(1);
  const std::vector<int> none(150, -1);
  const Surface empty = make_surface(0, Triangles(0, 3));
  CHECK(nearest_centroids(empty, Points(0, 3), {}, cloud.points, search) == none);
  CHECK(nearest_faces(empty, Points(0, 3), {}, 1, cloud.points, search) == none);
  const std::vector<char> all(200, 1);
  CHECK(nearest_centroids(cloud.surface, cloud.x, all, cloud.points, search) == none);
  CHECK(nearest_faces(cloud.surface, cloud.x, all, 1, cloud.points, search) == none);
  CHECK(nearest_centroids(cloud.surface, cloud.x, {}, Points(0, 3), search).empty());
  cloud.points(7, 1) = std::numeric_limits<double>::quiet_NaN();
  const std::vector<int> found = nearest_centroids(cloud.surface, cloud.x, {}, cloud.points, search);
  CHECK(found[7] == -1);
  CHECK(std::ranges::count(found, -1) == 1);
}

TEST_CASE("nearest faces: several threads find the same", "[graph]") {
  const Cloud cloud(4);
  NearestFaces one, several;
  const std::vector<int> all = nearest_faces(cloud.surface, cloud.x, {}, 1, cloud.points, one);
  with_threads(4, [&] { nearest_faces(cloud.surface, cloud.x, {}, 1, cloud.points, several); });
  CHECK(several.last == all);
}

}  // namespace selvedge::test_nearest_faces
