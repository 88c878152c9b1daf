#include <algorithm>
#include <catch2/catch.hpp>
#include <fstream>

#include "physics/scene/contact_forces.hpp"
#include "pipeline/scene/make_stepper.hpp"
#include "tests/pipeline/fake_run.hpp"

namespace selvedge::test_contact_force_run {

namespace {

// A sheet that comes to rest on a floor, and is left out from then on.
constexpr const char* lying = R"(
cloths: [{name: sheet, rectangle: {size: [0.4, 0.4], edge: 10 cm}, translate: [0, 0.002, 0]}]
obstacles: [{name: floor, plane: {size: 2}}]
run: {frames: 40, fps: 30}
)";

Setup read_lying(const fake::Folder& folder, const std::vector<std::string>& overrides) {
  std::ofstream(folder.path / "scene.yaml") << lying;
  return read_setup(folder.path / "scene.yaml", overrides);
}

RunSummary run(const Setup& setup, const std::filesystem::path& out, bool resume = false, int stop_after = 1 << 30) {
  return fake::run(setup, *make_stepper(setup), out, resume, stop_after);
}

}  // namespace

TEST_CASE("a run with contact forces has the same positions, and resumed the same forces") {
  const fake::Folder folder("contact_force_run");
  const Setup setup = read_lying(folder, {"run.contact_forces=true"});
  const RunSummary whole = run(setup, folder.path / "whole");
  const RunSummary plain = run(read_lying(folder, {}), folder.path / "plain");
  CHECK(whole.positions_hash == plain.positions_hash);
  run(setup, folder.path / "parts", false, 30);
  run(setup, folder.path / "parts", true);
  const TrajectoryReader at_once(folder.path / "whole" / "run.h5"), in_parts(folder.path / "parts" / "run.h5");
  REQUIRE(in_parts.frame_count() == 41);
  REQUIRE(at_once.frame(35).report.resting == 1);
  CHECK(in_parts.frame(0).report.contact_forces->pressure.array().isNaN().all());
  for (int f = 1; f <= 40; ++f) {
    const ContactForces one = *at_once.frame(f).report.contact_forces, other = *in_parts.frame(f).report.contact_forces;
    INFO("frame " << f);
    CHECK(one.normal == other.normal);
    CHECK(one.friction == other.friction);
    CHECK(one.pressure == other.pressure);
  }
  CHECK(at_once.frame(40).report.contact_forces->normal.col(1).sum() > 0);
  CHECK_FALSE(TrajectoryReader(folder.path / "plain" / "run.h5").info().contact_forces);
}

TEST_CASE("a stepper that computes no contact forces says so, and its run has none") {
  const fake::Folder folder("contact_force_warning");
  const Setup setup = read_lying(folder, {"run.contact_forces=true", "run.stepper=icm", "run.frames=2"});
  const std::unique_ptr<Stepper> stepper = make_stepper(setup);
  const std::vector<std::string> warnings = run_warnings(setup, stepper->traits());
  CHECK(std::ranges::find(warnings, "run.contact_forces: the stepper `icm` computes none") != warnings.end());
  fake::run(setup, *stepper, folder.path / "out");
  CHECK_FALSE(TrajectoryReader(folder.path / "out" / "run.h5").info().contact_forces);
}

}  // namespace selvedge::test_contact_force_run
