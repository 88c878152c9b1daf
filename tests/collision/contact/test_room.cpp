#include <catch2/catch.hpp>

#include "collision/contact/room.hpp"
#include "tests/collision/sheets.hpp"

namespace selvedge::test_room {

using testing::Sheet;
using testing::sheet;

namespace {

constexpr double thickness = 2e-3, separation = 2e-4;

// Cloth and obstacles, which end where `wanted` says.
struct Pushed {
  Surface cloth;
  std::vector<Surface> obstacles;
  ContactWorld world;
  Points x0, x1, wanted;
  Eigen::VectorXd inverse_mass;
  int cloth_nodes = 0;

  Pushed(const Sheet& layers, const std::vector<Sheet>& others) {
    cloth_nodes = static_cast<int>(layers.x.rows());
    cloth = make_surface(cloth_nodes, layers.triangles);
    std::vector<Points> positions;
    for (const Sheet& other : others) {
      obstacles.push_back(make_surface(static_cast<int>(other.x.rows()), other.triangles));
      positions.push_back(other.x);
    }
    std::vector<const Surface*> surfaces;
    for (const Surface& obstacle : obstacles) surfaces.push_back(&obstacle);
    world = make_contact_world(cloth, surfaces, true);
    wanted = x1 = x0 = gather_nodes(layers.x, positions);
    inverse_mass = Eigen::VectorXd::Zero(x0.rows());
    inverse_mass.head(cloth_nodes).setConstant(1e4);
  }
  bool make_room() {
    PairSearch search(world);
    PathPairs path;
    ResolveOptions options;
    options.thickness = thickness;
    options.separation = separation;
    update_pairs(search, thickness, x0, x1, path);
    const auto near = find_proximities(world, path.pairs, x0, thickness);
    ResolveReport report;
    return selvedge::make_room(search, world, options, near, x0, x1, path, inverse_mass, report);
  }
  double lag(int node) const { return (x1.row(node) - wanted.row(node)).norm(); }
};

Sheet stack(int layers, double size, double gap) {
  Sheet all = sheet(6, size, 0);
  for (int k = 1; k < layers; ++k) all = testing::join(all, sheet(6 + k, size, k * gap));
  return all;
}

// Layers of cloth between two plates; the plates end where `to` says.
struct Press : Pushed {
  Press(int layers, double cloth_size, double gap, double to, int plate_cells = 3)
      : Pushed(stack(layers, cloth_size, gap), {sheet(plate_cells, 0.3, -gap), sheet(plate_cells, 0.3, layers * gap)}) {
    const double middle = 0.5 * (layers - 1) * gap;
    for (int v = cloth_nodes; v < x1.rows(); ++v) x1(v, 1) = middle + (x0(v, 1) < middle ? -0.5 : 0.5) * to;
    wanted = x1;
  }
};

}  // namespace

TEST_CASE("room: plates that would meet stop with room for every layer, and not much more", "[room]") {
  for (const int layers : {1, 3}) {
    Press press(layers, 0.2, 1e-3, -1e-3);
    REQUIRE(press.make_room());
    const double least = (layers + 1) * 2 * separation;
    CHECK(press.x1.topRows(press.cloth_nodes) == press.x0.topRows(press.cloth_nodes));
    const int per_plate = press.obstacles[0].vertex_count;
    for (int v = 0; v < per_plate; ++v) {
      const int low = press.cloth_nodes + v, high = low + per_plate;
      if (std::abs(press.x0(low, 0)) > 0.11 || std::abs(press.x0(low, 2)) > 0.11) continue;
      CHECK(press.x1(high, 1) - press.x1(low, 1) > 0.9 * least);
      CHECK(press.x1(high, 1) - press.x1(low, 1) < (layers + 1) * 1e-3);
      CHECK(press.inverse_mass[low] > 0);
    }
  }
}

TEST_CASE("room: plates that leave just enough room are where they are wanted", "[room]") {
  for (const int layers : {1, 3}) {
    Press press(layers, 0.2, 1.5e-3, 1.05 * (layers + 1) * 2 * separation);
    const Eigen::VectorXd before = press.inverse_mass;
    CHECK_FALSE(press.make_room());
    CHECK(press.x1 == press.wanted);
    CHECK(press.inverse_mass == before);
  }
}

TEST_CASE("room: a plate alone pushes cloth and does not give way", "[room]") {
  Press press(2, 0.2, 1.5e-3, -1e-3);
  const int per_plate = press.obstacles[0].vertex_count;
  press.x1.bottomRows(per_plate).col(1).array() += 0.1;
  press.wanted = press.x1;
  CHECK_FALSE(press.make_room());
  CHECK(press.x1 == press.wanted);
}

TEST_CASE("room: plates wanted deep in each other do not fold round what is between them", "[room]") {
  Press press(1, 0.05, 1e-3, -0.05, 24);
  REQUIRE(press.make_room());
  double most = 0, steepest = 0;
  int node = press.cloth_nodes;
  for (const Surface& plate : press.obstacles) {
    for (int e = 0; e < plate.edges.rows(); ++e) {
      const int a = node + plate.edges(e, 0), b = node + plate.edges(e, 1);
      const Vec3 change = row(press.x1, a) - row(press.wanted, a) - row(press.x1, b) + row(press.wanted, b);
      steepest = std::max(steepest, change.norm() / (press.wanted.row(a) - press.wanted.row(b)).norm());
    }
    for (int v = 0; v < plate.vertex_count; ++v) most = std::max(most, press.lag(node + v));
    node += plate.vertex_count;
  }
  CHECK(most > 0.024);
  CHECK(most < 0.03);
  CHECK(steepest < 0.9);
}

TEST_CASE("room: only what is near the cloth gives way", "[room]") {
  Press press(1, 0.05, 1e-3, -1e-3, 24);
  REQUIRE(press.make_room());
  double most = 0;
  for (int v = press.cloth_nodes; v < press.x0.rows(); ++v) {
    const bool far = std::abs(press.x0(v, 0)) > 0.05 || std::abs(press.x0(v, 2)) > 0.05;
    if (far) {
      CHECK(press.lag(v) == 0);
      CHECK(press.inverse_mass[v] == 0);
    }
    most = std::max(most, press.lag(v));
  }
  CHECK(most > 0.5 * (1e-3 + 2 * separation));
}

TEST_CASE("room: obstacles catch up where the way has come free, and only there", "[room]") {
  Press press(2, 0.2, 1e-3, 2.5e-3);
  const int per_plate = press.obstacles[0].vertex_count;
  long searches = -1;  // of the last call
  const auto catch_up = [&] {
    PairSearch search(press.world);
    PathPairs path;
    ResolveOptions options;
    options.thickness = thickness;
    options.separation = separation;
    const bool clean = selvedge::catch_up(search, options, press.inverse_mass, press.wanted, press.x1, path).clean;
    searches = search.tally().searches;
    return clean;
  };
  press.x1 = press.x0;
  CHECK(catch_up());
  CHECK(press.x1 == press.wanted);
  CHECK(searches == 1);
  press.x1.bottomRows(2 * per_plate) *= 1 + std::numeric_limits<double>::epsilon();  // as a sum of substeps is off
  CHECK(catch_up());
  CHECK(press.x1 == press.wanted);
  CHECK(searches == 0);
  press.x1 = press.x0;
  press.wanted.bottomRows(per_plate).col(1).array() -= 2e-3;  // through the upper layer
  CHECK_FALSE(catch_up());
  CHECK(press.x1 == press.x0);
}

namespace {

// Bends a flat sheet round an axis along z.
Sheet arched(Sheet s, double radius) {
  for (auto p : s.x.rowwise()) {
    const double angle = p.x() / 0.06;
    p << radius * std::sin(angle), radius * std::cos(angle), p.z();
  }
  return s;
}

}  // namespace

TEST_CASE("room: a fine, round body pushes coarse layers before it and does not give way", "[room]") {
  const Sheet body = arched(sheet(48, 0.24, 0), 0.06);
  Sheet layers = arched(sheet(5, 0.16, 0), 0.065);
  for (const int k : {1, 2}) layers = testing::join(layers, arched(sheet(5 + k, 0.16, 0), 0.065 + 2e-3 * k));
  for (const double way : {0.01, 0.015, 0.02}) {
    Pushed pushed(layers, {body});
    const Eigen::AngleAxisd turn(0.3, Vec3::UnitZ());
    for (int v = pushed.cloth_nodes; v < pushed.x1.rows(); ++v)
      pushed.x1.row(v) = (turn * row(pushed.x0, v) + Vec3(0, way, way)).transpose();
    pushed.wanted = pushed.x1;
    CHECK_FALSE(pushed.make_room());
    CHECK((pushed.x1 - pushed.wanted).cwiseAbs().maxCoeff() == 0);
  }
}

}  // namespace selvedge::test_room
