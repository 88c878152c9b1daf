#include "collision/untangle/caught.hpp"

#include <numbers>

#include <Eigen/Geometry>

#include "physics/recovery/recovery.hpp"
#include "physics/steppers/icm_stepper.hpp"
#include "tests/frame.hpp"
#include "tests/physics/worlds.hpp"

namespace selvedge::test_caught {

using testing::add_obstacle;
using testing::block;
using testing::make_world;
using testing::sheet;
using testing::with_its_obstacle;
using testing::World;

namespace {

constexpr double hand_x = 0.011, hand_z = 0.007, hand_half = 0.02;

// A sheet at one height, and a body of two blocks: a thigh of 12 cm round the origin, and a hand of 4 cm at `hand`.
World sheet_and_hand(double height, double hand) {
  World w = make_world(sheet(20, 0.2, height));
  add_obstacle(w, testing::join(block({0, 0, 0}, 0.06), block({hand_x, hand, hand_z}, hand_half)));
  return w;
}

// The larger of the vertex's distances along x and z from the hand's axis: at most hand_half above or below the hand.
double off_hand(const World& w, int v) {
  return std::max(std::abs(w.state.x(v, 0) - hand_x), std::abs(w.state.x(v, 2) - hand_z));
}

}  // namespace

TEST_CASE("caught: a still body that crosses itself keeps what comes from outside out", "[caught]") {
  World w = make_world(sheet(12, 0.5, 0.12));
  // Two blocks that overlap at their corners: one obstacle of two closed parts.
  add_obstacle(w, testing::join(block({-0.05, 0, 0}, 0.06), block({0.05, 0.011, 0.013}, 0.06)));
  const ContactWorld world = with_its_obstacle(w);
  Points nodes = gather_nodes(w.state.x, w.state.obstacles), turned = nodes;
  SelfCrossings crossings(world);
  Exemption exemption;
  crossings.switch_off(nodes, nodes, {}, exemption);
  // Nor where it moves as one, however far.
  const Mat3 turn = Eigen::AngleAxisd(0.3, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  turned.bottomRows(16) =
      ((nodes.bottomRows(16) * turn.transpose()).rowwise() + Eigen::RowVector3d(0.1, 0.2, 0)).eval();
  crossings.switch_off(nodes, turned, {}, exemption);
  CHECK_FALSE(exemption.any());
  const testing::Run r = testing::run(w, 30);
  CHECK(r.state.x.allFinite());
  CHECK(r.held == 0);
  CHECK(r.passed_through == 0);
  CHECK(r.pairs == 0);
  CHECK(r.left_alone == 0);
}

TEST_CASE("caught: cloth between parts that pass through each other is caught, and no other is", "[caught]") {
  const testing::Sheet upright = testing::tilted(sheet(6, 0.06, 0), 0.5 * std::numbers::pi);  // in the plane x = 0
  testing::Sheet cloths = testing::join(upright, sheet(6, 0.2, 0.075));                       // and one on top
  World w = make_world(cloths);
  const testing::Sheet left = block({-0.07, 0, 0}, 0.06), right = block({0.07, 0.007, 0.009}, 0.06);
  add_obstacle(w, testing::join(left, right));
  const ContactWorld world = with_its_obstacle(w);
  const Points nodes = gather_nodes(w.state.x, w.state.obstacles);
  Points together = nodes;
  const Eigen::Index first = world.first_node[0];
  together.middleRows(first, 8).col(0).array() += 0.02;
  together.middleRows(first + 8, 8).col(0).array() -= 0.02;
  Exemption exemption;
  SelfCrossings(world).switch_off(nodes, together, {}, exemption,
                                  {1});  // its driver knows that it does not cross itself
  REQUIRE(exemption.switched_off.empty());
  SelfCrossings(world).switch_off(nodes, together, {}, exemption);
  const auto count = upright.x.rows();
  REQUIRE(exemption.switched_off.size() == static_cast<std::size_t>(nodes.rows()));
  CHECK(std::count(exemption.switched_off.begin(), exemption.switched_off.begin() + count, 1) == count);
  CHECK(std::count(exemption.switched_off.begin() + count, exemption.switched_off.begin() + cloths.x.rows(), 1) == 0);
  const std::vector<int> counted = switched_off_counts(world, exemption);
  CHECK(counted[0] > 0);
  CHECK(may_be_switched_off(w.scene.obstacles[0].surface, together.bottomRows(16)).size() >=
        static_cast<std::size_t>(counted[0]));
  w.drive.obstacles = {together.bottomRows(16)};
  State to;
  CHECK(testing::frame(w.scene, *make_recovering_conventional_stepper(w.scene, {}), w.state, w.drive, 1.0 / 30, to)
            .switched_off == counted);
  CHECK(testing::frame(w.scene, *make_icm_stepper(w.scene, {}), w.state, w.drive, 1.0 / 30, to).switched_off[0] > 0);
  // A pair is left alone for what is caught alone.
  const int body = static_cast<int>(first);
  CHECK(exemption.leaves_alone(world, {0, body + 1, body + 3, body + 5}));
  CHECK_FALSE(exemption.leaves_alone(world, {static_cast<int>(count), body + 1, body + 3, body + 5}));
  // Blocks that move into each other elsewhere catch nothing.
  Points apart = nodes;
  apart.topRows(cloths.x.rows()).col(1).array() += 0.2;
  Points apart_together = together;
  apart_together.topRows(cloths.x.rows()) = apart.topRows(cloths.x.rows());
  Exemption nothing;
  SelfCrossings(world).switch_off(apart, apart_together, {}, nothing);
  CHECK_FALSE(nothing.any());
}

TEST_CASE("caught: a limb that comes out of the body catches dressed cloth whose place it takes, and no other",
          "[caught]") {
  const World w = sheet_and_hand(0.065, 0.03);
  const ContactWorld world = with_its_obstacle(w);
  const Points nodes = gather_nodes(w.state.x, w.state.obstacles);
  Points out = nodes;
  out.bottomRows(8).col(1).array() += 0.05;  // its top from 1 cm below the surface to 4 cm above
  Exemption loose, worn;
  SelfCrossings(world).switch_off(nodes, out, {}, loose);
  CHECK_FALSE(loose.any());  // what comes from outside meets all of the body
  SelfCrossings(world).switch_off(nodes, out, w.state.x, worn);
  REQUIRE_FALSE(worn.switched_off.empty());
  for (int v = 0; v < w.state.x.rows(); ++v) {
    const double off = off_hand(w, v);
    if (std::abs(off - hand_half) > 1e-3) CHECK((worn.switched_off[v] != 0) == (off < hand_half));
  }
}

TEST_CASE("caught: cloth is caught where a part moves over it that lies on one that does not cross yet", "[caught]") {
  // The hand goes into the thigh by 3 cm, through cloth that lies on the thigh 1 mm off.
  const World w = sheet_and_hand(0.061, 0.1);
  const ContactWorld world = with_its_obstacle(w);
  const Points nodes = gather_nodes(w.state.x, w.state.obstacles);
  Points into = nodes;
  into.bottomRows(8).col(1).array() -= 0.05;
  for (const bool still_thigh : {true, false}) {  // the hand is what moves, or the thigh
    Points to = into;
    if (!still_thigh) to.bottomRows(16).col(1).array() += 0.05;
    Exemption exemption;
    SelfCrossings(world).switch_off(nodes, to, {}, exemption);
    REQUIRE_FALSE(exemption.switched_off.empty());
    for (int v = 0; v < w.state.x.rows(); ++v) {
      const double off = off_hand(w, v);
      INFO("thigh still " << still_thigh << ", vertex " << v << ", " << off);
      if (off < hand_half - 1e-3) CHECK(exemption.switched_off[v] != 0);
      if (off > 2 * hand_half)
        CHECK(exemption.switched_off[v] == 0);  // beside the hand; between these it may be pinched
    }
  }
}

}  // namespace selvedge::test_caught
