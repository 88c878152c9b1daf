#include <catch2/catch.hpp>

#include <algorithm>
#include <limits>

#include "physics/recovery/drawn.hpp"
#include "tests/frame.hpp"
#include "tests/physics/worlds.hpp"

namespace selvedge::test_drawn {

using testing::sheet;

namespace {

// A sheet over a plate of 0.2 m that is switched off where x > 0.
struct OverPlate {
  testing::World w = testing::make_world(sheet(10, 0.4, 0.01));
  ContactWorld world;
  Points nodes;
  Exemption exemption;

  OverPlate() {
    testing::add_obstacle(w, sheet(8, 0.2, 0));
    world = testing::with_its_obstacle(w);
    nodes = gather_nodes(w.state.x, w.state.obstacles);
    exemption.switched_off.assign(static_cast<std::size_t>(world.node_count), 0);
    for (int node = w.scene.surface.vertex_count; node < world.node_count; ++node)
      exemption.switched_off[node] = nodes(node, 0) > 0;
  }
};

}  // namespace

TEST_CASE("drawn: what is near a part that is switched off, and dressed, is drawn", "[drawn]") {
  OverPlate c;
  Points targets = c.w.state.x;
  const int undressed = 60, undefined = 61;
  c.nodes(undefined, 1) = std::numeric_limits<double>::quiet_NaN();
  targets.row(undressed).setConstant(std::numeric_limits<double>::quiet_NaN());
  const double reach = 0.03;
  const std::vector<char> drawn = drawn_vertices(c.world, c.exemption, targets, c.nodes, reach);
  REQUIRE(drawn.size() == static_cast<std::size_t>(c.w.state.x.rows()));
  int count = 0;
  for (int v = 0; v < c.w.state.x.rows(); ++v) {
    double nearest = 1;
    for (int node = c.w.scene.surface.vertex_count; node < c.world.node_count; ++node)
      if (c.exemption.switched_off[node]) nearest = std::min(nearest, (c.nodes.row(v) - c.nodes.row(node)).norm());
    CHECK((drawn[v] != 0) == (nearest < reach && v != undressed && v != undefined));
    count += drawn[v];
  }
  CHECK(count > 5);
  CHECK(drawn_vertices(c.world, c.exemption, Points(), c.nodes, reach).empty());
  CHECK(drawn_vertices(c.world, {}, targets, c.nodes, reach).empty());
  CHECK(drawn_vertices(c.world, c.exemption, targets, c.nodes, 1e-3).empty());
}

TEST_CASE("drawn: the springs' derivatives are those of their value, and they pull to the targets", "[drawn]") {
  const OverPlate c;
  const Points& x0 = c.w.state.x;
  const auto n = static_cast<std::size_t>(x0.rows());
  Points targets = x0;
  targets.rowwise() += Eigen::RowVector3d(0.02, 0.01, -0.03);
  std::vector<char> drawn(n, 0);
  drawn[7] = drawn[23] = 1;
  const Eigen::VectorXd masses = Eigen::VectorXd::Constant(x0.rows(), 0.01);
  const double h = 0.01;
  const AddedTerm whole = drawing_term(drawn, masses, x0, targets, 1, h);
  CHECK(whole.value(targets) == Approx(0).margin(1e-20));
  CHECK(whole.value(x0) == Approx(2 * 0.5 * 0.01 / (h * h) * (0.0004 + 0.0001 + 0.0009)));
  // Part of the way, and both terms at once.
  const AddedTerm term = sum_of(drawing_term(drawn, masses, x0, targets, 0.005, h), whole);
  Points x = x0;
  x.row(7) += Eigen::RowVector3d(0.003, -0.002, 0.001);
  Points gradient = Points::Zero(x.rows(), 3);
  std::vector<ContactBlock> blocks;
  term.add_derivatives(x, gradient, blocks);
  REQUIRE(blocks.size() == 4);
  for (const int v : {7, 23, 11})
    for (int k = 0; k < 3; ++k) {
      const double step = 1e-5;
      Points to = x, from = x;
      to(v, k) += step;
      from(v, k) -= step;
      CHECK(gradient(v, k) == Approx((term.value(to) - term.value(from)) / (2 * step)).margin(1e-9));
      Points ahead = Points::Zero(x.rows(), 3);
      std::vector<ContactBlock> unused;
      term.add_derivatives(to, ahead, unused);
      double stiffness = 0;
      for (const ContactBlock& block : blocks)
        if (block.nodes[0] == v) stiffness += contact_matrix(block)(k, k);
      CHECK(stiffness == Approx((ahead(v, k) - gradient(v, k)) / step).margin(1e-6));
    }
}

// Decision 32: what comes from outside meets all of a body.
TEST_CASE("drawn: clean cloth over a body that keeps its shape is not drawn, where that crosses itself either",
          "[drawn]") {
  // Two plates that cross at x = 0, and move, under a sheet that touches neither.
  const auto way_of_middle = [](bool dressed) {
    testing::World w = testing::make_world(sheet(12, 0.3, 0.012));
    w.drive.acceleration.setZero();
    testing::add_obstacle(w, testing::join(sheet(24, 0.3, 0), testing::tilted(sheet(23, 0.3, 3e-4), 0.05)));
    const auto stepper = make_recovering_conventional_stepper(w.scene, {});
    const Points start = w.state.x;
    for (int frame = 0; frame < 10; ++frame) {
      w.drive.obstacles[0].col(0).array() += 0.005;
      if (dressed) {
        w.drive.skinned_targets = start;
        w.drive.skinned_targets.col(0).array() += 0.005 * (frame + 1);
      }
      State to;
      REQUIRE(testing::frame(w.scene, *stepper, w.state, w.drive, 1.0 / 30, to).status == StepStatus::accepted);
      w.state = to;
    }
    return w.state.x(6 * 13 + 6, 0) - start(6 * 13 + 6, 0);
  };
  CHECK(std::abs(way_of_middle(true)) < 1e-6);
  CHECK(std::abs(way_of_middle(false)) < 1e-6);
}

}  // namespace selvedge::test_drawn
