#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <random>

#include "collision/geometry/distance.hpp"

namespace selvedge::test_distance {

using Four = std::array<Vec3, 4>;

namespace {

Four random_points(std::mt19937& random, double size) {
  std::uniform_real_distribution<double> at(-size, size);
  Four x;
  for (Vec3& p : x) p = Vec3(at(random), at(random), at(random));
  return x;
}

Vec3 between(const Closest& c, const Four& x) {
  return c.weights[0] * x[0] + c.weights[1] * x[1] + c.weights[2] * x[2] + c.weights[3] * x[3];
}

Closest point_triangle(const Four& x) { return selvedge::point_triangle(x[0], x[1], x[2], x[3]); }
Closest edge_edge(const Four& x) { return selvedge::edge_edge(x[0], x[1], x[2], x[3]); }

void check_weights(const Closest& c, const Four& x, int split) {
  double first = 0, second = 0;
  for (int i = 0; i < 4; ++i) {
    (i < split ? first : second) += c.weights[i];
    REQUIRE((i < split ? c.weights[i] : -c.weights[i]) >= 0);
  }
  REQUIRE(first == Approx(1).epsilon(1e-14));
  REQUIRE(second == Approx(-1).epsilon(1e-14));
  double scale = 0;
  for (const Vec3& p : x) scale = std::max(scale, p.squaredNorm());
  REQUIRE(std::abs(between(c, x).squaredNorm() - c.squared_distance) <= 1e-13 * scale);
}

// Two convex sets are nearest where the vector between the points separates them: no node of either lies further along.
void check_optimal(const Closest& c, const Four& x, int split, double tolerance) {
  const Vec3 apart = between(c, x);
  for (int i = 0; i < split; ++i)
    for (int j = split; j < 4; ++j) REQUIRE(apart.dot(x[i] - x[j]) >= c.squared_distance - tolerance);
}

}  // namespace

TEST_CASE("distance: optimal for random primitives at every scale", "[distance]") {
  std::mt19937 random(1);
  for (double size : {1e-3, 1.0, 1e3})
    for (int i = 0; i < 3000; ++i) {
      const Four x = random_points(random, size);
      for (int split : {1, 2}) {
        const Closest c = split == 1 ? point_triangle(x) : edge_edge(x);
        check_weights(c, x, split);
        check_optimal(c, x, split, 1e-12 * size * size);
      }
    }
}

TEST_CASE("distance: no sampled point is nearer", "[distance]") {
  std::mt19937 random(2);
  for (int i = 0; i < 100; ++i) {
    const Four x = random_points(random, 1);
    const double face = point_triangle(x).squared_distance, edge = edge_edge(x).squared_distance;
    double best_face = 1e9, best_edge = 1e9;
    constexpr int n = 60;
    for (int a = 0; a <= n; ++a)
      for (int b = 0; b <= n; ++b) {
        const double s = double(a) / n, t = double(b) / n;
        const Vec3 on_edge = x[2] + t * (x[3] - x[2]);
        best_edge = std::min(best_edge, (x[0] + s * (x[1] - x[0]) - on_edge).squaredNorm());
        if (a + b <= n)
          best_face = std::min(best_face, (x[1] + s * (x[2] - x[1]) + t * (x[3] - x[1]) - x[0]).squaredNorm());
      }
    CHECK(face <= best_face + 1e-14);
    CHECK(edge <= best_edge + 1e-14);
    CHECK(std::sqrt(face) >= std::sqrt(best_face) - 4.0 / n);
    CHECK(std::sqrt(edge) >= std::sqrt(best_edge) - 4.0 / n);
  }
}

TEST_CASE("distance: known cases", "[distance]") {
  const Vec3 o(0, 0, 0), x(1, 0, 0), z(0, 0, 1);
  CHECK(selvedge::point_triangle({0.25, 2, 0.25}, o, z, x).squared_distance == 4);
  CHECK(selvedge::point_triangle({0.25, 2, 0.25}, o, z, x).weights.isApprox(Eigen::Vector4d(1, -0.5, -0.25, -0.25)));
  CHECK(selvedge::point_triangle({-3, 4, 0}, o, z, x).weights == Eigen::Vector4d(1, -1, 0, 0));
  CHECK(selvedge::point_triangle({1, 1, 1}, o, z, x).squared_distance == Approx(1.5));
  CHECK(selvedge::edge_edge({-1, 1, 0}, {1, 1, 0}, {0, 0, -1}, {0, 0, 1})
            .weights.isApprox(Eigen::Vector4d(0.5, 0.5, -0.5, -0.5)));
  CHECK(selvedge::edge_edge(o, x, {3, 0, 0}, {2, 0, 0}).squared_distance == 1);
  CHECK(selvedge::edge_edge(o, x, {0, 2, 0}, {1, 2, 0}).squared_distance == 4);
  CHECK(selvedge::edge_edge(o, x, {0.5, -1, 0}, {0.5, 1, 0}).squared_distance == 0);
}

TEST_CASE("distance: degenerate triangles and edges are the segment or point that they are", "[distance]") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> parameter(-0.5, 1.5);
  for (int i = 0; i < 2000; ++i) {
    Four x = random_points(random, 1);
    x[3] = x[1] + parameter(random) * (x[2] - x[1]);  // collinear up to rounding: nearly flat, either way
    check_weights(point_triangle(x), x, 1);
    check_optimal(point_triangle(x), x, 1, 1e-11);
    x[3] = x[1];
    check_optimal(point_triangle(x), x, 1, 1e-13);
    x[2] = x[1];
    CHECK(point_triangle(x).squared_distance == Approx((x[0] - x[1]).squaredNorm()));

    x = random_points(random, 1);
    x[3] = x[2] + parameter(random) * (x[1] - x[0]);  // parallel up to rounding
    check_weights(edge_edge(x), x, 2);
    check_optimal(edge_edge(x), x, 2, 1e-11);
    x[3] = x[2];
    check_weights(edge_edge(x), x, 2);
    check_optimal(edge_edge(x), x, 2, 1e-13);
    x[1] = x[0];
    CHECK(edge_edge(x).squared_distance == Approx((x[0] - x[2]).squaredNorm()));
  }
}

TEST_CASE("distance: slivers down to the last bit stay optimal", "[distance]") {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> parameter(-0.5, 1.5), exponent(-17, 0), sign(-1, 1);
  double worst = 0;
  for (int i = 0; i < 5000; ++i) {
    const double height = std::pow(10, exponent(random));
    for (int split : {1, 2}) {
      Four x = random_points(random, 1);
      const Vec3 jitter = height * Vec3(sign(random), sign(random), sign(random));
      x[3] = split == 1 ? Vec3(x[1] + parameter(random) * (x[2] - x[1]) + jitter)
                        : Vec3(x[2] + parameter(random) * (x[1] - x[0]) + jitter);
      if (i % 2)  // the other primitive on the same line, all but for a jitter
        x[0] = split == 1 ? Vec3(x[1] + parameter(random) * (x[2] - x[1]) + jitter.reverse())
                          : Vec3(x[2] + parameter(random) * (x[1] - x[2]) + jitter.reverse());
      const Closest c = split == 1 ? point_triangle(x) : edge_edge(x);
      check_weights(c, x, split);
      const Vec3 apart = between(c, x);
      for (int a = 0; a < split; ++a)
        for (int b = split; b < 4; ++b) worst = std::max(worst, c.squared_distance - apart.dot(x[a] - x[b]));
    }
  }
  CHECK(worst < 1e-8);
}

TEST_CASE("distance: independent of the order of the arguments", "[distance]") {
  std::mt19937 random(5);
  for (int i = 0; i < 1000; ++i) {
    const Four x = random_points(random, 1);
    const double face = point_triangle(x).squared_distance, edge = edge_edge(x).squared_distance;
    CHECK(selvedge::point_triangle(x[0], x[2], x[3], x[1]).squared_distance == Approx(face));
    CHECK(selvedge::point_triangle(x[0], x[2], x[1], x[3]).squared_distance == Approx(face));
    CHECK(selvedge::edge_edge(x[2], x[3], x[0], x[1]).squared_distance == Approx(edge));
    CHECK(selvedge::edge_edge(x[1], x[0], x[2], x[3]).squared_distance == Approx(edge));
  }
}

}  // namespace selvedge::test_distance
