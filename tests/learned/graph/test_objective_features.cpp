#include <catch2/catch.hpp>
#include <cmath>

#include "learned/graph/integration.hpp"
#include "learned/network/architecture.hpp"
#include "tests/learned/graph_scenes.hpp"

namespace selvedge::test_objective_features {

namespace {

FeatureOptions own() { return architecture_preset("small").features; }

// Columns of a node: velocity 0, normal 3, dt 6, log mass 7, body 8, force 22, move 25 | materials 28, pinned 31,
// near 32, pass 33.
constexpr int body = 8, force = 22, move = 25, pinned = 31, near = 32, pass = 33;

// A cloth of 3 x 3 vertices, 2 cm apart, 1 cm above a large triangle that rises by 2 mm and goes 1 mm along x.
fake::World above_a_face() {
  fake::Mesh face;
  face.x.resize(3, 3);
  face.x << -1, -.01, -1, -1, -.01, 2, 2, -.01, -1;
  face.triangles.resize(1, 3);
  face.triangles << 0, 1, 2;
  fake::World world = fake::world(fake::grid(3, 3), face);
  world.state.body_target = world.state.body.rowwise() + Eigen::RowVector3d(1e-3, 2e-3, 0);
  return world;
}

Graph raw_graph(const fake::World& world, const FeatureOptions& options, GraphReport& report) {
  GraphSearch search;
  Graph graph;
  make_raw_graph(world.scene, make_rest_graph(world.scene, options), world.state, options, {}, search, graph, report);
  return graph;
}

Graph raw_graph(const fake::World& world, const FeatureOptions& options) {
  GraphReport report;
  Graph graph = raw_graph(world, options, report);
  REQUIRE(report.refused.empty());
  return graph;
}

void check_vector(const Graph& graph, int node, int column, const Eigen::RowVector3f& wanted) {
  INFO("node " << node << " column " << column);
  CHECK((graph.nodes.row(node).segment<3>(column) - wanted).norm() < 1e-6f);
}

}  // namespace

TEST_CASE("objective features: the body's nearest face, now and next", "[learned]") {
  fake::World world = above_a_face();
  world.state.velocity.setZero();
  world.state.velocity.row(4) << 0, -5e-3, 0;
  world.state.x.row(8).y() = 1;  // far away
  const Graph graph = raw_graph(world, own());
  REQUIRE(graph.nodes.cols() == 34);
  CHECK(graph.nodes.rows() == 9);  // no body nodes
  CHECK(graph.edge_sets.size() == 3);
  check_vector(graph, 4, body, {0, .01f, 0});
  check_vector(graph, 4, body + 3, {-1e-3f, .008f, 0});
  check_vector(graph, 4, body + 6, {0, 1, 0});
  CHECK(graph.nodes(4, body + 9) == Approx(.01));
  CHECK(graph.nodes(4, body + 10) == Approx(.003).epsilon(1e-4));  // .01 - .005 - .002
  check_vector(graph, 4, body + 11, {1e-3f, 2e-3f, 0});
  CHECK(graph.nodes(4, near) == 1);
  CHECK(graph.nodes.row(8).segment<14>(body).isZero());
  CHECK(graph.nodes(8, near) == 0);
}

TEST_CASE("objective features: force, move, pass and pinned vertices", "[learned]") {
  fake::World world = above_a_face();
  world.scene.types[2] = pinned_vertex;
  world.state.target.row(2) << .5, .5, .5;
  Graph graph = raw_graph(world, own());
  CHECK(graph.nodes.middleCols<6>(force).isZero());
  CHECK(graph.nodes.col(pinned).sum() == 1);
  CHECK(graph.nodes(2, pinned) == 1);
  CHECK(graph.nodes.col(pass).isZero());
  world.state.force = Points::Zero(9, 3);
  world.state.force.row(4) << 0, 0, -.02;
  world.state.guess = world.state.x + world.state.velocity;
  world.state.guess.row(4) += Eigen::RowVector3d(0, 3e-3, 0);
  world.state.guess.row(2) = world.state.target.row(2);
  world.state.pass = 1;
  graph = raw_graph(world, own());
  check_vector(graph, 4, force, {0, 0, -std::log1p(20.f)});
  check_vector(graph, 4, move, {0, 3e-3f, 0});
  CHECK(graph.nodes.col(force + 2).cwiseAbs().sum() == Approx(std::log1p(20.)));
  CHECK(graph.nodes.middleCols<3>(move).cwiseAbs().sum() == Approx(3e-3).epsilon(1e-4));
  CHECK(graph.nodes.col(pass).isOnes());
}

TEST_CASE("objective features: strain of edges at x and at the guess", "[learned]") {
  fake::World world = above_a_face();
  world.state.x.col(0) *= 1.1;
  world.state.velocity.setZero();
  world.state.guess = world.state.x;
  world.state.guess.col(0) *= .5;
  const Graph graph = raw_graph(world, own());
  const EdgeSet& mesh = graph.edge_sets.front();
  REQUIRE(mesh.features.cols() == 7);
  int along = 0;
  for (std::size_t e = 0; e < mesh.senders.size(); ++e) {
    const auto row = mesh.features.row(static_cast<Eigen::Index>(e));
    const int apart = std::abs(mesh.senders[e] - mesh.receivers[e]);
    if (apart == 3) {  // along x
      ++along;
      CHECK(row(4) == Approx(.02));
      CHECK(row(5) == Approx(.1).epsilon(1e-4));
      CHECK(row(6) == Approx(-.45).epsilon(1e-4));
    } else if (apart == 1) {
      CHECK(row(5) == Approx(0).margin(1e-6));
      CHECK(row(6) == Approx(0).margin(1e-6));
    }
  }
  CHECK(along == 12);
}

TEST_CASE("objective features: a guess or a force that is no number gives no graph; a wrong size is an error",
          "[learned]") {
  fake::World world = above_a_face();
  world.state.force = Points::Constant(9, 3, std::nan(""));
  GraphReport report;
  raw_graph(world, own(), report);
  CHECK_FALSE(report.refused.empty());
  world.state.force = Points::Zero(8, 3);
  CHECK_THROWS(raw_graph(world, own(), report));
}

TEST_CASE("objective features: the next pass of a frame goes on from the guess", "[learned]") {
  fake::World world = above_a_face();
  const FeatureOptions options = own();
  const RestGraph rest = make_rest_graph(world.scene, options);
  const Statistics output{{1e-3f, 0, 0}, {1e-2f, 1e-2f, 1e-2f}};
  const FeatureRows decoded = FeatureRows::Constant(9, 3, .5f);
  const NextCloth first = integrate(rest, world.state, options, output, decoded);
  world.state.guess = first.x;
  const NextCloth second = integrate(rest, world.state, options, output, decoded);
  const Eigen::RowVector3d a(6e-3, 5e-3, 5e-3);
  CHECK(((first.x - world.state.x - world.state.velocity).rowwise() - a).cwiseAbs().maxCoeff() < 1e-9);
  CHECK(((second.x - first.x).rowwise() - a).cwiseAbs().maxCoeff() < 1e-9);
  CHECK((second.velocity - (second.x - world.state.x)).cwiseAbs().maxCoeff() < 1e-12);
}

TEST_CASE("warm-up: constant columns get deviation 1, and sets that were not seen keep what they have", "[learned]") {
  const Architecture a = architecture_preset("small_contour");
  fake::World world = above_a_face();
  FeatureSums<double> sums = empty_sums(a.features);
  FeatureTables tables;
  tables.world_edge = {std::vector<float>(13, 7.f), std::vector<float>(13, 3.f)};
  for (int i = 0; i < 3; ++i) {
    fake::jitter(world.state.x, 1e-3, static_cast<unsigned>(i));
    gather(a.features, raw_graph(world, a.features), FeatureRows::Constant(9, 3, .25f * static_cast<float>(i)), sums);
  }
  freeze_statistics(sums, tables);
  CHECK(tables.node.deviation[6] == 1);  // time step
  CHECK(tables.node.mean[6] == Approx(1. / 30));
  CHECK(tables.node.deviation[22] == 1);                        // no force
  CHECK(tables.node.deviation[9] == Approx(1e-3).epsilon(.5));  // height above the body: jitter adds up
  CHECK(tables.mesh_edge.deviation[0] > 1e-3f);
  CHECK(tables.output.mean[1] == Approx(.25));
  CHECK(tables.output.deviation[1] == Approx(.25 * std::sqrt(2. / 3)));
  CHECK(tables.world_edge.mean[0] == 7);
  CHECK(tables.world_edge.deviation[0] == 3);
}

}  // namespace selvedge::test_objective_features
