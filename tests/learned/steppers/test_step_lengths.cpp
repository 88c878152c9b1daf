#include <catch2/catch.hpp>

#include "learned/steppers/learned_state.hpp"
#include "learned/steppers/step_lengths.hpp"
#include "physics/steppers/guard.hpp"
#include "tests/learned/learned_scenes.hpp"

// How far a step follows the output of a network beside the carried guess.
namespace selvedge::test_step_lengths {

namespace {

// A sheet in free flight whose guess is where it is, so that without elastic forces it ends one velocity further.
struct Flight {
  explicit Flight(const fake::Mesh& cloth, const fake::Mesh& body = {})
      : made(fake::learned_case(cloth, body, {0, 0, 0}, 1)) {
    made.scene.pins.clear();
    graph = learned_scene(made.scene).graph;
    elastic = make_elastic(made.scene);
    rest = make_rest_graph(graph, features);
    Drive drive = made.drives[0];
    drive.pins.resize(0, 3);
    state = graph_state(made.scene, made.state, drive);
    state.velocity = Points::Constant(cloth.x.rows(), 3, 2e-3);
    state.acceleration.setZero();
    state.guess = state.x;
  }

  Points after(const Points& output, std::span<const BodyPair> pairs = {}) {
    NextCloth next{state.guess + output, state.guess + output - state.x};
    take_lengths({elastic, graph, rest, features, made.scene.contact.thickness}, state, pairs, scratch, next);
    CHECK((next.velocity - (next.x - state.x)).norm() < 1e-15);
    return next.x;
  }
  // In units of its mass over dt^2.
  double potential(const Points& x) {
    std::vector<double> parts;
    append_elastic_energies(elastic, x, parts);
    double sum = 0;
    for (const double part : parts) sum += part * state.timestep * state.timestep;
    const Points off = x - state.x - state.velocity;
    for (Eigen::Index v = 0; v < x.rows(); ++v)
      sum += 0.5 * graph.mass[static_cast<std::size_t>(v)] * off.row(v).squaredNorm();
    return sum;
  }

  fake::LearnedCase made;
  FeatureOptions features = architecture_preset("student").features;
  GraphScene graph;
  Elastic elastic;
  RestGraph rest;
  GraphState state;
  AssemblyScratch scratch;
};

bool is_near(const Points& a, const Points& b) { return (a - b).cwiseAbs().maxCoeff() < 1e-12; }

Points rough_output(Eigen::Index rows, double by, unsigned seed) {
  Points output = Points::Zero(rows, 3);
  fake::jitter(output, by, seed);
  return output;
}

}  // namespace

TEST_CASE("step lengths: a flight that the network takes too far ends where it should", "[learned][student]") {
  Flight flight(fake::grid(7, 8));
  const Points way = flight.state.velocity;
  CHECK(is_near(flight.after(2 * way), flight.state.x + way));
  CHECK(is_near(flight.after(way), flight.state.x + way));
  CHECK(is_near(flight.after(0.4 * way), flight.state.x + 0.4 * way));  // at most the whole
  CHECK(is_near(flight.after(-way), flight.state.x));
  CHECK(fake::same_points(flight.after(0 * way), flight.state.x));
}

TEST_CASE("step lengths: noise on a right motion is taken off, and the motion stays", "[learned][student]") {
  Flight flight(fake::grid(9, 9));
  const Points way = flight.state.velocity;
  const Points whole = way + rough_output(way.rows(), 1e-3, 5), x = flight.after(whole);
  CHECK((x - flight.state.x - way).norm() < 0.5 * (whole - way).norm());
  CHECK((x - flight.state.x).colwise().mean()[0] == Approx(2e-3).epsilon(0.2));
}

TEST_CASE("step lengths: the potential never rises above that of the guess, whatever the output",
          "[learned][student]") {
  Flight flight(fake::grid(6, 7));
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const double reach = seed % 2 == 0 ? 1e-4 : 2e-3;
    const Points output = rough_output(flight.state.x.rows(), reach, seed) + 0.1 * seed * flight.state.velocity;
    const Points x = flight.after(output);
    CHECK(flight.potential(x) <= flight.potential(flight.state.guess) * (1 + 1e-9));
    CHECK(flight.potential(x) <= flight.potential(flight.state.guess + output) * (1 + 1e-9));
  }
}

TEST_CASE("step lengths: each cloth has its own", "[learned][student]") {
  fake::Mesh two = fake::grid(5, 6);
  const Eigen::Index half = two.x.rows();
  fake::add(two, fake::grid(5, 6), {0, 0.3, 0});
  Flight flight(two);
  Points output = flight.state.velocity;
  output.topRows(half) *= -1;
  const Points x = flight.after(output);
  CHECK(is_near(x.topRows(half), flight.state.x.topRows(half)));
  CHECK(is_near(x.bottomRows(half), (flight.state.x + output).bottomRows(half)));
}

TEST_CASE("step lengths: cloth that touches the body takes the whole output", "[learned][student]") {
  fake::Mesh plate = fake::grid(3, 3, 0.1);
  plate.x.col(1).array() -= 0.003;
  Flight flight(fake::grid(5, 6), plate);
  REQUIRE(0.003 < contact_reach * flight.made.scene.contact.thickness);
  BodySearch search;
  const std::vector<BodyPair> pairs =
      find_body_pairs(flight.graph, flight.features, flight.state.x, flight.state.body, search);
  REQUIRE(std::ssize(pairs) == flight.state.x.rows());
  const Points back = -flight.state.velocity;
  CHECK(is_near(flight.after(back, pairs), flight.state.x + back));
  CHECK(is_near(flight.after(back), flight.state.x));
  flight.state.body.col(1).array() -= 0.1;  // it is far away at both ends
  flight.state.body_target = flight.state.body;
  CHECK(is_near(flight.after(back, pairs), flight.state.x));
}

TEST_CASE("step lengths: pins stay where they are driven", "[learned][student]") {
  Flight flight(fake::grid(6, 6));
  flight.graph.types[0] = pinned_vertex;
  Points output = flight.state.velocity;
  output.row(0) = Eigen::RowVector3d(0, 0.05, 0);  // as integrate leaves it
  const Points x = flight.after(output);
  CHECK((x.row(0) - flight.state.x.row(0) - output.row(0)).norm() < 1e-15);
}

TEST_CASE("step lengths: a learned step has them by default", "[learned][student]") {
  fake::NarrowNetwork student = fake::narrow_network("student", 2e-3);
  const fake::LearnedCase made = fake::learned_case(fake::grid(7, 8), {}, {0, 0, 0}, 1);
  const auto end = [&](const LearnedOptions& options) {
    const auto stepper = make_learned_stepper(made.scene, student.architecture, student.weights, options);
    State to;
    REQUIRE(stepper->step(made.state, made.drives[0], 1.0 / 30, to).status == StepStatus::accepted);
    return to.x;
  };
  CHECK_FALSE(fake::same_points(end({}), end({.step_lengths = false})));
  const auto planned = [&](const Architecture& architecture, bool on) {
    std::vector<bool> in;
    for (const PlanLine& line : learned_plan_lines(made.scene, architecture, {.step_lengths = on}))
      if (line.feature == "step lengths") in.push_back(line.in);
    return in;
  };
  CHECK(planned(student.architecture, true) == std::vector{true});
  CHECK(planned(student.architecture, false) == std::vector{false});
  CHECK(planned(fake::narrow_network("small").architecture, true).empty());
}

}  // namespace selvedge::test_step_lengths
