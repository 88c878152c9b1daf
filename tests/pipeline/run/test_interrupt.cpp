#include <catch2/catch.hpp>

#include "pipeline/hdf5/checkpoint.hpp"
#include "pipeline/hdf5/trajectory.hpp"
#include "pipeline/run/prepare.hpp"
#include "pipeline/scene/make_stepper.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::test_interrupt {

TEST_CASE("A run that is interrupted within a step keeps the state before it and is resumed with the same bits",
          "[interrupt]") {
  const fake::Folder folder("interrupt");
  const Setup setup = read_setup(fake::write(folder, "scene.yaml",
                                             "cloths:\n"
                                             "  - rectangle: {size: [0.4, 0.4], resolution: 9}\n"
                                             "    translate: [0, 0.2, 0]\n"
                                             "obstacles: [{sphere: {radius: 0.1}}]\n"
                                             "run: {frames: 8}\n"));
  const auto run = [&](const std::string& out, bool resume, const StopFlag& interrupt, Points& last) {
    RunRequest request;
    request.out = folder.path / out;
    request.interrupt = interrupt;
    request.observe = [&](const FrameEvent& event) { last = event.state.x; };
    const auto stepper = make_stepper(setup);
    return resume ? resume_scene(setup, *stepper, request) : run_scene(setup, *prepare(setup), *stepper, request);
  };
  Points whole, before, after;
  int all = 0;
  REQUIRE(run(
              "whole", false, [&] { return ++all < 0; }, whole)
              .end == RunEnd::finished);
  REQUIRE(all > 20);
  int asked = 0;
  const RunSummary stopped = run(
      "part", false, [&] { return ++asked > all / 2; }, before);
  CHECK(stopped.end == RunEnd::interrupted);
  const State kept = read_checkpoint(folder.path / "part" / "checkpoint.h5").state;
  CHECK(kept.x == before);
  CHECK(kept.frame > 0);
  CHECK(kept.frame < 8);
  CHECK(TrajectoryReader(folder.path / "part" / "run.h5").frame_count() == kept.frame + 1);
  CHECK(run("part", true, {}, after).end == RunEnd::finished);
  CHECK(after == whole);
}

}  // namespace selvedge::test_interrupt
