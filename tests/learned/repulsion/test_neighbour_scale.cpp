#include <catch2/catch.hpp>

#include <algorithm>

#include "collision/geometry/error.hpp"
#include "learned/repulsion/neighbour_scale.hpp"
#include "learned/repulsion/repulsion_training.hpp"
#include "tests/collision/solids.hpp"

namespace selvedge::test_neighbour_scale {

using testing::Solid;

namespace {

// A ball of cloth through a lumpy body, and scales that differ from vertex to vertex.
struct Dressed {
  Solid body = testing::blob(10), garment = testing::ball(8);
  DistanceField field{body.surface};
  Adjacency ring;
  AskDistance ask;
  NeighbourScale network;

  Dressed() {
    field.move_to(body.x);
    ring = adjacency_of(garment.surface.vertex_count, garment.surface.edges);
    ask = [this](const Points& at, std::vector<SignedDistance>& found) { found = field.ask(at); };
    network = make_neighbour_scale({.width = 6, .unit = 0.1, .edge_unit = 0.2}, 3);
    network.end.layers.back().weight *= 60;
    network.end.layers.back().bias[0] = 0.5f;  // where softplus is steep
  }
  std::vector<int> inside(const Points& x) const {
    std::vector<int> all;
    const std::vector<SignedDistance> found = field.ask(x);
    for (int v = 0; v < x.rows(); ++v)
      if (found[static_cast<std::size_t>(v)].value < 0) all.push_back(v);
    return all;
  }
};

double weighted(const Scales& scales) {
  double sum = 0;
  for (std::size_t i = 0; i < scales.alpha.size(); ++i) sum += (1 + 0.1 * static_cast<double>(i % 7)) * scales.alpha[i];
  return sum;
}

}  // namespace

TEST_CASE("scales by neighbours: a patch knows the smallest distance on its edges", "[neighbour_scale]") {
  // Two vertices before a ball whose edge dips into it, and one far off.
  Points x(3, 3);
  x << -0.3, 0.28, 0, 0.3, 0.28, 0, 0.3, 2, 0;
  const AskDistance ball = [](const Points& at, std::vector<SignedDistance>& found) {
    found.assign(static_cast<std::size_t>(at.rows()), {});
    for (int i = 0; i < at.rows(); ++i) {
      found[static_cast<std::size_t>(i)].value = row(at, i).norm() - 0.4;
      found[static_cast<std::size_t>(i)].gradient = row(at, i).normalized();
    }
  };
  const Adjacency ring = adjacency_of(3, unique_edges({{0, 1}, {1, 2}}));
  const std::vector<int> pushed{0};
  const NeighbourPatch patch = neighbour_patch(x, ring, ball, pushed);
  REQUIRE(patch.vertex == std::vector<int>{0, 1, 2});
  CHECK(patch.pushed == 1);
  CHECK(patch.near == 2);
  CHECK(patch.smallest[0].value == Approx(0.28 - 0.4));
  CHECK(patch.smallest[0].other == 1);
  CHECK(patch.smallest[1].other == 0);
  CHECK(patch.smallest[2].value == Approx((row(x, 1) + row(x, 2)).norm() / 2 - 0.4));
  CHECK(patch.length[1] == Approx((0.6 + 1.72) / 2));
  CHECK_THROWS_AS(make_neighbour_scale({.width = 0}, 1), Error);
}

TEST_CASE("scales by neighbours: begin near 1.02, and neither order of vertices nor what is far away matters",
          "[neighbour_scale]") {
  Dressed c;
  const NeighbourScale fresh = make_neighbour_scale({.unit = 0.1, .edge_unit = 0.2}, 1);
  const std::vector<int> inside = c.inside(c.garment.x);
  REQUIRE(inside.size() > 20);
  const Scales scales = neighbour_scales(fresh, neighbour_patch(c.garment.x, c.ring, c.ask, inside));
  for (const double alpha : scales.alpha) CHECK(alpha == Approx(1.02).margin(0.015));

  const Scales own = neighbour_scales(c.network, neighbour_patch(c.garment.x, c.ring, c.ask, inside));
  CHECK(*std::ranges::max_element(own.alpha) > *std::ranges::min_element(own.alpha) + 0.02);
  std::vector<int> backwards(inside.rbegin(), inside.rend());
  const Scales turned = neighbour_scales(c.network, neighbour_patch(c.garment.x, c.ring, c.ask, backwards));
  for (std::size_t i = 0; i < inside.size(); ++i)
    CHECK(turned.alpha[inside.size() - 1 - i] == Approx(own.alpha[i]).epsilon(1e-5));
  const std::vector<int> alone{inside[0]};
  CHECK(neighbour_scales(c.network, neighbour_patch(c.garment.x, c.ring, c.ask, alone)).alpha[0] ==
        Approx(own.alpha[0]).epsilon(1e-5));
}

TEST_CASE("scales by neighbours: gradients by parameters and positions agree with differences", "[neighbour_scale]") {
  Dressed c;
  const Points x = c.garment.x;
  const std::vector<int> inside = c.inside(x);
  const auto loss = [&](const Points& at) {
    return weighted(neighbour_scales(c.network, neighbour_patch(at, c.ring, c.ask, inside)));
  };
  std::vector<double> by_alpha;
  for (std::size_t i = 0; i < inside.size(); ++i) by_alpha.push_back(1 + 0.1 * static_cast<double>(i % 7));
  const NeighbourGradients made =
      neighbour_gradients(c.network, neighbour_patch(x, c.ring, c.ask, inside), x, c.ring, by_alpha);

  // Floats and a closest point that passes from face to face: most components agree, and none is far off.
  const double largest = made.by_x.cwiseAbs().maxCoeff();
  int good = 0, tried = 0;
  for (int v = 0; v < x.rows(); v += 5)
    for (int k = 0; k < 3; ++k) {
      Points forth = x, back = x;
      forth(v, k) += 1e-3;
      back(v, k) -= 1e-3;
      good += std::abs((loss(forth) - loss(back)) / 2e-3 - made.by_x(v, k)) < 0.03 * largest;
      ++tried;
    }
  CHECK(largest > 0.1);
  CHECK(good > 0.95 * tried);

  const auto check = [&](PlainNetwork& part, const std::vector<float>& gradient) {
    REQUIRE(static_cast<long long>(gradient.size()) == parameter_count(part));
    std::vector<float> all = parameters_of(part);
    for (std::size_t k = 0; k < all.size(); k += 7) {
      const float kept = all[k];
      all[k] = kept + 1e-3f;
      set_parameters(all, part);
      const double above = loss(x);
      all[k] = kept - 1e-3f;
      set_parameters(all, part);
      const double below = loss(x);
      all[k] = kept;
      set_parameters(all, part);
      CHECK((above - below) / 2e-3 == Approx(gradient[k]).epsilon(0.05).margin(0.02));
    }
  };
  check(c.network.first, made.first);
  check(c.network.second, made.second);
  check(c.network.end, made.end);
}

}  // namespace selvedge::test_neighbour_scale
