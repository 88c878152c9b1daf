#include <catch2/catch.hpp>

#include <algorithm>
#include <random>

#include "pipeline/garments/footing.hpp"

namespace selvedge::test_footing {

namespace {

// Two plates that face each other, the one at y = 0 and the other `gap` above it, 0.4 m wide, `aside` along x.
struct Plates {
  static constexpr int n = 20;
  Surface surface;

  Plates() {
    Triangles triangles(4 * n * n, 3);
    int t = 0;
    for (int plate = 0; plate < 2; ++plate)
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          const int a = plate * (n + 1) * (n + 1) + i * (n + 1) + j, b = a + n + 1, c = b + 1, d = a + 1;
          triangles.row(t++) << a, plate ? b : c, plate ? c : b;
          triangles.row(t++) << a, plate ? c : d, plate ? d : c;
        }
    surface = make_surface(2 * (n + 1) * (n + 1), triangles);
  }
  Points at(double gap, double aside = 0) const {
    Points x(surface.vertex_count, 3);
    for (int v = 0; v < surface.vertex_count; ++v) {
      const int plate = v / ((n + 1) * (n + 1)), k = v % ((n + 1) * (n + 1));
      x.row(v) << 0.02 * (k / (n + 1)) - 0.2 + plate * aside, plate * gap, 0.02 * (k % (n + 1)) - 0.2;
    }
    return x;
  }
  PosedSkin skin(double gap, double aside = 0) const { return {surface, at(gap, aside)}; }
};

// Layers over the middle of the lower plate.
Points layers(std::initializer_list<double> heights) {
  Points x(static_cast<Eigen::Index>(heights.size()), 3);
  Eigen::Index v = 0;
  for (const double height : heights) x.row(v++) << 0, height, 0;
  return x;
}

// squeezed with all vertices of the body looked at, in double.
Points squeezed_by_all(const Footing& footing, const PosedSkin& body, const Points& x) {
  Points to = x;
  for (Eigen::Index v = 0; v < x.rows(); ++v) {
    const Vec3 foot = row(body.x, footing.foot[v]), way = row(x, static_cast<int>(v)) - foot;
    const double out = way.norm(), part = footing.part[v];
    if (!(out > 0 && out < 0.06)) continue;
    double gap = std::numeric_limits<double>::infinity();
    for (int p = 0; p < body.x.rows(); ++p) {
      const Vec3 offset = row(body.x_in_order, p) - foot;
      const double height = offset.dot(way) / out, beside = (offset - height / out * way).norm();
      const double there = height + std::max(0.0, beside - 0.01);
      if (height > 0 && row(body.normals_in_order, p).dot(way) / out <= -0.3 && there < out / 0.25)
        gap = std::min(gap, there);
    }
    if (!(out > part * gap)) continue;
    const double left = (0.5 - part) * gap, beyond = out - part * gap;
    const double less = left > 0 ? part * gap + left * beyond / (beyond + left) : part * gap;
    to.row(v) += std::clamp((0.06 - out) / 0.03, 0.0, 1.0) * (less / out - 1) * way.transpose();
  }
  return to;
}

}  // namespace

TEST_CASE("footing: what comes near squeezes layers into its half of the gap, in their order", "[footing]") {
  const Plates body;
  const Points x = layers({0.002, 0.005, 0.01, 0.015, 0.02, 0.03});
  const Footing footing = footing_of(x, body.skin(1));
  Points before = x;
  for (double gap = 0.2; gap > 0.004; gap *= 0.9) {
    CAPTURE(gap);
    const Points to = squeezed(footing, body.skin(gap), x);
    CHECK(to.col(0).isZero());
    CHECK((to.col(1).array() <= before.col(1).array()).all());  // nearer parts squeeze more, without a jump
    CHECK((to - before).rowwise().norm().maxCoeff() < 0.006);
    for (int k = 0; k + 1 < to.rows(); ++k) CHECK(to(k, 1) < to(k + 1, 1));
    CHECK(to.col(1).maxCoeff() < gap / 2);
    before = to;
  }
  CHECK(squeezed(footing, body.skin(0.15), x) == x);
}

TEST_CASE("footing: nothing moves for what was as near at rest, behind, far, or all of it worn far out", "[footing]") {
  const Plates body;
  const Points x = layers({0.002, 0.015, 0.019});
  const Footing near = footing_of(x, body.skin(0.04));
  CHECK(squeezed(near, body.skin(0.04), x) == x);
  CHECK(squeezed(near, body.skin(0.03), x) != x);
  const Footing footing = footing_of(x, body.skin(1));
  CHECK(squeezed(footing, body.skin(-0.01), x) == x);       // gone through
  CHECK(squeezed(footing, body.skin(0.01, 0.5), x) == x);   // passes by
  CHECK(squeezed(footing, body.skin(0.01, 0.23), x) != x);  // not quite
  const Points out = layers({0.07});
  CHECK(squeezed(footing_of(out, body.skin(1)), body.skin(0.05), out) == out);
}

TEST_CASE("footing: what lies on the body stays on it", "[footing]") {
  const Plates body;
  const Points x = layers({0});
  CHECK(squeezed(footing_of(x, body.skin(1)), body.skin(0.001), x) == x);
}

TEST_CASE("footing: no part that comes near is missed, also far from the origin", "[footing]") {
  const Plates body;
  std::mt19937 random(4);
  std::uniform_real_distribution<double> unit(-1, 1);
  int moved = 0, still = 0;
  for (const double far : {0.0, 3.0, 300.0}) {
    Points x(200, 3);
    for (int v = 0; v < x.rows(); ++v)
      x.row(v) << 0.18 * unit(random), 0.025 + 0.025 * unit(random), 0.18 * unit(random);
    Footing footing = footing_of(x, body.skin(1));
    for (int pose = 0; pose < 10; ++pose) {
      Points at = body.at(0.05 + 0.04 * unit(random), 0.2 * unit(random));
      for (double& c : at.reshaped()) c += 0.008 * unit(random);
      at.array() += far;
      const Points worn = x.array() + far;
      const PosedSkin skin(body.surface, at);
      const Points to = squeezed(footing, skin, worn);
      CHECK((to - squeezed_by_all(footing, skin, worn)).cwiseAbs().maxCoeff() < 1e-9);
      for (int v = 0; v < x.rows(); ++v) ++(to.row(v) != worn.row(v) ? moved : still);
    }
  }
  CHECK(moved > 500);
  CHECK(still > 500);
}

}  // namespace selvedge::test_footing
