#include <catch2/catch.hpp>

#include <algorithm>
#include <limits>

#include "physics/carrying.hpp"
#include "tests/physics/worlds.hpp"

using namespace selvedge;
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
    world = make_contact_world(w.scene.surface, {&w.scene.obstacles[0].surface}, true);
    nodes = gather_nodes(w.state.x, w.state.obstacles);
    exemption.off.assign(static_cast<std::size_t>(world.node_count), 0);
    for (int node = w.scene.surface.vertex_count; node < world.node_count; ++node)
      exemption.off[node] = nodes(node, 0) > 0;
  }
};

// A closed box.
testing::Sheet bar(const Vec3& centre, const Vec3& half) {
  testing::Sheet body{Points(8, 3), Triangles(12, 3)};
  for (int v = 0; v < 8; ++v)
    body.x.row(v) = (centre + half.cwiseProduct(Vec3(v & 1 ? 1 : -1, v & 2 ? 1 : -1, v & 4 ? 1 : -1))).transpose();
  body.triangles << 0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5,
      3, 7, 5;
  return body;
}

}  // namespace

TEST_CASE("carrying: what is near a part that is switched off, and worn, is carried", "[carrying]") {
  const OverPlate c;
  Points worn = c.w.state.x;
  const int unworn = 60;
  worn.row(unworn).setConstant(std::numeric_limits<double>::quiet_NaN());
  const double reach = 0.03;
  const std::vector<char> carried = carried_vertices(c.world, c.exemption, worn, c.nodes, reach);
  REQUIRE(carried.size() == static_cast<std::size_t>(c.w.state.x.rows()));
  int count = 0;
  for (int v = 0; v < c.w.state.x.rows(); ++v) {
    double nearest = 1;
    // The plate is square and off from its first column of vertices with x > 0.
    const Vec3 x = row(c.nodes, v), on_plate(std::clamp(x.x(), 0.025, 0.1), 0, std::clamp(x.z(), -0.1, 0.1));
    nearest = (x - on_plate).norm();
    CHECK((carried[v] != 0) == (nearest < reach && v != unworn));
    count += carried[v];
  }
  CHECK(count > 5);
  CHECK(carried_vertices(c.world, c.exemption, Points(), c.nodes, reach).empty());
  CHECK(carried_vertices(c.world, {}, worn, c.nodes, reach).empty());
  CHECK(carried_vertices(c.world, c.exemption, worn, c.nodes, 1e-3).empty());
}

TEST_CASE("carrying: the springs' derivatives are those of their value, and where they pull to is worn", "[carrying]") {
  const OverPlate c;
  const Points& x0 = c.w.state.x;
  const auto n = static_cast<std::size_t>(x0.rows());
  Points worn = x0;
  worn.rowwise() += Eigen::RowVector3d(0.02, 0.01, -0.03);
  std::vector<char> carried(n, 0);
  carried[7] = carried[23] = 1;
  const Eigen::VectorXd masses = Eigen::VectorXd::Constant(x0.rows(), 0.01);
  const double h = 0.01;
  const AddedTerm whole = carrying_term(carried, masses, x0, worn, 1, h);
  CHECK(whole.value(worn) == Approx(0).margin(1e-20));
  CHECK(whole.value(x0) == Approx(2 * 0.5 * 0.01 / (h * h) * (0.0004 + 0.0001 + 0.0009)));
  // Part of the way, and both terms at once.
  const AddedTerm term = sum_of(carrying_term(carried, masses, x0, worn, 0.005, h), whole);
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

TEST_CASE("carrying: cloth between parts of a body that cross goes along with it, as worn, and nothing else does",
          "[carrying]") {
  // Two bars that cross, under a sheet that is worn on the first one, which moves.
  const auto moved_by = [](bool worn) {
    testing::World w = testing::make_world(sheet(12, 0.3, 0.031));
    w.drive.acceleration.setZero();
    testing::add_obstacle(w, testing::join(bar({0, 0, 0}, {0.2, 0.03, 0.05}), bar({0, 0.002, 0}, {0.05, 0.027, 0.2})));
    const auto stepper = make_conventional_stepper(w.scene, {});
    const Points start = w.state.x;
    for (int frame = 0; frame < 10; ++frame) {
      w.drive.obstacles[0].col(0).array() += 0.005;
      if (worn) {
        w.drive.worn = start;
        w.drive.worn.col(0).array() += 0.005 * (frame + 1);
      }
      State to;
      REQUIRE(stepper->step(w.state, w.drive, 1.0 / 30, to).status == StepStatus::accepted);
      w.state = to;
    }
    const Points way = w.state.x - start;
    return std::pair(way(6 * 13 + 6, 0), way(0, 0));  // in the middle, where the bars cross, and at a corner
  };
  const auto [middle, corner] = moved_by(true);
  CHECK(middle > 0.04);
  CHECK(moved_by(false).first < 0.5 * middle);
}
