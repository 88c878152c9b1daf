#include <catch2/catch.hpp>
#include <cmath>

#include "collision/geometry/error.hpp"
#include "collision/geometry/turned_frames.hpp"
#include "learned/graph/elastic_motion.hpp"
#include "learned/graph/integration.hpp"
#include "learned/graph/node_columns.hpp"
#include "learned/network/architecture.hpp"
#include "physics/scene/make_scene.hpp"
#include "tests/learned/graph_scenes.hpp"

// Networks whose output is added to the carried guess: frames, integration, features.
namespace selvedge::test_carried_base {

namespace {

constexpr double dt = 1.0 / 30;

FeatureOptions student() { return architecture_preset("student").features; }

Mat3 some_turn() { return Eigen::AngleAxisd(0.7, Vec3(1, -2, 0.5).normalized()).toRotationMatrix(); }

// A quarter turn, which floats take without rounding.
Mat3 quarter_turn() { return (Mat3() << 0, -1, 0, 1, 0, 0, 0, 0, 1).finished(); }

Points turned(const Points& x, const Mat3& turn) { return x * turn.transpose(); }

// A rumpled cloth of 4 x 5 vertices near a large triangle that moves, with a guess, frames and forces.
fake::World rumpled() {
  fake::Mesh face;
  face.x.resize(3, 3);
  face.x << -1, -.015, -1, -1, -.015, 2, 2, -.015, -1;
  face.triangles.resize(1, 3);
  face.triangles << 0, 1, 2;
  fake::World world = fake::world(fake::grid(4, 5), face);
  GraphState& state = world.state;
  fake::jitter(state.x, 2e-3, 1);
  fake::jitter(state.velocity, 2e-3, 2);
  state.previous = state.x - state.velocity;
  state.target = state.x + state.velocity;
  state.body_target = state.body.rowwise() + Eigen::RowVector3d(1e-3, 2e-3, 0);
  state.guess = state.x;
  fake::jitter(state.guess, 4e-3, 3);
  state.elastic = Points::Zero(state.x.rows(), 3);
  fake::jitter(state.elastic, 1e-2, 4);
  state.acceleration = Eigen::RowVector3d(0, -9.81, 0).replicate(state.x.rows(), 1);
  state.worn_motion = state.worn_offset = Points::Zero(state.x.rows(), 3);
  fake::jitter(state.worn_motion, 3e-3, 6);
  fake::jitter(state.worn_offset, 8e-3, 7);
  state.frames.assign(static_cast<std::size_t>(state.x.rows()), some_turn());
  world.scene.types[3] = pinned_vertex;
  state.guess.row(3) = state.target.row(3);
  return world;
}

void turn(fake::World& world, const Mat3& by) {
  GraphState& s = world.state;
  world.scene.rest = turned(world.scene.rest, by);
  for (Points* points : {&s.x, &s.previous, &s.target, &s.velocity, &s.body, &s.body_previous, &s.body_target, &s.guess,
                         &s.elastic, &s.acceleration, &s.worn_motion, &s.worn_offset})
    *points = turned(*points, by);
  for (Mat3& frame : s.frames) frame = by * frame * by.transpose();
}

Graph raw_graph(const fake::World& world) {
  GraphSearch search;
  GraphReport report;
  Graph graph;
  make_raw_graph(world.scene, make_rest_graph(world.scene, student()), world.state, student(), {}, search, graph,
                 report);
  REQUIRE(report.refused.empty());
  return graph;
}

const Statistics output{{0.5f, -0.5f, 0.5f}, {1e-2f, 2e-2f, 3e-2f}};

FeatureRows some_output(Eigen::Index rows) {
  Points decoded = Points::Zero(rows, 3);
  fake::jitter(decoded, 1, 9);
  return decoded.cast<float>();
}

}  // namespace

TEST_CASE("carried frames: a surface that turns as a whole turns all its frames so", "[graph][carried_base]") {
  const fake::Mesh mesh = fake::grid(4, 5);
  const Surface surface = surface_of(mesh);
  Points before = mesh.x;
  fake::jitter(before, 3e-3, 5);
  const Points after = turned(before, some_turn()).rowwise() + Eigen::RowVector3d(1, 2, 3);
  for (const Mat3& frame : turned_frames(surface, before, after)) CHECK((frame - some_turn()).norm() < 1e-9);
  for (const Mat3& frame : turned_frames(surface, before, before)) CHECK((frame - Mat3::Identity()).norm() < 1e-12);
}

TEST_CASE("carried frames: the identity where there is no frame, or no pose", "[graph][carried_base]") {
  fake::Mesh mesh = fake::grid(2, 2);
  mesh.x.conservativeResize(5, 3);  // a vertex without triangles
  mesh.x.row(4) << 1, 1, 1;
  const Surface surface = surface_of(mesh);
  const Points after = turned(mesh.x, some_turn());
  const auto frames = turned_frames(surface, mesh.x, after);
  CHECK((frames[0] - some_turn()).norm() < 1e-9);
  CHECK(frames[4] == Mat3::Identity());
  for (const Mat3& frame : turned_frames(surface, mesh.x, Points::Constant(5, 3, std::nan(""))))
    CHECK(frame == Mat3::Identity());
  for (const Mat3& frame : turned_frames(surface, Points::Zero(5, 3), after)) CHECK(frame == Mat3::Identity());
}

TEST_CASE("carried frames: the turn about the vertical that brings points nearest", "[graph][carried_base]") {
  Points from = fake::grid(4, 5).x;
  fake::jitter(from, 3e-3, 5);
  for (const double angle : {0.0, 0.4, -2.9}) {
    const Mat3 by = Eigen::AngleAxisd(angle, Vec3::UnitY()).toRotationMatrix();
    Points to = turned(from, by).rowwise() + Eigen::RowVector3d(1, 2, 3);
    CHECK((turn_about_vertical(from, to) - by).norm() < 1e-9);
    to.row(4).setConstant(std::nan(""));
    CHECK((turn_about_vertical(from, to) - by).norm() < 1e-9);
  }
  CHECK(turn_about_vertical(from, Points::Zero(20, 3)) == Mat3::Identity());
  CHECK(turn_about_vertical(from, Points::Constant(20, 3, std::nan(""))) == Mat3::Identity());
}

TEST_CASE("carried base: an output of zero is the guess, bit for bit", "[graph][carried_base]") {
  const fake::World world = rumpled();
  const RestGraph rest = make_rest_graph(world.scene, student());
  const NextCloth next = integrate(rest, world.state, student(), output, FeatureRows::Zero(20, 3));
  CHECK((next.x.array() == world.state.guess.array()).all());
  CHECK((next.velocity - (next.x - world.state.x)).row(5).norm() < 1e-12);
}

TEST_CASE("carried base: the output is added in the frame of each vertex, without a mean", "[graph][carried_base]") {
  fake::World world = rumpled();
  const RestGraph rest = make_rest_graph(world.scene, student());
  const FeatureRows decoded = some_output(20);
  const NextCloth next = integrate(rest, world.state, student(), output, decoded);
  const Vec3 wanted = some_turn() * Vec3(1e-2 * decoded(7, 0), 2e-2 * decoded(7, 1), 3e-2 * decoded(7, 2));
  CHECK((row(next.x, 7) - row(world.state.guess, 7) - wanted).norm() < 1e-8);
  CHECK(next.x.row(3) == world.state.target.row(3));
  world.state.frames.clear();
  const NextCloth plain = integrate(rest, world.state, student(), output, decoded);
  CHECK(plain.x(7, 1) - world.state.guess(7, 1) == Approx(2e-2 * decoded(7, 1)).epsilon(1e-6));
  world.state.frames.resize(7);
  CHECK_THROWS_AS(integrate(rest, world.state, student(), output, decoded), Error);
}

TEST_CASE("carried base: derivatives by the output are those of differences", "[graph][carried_base]") {
  const fake::World world = rumpled();
  const RestGraph rest = make_rest_graph(world.scene, student());
  Points by_x = Points::Zero(20, 3);
  fake::jitter(by_x, 1, 8);
  const Points by_a = by_acceleration(rest, world.state, student(), by_x);
  const auto value = [&](const FeatureRows& decoded) {
    return integrate(rest, world.state, student(), output, decoded).x.cwiseProduct(by_x).sum();
  };
  for (const auto& [v, k] : {std::pair(0, 0), std::pair(7, 1), std::pair(19, 2), std::pair(3, 1)}) {
    FeatureRows more = FeatureRows::Zero(20, 3), less = more;
    more(v, k) = 1;  // the value is linear in the output
    less(v, k) = -1;
    const double deviation = output.deviation[static_cast<std::size_t>(k)];
    CHECK((value(more) - value(less)) / (2 * deviation) == Approx(by_a(v, k)).margin(1e-9));
  }
  CHECK(by_a.row(3).isZero(0));
  const Points plain = by_acceleration(rest, world.state, architecture_preset("small").features, by_x);
  CHECK(plain.row(7) == by_x.row(7));  // networks that make accelerations in space
}

TEST_CASE("student features: the guess and the forces left at it", "[graph][carried_base]") {
  const fake::World world = rumpled();
  const GraphState& s = world.state;
  const Graph graph = raw_graph(world);
  const int at = NodeColumns(student()).objective + 14;
  REQUIRE(graph.nodes.cols() == node_widths(student()).all);
  CHECK(graph.body_vertices.empty());
  CHECK(graph.edge_sets.size() == 3);
  const auto columns = [&](int v, int first) { return graph.nodes.row(v).segment<3>(first).cast<double>().eval(); };
  const auto compressed = [](const Eigen::RowVector3d& way) -> Eigen::RowVector3d {
    return way * (std::log1p(way.norm() / 1e-3) / way.norm());
  };
  CHECK((columns(7, at) - (s.guess.row(7) - s.x.row(7))).norm() < 1e-8);
  CHECK((columns(7, at + 3) - compressed(s.elastic.row(7))).norm() < 1e-5);
  const Eigen::RowVector3d inertia =
      s.x.row(7) + s.velocity.row(7) + dt * dt * Eigen::RowVector3d(0, -9.81, 0) - s.guess.row(7);
  CHECK((columns(7, at + 6) - compressed(inertia)).norm() < 1e-4);
  CHECK(columns(3, at + 3).isZero(0));  // pinned
  CHECK(columns(3, at + 6).isZero(0));
  CHECK((columns(3, at + 9) - s.worn_motion.row(3)).norm() < 1e-8);
  CHECK((columns(7, at + 12) - s.worn_offset.row(7)).norm() < 1e-8);
  fake::World bare = world;
  bare.state.worn_motion.resize(0, 3);
  bare.state.worn_offset.resize(0, 3);
  CHECK(raw_graph(bare).nodes.middleCols<6>(at + 9).isZero(0));
}

TEST_CASE("student features: from its heading a turned state looks the same, and its cloth is the same, turned",
          "[graph][carried_base]") {
  const fake::World world = rumpled();
  fake::World other = world;
  const Mat3 by = Eigen::AngleAxisd(2.1, Vec3::UnitY()).toRotationMatrix();
  turn(other, by);
  other.scene.rest = world.scene.rest;
  other.state.heading = by;
  for (std::size_t v = 0; v < other.state.frames.size(); ++v) other.state.frames[v] = by * world.state.frames[v];
  const Graph graph = raw_graph(world), turned_graph = raw_graph(other);
  CHECK((graph.nodes - turned_graph.nodes).cwiseAbs().maxCoeff() < 1e-5f);
  for (std::size_t k = 0; k < graph.edge_sets.size(); ++k)
    CHECK((graph.edge_sets[k].features - turned_graph.edge_sets[k].features).cwiseAbs().maxCoeff() < 1e-5f);
  const RestGraph rest = make_rest_graph(world.scene, student());
  const FeatureRows decoded = some_output(20);
  CHECK((turned(integrate(rest, world.state, student(), output, decoded).x, by) -
         integrate(rest, other.state, student(), output, decoded).x)
            .cwiseAbs()
            .maxCoeff() < 1e-9);
}

TEST_CASE("student features: turning all turns vectors and leaves the rest; moving all changes nothing",
          "[graph][carried_base]") {
  const fake::World world = rumpled();
  const Graph graph = raw_graph(world);
  fake::World other = world;
  turn(other, quarter_turn());
  const Graph turned_graph = raw_graph(other);
  const NodeColumns at(student());
  const int first = at.objective;  // body: 4 vectors among 14 columns, guess: 5 vectors
  const std::vector<int> vectors{0,          at.normal,  first,      first + 3,  first + 6, first + 11,
                                 first + 14, first + 17, first + 20, first + 23, first + 26};
  FeatureRows wanted = graph.nodes;
  for (const int column : vectors)
    wanted.middleCols<3>(column) =
        (graph.nodes.middleCols<3>(column) * quarter_turn().cast<float>().transpose()).eval();
  CHECK((wanted - turned_graph.nodes).cwiseAbs().maxCoeff() < 1e-5f);
  CHECK((graph.nodes - turned_graph.nodes).cwiseAbs().maxCoeff() > 1e-2f);
  const FeatureRows edges = graph.edge_sets[0].features, turned_edges = turned_graph.edge_sets[0].features;
  CHECK((edges.rightCols(4) - turned_edges.rightCols(4)).cwiseAbs().maxCoeff() < 1e-5f);

  fake::World moved = world;
  const Eigen::RowVector3d by(1, -2, 0.5);
  for (Points* points : {&moved.state.x, &moved.state.previous, &moved.state.target, &moved.state.body,
                         &moved.state.body_previous, &moved.state.body_target, &moved.state.guess})
    points->rowwise() += by;
  CHECK((graph.nodes - raw_graph(moved).nodes).cwiseAbs().maxCoeff() < 1e-5f);

  // The same output, turned: the same cloth, turned.
  const RestGraph rest = make_rest_graph(world.scene, student());
  const Statistics even{{0, 0, 0}, {1e-2f, 1e-2f, 1e-2f}};
  const FeatureRows decoded = some_output(20), turned_output = decoded * quarter_turn().cast<float>().transpose();
  const NextCloth next = integrate(rest, world.state, student(), even, decoded),
                  turned_next = integrate(rest, other.state, student(), even, turned_output);
  CHECK((turned(next.x, quarter_turn()) - turned_next.x).cwiseAbs().maxCoeff() < 1e-9);
}

TEST_CASE("elastic motion: minus the slope of the solver's energies over the mass", "[graph][carried_base]") {
  const fake::Mesh mesh = fake::grid(4, 4);
  Scene scene;
  add_cloth(scene, mesh.x, mesh.triangles, {}, "sheet");
  GraphScene graph = fake::world(mesh).scene;
  graph.types[0] = pinned_vertex;
  graph.mass[5] = 0;
  graph.mass[6] = 3e-4;
  const Elastic elastic = make_elastic(scene);
  Points x = mesh.x;
  fake::jitter(x, 3e-3, 6);
  AssemblyScratch scratch;
  const Points motion = elastic_motion(elastic, graph, dt, x, scratch);
  CHECK(motion.row(0).isZero(0));
  CHECK(motion.row(5).isZero(0));
  const auto energy = [&](const Points& at) {
    std::vector<double> parts;
    append_elastic_energies(elastic, at, parts);
    double sum = 0;
    for (const double part : parts) sum += part;
    return sum;
  };
  for (const int k : {0, 1, 2}) {
    Points more = x, less = x;
    more(6, k) += 1e-7;
    less(6, k) -= 1e-7;
    const double slope = (energy(more) - energy(less)) / 2e-7;
    CHECK(motion(6, k) == Approx(-dt * dt * slope / 3e-4).epsilon(1e-4));
  }
  CHECK(elastic_motion(elastic, graph, dt, Points::Constant(16, 3, std::nan("")), scratch).isZero(0));
}

}  // namespace selvedge::test_carried_base
