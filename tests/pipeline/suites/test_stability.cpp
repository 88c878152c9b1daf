#include <catch2/catch.hpp>

#include <algorithm>
#include <limits>

#include "collision/geometry/error.hpp"
#include "pipeline/run/simulate.hpp"
#include "pipeline/scene/make_stepper.hpp"
#include "pipeline/scene/setup.hpp"
#include "pipeline/suites/stability.hpp"
#include "pipeline/suites/stability_suite.hpp"
#include "pipeline/suites/stability_watch.hpp"
#include "tests/pipeline/files.hpp"
#include "tests/source_root.hpp"

namespace selvedge::test_stability {

using Catch::Matchers::Contains;
using fake::Folder;

namespace {

const std::filesystem::path suite_file = source_root() / "configs/stability.yaml";

const char* falling_sheet = "cloths: [{name: sheet, rectangle: {size: [0.3, 0.3], resolution: 4}}]\nrun: {frames: 4}";

// What the watch makes of four frames of a scene that stands still, but for what is done to the second by hand.
StabilityMeasures watched(const Folder& folder, const char* scene, const StepperTraits& stepper,
                          const std::function<void(State&)>& spoil) {
  const Setup setup = read_setup(fake::write(folder, "scene.yaml", scene));
  StabilityWatch watch(setup, setup.initial, stepper);
  State state = setup.initial;
  StepReport report;
  report.status = StepStatus::accepted;
  report.substeps = 2;
  report.iterations = 6;
  report.linear_iterations = 30;
  for (int frame = 1; frame <= 4; ++frame) {
    state.frame = frame;
    state.time = frame / setup.run.fps;
    if (frame == 2) spoil(state);
    watch({state, setup.drive_at(state.time), report, 0});
  }
  return watch.measures();
}

StabilityMeasures thrown(const Folder& folder, const Vec3& velocity) {
  return watched(folder, falling_sheet, {}, [&](State& state) { state.v.rowwise() = velocity.transpose(); });
}

// The suite's short form, of these cases alone or of all.
void check_short_form(const std::vector<std::string>& cases) {
  const Folder folder("stability");
  StabilityRequest request;
  request.suite = suite_file;
  request.short_form = true;
  request.cases = cases;
  request.out = folder.path / "out";
  const std::vector<StabilityRow> rows = stability(request);
  std::size_t brief = 0;
  for (const StabilityCase& each : read_stability_suite(suite_file).cases)
    if (request.cases.empty() || std::ranges::count(request.cases, each.name))
      brief += std::ranges::count_if(each.runs, &StabilityRun::brief);
  CHECK(rows.size() == brief);
  INFO(stability_table(rows));
  CHECK(passed(rows));
  for (const char* name : {"stability.txt", "stability.csv", "stability.json", "stability.md"})
    CHECK(std::filesystem::file_size(request.out / name) > 0);
}

}  // namespace

TEST_CASE("stability: cases pass in their short form", "[stability]") {
  check_short_form({"membrane", "bending", "teleport", "pins"});
}

TEST_CASE("stability: the short form of the suite passes", "[stability][.long]") { check_short_form({}); }

TEST_CASE("stability: contacts carry cloth 1e4 times as heavy as what lies below it; zones are left with little",
          "[stability]") {
  const Setup setup = read_setup(source_root() / "configs/stability/neighbours.yaml",
                                 {"cloths.lower.rectangle.resolution=9", "cloths.upper.rectangle.resolution=8"});
  State state = setup.initial;
  int halved = 0, held = 0;
  simulate(setup.scene, *make_stepper(setup), setup.drive_at, 1 / setup.run.fps, 24, state,
           [&](const FrameEvent& event) {
             halved += event.report.collision.halved_substeps;
             held += event.report.collision.held_vertices;
             return true;
           });
  CHECK(state.frame == 24);
  CHECK(halved < 20);  // 69 if loads raise a stiffness 100 times at most
  CHECK(held < 20);    // 345
}

TEST_CASE("stability: energy from nowhere, numbers that are none and lasting motion are seen", "[stability]") {
  const Folder folder("watch");
  const StabilityMeasures calm = thrown(folder, Vec3::Zero());
  CHECK(calm.unaccounted <= 1e-12);
  CHECK(calm.end_speed == 0);
  CHECK(calm.newton == 3);
  CHECK(calm.linear == 5);
  const StabilityMeasures fast = thrown(folder, Vec3(2, 0, 0));
  CHECK(fast.unaccounted == Approx(0.5 * 0.2 * 0.09 * 4));
  CHECK(fast.end_speed > 0.5);
  const double none = std::numeric_limits<double>::quiet_NaN();
  CHECK(thrown(folder, Vec3(0, none, 0)).nonfinite > 0);
}

TEST_CASE("stability: the energy of a force that the stepper ignores is in no book", "[stability]") {
  const Folder folder("ignored");
  const char* buttoned =
      "cloths:\n"
      "  - {name: left, rectangle: {size: [0.3, 0.3], resolution: 4}}\n"
      "  - {name: right, rectangle: {size: [0.3, 0.3], resolution: 4}, translate: [0.4, 0, 0]}\n"
      "springs: [{from: {cloth: left, vertices: [5]}, to: {cloth: right, vertices: [5]}, rest_length: 0.4,\n"
      "  stiffness: 100}]\n"
      "run: {frames: 4}\n";
  const auto pull = [](State& state) { state.x.bottomRows(16).col(0).array() += 0.1; };
  CHECK(watched(folder, buttoned, {}, pull).unaccounted == Approx(0.5 * 100 * 0.01));
  const StepperTraits network{.name = "network", .ignores = {"springs"}};
  CHECK(watched(folder, buttoned, network, pull).unaccounted == Approx(0).margin(1e-9));
}

TEST_CASE("stability: a run that moves to its end or meets its limit fails, with the reason and a page",
          "[stability]") {
  const Folder folder("failing");
  fake::write(folder, "scene.yaml", falling_sheet);
  StabilityRequest request;
  request.suite = fake::write(folder, "suite.yaml",
                              "limits: {newton: 1}\ncases: [{name: fall, scene: scene.yaml, runs: [free, {name: "
                              "thrown, set: \"cloths.0.velocity=[5, 0, 0]\"}]}]");
  request.out = folder.path / "out";
  const std::vector<StabilityRow> rows = stability(request);
  REQUIRE(rows.size() == 2);
  CHECK_FALSE(passed(rows));
  CHECK_THAT(rows[0].failures.at(0), Contains("does not rest"));
  CHECK(std::filesystem::exists(request.out / "fall_0" / "view.html"));
  CHECK_THAT(stability_table(rows), Contains("0 of 2 pass"));
}

TEST_CASE("stability: a faulty suite is named by file and line", "[stability]") {
  const Folder folder("faulty");
  CHECK_THROWS_WITH(
      read_stability_suite(fake::write(folder, "a.yaml", "cases:\n  - {name: a, scene: no.yaml, runs: [b]}")),
      Contains("a.yaml:2") && Contains("does not exist"));
  StabilityRequest request;
  request.suite = suite_file;
  request.cases = {"gravitas"};
  CHECK_THROWS_WITH(stability(request), Contains("there is no case") && Contains("gravity"));
  fake::write(folder, "scene.yaml", falling_sheet);
  request.suite = fake::write(
      folder, "b.yaml", "cases: [{name: a, scene: scene.yaml, runs: [{name: b, set: [cloths.sheet.materal=2]}]}]");
  request.cases = {};
  CHECK_THROWS_WITH(stability(request), Contains("b.yaml: run `b` of case `a`: --set cloths.sheet.materal=2"));
}

}  // namespace selvedge::test_stability
