#pragma once

#include <random>

#include "tests/frame.hpp"
#include "tests/physics/worlds.hpp"

// Steps of the conventional stepper, and the same steps spoiled, for tests of the guard.
namespace selvedge::testing {

struct RecordedStep {
  State before, from, to;  // `before`: one step earlier
  Drive drive;
};

// A swinging sheet that hangs by one side.
inline World swinging_sheet() {
  World w = make_world(sheet(10, 0.4, 0));
  for (int i = 0; i <= 10; ++i) w.scene.pins.push_back(i);
  w.state.clean = true;
  w.drive = at_rest(w.scene, w.state);
  w.drive.acceleration = {0, -9.81, 0};
  return w;
}

inline std::vector<RecordedStep> recorded(const World& w, int frames) {
  const auto stepper = conventional(w.scene);
  std::vector<RecordedStep> steps;
  State before = w.state, from = w.state;
  for (int f = 0; f < frames; ++f) {
    State to;
    REQUIRE(testing::frame(w.scene, *stepper, from, w.drive, 1.0 / 30, to).status == StepStatus::accepted);
    steps.push_back({before, from, to, w.drive});
    before = from;
    from = to;
  }
  return steps;
}

using Spoil = std::function<Points(const Scene&, const RecordedStep&)>;

inline Points with_noise(const Scene& scene, const RecordedStep& step, double size) {
  Points x = step.to.x;
  std::mt19937 random(11);
  const auto between = [&] { return size * (2.0 * static_cast<double>(random()) / 4294967295.0 - 1); };
  for (Eigen::Index i = 0; i < x.rows(); ++i)
    for (int c = 0; c < 3; ++c) x(i, c) += std::sqrt(3.0) * between();
  for (const int pin : scene.pins) x.row(pin) = step.to.x.row(pin);
  return x;
}

// Names of the ways to spoil a step that need no layers and no body.
inline std::vector<std::pair<std::string, Spoil>> spoils() {
  const auto noise = [](double size) {
    return [size](const Scene& scene, const RecordedStep& step) { return with_noise(scene, step, size); };
  };
  const auto middle = [](const RecordedStep& step) { return Eigen::RowVector3d(step.to.x.colwise().mean()); };
  return {{"noise of 1 mm", noise(1e-3)},
          {"noise of 3 mm", noise(3e-3)},
          {"noise of 10 mm", noise(1e-2)},
          {"frozen", [](const Scene&, const RecordedStep& step) { return step.from.x; }},
          {"stretched by 20 %",
           [=](const Scene&, const RecordedStep& step) {
             return Points((1.2 * (step.to.x.rowwise() - middle(step))).rowwise() + middle(step));
           }},
          {"one vertex off by 5 cm",
           [](const Scene&, const RecordedStep& step) {
             Points x = step.to.x;
             x(x.rows() - 2, 1) += 0.05;
             return x;
           }},
          {"previous frame", [](const Scene&, const RecordedStep& step) { return step.before.x; }},
          {"mirrored",
           [=](const Scene&, const RecordedStep& step) {
             Points x = step.to.x;
             x.col(0) = (2 * middle(step).x() - x.col(0).array()).matrix();
             return x;
           }},
          {"not finite", [](const Scene&, const RecordedStep& step) {
             Points x = step.to.x;
             x(1, 1) = std::numeric_limits<double>::infinity();
             return x;
           }}};
}

}  // namespace selvedge::testing
