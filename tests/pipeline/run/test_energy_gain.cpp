#include <catch2/catch.hpp>

#include "physics/energies/measures.hpp"
#include "physics/linear/cholesky.hpp"
#include "pipeline/run/simulate.hpp"
#include "pipeline/scene/make_stepper.hpp"
#include "tests/pipeline/cases.hpp"
#include "tests/source_root.hpp"

// Scenes whose energy grew from nowhere without a word, and scenes where all of it is explained.
namespace selvedge::test_energy_gain {

using fake::case_file;

namespace {

struct Reasons {
  std::vector<int> gains;  // frames that leave `energy_gain` in doubt
  StepReport last;
  double energy = 0;  // at the end [J]
};

Reasons run(const std::filesystem::path& file, std::vector<std::string> overrides) {
  const Setup setup = read_setup(file, overrides);
  State state = setup.initial;
  Reasons seen;
  seen.last = simulate(setup.scene, *make_stepper(setup), setup.drive_at, 1 / setup.run.fps, setup.run.frames, state,
                       [&](const FrameEvent& event) {
                         if (event.report.doubts.energy_gain) seen.gains.push_back(event.state.frame);
                         return true;
                       });
  seen.energy = energies(setup.scene, state.x, state.v, setup.drive_at(0).acceleration).total();
  return seen;
}

}  // namespace

// The second frame is rejected where CHOLMOD solves. PCG does without the step that gains energy, and all frames are
// made.
TEST_CASE("energy gain: icm makes no frame that springs of 1 m throw about; the conventional stepper hides nothing",
          "[energy_gain]") {
  const auto file = case_file("icm_energy/springs_1m.yaml");
  if (!file) return;
  const Reasons icm = run(*file, {"run.stepper=icm"});
  CHECK(icm.last.status == (Cholesky::available() ? StepStatus::rejected : StepStatus::accepted));
  CHECK(icm.last.reason == (Cholesky::available() ? Reason::energy_gain : Reason::none));
  CHECK(icm.gains.empty());
  CHECK(icm.energy < 12);
  const Reasons conventional = run(*file, {});
  CHECK(conventional.last.status == StepStatus::accepted);
  CHECK(conventional.gains.empty());
}

TEST_CASE("energy gain: frames in which the contact of needles lifts them say so", "[energy_gain]") {
  const auto file = case_file("needles/needles.yaml");
  if (!file) return;
  const Reasons needles = run(*file, {"run.frames=6"});
  CHECK(needles.last.status == StepStatus::accepted);
  CHECK_FALSE(needles.gains.empty());
}

TEST_CASE("energy gain: none in cloth that drops, hangs, or flies, by the steppers that solve", "[energy_gain]") {
  const std::filesystem::path configs = source_root() / "configs";
  for (const char* stepper : {"conventional", "icm"})
    for (const auto& [file, resolution] : std::vector<std::pair<std::string, std::string>>{
             {"bench/drop.yaml", "cloths.sheet.rectangle.resolution=11"},
             {"bench/hang.yaml", "cloths.sheet.rectangle.resolution=11"},
             {"compare/flag.yaml", "cloths.flag.rectangle.resolution=[9, 6]"}}) {
      INFO(stepper << " " << file);
      const Reasons seen = run(configs / file, {resolution, "run.frames=16", std::string("run.stepper=") + stepper});
      CHECK(seen.last.status == StepStatus::accepted);
      CHECK(seen.gains.empty());
    }
}

}  // namespace selvedge::test_energy_gain
