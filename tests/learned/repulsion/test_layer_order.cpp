#include <catch2/catch.hpp>

#include "learned/repulsion/repulsive_layer.hpp"
#include "tests/collision/solids.hpp"

namespace selvedge::test_layer_order {

namespace {

SignedDistance over(const Vec3& place, double height) {
  SignedDistance at;
  at.value = height;
  at.closest = place;
  at.gradient = Vec3::UnitY();
  return at;
}

}  // namespace

TEST_CASE("layer order: heights over one place keep their order, and none goes down or stays inside", "[layer_order]") {
  constexpr double margin = 1e-4;
  const LayerOrder order{.reach = 0.01};
  std::vector<SignedDistance> at;
  for (const double height : {-0.006, -0.0059, -0.002, -1e-9, 0.0, 0.003, 0.0099, 0.01, 0.02})
    at.push_back(over({1, 2, 3}, height));
  const std::vector<double> heights = ordered_heights(at, margin, order);
  CHECK(heights[0] == Approx(margin));
  for (std::size_t i = 0; i < at.size(); ++i) {
    CHECK(heights[i] >= std::max(margin, at[i].value) - 1e-12);
    if (i > 0) CHECK(heights[i] > heights[i - 1]);
    if (at[i].value >= order.reach) CHECK(heights[i] == at[i].value);
  }
}

TEST_CASE("layer order: a push fades along the surface, and without a vertex inside nothing goes", "[layer_order]") {
  const LayerOrder order{.reach = 0.01};
  const std::vector<SignedDistance> at{over({0, 0, 0}, -0.004), over({0.01, 0, 0}, 0.001), over({0.03, 0, 0}, 0.001),
                                       over({0.041, 0, 0}, 0.001)};
  const std::vector<double> heights = ordered_heights(at, 0, order);
  CHECK(heights[1] > heights[2]);
  CHECK(heights[2] > 0.001);
  CHECK(heights[3] == 0.001);
  const std::vector<double> outside = ordered_heights({at[1], at[2]}, 0, order);
  CHECK(outside == std::vector<double>{0.001, 0.001});
  const std::vector<double> very_deep = ordered_heights({over({0, 0, 0}, -0.5), over({0, 0, 0}, 0)}, 1e-4, order);
  CHECK(very_deep[0] == 1e-4);
  CHECK(very_deep[1] < order.reach);
}

TEST_CASE("layer order: two layers inside come out one over the other; held vertices and far cloth stay bit for bit",
          "[layer_order]") {
  const testing::Solid body = testing::block({-1, -1, -1}, {1, 0, 1}, 4);
  DistanceField field(body.surface);
  field.move_to(body.x);
  const AskDistance ask = [&](const Points& at, std::vector<SignedDistance>& found) { found = field.ask(at); };
  constexpr int side = 6;
  Points x(3 * side * side, 3);  // two layers in the block and one over it
  for (int v = 0; v < x.rows(); ++v) {
    const int layer = v / (side * side), k = v % (side * side);
    x.row(v) << 0.02 * (k / side) + 0.001 * layer, std::array{-0.004, -0.002, 0.05}[static_cast<std::size_t>(layer)],
        0.02 * (k % side);
  }
  const Adjacency ring = adjacency_of(static_cast<int>(x.rows()), Edges(0, 2));
  const AskScale one = [](std::span<const int> vertices, std::span<const double>) {
    return constant_scale(vertices, 1);
  };
  RepulsionOptions options{.recheck = 3, .margin = 1e-4};
  std::vector<char> held(static_cast<std::size_t>(x.rows()), false);
  held[1] = true;
  const Repelled flat = repel(x, ring, ask, one, options, held);
  options.order.reach = 0.01;
  const Repelled ordered = repel(x, ring, ask, one, options, held);
  CHECK(ordered.inside == 0);
  CHECK(ordered.carried == 0);
  for (int k = 0; k < side * side; ++k) {
    if (held[static_cast<std::size_t>(k)]) {
      CHECK(ordered.x.row(k) == x.row(k));
      continue;
    }
    CHECK(flat.x(side * side + k, 1) == Approx(flat.x(k, 1)));  // one on the other
    CHECK(ordered.x(k, 1) > 0);
    CHECK(ordered.x(2 * side * side + k, 1) == 0.05);
    if (k > 1) CHECK(ordered.x(side * side + k, 1) > ordered.x(k, 1) + 5e-4);
  }
}

TEST_CASE("repulsive layer: a vertex comes to rest in a gap that is narrower than the margin", "[layer_order]") {
  const testing::Solid left = testing::block({-1, -1, -1}, {-2e-5, 1, 1}, 2),
                       right = testing::block({2e-5, -1, -1}, {1, 1, 1}, 2);
  std::vector<Vec3> points;
  std::vector<std::array<int, 3>> triangles;
  for (const testing::Solid* solid : {&left, &right}) {
    const int first = static_cast<int>(points.size());
    for (int v = 0; v < solid->x.rows(); ++v) points.push_back(row(solid->x, v));
    for (int t = 0; t < solid->surface.triangles.rows(); ++t)
      triangles.push_back({first + solid->surface.triangles(t, 0), first + solid->surface.triangles(t, 1),
                           first + solid->surface.triangles(t, 2)});
  }
  const testing::Solid both = testing::solid_of(points, triangles);
  DistanceField field(both.surface);
  field.move_to(both.x);
  const AskDistance ask = [&](const Points& at, std::vector<SignedDistance>& found) { found = field.ask(at); };
  const AskScale one = [](std::span<const int> vertices, std::span<const double>) {
    return constant_scale(vertices, 1);
  };
  const Points x = Eigen::RowVector3d(-0.001, 0.1, 0.2);
  const Repelled made = repel(x, adjacency_of(1, Edges(0, 2)), ask, one, {.recheck = 8, .margin = 1e-4});
  CHECK(made.projected > 1);
  CHECK(made.inside == 0);
  CHECK(std::abs(made.x(0, 0)) < 2e-5);
}

}  // namespace selvedge::test_layer_order
