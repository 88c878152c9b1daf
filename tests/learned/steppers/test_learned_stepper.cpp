#include <catch2/catch.hpp>
#include <filesystem>
#include <limits>

#include "collision/geometry/error.hpp"
#include "learned/gradients/torch_network.hpp"
#include "learned/graph/integration.hpp"
#include "learned/network/engine.hpp"
#include "learned/network/packed_network.hpp"
#include "learned/steppers/learned_stepper.hpp"
#include "tests/frame.hpp"
#include "tests/learned/learned_scenes.hpp"
#include "tests/threads.hpp"

namespace selvedge::test_learned_stepper {

namespace {

constexpr double frame_dt = 1.0 / 30;

fake::LearnedCase above_a_plate(int frames, double height = 0.01) {
  fake::Mesh plate = fake::grid(5, 5, 0.03);
  plate.x.col(1).array() -= height;
  return fake::learned_case(fake::grid(8, 9), plate, {0.001, 0.002, 0}, frames);
}

// Steps until a step is rejected. Returns the states, the first one included.
std::vector<State> rollout(const fake::LearnedCase& run, Stepper& stepper, StepReport* last = nullptr) {
  std::vector<State> states{run.state};
  for (const Drive& drive : run.drives) {
    State to;
    const StepReport report = testing::frame(run.scene, stepper, states.back(), drive, frame_dt, to);
    if (last) *last = report;
    if (report.status != StepStatus::accepted) break;
    states.push_back(std::move(to));
  }
  return states;
}

std::unique_ptr<Stepper> stepper_of(const Scene& scene, const fake::NarrowNetwork& network,
                                    const LearnedOptions& options = {}) {
  return make_learned_stepper(scene, network.architecture, network.weights, options);
}

// What the stepper does, from the parts: a frame of the network by hand.
struct ByHand {
  const Scene& scene;
  const fake::NarrowNetwork& network;
  GraphScene graph_scene = learned_scene(scene).graph;
  RestGraph rest = make_rest_graph(graph_scene, network.architecture.features);

  NextCloth frame(const GraphState& state) const {
    GraphSearch search;
    GraphReport found;
    const FeatureTables& tables = network.weights.tables;
    Graph graph;
    make_graph(graph_scene, rest, state, network.architecture.features, tables, search, graph, found);
    return integrate(rest, state, network.architecture.features, tables.output,
                     infer(*pack_network(network.architecture, network.weights), graph));
  }
};

GraphState first_state(const fake::LearnedCase& run) {
  GraphState state;
  state.x = state.previous = state.target = run.state.x;
  state.velocity = Points::Zero(state.x.rows(), 3);
  state.body = state.body_previous = state.body_target = run.state.obstacles[0];
  return state;
}

}  // namespace

TEST_CASE("A roll-out of HOOD through the stepper has the bits of one by hand", "[learned]") {
  const fake::LearnedCase run = above_a_plate(4);
  const fake::NarrowNetwork network = fake::narrow_network("hood");
  const std::vector<State> states = rollout(run, *stepper_of(run.scene, network));
  REQUIRE(states.size() == 5);

  const ByHand hand{run.scene, network};
  GraphState state = first_state(run);
  state.timestep = 1.0 / 3;
  push_out(hand.graph_scene.body, state.body, push_out_margin, state.x);
  state.previous = state.x;
  NextCloth next = hand.frame(state);
  state.timestep = frame_dt;
  for (std::size_t k = 0; k < run.drives.size(); ++k) {
    state.previous = k == 0 ? next.x : state.x;
    state.previous.row(0) = k == 0 ? next.x.row(0) : state.target.row(0);
    state.x = state.target = next.x;
    state.target.row(0) = run.drives[k].pins.row(0);
    state.velocity = next.velocity;
    if (k > 0) {
      state.body_previous = state.body;
      state.body = state.body_target;
    }
    state.body_target = run.drives[k].obstacles[0];
    next = hand.frame(state);
    INFO("frame " << k + 1);
    CHECK(fake::same_points(states[k + 1].x, next.x));
    CHECK(states[k + 1].x.row(0) == run.drives[k].pins.row(0));
    CHECK((states[k + 1].v.row(5) - 30 * next.velocity.row(5)).norm() < 1e-12);
  }
}

TEST_CASE("A proposal has the bits of a step; its energy is left to the stepper that judges it", "[learned]") {
  const fake::LearnedCase run = above_a_plate(1);
  const fake::NarrowNetwork network = fake::narrow_network("hood");
  State step, proposal;
  const StepReport report =
      stepper_of(run.scene, network)->step(run.state, run.drives[0], frame_dt, proposal, {.proposal = true});
  stepper_of(run.scene, network)->step(run.state, run.drives[0], frame_dt, step);
  CHECK(report.status == StepStatus::accepted);
  CHECK_FALSE(report.doubts.any());
  CHECK(fake::same_points(step.x, proposal.x));
  CHECK(fake::same_points(step.v, proposal.v));
}

TEST_CASE("The first frame of a roll-out says how many vertices its settling moved out of bodies", "[learned]") {
  const fake::LearnedCase run = above_a_plate(2, -0.005);
  const auto pushed = [&](const std::string& preset, const LearnedOptions& options, int frames) {
    fake::LearnedCase part = run;
    part.drives.resize(static_cast<std::size_t>(frames));
    StepReport last;
    REQUIRE(std::ssize(rollout(part, *stepper_of(part.scene, fake::narrow_network(preset), options), &last)) ==
            frames + 1);
    return last.collision.pushed_out;
  };
  CHECK(pushed("hood", {}, 1) > 10);
  CHECK(pushed("hood", {}, 2) == 0);
  CHECK(pushed("contourcraft", {.settle = true}, 1) == 0);
}

TEST_CASE("A roll-out of ContourCraft through the stepper has the bits of one by hand", "[learned]") {
  fake::LearnedCase run = above_a_plate(3);
  run.state.v.setConstant(0.03);
  const fake::NarrowNetwork network = fake::narrow_network("contourcraft");
  const bool settle = GENERATE(false, true);
  const std::vector<State> states = rollout(run, *stepper_of(run.scene, network, {settle, {}, {}}));
  REQUIRE(states.size() == 4);

  const ByHand hand{run.scene, network};
  GraphState state = first_state(run);
  if (settle) {
    state.timestep = 1.0 / 3;
    state.is_init = state.no_cloth_edges = true;
    const NextCloth settled = hand.frame(state);
    state = first_state(run);
    state.x = state.previous = state.target = settled.x;
    state.velocity = settled.velocity;
  } else {
    state.velocity = run.state.v * frame_dt;
    state.previous = state.x - state.velocity;
  }
  for (std::size_t k = 0; k < run.drives.size(); ++k) {
    state.target = state.x;
    state.target.row(0) = run.drives[k].pins.row(0);
    state.body_target = run.drives[k].obstacles[0];
    const NextCloth next = hand.frame(state);
    INFO("frame " << k + 1);
    CHECK(fake::same_points(states[k + 1].x, next.x));
    state.previous = state.x;
    state.x = next.x;
    state.velocity = next.velocity;
    state.body_previous = state.body;
    state.body = state.body_target;
  }
}

TEST_CASE("A learned step depends on the state alone and leaves it untouched", "[learned]") {
  const fake::LearnedCase run = above_a_plate(4);
  const fake::NarrowNetwork network = fake::narrow_network(GENERATE("hood", "contourcraft", "hood_cvpr", "fine15"));
  std::vector<State> once, twice;
  with_threads(1, [&] { once = rollout(run, *stepper_of(run.scene, network)); });
  with_threads(2, [&] { twice = rollout(run, *stepper_of(run.scene, network)); });
  REQUIRE(once.size() == twice.size());
  for (std::size_t k = 0; k < once.size(); ++k) CHECK(fake::same_state(once[k], twice[k]));

  REQUIRE(once.size() == 5);
  const auto fresh = stepper_of(run.scene, network);
  const State from = once[2];
  State to;
  CHECK(testing::frame(run.scene, *fresh, from, run.drives[2], frame_dt, to).status == StepStatus::accepted);
  CHECK(fake::same_state(to, once[3]));
  CHECK(fake::same_state(from, once[2]));
  State other = once[2];
  for (MemoryBlock& block : other.memory) block.rows.array() += 2e-3;  // hood_cvpr and fine15 look at positions alone
  CHECK(testing::frame(run.scene, *fresh, other, run.drives[2], frame_dt, to).status == StepStatus::accepted);
  CHECK_FALSE(fake::same_points(to.x, once[3].x));
}

TEST_CASE("A learned step reports itself", "[learned]") {
  const fake::LearnedCase run = above_a_plate(2);
  const auto stepper = stepper_of(run.scene, fake::narrow_network("hood"));
  CHECK(stepper->traits().name == "learned");
  State first, second;
  const StepReport report = testing::frame(run.scene, *stepper, run.state, run.drives[0], frame_dt, first);
  CHECK(report.by == "learned");
  CHECK(report.substeps == 1);  // the settling frame is no time step of the scene
  CHECK(report.audit.has_value());
  CHECK(report.seconds.graph > 0);
  CHECK(report.seconds.network > 0);
  CHECK(report.seconds.total() >= report.seconds.graph + report.seconds.network);
  CHECK(testing::frame(run.scene, *stepper, first, run.drives[1], frame_dt, second).substeps == 1);
  CHECK(second.frame == 2);
  CHECK(second.time == Approx(2 * frame_dt));
  CHECK(fake::same_points(second.obstacles[0], run.drives[1].obstacles[0]));
}

TEST_CASE("A learned stepper ends finite or says why it stopped", "[learned]") {
  const std::string preset = GENERATE("hood", "contourcraft");
  const auto check = [&](const fake::LearnedCase& run, const fake::NarrowNetwork& network, bool must_stop) {
    StepReport last;
    const std::vector<State> states = rollout(run, *stepper_of(run.scene, network), &last);
    for (const State& state : states) CHECK((state.x.allFinite() && state.v.allFinite()));
    const bool stopped = states.size() < run.drives.size() + 1;
    if (stopped) CHECK((last.status == StepStatus::rejected && last.reason == Reason::not_finite));
    if (must_stop) CHECK(stopped);
  };
  const fake::NarrowNetwork calm = fake::narrow_network(preset);
  SECTION("random weights") { check(above_a_plate(6), fake::narrow_network(preset, 0.05), false); }
  SECTION("weights that throw the cloth away") { check(above_a_plate(6), fake::narrow_network(preset, 1e30), true); }
  SECTION("NaN in the weights") {
    fake::NarrowNetwork network = calm;
    network.weights.decoder.layers.back().bias[1] = std::numeric_limits<float>::quiet_NaN();
    check(above_a_plate(2), network, true);
  }
  SECTION("a body that jumps") {
    fake::LearnedCase run = above_a_plate(3);
    run.drives[1].obstacles[0].array() += 100;
    check(run, calm, false);
    run.drives[1].obstacles[0](3, 1) = std::numeric_limits<double>::infinity();
    check(run, calm, true);
  }
  SECTION("a state that is not finite") {
    fake::LearnedCase run = above_a_plate(1);
    run.state.x(4, 2) = std::numeric_limits<double>::quiet_NaN();
    State to = run.state;
    to.x.setOnes();
    const StepReport report =
        testing::frame(run.scene, *stepper_of(run.scene, calm), run.state, run.drives[0], frame_dt, to);
    CHECK(report.status == StepStatus::rejected);
    CHECK((to.x.array() == 1).all());
  }
  SECTION("a cloth of 12 vertices") { check(fake::learned_case(fake::grid(3, 4), {}, {0, 0, 0}, 3), calm, false); }
  SECTION("two triangles") { check(fake::learned_case(fake::two_triangles(), {}, {0, 0, 0}, 3), calm, false); }
  SECTION("20 pieces") {
    fake::Mesh pieces = fake::grid(3, 3);
    for (int k = 1; k < 20; ++k) fake::add(pieces, fake::grid(3, 2 + k % 3), {0.05 * k, 0.001 * k, 0});
    check(fake::learned_case(pieces, fake::grid(4, 4, 0.1), {0, 0.001, 0}, 3), calm, false);
  }
}

TEST_CASE("A learned stepper refuses with one error what it cannot run", "[learned]") {
  const fake::LearnedCase run = above_a_plate(1);
  const auto stepper = stepper_of(run.scene, fake::narrow_network("hood"));
  State to;
  CHECK_THROWS_WITH(testing::frame(run.scene, *stepper, run.state, run.drives[0], 1.0 / 60, to),
                    Catch::Contains("fps: 30"));
  Architecture strange = architecture_preset("small");
  ++strange.node_inputs;
  CHECK_THROWS_AS(make_learned_stepper(run.scene, strange, random_weights(strange, 1)), Error);
  CHECK_THROWS_AS(stepper_of(run.scene, fake::narrow_network("hood"), {false, {1000}, {}}), Error);
}

TEST_CASE("A network of several passes goes on from its own guess, and starts at rest", "[learned]") {
  const fake::LearnedCase run = above_a_plate(2);
  for (const std::string name : {"small", "small_contour"}) {
    INFO(name);
    fake::NarrowNetwork network = fake::narrow_network(name, 1e-3);
    State first, second;
    const auto stepper = stepper_of(run.scene, network);
    const StepReport report = testing::frame(run.scene, *stepper, run.state, run.drives[0], frame_dt, first);
    REQUIRE(report.status == StepStatus::accepted);
    CHECK(report.substeps == 1);  // passes are no time steps
    REQUIRE(testing::frame(run.scene, *stepper, first, run.drives[1], frame_dt, second).status == StepStatus::accepted);
    CHECK(second.x.allFinite());
    network.architecture.passes = 1;
    State once;
    testing::frame(run.scene, *stepper_of(run.scene, network), run.state, run.drives[0], frame_dt, once);
    CHECK_FALSE(fake::same_points(once.x, first.x));
  }
  // A network that adds nothing goes where the cloth would without forces: settled, it falls not at all.
  fake::NarrowNetwork still = fake::narrow_network("small", 0);
  State to;
  REQUIRE(testing::frame(run.scene, *stepper_of(run.scene, still), run.state, run.drives[0], frame_dt, to).status ==
          StepStatus::accepted);
  CHECK((to.x - run.state.x).bottomRows(to.x.rows() - 1).cwiseAbs().maxCoeff() < 2.1e-3);  // pushed out at most
}

TEST_CASE("Networks that see forces are moved by the drive's acceleration and wind, others are not", "[learned]") {
  fake::LearnedCase run = above_a_plate(1);
  const auto first_of = [&](const std::string& name) {
    State to;
    const auto stepper = stepper_of(run.scene, fake::narrow_network(name));
    REQUIRE(testing::frame(run.scene, *stepper, run.state, run.drives[0], frame_dt, to).status == StepStatus::accepted);
    return to.x;
  };
  std::vector<Points> calm;
  const std::vector<std::string> names{"senc", "small_senc", "hood", "small"};
  for (const std::string& name : names) calm.push_back(first_of(name));
  const auto check = [&] {
    for (std::size_t k = 0; k < names.size(); ++k) {
      INFO(names[k]);
      CHECK(fake::same_points(first_of(names[k]), calm[k]) == (k >= 2));
    }
  };
  run.drives[0].acceleration = {3, -9.81, 1};
  check();
  run.drives[0].acceleration = {0, -9.81, 0};
  run.scene.wind.on = true;
  run.drives[0].wind = {0, 3, 0};
  check();
}

TEST_CASE("Materials become the inputs of networks", "[learned]") {
  fake::LearnedCase run = above_a_plate(1);
  Material& material = run.scene.cloths[0].material;
  material.bending_model = BendingModel::hinge;
  material.bending = 3.220202984266507e-07;  // of hood_step1 in the parity pack
  material.lame_mu = 19841.966796875 * 4.7e-4;
  material.lame_lambda = 80427.3359375 * 4.7e-4;
  const LearnedScene within = learned_scene(run.scene);
  CHECK(within.clamped.empty());
  CHECK(within.graph.materials(5, 0) == Approx(0.16310298f).epsilon(1e-4));
  CHECK(within.graph.materials(5, 1) == Approx(0.15935570f).epsilon(1e-4));
  CHECK(within.graph.materials(5, 2) == Approx(0.85627347f).epsilon(1e-4));
  material.lame_mu = 384.6;
  const LearnedScene beyond = learned_scene(run.scene);
  CHECK(beyond.graph.materials(5, 1) == 1);
  REQUIRE(beyond.clamped.size() == 1);
  CHECK_THAT(beyond.clamped[0], Catch::Contains("sheet") && Catch::Contains("mu 384.6"));
}

TEST_CASE("The plan says what of the network a scene leaves out", "[learned]") {
  const auto is_in = [](const Scene& scene, const std::string& preset, const std::string& feature) {
    for (const PlanLine& line : learned_plan_lines(scene, architecture_preset(preset), {}))
      if (line.feature == feature) return line.in;
    FAIL("no line of " << feature);
    return false;
  };
  fake::LearnedCase run = above_a_plate(1);
  CHECK(is_in(run.scene, "contourcraft", "body edges"));
  CHECK(is_in(run.scene, "contourcraft", "world edges"));
  CHECK_FALSE(is_in(run.scene, "hood", "world edges"));
  CHECK_FALSE(is_in(run.scene, "hood", "libtorch"));
  run.scene.contact.self = false;
  CHECK_FALSE(is_in(run.scene, "contourcraft", "world edges"));
  run.scene.obstacles.clear();
  CHECK_FALSE(is_in(run.scene, "hood", "body edges"));
}

TEST_CASE("A network runs on the device that is asked for, or there is an error", "[learned]") {
  const fake::LearnedCase run = above_a_plate(1);
  const fake::NarrowNetwork network = fake::narrow_network("hood");
  const std::vector<State> kernels = rollout(run, *stepper_of(run.scene, network));
  const bool is_there = std::filesystem::exists(torch_library_path());
  if (!is_there) {
    for (const NetworkDevice device : {NetworkDevice::libtorch, NetworkDevice::cuda})
      CHECK_THROWS_WITH(stepper_of(run.scene, network, {.device = device}),
                        Catch::Contains("run.learned.device") && Catch::Contains("libselvedge_torch.so") &&
                            Catch::Contains("cure: give `cpu` or `auto`"));
    const std::vector<State> automatic =
        rollout(run, *stepper_of(run.scene, network, {.device = NetworkDevice::automatic}));
    CHECK(automatic.back().x == kernels.back().x);
  }
}

TEST_CASE("A roll-out by libtorch is that of the kernels", "[.torch]") {
  const fake::LearnedCase run = above_a_plate(4);
  for (const char* preset : {"hood", "contourcraft"}) {
    const fake::NarrowNetwork network = fake::narrow_network(preset);
    const std::vector<State> kernels = rollout(run, *stepper_of(run.scene, network)),
                             torch = rollout(run, *stepper_of(run.scene, network, {.device = NetworkDevice::libtorch}));
    REQUIRE(torch.size() == 5);
    CHECK((torch.back().x - kernels.back().x).cwiseAbs().maxCoeff() < 1e-5);
  }
}

}  // namespace selvedge::test_learned_stepper
