#include <catch2/catch.hpp>

#include "pipeline/scene/make_stepper.hpp"
#include "pipeline/scene/setup.hpp"
#include "tests/frame.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::test_step_options {

using Catch::Matchers::Contains;
using fake::Folder;

namespace {

Setup read(const Folder& folder, const std::vector<std::string>& overrides = {}) {
  return read_setup(fake::write(folder, "scene.yaml",
                                "cloths: [{rectangle: {size: 0.4, resolution: 6}, translate: [0, 0.22, 0]}]\n"
                                "obstacles: [{sphere: {radius: 0.2}}]\n"
                                "contact: {friction: 0.3}\n"),
                    overrides);
}

// Where the cloth is after some frames.
Points after(const Setup& setup, int frames) {
  const auto stepper = make_stepper(setup);
  State state = setup.initial, next;
  for (int k = 0; k < frames; ++k) {
    REQUIRE(
        testing::frame(setup.scene, *stepper, state, setup.drive_at(state.time + 1.0 / 30), 1.0 / 30, next).status ==
        StepStatus::accepted);
    std::swap(state, next);
  }
  return state.x;
}

}  // namespace

TEST_CASE("Step options: what a scene file gives reaches the steppers", "[setup]") {
  const Folder folder("step_options");
  const Setup set = read(
      folder, {"solver.newton.exact_from=5", "solver.substep.max_passes=4", "solver.substep.contact_term.stiffness=300",
               "solver.response.zone_sweeps=150", "solver.response.room.max_rounds=3", "run.resting.still_seconds=0.25",
               "run.recovery.farthest_place=20 cm", "run.hybrid.admitted_to_halve=2", "run.hybrid.guard.patch_size=30",
               "run.icm.push_softness=0.03"});
  const ConventionalOptions& conventional = set.run.conventional;
  CHECK(conventional.implicit_euler.newton.exact_from == 5);
  CHECK(conventional.substep.max_passes == 4);
  CHECK(conventional.substep.contact.stiffness == 300);
  CHECK(conventional.resolve.zone_sweeps == 150);
  CHECK(conventional.resolve.room.max_rounds == 3);
  CHECK(set.run.resting.still_seconds == 0.25);
  CHECK(set.run.recovery.farthest_place == 0.2);
  CHECK(set.run.hybrid.admitted_to_halve == 2);
  CHECK(set.run.hybrid.guard.patch_size == 30);
  CHECK(set.run.icm.push_softness == 0.03);
  CHECK(set.run.icm.substep.max_passes == 4);
  CHECK_THROWS_WITH(read(folder, {"solver.substep.max_passs=4"}), Contains("max_passes"));
  CHECK_THROWS_WITH(read(folder, {"solver.substep.max_passes=-1"}), Contains("max_passes"));
}

TEST_CASE("Step options: defaults written out give the same bits, other values another step", "[setup]") {
  const Folder folder("step_options");
  const Points standard = after(read(folder), 8);
  const std::vector<std::string> as_they_are{"solver.substep.max_passes=6", "solver.substep.contact_term.stiffness=200",
                                             "solver.response.room.sweeps=25", "solver.newton.exact_from=3"};
  CHECK(after(read(folder, as_they_are), 8) == standard);
  CHECK(after(read(folder, {"solver.substep.contact_term.stiffness=50"}), 8) != standard);
  CHECK(after(read(folder, {"solver.substep.longest=50 ms"}), 8) != standard);
  CHECK(after(read(folder, {"solver.substep.contact_term.overlap_removed=0.5"}), 8) != standard);
}

}  // namespace selvedge::test_step_options
