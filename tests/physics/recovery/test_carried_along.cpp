#include <catch2/catch.hpp>

#include <cmath>

#include "physics/recovery/carried_along.hpp"
#include "tests/physics/worlds.hpp"

namespace selvedge::test_carried_along {

using testing::Sheet;

namespace {

// A sheet of 0.4 m with n x n squares between two plates, `gap` below and above it.
struct Between {
  testing::World w;
  ContactWorld world;
  Points before;

  Between(int n, double gap) {
    w = testing::make_world(testing::sheet(n, 0.4, 0));
    for (const double height : {-gap, gap}) testing::add_obstacle(w, testing::sheet(20, 0.6, height));
    world = make_contact_world(w.scene.surface, {&w.scene.obstacles[0].surface, &w.scene.obstacles[1].surface}, true);
    before = gather_nodes(w.state.x, w.state.obstacles);
  }
  auto plate(Points& nodes, int k) const { return nodes.middleRows(world.first_node[k], w.state.obstacles[k].rows()); }
};

}  // namespace

TEST_CASE("carried along: as a whole with what moves as a whole, near or far") {
  const Between b(8, GENERATE(0.001, 0.03, 3.0));
  Points nodes = b.before;
  const Eigen::RowVector3d way(0.3, -2, 0.1);
  for (int k = 0; k < 2; ++k) b.plate(nodes, k).rowwise() += way;
  const Points carried = carried_along(b.world, b.before, nodes, 0.002);
  CHECK((carried.rowwise() - way - b.w.state.x).cwiseAbs().maxCoeff() < 1e-12);
}

TEST_CASE("carried along: with the nearest, and what lies farther off smoothly, on any mesh") {
  Between b(GENERATE(8, 16, 32), 0.04);
  Points& x = b.before;
  // On the lower plate on one side, on the upper one on the other.
  for (int v = 0; v < b.world.cloth->vertex_count; ++v) x(v, 1) = 0.039 * std::tanh(x(v, 0) / 0.02);
  Points nodes = x;
  b.plate(nodes, 0).col(2).array() -= 0.1;
  b.plate(nodes, 1).col(2).array() += 0.1;
  const Points ways = carried_along(b.world, x, nodes, 0.002) - x.topRows(b.world.cloth->vertex_count);
  double middle = 0;
  for (int v = 0; v < ways.rows(); ++v) {
    if (x(v, 0) < -0.1) CHECK(ways(v, 2) == Approx(-0.1).margin(0.01));
    if (x(v, 0) > 0.1) CHECK(ways(v, 2) == Approx(0.1).margin(0.01));
    if (std::abs(x(v, 0)) < 1e-9) middle = std::max(middle, std::abs(ways(v, 2)));
  }
  CHECK(middle < 0.06);  // half way: nearest alone would be 0.1
  for (const auto& edge : b.world.cloth->edges.rowwise()) {
    const double apart = (x.row(edge[0]) - x.row(edge[1])).norm();
    CHECK(std::abs(ways(edge[0], 2) - ways(edge[1], 2)) < 3.5 * apart);
  }
}

TEST_CASE("carried along: the node nearest to a place, the lowest on a tie") {
  const Between b(2, 0.1);
  Points places(2, 3);
  places << -0.3, 0, -0.3, -0.3, 0.01, -0.3;
  CHECK(nearest_obstacle_nodes(b.world, b.before, places) ==
        std::vector<int>{b.world.first_node[0], b.world.first_node[1]});
}

}  // namespace selvedge::test_carried_along
