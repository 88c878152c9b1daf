#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

#include "pipeline/run/jitter.hpp"
#include "pipeline/scene/outcome_measures.hpp"
#include "pipeline/scene/setup.hpp"
#include "pipeline/shapes/motion.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::test_outcome {

using fake::Folder;

namespace {

Setup read(const std::string& scene) {
  const Folder folder("outcome");
  return read_setup(fake::write(folder, "scene.yaml", scene));
}

const std::string two_sheets =
    "cloths:\n"
    "  - {name: low, rectangle: {size: [1, 1], resolution: 5}}\n"
    "  - {name: high, rectangle: {size: [1, 1], resolution: 4}, translate: [0.1, 0.1, 0]}\n"
    "obstacles: [{name: ball, sphere: {radius: 0.2}, translate: [0, -0.5, 0]}]\n"
    "run: {frames: 3, fps: 10}\n";

// The results of a run whose cloth is where `at(frame)` puts it.
template <class At>
std::vector<OutcomeResult> followed(const Setup& setup, const At& at) {
  OutcomeWatch watch(setup.scene, setup.outcomes, setup.run.frames / setup.run.fps);
  State state = setup.initial;
  for (int frame = 0; frame <= setup.run.frames; ++frame) {
    state.frame = frame;
    state.time = frame / setup.run.fps;
    state.x = at(frame);
    watch(state, setup.drive_at(state.time));
  }
  return watch.results();
}

double measure_of(const Setup& setup, const State& state) {
  return std::visit(
      [&](const auto& m) {
        if constexpr (requires { measured(m, setup.scene, state, Drive{}); })
          return measured(m, setup.scene, state, setup.drive_at(0));
        else
          return 0.0;
      },
      setup.outcomes[0].measure);
}

Setup asking(const std::string& measure) { return read(two_sheets + "outcome: [{name: it, " + measure + "}]\n"); }

double first_measure(const std::string& measure) {
  const Setup setup = asking(measure);
  return measure_of(setup, setup.initial);
}

}  // namespace

TEST_CASE("Measures have their known values", "[outcome]") {
  CHECK(first_measure("outside: {max: [0.4, 9, 9]}") == Approx(0.2));
  CHECK(first_measure("outside: {of: low, max: [0.4, 9, 9]}") == Approx(0.1));
  CHECK(first_measure("outside: {of: {cloth: low, box: {min: [-1, -1, -1], max: [0.1, 1, 1]}}, max: [0.4, 9, 9]}") ==
        0);
  CHECK(first_measure("distance: {from: low, to: high}") == Approx(std::sqrt(0.02)));
  CHECK(first_measure("distance: {from: high, to: low, along: [0, 3, 0]}") == Approx(-0.1));
  CHECK(first_measure("distance: {from: {cloth: low, group: left}, to: {cloth: low, group: right}}") == Approx(1));
  CHECK(first_measure("disorder: {}") == 0);
  CHECK(first_measure("disorder: {up: [0, -1, 0]}") == 12);
  CHECK(first_measure("stretch: {}") == Approx(1));
  CHECK(first_measure("lag: {}") == 0);
  CHECK(first_measure("wanted_pairs: {}") == 0);
  CHECK(first_measure("ahead: {obstacle: ball, direction: [0, 1, 0]}") == Approx(0.3).margin(1e-3));
  CHECK(first_measure("ahead: {obstacle: ball, direction: [0, -2, 0]}") == Approx(-0.7).margin(1e-3));
  CHECK(std::isinf(first_measure("ahead: {obstacle: ball, direction: [0, 1, 0], of: {cloth: high}, radius: 0.001}")));
}

TEST_CASE("A layer pushed through the one below is out of order", "[outcome]") {
  const Setup setup = asking("disorder: {}");
  State state = setup.initial;
  const int v = setup.scene.cloths[1].first_vertex + 5;
  state.x(v, 1) = -0.01;
  CHECK(measure_of(setup, state) == 1);
}

TEST_CASE("An edge that curls over the layer above it leaves the order as it is", "[outcome]") {
  const Setup setup = asking("disorder: {}");
  State state = setup.initial;
  const Cloth& low = setup.scene.cloths[0];
  for (int v = low.first_vertex; v < low.first_vertex + low.vertex_count; ++v)
    if (state.x(v, 0) < -0.4) state.x.row(v) += Eigen::RowVector3d(0.6, 0.3, 0);
  CHECK(measure_of(setup, state) == 0);
  state.x.bottomRows(setup.scene.cloths[1].vertex_count).col(1).array() -= 0.11;
  CHECK(measure_of(setup, state) > 0);
}

TEST_CASE("An edge that is folded under the layer below leaves the order as it is", "[outcome]") {
  const Setup setup = asking("disorder: {}");
  const Cloth& high = setup.scene.cloths[1];
  State state = setup.initial;
  for (int v = high.first_vertex; v < high.first_vertex + high.vertex_count; ++v) {
    if (state.x(v, 0) > 0.5)
      state.x.row(v) += Eigen::RowVector3d(-0.2, -0.2, 0);  // the last row, under the lower sheet, which ends at 0.5
    else if (state.x(v, 0) > 0.2)
      state.x(v, 0) = 0.65;
  }
  CHECK(measure_of(setup, state) == 0);
  state.x.bottomRows(high.vertex_count).col(1).array() -= 0.11;
  CHECK(measure_of(setup, state) == 8);  // the two rows over the lower sheet and not beyond its edge
}

TEST_CASE("What obstacles want is measured apart from where they are", "[outcome]") {
  const Setup setup = read(two_sheets + "outcome: [{name: it, lag: ball}, {name: pairs, wanted_pairs: {}}]\n");
  State state = setup.initial;
  Drive drive = setup.drive_at(0);
  drive.obstacles[0].col(1).array() += 0.4;  // now through the lower sheet
  CHECK(measured(Lag{}, setup.scene, state, drive) == Approx(0.4));
  CHECK(measured(WantedPairs{}, setup.scene, state, drive) > 4);
}

TEST_CASE("Turns are followed past a whole one", "[outcome]") {
  const Setup setup = read(
      "cloths: [{tube: {resolution: [6, 4]}}]\n"
      "outcome:\n"
      "  - {name: top, turns: {of: {group: top}, against: {group: bottom}}, least: 2.99, most: 3.01}\n"
      "  - {name: other way, turns: {of: {group: top}, axis: [0, -5, 0]}, least: -3.01, most: -2.99}\n"
      "run: {frames: 30, fps: 10}\n");
  const auto results = followed(setup, [&](int frame) {
    Points x = setup.initial.x;
    const Mat3 turn = rotation_matrix({0, 2 * std::numbers::pi * frame / 10, 0});
    for (int v = 18; v < 24; ++v) x.row(v) = (turn * row(setup.initial.x, v)).transpose();
    x.rowwise() += Eigen::RowVector3d(0.1 * frame, 0, 0);
    return x;
  });
  for (const OutcomeResult& result : results) {
    INFO(result.name << " " << result.value);
    CHECK(result.came_true);
  }
}

TEST_CASE("Times and `hold` say which frames count", "[outcome]") {
  const Setup setup = read(two_sheets +
                           "outcome:\n"
                           "  - {name: end alone, outside: {max: [9, 0.1, 9]}}\n"
                           "  - {name: always, outside: {max: [9, 0.1, 9]}, from: 0}\n"
                           "  - {name: until, outside: {max: [9, 0.1, 9]}, until: 0.1}\n"
                           "  - {name: once, outside: {max: [9, 0.1, 9]}, from: 0.2, hold: once}\n"
                           "  - {name: never, outside: {max: [9, 0.1, 9]}, from: 0.2, until: 0.2, hold: once}\n"
                           "  - {name: too late, outside: {}, from: 7}\n"
                           "  - {name: drift, drift: {}, from: 0.1, least: 0.39, most: 0.41}\n");
  const auto results = followed(setup, [&](int frame) {
    Points x = setup.initial.x;
    if (frame == 2) x.col(1).array() += 0.4;
    return x;
  });
  std::vector<bool> came_true;
  for (const OutcomeResult& result : results) came_true.push_back(result.came_true);
  CHECK(came_true == std::vector<bool>{true, false, true, true, false, false, false});
  CHECK(results[1].frame == 2);
  CHECK(results[1].value == Approx(0.4));
  CHECK(results[5].frame == -1);
  CHECK(outcome_text(setup.outcomes[1], results[1]) == "always: no, 0.4 in frame 2, asked at most 0");
  CHECK(outcome_text(setup.outcomes[0], results[0]) == "end alone: yes");
  CHECK_FALSE(all_came_true(results));
}

TEST_CASE("A jittered start is clean, the same for the same seed, and leaves pins alone", "[stress]") {
  const std::string scene =
      "cloths:\n"
      "  - {name: low, rectangle: {size: [1, 1], resolution: 9}, pins: [{group: left}]}\n"
      "  - {name: high, rectangle: {size: [1, 1], resolution: 9}, translate: [0, 0.01, 0]}\n";
  const Setup setup = read(scene);
  const auto jittered = [&](std::uint64_t seed) -> Points {
    State start = setup.initial;
    CHECK(jitter_start(setup, 0.03, seed, start) == 0.03);
    return start.x;
  };
  const Points first = jittered(5), moved = first - setup.initial.x;
  CHECK(first == jittered(5));
  CHECK(first != jittered(6));
  const double edge = (2 * 0.125 + std::sqrt(2.0) * 0.125) / 3;
  CHECK(moved.cwiseAbs().maxCoeff() <= 0.03 * edge);
  CHECK(moved.cwiseAbs().maxCoeff() > 0.02 * edge);
  for (const int pin : setup.scene.pins) CHECK(moved.row(pin).isZero(0));
  State rough = setup.initial;
  const double used = jitter_start(setup, 0.8, 5, rough);  // would push the sheets through each other
  CHECK(used < 0.8);
  CHECK(used > 0.01);
}

}  // namespace selvedge::test_outcome
