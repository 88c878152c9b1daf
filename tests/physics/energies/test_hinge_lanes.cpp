#include <catch2/catch.hpp>

#include <numbers>
#include <random>

#include "physics/energies/hinge_lanes.hpp"

namespace selvedge::test_hinge_lanes {
namespace {

// Loose hinges with four vertices each, of every kind; the last ones are degenerate.
struct LooseHinges {
  std::vector<Hinge> hinges;
  Points x;

  explicit LooseHinges(int count) : x(4 * count, 3) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> anywhere(-1, 1);
    for (double& value : x.reshaped()) value = anywhere(random);
    for (int h = 0; h < count; ++h) {
      const double rest = h % 3 == 0 ? 0 : std::numbers::pi * anywhere(random);
      hinges.push_back({{4 * h, 4 * h + 1, 4 * h + 2, 4 * h + 3},
                        0.5 + 0.1 * h,
                        rest,
                        h % 2 ? HingeLength::current : HingeLength::rest});
    }
    x.row(4 * count - 3) = x.row(4 * count - 4);  // no edge
    x.row(4 * count - 6) = x.row(4 * count - 8);  // a tip at the edge's end
    x.middleRows(4 * count - 12, 4).setZero();
    x.middleRows(4 * count - 16, 4) << 0, 0, 0, 1, 0, 0, 0.5, 1e-6, 0, 0.3, 0, 1;  // a sliver
    x.middleRows(4 * count - 20, 4) << 0, 0, 0, 1, 0, 0, 0.5, 1, 0, 0.3, -1, 0;    // flat
  }
};

}  // namespace

TEST_CASE("hinge lanes: energies and gradients are those of single hinges", "[bending]") {
  const LooseHinges loose(77);
  std::span<const Hinge> rest = loose.hinges;
  HingeLanes lanes, bare;
  for (; !rest.empty(); rest = rest.subspan(static_cast<std::size_t>(lanes.count))) {
    hinge_energies(rest, loose.x, true, lanes);
    hinge_energies(rest, loose.x, false, bare);
    REQUIRE(lanes.count == static_cast<int>(std::min<std::size_t>(rest.size(), HingeLanes::width)));
    for (int l = 0; l < lanes.count; ++l) {
      const Hinge& hinge = rest[static_cast<std::size_t>(l)];
      INFO("hinge " << hinge.nodes[0] / 4);
      Vec12 gradient, ours;
      const double energy = hinge_derivatives(hinge, loose.x, gradient, nullptr);
      for (int k = 0; k < 12; ++k) ours[k] = lanes.force[k][l];
      CHECK(lanes.energy[l] == Approx(energy).epsilon(1e-12).margin(1e-28));
      CHECK(bare.energy[l] == lanes.energy[l]);
      CHECK((ours - gradient).norm() <= 1e-10 * gradient.norm());
    }
  }
}

TEST_CASE("hinge lanes: angles all the way round", "[bending]") {
  std::vector<Hinge> one{{{0, 1, 2, 3}, 2, 0, HingeLength::rest}};
  HingeLanes lanes;
  for (int degrees = -179; degrees <= 180; ++degrees) {
    const double angle = degrees * std::numbers::pi / 180;
    Points x(4, 3);
    x << 0, 0, 0, 1, 0, 0, 0, -std::sin(angle / 2), -std::cos(angle / 2), 0, -std::sin(angle / 2), std::cos(angle / 2);
    hinge_energies(one, x, false, lanes);
    CHECK(std::sqrt(lanes.energy[0]) == Approx(std::abs(angle)).epsilon(1e-14).margin(1e-15));
  }
}

}  // namespace selvedge::test_hinge_lanes
