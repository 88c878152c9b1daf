#include <catch2/catch.hpp>

#include "collision/geometry/error.hpp"
#include "learned/network/weights_hdf5.hpp"
#include "pipeline/scene/make_stepper.hpp"
#include "pipeline/suites/spoiled_weights.hpp"
#include "pipeline/tools/plan.hpp"
#include "tests/frame.hpp"
#include "tests/learned/learned_scenes.hpp"
#include "tests/pipeline/files.hpp"
#include "tests/threads.hpp"

// The kind `hybrid`: a network proposes in a scene that a file describes.
namespace selvedge::test_hybrid_kind {

using Catch::Matchers::Contains;
using fake::Folder;

namespace {

constexpr double dt = 1.0 / 30;

// A sheet that hangs by a corner and falls on a ball that moves, with an untrained network, spoiled or not.
Setup scene_of(const Folder& folder, const std::string& preset, const std::string& fault,
               std::vector<std::string> overrides = {}) {
  const fake::NarrowNetwork network = fake::narrow_network(preset, 2e-2);
  WeightFile file{network.architecture, network.weights, "", {}, ""};
  if (!fault.empty()) file = spoiled_weights(std::move(file), fault);
  write_weight_file(folder.path / "w.h5", file);
  overrides.insert(overrides.end(),
                   {"run.learned.weights=w.h5", "run.stepper=hybrid", "run.hybrid.stop_when_slow=false"});
  return read_setup(
      fake::write(folder, "scene.yaml",
                  "cloths: [{name: sheet, rectangle: {size: [0.3, 0.3], resolution: 8}, translate: [0, 0.3, 0], pins: "
                  "[{group: [top_left]}]}]\n"
                  "obstacles: [{name: ball, sphere: {radius: 0.1, edge: 0.04}, motion: {keyframes: [{time: 0}, {time: "
                  "1, translate: [0.3, 0, 0]}]}}]\ncontact: {thickness: 4 mm}\nrun: {fps: 30}\n"),
      overrides);
}

struct Course {
  State state;
  std::vector<Verdict> verdicts;
};

Course follow(const Setup& setup, int frames) {
  const auto stepper = make_stepper(setup);
  Course course{setup.initial, {}};
  for (int f = 0; f < frames; ++f) {
    State to;
    const StepReport report =
        testing::frame(setup.scene, *stepper, course.state, setup.drive_at(course.state.time + dt), dt, to);
    REQUIRE(report.status == StepStatus::accepted);
    REQUIRE(to.x.allFinite());
    REQUIRE(to.v.allFinite());
    CHECK(report.collision.pairs_after == 0);
    CHECK(report.collision.passed_through == 0);
    course.verdicts.push_back(report.verdict);
    course.state = to;
  }
  return course;
}

}  // namespace

TEST_CASE("hybrid kind: with spoiled weights every frame is finite and clean", "[hybrid]") {
  for (const char* preset : {"hood", "contourcraft"})
    for (const std::string& fault : {std::string(), std::string("nan"), std::string("zero"), std::string("huge")}) {
      INFO(preset << " " << fault);
      const Folder folder("hybrid_faults");
      const Course course = follow(scene_of(folder, preset, fault), 10);
      CHECK(course.verdicts.front() == Verdict::no_history);
      const auto asked = [](Verdict v) { return v != Verdict::no_history && v != Verdict::waiting; };
      CHECK(std::ranges::count_if(course.verdicts, asked) >= 2);
      if (fault == "nan") CHECK(std::ranges::count(course.verdicts, Verdict::not_made) >= 2);
      if (fault == "huge") CHECK(std::ranges::count(course.verdicts, Verdict::admitted) == 0);
    }
}

TEST_CASE("hybrid kind: behind the response and behind a rough solve, too", "[hybrid][student]") {
  for (const std::string mode : {"response", "rough"})
    for (const std::string fault : {"", "nan", "random", "zero", "huge"}) {
      INFO(mode << " " << fault);
      const Folder folder("hybrid_student");
      const Course course = follow(scene_of(folder, "student", fault, {"run.hybrid.mode=" + mode}), 10);
      const auto of = [&](Verdict verdict) { return std::ranges::count(course.verdicts, verdict); };
      CHECK(course.verdicts.front() == Verdict::no_history);
      if (fault == "nan") CHECK(of(Verdict::not_made) >= 2);
      // Without an output the proposal is the carried guess.
      if (fault == "zero" && mode == "rough") CHECK(of(Verdict::refined) >= 2);
      if (fault == "zero" && mode == "response") {
        std::string all;
        for (const Verdict verdict : course.verdicts) all += std::to_string(static_cast<int>(verdict)) + " ";
        INFO(all);
        CHECK(of(Verdict::admitted) + of(Verdict::energy_gain) + of(Verdict::moved_too_far) >= 2);
      }
      if (fault != "huge")
        continue;  // step lengths may bring a huge output back to the guess, the whole one is refused
      const Course whole =
          follow(scene_of(folder, "student", fault, {"run.hybrid.mode=" + mode, "run.learned.step_lengths=false"}), 10);
      CHECK(std::ranges::count(whole.verdicts, Verdict::moved_too_far) >= 2);
    }
}

TEST_CASE("hybrid kind: every mode, on one thread and on two, gives the same bits", "[hybrid]") {
  for (const char* mode : {"fallback", "corrected", "response", "rough"}) {
    INFO(mode);
    const Folder folder("hybrid_threads");
    const Setup setup = scene_of(folder, "contourcraft", "", {std::string("run.hybrid.mode=") + mode});
    Course one, two;
    with_threads(1, [&] { one = follow(setup, 6); });
    with_threads(2, [&] { two = follow(setup, 6); });
    CHECK(fake::same_state(one.state, two.state));
    CHECK(one.verdicts == two.verdicts);
  }
}

TEST_CASE("hybrid kind: refuses what it cannot do, and the plan says what is in", "[hybrid]") {
  const Folder folder("hybrid_plan");
  const Setup setup = scene_of(folder, "hood", "", {"run.hybrid.mode=rough"});
  const std::string plan = plan_text(setup);
  CHECK_THAT(plan, Contains("proposals") && Contains("rough solve") && Contains("guard") &&
                       Contains("proposal: network") && Contains("linear solver"));
  Setup without = setup;
  without.run.learned.weights.clear();
  CHECK_THROWS_WITH(make_stepper(without), Contains("`hybrid` needs a weight file"));
  CHECK_THROWS_WITH(scene_of(folder, "hood", "", {"run.hybrid.mode=respons"}), Contains("did you mean `response`"));
}

}  // namespace selvedge::test_hybrid_kind
