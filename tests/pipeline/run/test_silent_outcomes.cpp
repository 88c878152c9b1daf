#include <catch2/catch.hpp>

#include "pipeline/scene/make_stepper.hpp"
#include "pipeline/tools/check.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::test_silent_outcomes {

namespace {

struct Ran {
  RunSummary summary;
  CheckReport found;
};

Ran run_and_check(const fake::Folder& folder, const std::string& yaml) {
  const Setup setup = read_setup(fake::write(folder, "scene.yaml", yaml));
  Ran ran{fake::run(setup, *make_stepper(setup), folder.path / "out"), {}};
  CheckRequest request;
  request.file = folder.path / "out" / "run.h5";
  request.horizon = 0;
  ran.found = check(request);
  return ran;
}

}  // namespace

TEST_CASE("A ball that is too fast for a sweep is not silently on the other side", "[silent_outcomes]") {
  const fake::Folder folder("fast_ball");
  const Ran ran = run_and_check(folder,
                                "cloths:\n"
                                "  - rectangle: {size: [0.6, 0.6], resolution: 25}\n"
                                "    rotate: [90 deg, 0, 0]\n"
                                "    pins: [{group: [top_left, top_right, bottom_left, bottom_right]}]\n"
                                "obstacles:\n"
                                "  - sphere: {radius: 4 cm, edge: 1.5 cm}\n"
                                "    translate: [0, 0, -1.03]\n"
                                "    motion: {keyframes: [{time: 0}, {time: 0.0333, translate: [0, 0, 2]}]}\n"
                                "run: {frames: 2}\n");
  CHECK(ran.summary.jumped == 1);
  CHECK(ran.summary.first_jump_frame == 1);
  CHECK_FALSE(is_clean(ran.summary));
  CHECK_THAT(summary_json(ran.summary), Catch::Contains("\"jumped\": 1"));
  CHECK_THAT(summary_text(ran.summary), Catch::Contains("jumped"));
}

// The wall has nowhere to go but the file must say where the run had it.
TEST_CASE("Where pins drive cloth into a still wall the file shows what was simulated", "[silent_outcomes]") {
  const fake::Folder folder("pin_into_wall");
  const Ran ran =
      run_and_check(folder,
                    "cloths:\n"
                    "  - rectangle: {size: [0.4, 0.4], resolution: 9}\n"
                    "    rotate: [90 deg, 0, 0]\n"
                    "    pins: [{group: top, motion: {keyframes: [{time: 0}, {time: 0.5, translate: [0, 0, 0.4]}]}}]\n"
                    "obstacles:\n"
                    "  - box: {size: [1, 1, 0.1]}\n"
                    "    translate: [0, 0, 0.25]\n"
                    "run: {frames: 13}\n");
  long pairs = 0;
  for (const int frame : ran.found.pairs_by_frame) pairs += frame;
  CHECK(pairs == ran.summary.pairs);
  CHECK(ran.found.inside_vertices == ran.summary.worst_inside);
  CHECK(ran.summary.max_obstacle_lag > 0);  // or the scene shows nothing
}

}  // namespace selvedge::test_silent_outcomes
