#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "collision/untangle/find_exemption.hpp"
#include "physics/recovery/pierced.hpp"
#include "physics/recovery/put_on.hpp"
#include "physics/recovery/recovery.hpp"
#include "physics/steppers/recovering_stepper.hpp"
#include "tests/frame.hpp"
#include "tests/physics/worlds.hpp"

namespace selvedge::test_pierced {

using testing::Sheet;

namespace {

// A closed spindle along y, oriented outwards.
Sheet spindle(double radius, double half_length) {
  const int along = 24, round = 16;
  Sheet s{Points(2 + (along - 1) * round, 3), Triangles(2 * (along - 1) * round, 3)};
  s.x.row(0) << 0, half_length, 0;
  s.x.row(1) << 0, -half_length, 0;
  const auto at = [&](int i, int j) { return i == 0 ? 0 : i == along ? 1 : 2 + (i - 1) * round + j % round; };
  int t = 0;
  for (int i = 0; i < along; ++i)
    for (int j = 0; j < round; ++j) {
      const double a = std::numbers::pi * i / along, b = 2 * std::numbers::pi * (j + 0.3) / round;
      if (i > 0)
        s.x.row(at(i, j)) << radius * std::sin(a) * std::cos(b), half_length * std::cos(a),
            radius * std::sin(a) * std::sin(b);
      if (i > 0) s.triangles.row(t++) << at(i, j), at(i, j + 1), at(i + 1, j);
      if (i + 1 < along) s.triangles.row(t++) << at(i, j + 1), at(i + 1, j + 1), at(i + 1, j);
    }
  return s;
}

// A sheet with a body through its middle, and a second sheet beside them; the skinned targets of both are 0.5 m farther
// up.
struct Skewer {
  testing::World w;
  ContactWorld world;
  Points nodes;

  explicit Skewer(const Sheet& body) {
    Sheet beside = testing::sheet(4, 0.2, 0);
    beside.x.rowwise() += Eigen::RowVector3d(0.6, 0, 0);
    w = testing::make_world(testing::join(testing::sheet(16, 0.6, 0.013), beside));
    testing::add_obstacle(w, body);
    w.state.clean = false;
    w.drive.skinned_targets = w.state.x;
    w.drive.skinned_targets.col(1).array() += 0.5;
    world = testing::with_its_obstacle(w);
    nodes = gather_nodes(w.state.x, w.state.obstacles);
  }
  std::vector<char> pierced(double min_distance = 1) const {
    return pierced_vertices(world, find_exemption(world, nodes), nodes, nodes, w.drive.skinned_targets, min_distance);
  }
  RecoveryTargets where(const Points& wanted, const Points& targets, const Points& last_clean = {}) const {
    return {&wanted, &targets, last_clean, w.scene.contact.thickness, 0.1};
  }
};

}  // namespace

TEST_CASE("pierced: all of a cloth that something long has gone through, and no other", "[pierced]") {
  const std::vector<char> marked = Skewer(spindle(0.05, 0.3)).pierced();
  REQUIRE(marked.size() == 17 * 17 + 25);
  CHECK(std::count(marked.begin(), marked.begin() + 17 * 17, 1) == 17 * 17);
  CHECK(std::count(marked.begin() + 17 * 17, marked.end(), 1) == 0);
}

TEST_CASE("pierced: nothing that can be pushed out, or is pierced at its targets, or has no place to go to",
          "[pierced]") {
  CHECK(Skewer(spindle(0.05, 0.06)).pierced().empty());  // a bump
  Skewer there(spindle(0.05, 0.3));
  there.w.drive.skinned_targets.col(1).array() -= 0.52;
  CHECK(there.pierced().empty());
  Skewer undressed(spindle(0.05, 0.3));
  undressed.w.drive.skinned_targets.row(40).setConstant(std::numeric_limits<double>::quiet_NaN());
  CHECK(undressed.pierced().empty());
  CHECK(undressed.pierced(0).empty());
  undressed.w.drive.skinned_targets.resize(0, 3);
  CHECK(undressed.pierced().empty());
  const Skewer crossing(spindle(0.05, 0.3));
  Exemption exemption = find_exemption(crossing.world, crossing.nodes);
  exemption.switched_off.assign(static_cast<std::size_t>(crossing.world.node_count), 0);
  CHECK(pierced_vertices(crossing.world, exemption, crossing.nodes, crossing.nodes, crossing.w.drive.skinned_targets, 0)
            .empty());
}

TEST_CASE("pierced: cloth that is tangled far from its targets, until it is near", "[pierced]") {
  const Skewer bump(spindle(0.05, 0.06));  // its targets are 0.5 m away
  const std::vector<char> marked = bump.pierced(0.45);
  REQUIRE(marked.size() == 17 * 17 + 25);
  CHECK(std::count(marked.begin(), marked.begin() + 17 * 17, 1) == 17 * 17);
  CHECK(std::count(marked.begin() + 17 * 17, marked.end(), 1) == 0);  // as far, and not tangled
  CHECK(bump.pierced(0.55).empty());
  const Skewer pinprick(spindle(0.02, 0.03));
  CHECK(find_exemption(pinprick.world, pinprick.nodes).tangled_vertices() > 0);
  CHECK(pinprick.pierced(0.1).empty());  // a few vertices: the rest of the cloth is where it should be
}

TEST_CASE("pierced: the stepper takes the cloth off, through the body, and only to its targets", "[pierced]") {
  Skewer skewer(spindle(0.05, 0.3));
  skewer.w.drive.acceleration.setZero();
  skewer.w.drive.skinned_targets.col(1).array() -= 1;  // below: by itself it would leave over the nearer end, above
  const testing::Run off = testing::run(skewer.w, 12);
  CHECK(off.state.clean);
  CHECK(off.state.x.topRows(17 * 17).col(1).maxCoeff() < -0.25);
  CHECK(off.state.v.topRows(17 * 17).rowwise().norm().maxCoeff() < 0.5);  // it does not fly on as it was drawn
  skewer.w.drive.skinned_targets.resize(0, 3);
  CHECK(testing::run(skewer.w, 12).state.x.topRows(17 * 17).col(1).mean() > 0.01);
}

TEST_CASE("pierced: cloth is drawn to its targets also while it cannot be put there", "[pierced]") {
  Skewer skewer(spindle(0.05, 0.3));
  skewer.w.drive.acceleration.setZero();
  Points& targets = skewer.w.drive.skinned_targets;
  for (int v = 0; v < 17 * 17; ++v) targets.row(v) += 0.1 * Eigen::RowVector3d(std::sin(v * v), -3, std::cos(v * v));
  const std::vector<char> marked = skewer.pierced();
  REQUIRE_FALSE(marked.empty());
  Points nodes = skewer.nodes, v = skewer.w.state.v;
  const PutOn put = put_on(skewer.world, marked, skewer.where(skewer.nodes, targets), nodes, v);
  REQUIRE(put == PutOn::no_place);  // it crosses itself there
  const auto height = [](const Points& x) { return x.topRows(17 * 17).col(1).mean(); };
  CHECK(height(testing::run(skewer.w, 1).state.x) > height(skewer.w.state.x) + 0.05);
}

TEST_CASE("sunken: cloth that has no way out, and is too far to be put on, is drawn to its targets", "[pierced]") {
  const int n = 16;
  Sheet barbed = testing::sheet(n, 0.6, 0);
  const auto first = barbed.x.rows();
  barbed.x.conservativeResize(first + 2, 3);
  barbed.x.row(first) << -0.7, -1, 0.3;  // wider than where it hangs on the sheet: it gets longer on the way out
  barbed.x.row(first + 1) << 0.7, -1, 0.3;
  barbed.triangles.conservativeResize(barbed.triangles.rows() + 2, 3);
  const int a = n * (n + 1) + n / 2, b = a + 1, c = static_cast<int>(first), d = c + 1;
  barbed.triangles.bottomRows(2) << a, c, b, b, c, d;
  testing::World w = testing::make_world(barbed);
  Sheet block = spindle(4, 4);
  block.x.col(1).array() -= 4.03;
  testing::add_obstacle(w, block);
  w.state.clean = false;
  w.drive.acceleration.setZero();
  const ContactWorld world = testing::with_its_obstacle(w);
  Points nodes = gather_nodes(w.state.x, w.state.obstacles);
  const Exemption exemption = find_exemption(world, nodes);
  w.drive.skinned_targets = w.state.x.rowwise() + Eigen::RowVector3d(0, 1.5, 0);
  CHECK(pierced_vertices(world, exemption, nodes, nodes, w.drive.skinned_targets, 0.02).empty());
  REQUIRE_FALSE(sunken_vertices(world, exemption, w.drive.skinned_targets).empty());
  REQUIRE(recover(world, inverse_masses(w.scene, world.node_count), 1.0 / 30, exemption, {}, nodes).stuck);
  const auto height = [](const Points& x) { return x.col(1).mean(); };
  CHECK(height(testing::run(w, 1).state.x) > height(w.state.x) + 0.05);
  w.drive.skinned_targets.resize(0, 3);
  CHECK(height(testing::run(w, 1).state.x) < height(w.state.x) + 0.01);
}

TEST_CASE("sunken: all of a cloth of which one vertex in a hundred is tangled, however near", "[pierced]") {
  const auto sunken = [](const Skewer& skewer) {
    return sunken_vertices(skewer.world, find_exemption(skewer.world, skewer.nodes), skewer.w.drive.skinned_targets);
  };
  Skewer bump(spindle(0.05, 0.06));
  const std::vector<char> marked = sunken(bump);
  REQUIRE(marked.size() == 17 * 17 + 25);
  CHECK(std::count(marked.begin(), marked.begin() + 17 * 17, 1) == 17 * 17);
  CHECK(std::count(marked.begin() + 17 * 17, marked.end(), 1) == 0);
  bump.w.drive.skinned_targets.row(40).setConstant(std::numeric_limits<double>::quiet_NaN());
  CHECK(sunken(bump).empty());
  Exemption few;
  few.body.assign(17 * 17 + 25, 0);
  few.body[0] = few.body[1] = 1;
  CHECK(sunken_vertices(bump.world, few, bump.w.state.x).empty());
  few.body[2] = 1;
  CHECK_FALSE(sunken_vertices(bump.world, few, bump.w.state.x).empty());
}

TEST_CASE("put on: cloth is at its targets, clean, and moves along with its body", "[pierced]") {
  Skewer skewer(spindle(0.05, 0.2));
  const std::vector<char> marked = skewer.pierced();
  const Vec3 way(0.01, 0.02, -0.01);
  Points wanted = skewer.nodes;
  wanted.bottomRows(wanted.rows() - skewer.w.state.x.rows()).rowwise() += way.transpose();
  Points nodes = skewer.nodes, v = skewer.w.state.v;
  const auto put = [&] {
    return put_on(skewer.world, marked, skewer.where(wanted, skewer.w.drive.skinned_targets), nodes, v);
  };
  skewer.w.drive.skinned_targets.col(1).array() += 0.1;
  CHECK(put() == PutOn::too_far);  // half a metre away
  CHECK(nodes == skewer.nodes);
  skewer.w.drive.skinned_targets.col(1).array() -= 0.3;
  REQUIRE(put() == PutOn::done);
  const int sheet = 17 * 17;
  const Points place = skewer.w.drive.skinned_targets.topRows(sheet).rowwise() - way.transpose();
  CHECK((nodes.topRows(sheet) - place).cwiseAbs().maxCoeff() < 1e-12);
  CHECK((v.topRows(sheet).rowwise() - 10 * way.transpose()).cwiseAbs().maxCoeff() < 1e-12);
  CHECK(nodes.bottomRows(nodes.rows() - sheet) == skewer.nodes.bottomRows(nodes.rows() - sheet));
  CHECK(v.bottomRows(v.rows() - sheet) == skewer.w.state.v.bottomRows(v.rows() - sheet));
}

TEST_CASE("put on: a place that is in the body is untangled, and one that cannot be is left alone", "[pierced]") {
  Skewer skewer(spindle(0.05, 0.3));
  const std::vector<char> marked = skewer.pierced();
  Points targets = skewer.w.drive.skinned_targets, nodes = skewer.nodes, v = skewer.w.state.v;
  targets.col(1).array() -= 0.21;  // just in the spindle's tip
  const auto put = [&] { return put_on(skewer.world, marked, skewer.where(skewer.nodes, targets), nodes, v); };
  CHECK(put() == PutOn::done);
  CHECK_FALSE(find_exemption(skewer.world, nodes).tangled());
  targets.col(1).array() -= 0.31;  // about its middle
  nodes = skewer.nodes;
  CHECK(put() == PutOn::no_place);
  CHECK(nodes == skewer.nodes);
  CHECK(put_on(skewer.world, {}, skewer.where(skewer.nodes, targets), nodes, v) == PutOn::nothing);
}

TEST_CASE("put on: another layer that is in the way makes way, and keeps its velocity", "[pierced]") {
  const int sheet = 17 * 17;
  Sheet upright = testing::tilted(testing::sheet(4, 0.2, 0), std::numbers::pi / 2);
  upright.x.col(1).array() += 0.28;  // its lowest two centimetres reach through the sheet's targets
  testing::World w = testing::make_world(testing::join(testing::sheet(16, 0.6, 0), upright));
  testing::add_obstacle(w, spindle(0.05, 0.06));
  Points targets = w.state.x, nodes = gather_nodes(w.state.x, w.state.obstacles), v = w.state.v;
  targets.col(1).array() += 0.2;
  v.bottomRows(25).setConstant(0.3);
  std::vector<char> marked(static_cast<std::size_t>(sheet) + 25, 0);
  std::fill_n(marked.begin(), sheet, 1);
  const ContactWorld world = testing::with_its_obstacle(w);
  const Points before = nodes;
  const Points wanted = nodes;
  REQUIRE(put_on(world, marked, {&wanted, &targets, {}, 0.002, 0.1}, nodes, v) == PutOn::done);
  CHECK_FALSE(find_exemption(world, nodes).tangled());
  CHECK((nodes - before).middleRows(sheet, 25).cwiseAbs().maxCoeff() > 1e-3);
  CHECK((v.bottomRows(25).array() == 0.3).all());
  CHECK(v.topRows(sheet).isZero());
}

TEST_CASE("put on: where cloth was clean last is a place as well, carried to where obstacles are now", "[pierced]") {
  const Skewer skewer(spindle(0.05, 0.25));
  const int sheet = 17 * 17;
  const std::vector<char> marked = skewer.pierced();
  Points targets = skewer.w.drive.skinned_targets, wanted = skewer.nodes, nodes = skewer.nodes, v = skewer.w.state.v;
  for (int i = 0; i < sheet; ++i)  // no place: it crosses itself there
    targets.row(i) = skewer.nodes.row(i) + 0.1 * Eigen::RowVector3d(std::sin(i * i), 0, std::cos(i * i));
  const Eigen::RowVector3d elsewhere(0.4, 1, -2), way(0.01, 0.02, -0.01);
  wanted.bottomRows(wanted.rows() - skewer.w.state.x.rows()).rowwise() += way;
  Points last_clean = skewer.nodes.rowwise() + elsewhere;
  const auto put = [&] { return put_on(skewer.world, marked, skewer.where(wanted, targets, last_clean), nodes, v); };
  CHECK(put() == PutOn::no_place);  // both
  last_clean.topRows(sheet).col(1).array() += 0.4;
  CHECK(put() == PutOn::no_place);  // that one is too far
  CHECK(nodes == skewer.nodes);
  last_clean.topRows(sheet).col(1).array() -= 0.13;  // above the spindle
  REQUIRE(put() == PutOn::done);
  CHECK_FALSE(find_exemption(skewer.world, nodes).tangled());
  CHECK((nodes.topRows(sheet).rowwise() + elsewhere - last_clean.topRows(sheet)).cwiseAbs().maxCoeff() < 1e-12);
  CHECK((v.topRows(sheet).rowwise() - 10 * way).cwiseAbs().maxCoeff() < 1e-12);
  last_clean.resize(0, 3);
  nodes = skewer.nodes;
  CHECK(put() == PutOn::no_place);
}

TEST_CASE("put on: cloth that a body closed on, through itself, is back between its parts once these part",
          "[pierced]") {
  const auto lenses = [](double apart) {
    Sheet above = spindle(0.15, 0.05), below = above;
    above.x.col(1).array() += apart;
    below.x.col(1).array() -= apart;
    return testing::join(above, below);
  };
  testing::World w = testing::make_world(testing::sheet(16, 0.4, 0));
  testing::add_obstacle(w, lenses(0.07));
  w.drive.acceleration.setZero();
  w.drive.skinned_targets = w.state.x;
  w.state.clean = true;
  const auto end = [&](int renew) {
    auto stepper = testing::conventional(w.scene);
    State at = w.state;
    int frame = 0;
    for (const double apart : {0.06, 0.02, 0.01, 0.02, 0.06, 0.06}) {
      if (++frame == renew) stepper = testing::conventional(w.scene);
      State to;
      w.drive.obstacles = {lenses(apart).x};
      w.drive.skinned_targets.col(1).setConstant(apart);  // in the upper one's middle
      REQUIRE(testing::frame(w.scene, *stepper, at, w.drive, 1.0 / 30, to).status == StepStatus::accepted);
      CHECK(to.clean == (frame == 1 || frame == 6));
      CHECK(last_clean(to).x == (at.clean ? at.x : Points(last_clean(at).x)));  // the frame before, or still that one
      at = to;
    }
    return at;
  };
  const State whole = end(0);
  CHECK(whole.x.col(1).cwiseAbs().maxCoeff() < 0.02);
  CHECK(end(4).x == whole.x);  // a stepper that goes on from a checkpoint
}

}  // namespace selvedge::test_pierced
