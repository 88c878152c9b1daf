#include <catch2/catch.hpp>

#include "collision/geometry/error.hpp"
#include "pipeline/scene/setup.hpp"
#include "pipeline/tools/plan.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::test_quality {

using Catch::Matchers::Contains;
using fake::Folder;

namespace {

Setup read(const Folder& folder, const std::string& more, const std::vector<std::string>& overrides = {}) {
  const std::string scene = "cloths: [{rectangle: {size: 1, resolution: 4}}]\n";
  return read_setup(fake::write(folder, "scene.yaml", scene + more), overrides);
}

}  // namespace

TEST_CASE("Quality: standard is every key's default", "[setup]") {
  const Folder folder("quality");
  const Setup none = read(folder, ""), standard = read(folder, "run: {quality: standard}\n");
  CHECK(none.config == standard.config);
  const ConventionalOptions defaults;
  CHECK(standard.run.conventional.substeps == defaults.substeps);
  CHECK(standard.run.conventional.integrator == Integrator::implicit_euler);
  CHECK(standard.run.conventional.implicit_euler.max_newton == defaults.implicit_euler.max_newton);
}

TEST_CASE("Quality: a word stands for several keys, and a key that is given stays", "[setup]") {
  const Folder folder("quality");
  const Setup preview = read(folder, "run: {quality: preview}\n");
  CHECK(preview.run.conventional.substeps == 1);
  CHECK(preview.run.conventional.implicit_euler.max_newton == 2);
  CHECK(preview.run.conventional.implicit_euler.relative_tolerance == 0.03);
  CHECK(preview.run.conventional.implicit_euler.max_newton_step == 16);
  CHECK(preview.run.icm.substeps == 1);

  const Setup draft = read(folder, "run: {quality: draft}\n");
  CHECK(draft.run.conventional.substep.max_passes == 0);
  CHECK(draft.run.conventional.guess == FirstGuess::carried);
  CHECK(draft.run.conventional.implicit_euler.max_newton == 2);
  CHECK_THAT(plan_text(draft), Contains("solver.substep.max_passes 0, solver.guess carried"));
  CHECK(read_setup(fake::write(folder, "config.yaml", draft.config)).run.conventional.substep.max_passes == 0);

  const Setup given = read(folder, "run: {quality: preview, substeps: auto}\nsolver: {max_newton: 5}\n");
  CHECK_FALSE(given.run.conventional.substeps);
  CHECK(given.run.conventional.implicit_euler.max_newton == 5);
  CHECK(given.run.conventional.implicit_euler.relative_tolerance == 0.03);
  CHECK_THAT(plan_text(given), Contains("preview: run.substeps auto (given), solver.max_newton 5 (given), "
                                        "solver.relative_tolerance 0.03"));

  const Setup overridden = read(folder, "run: {quality: fine}\n", {"run.quality=preview", "run.substeps=3"});
  CHECK(overridden.run.conventional.substeps == 3);
  CHECK(overridden.run.conventional.integrator == Integrator::implicit_euler);

  const Setup fine = read(folder, "run: {quality: fine}\n");
  CHECK(fine.run.conventional.min_substeps == 4);
  CHECK(fine.run.conventional.integrator == Integrator::bdf2);
  CHECK_NOTHROW(read(folder, "run: {quality: fine, stepper: icm}\n"));
  CHECK_THROWS_WITH(read(folder, "run: {quality: previw}\n"), Contains("preview"));
}

TEST_CASE("Quality: the configuration of a run names it and reads back to the same", "[setup]") {
  const Folder folder("quality");
  const Setup preview = read(folder, "run: {quality: preview}\nsolver: {max_newton: 3}\n");
  CHECK_THAT(preview.config, Contains("quality: \"preview\""));
  const Setup again = read_setup(fake::write(folder, "config.yaml", preview.config));
  CHECK(again.config == preview.config);
  CHECK(again.run.conventional.substeps == 1);
  CHECK(again.run.conventional.implicit_euler.max_newton == 3);
}

}  // namespace selvedge::test_quality
