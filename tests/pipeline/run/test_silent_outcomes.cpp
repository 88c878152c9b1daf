#include <fmt/format.h>
#include <catch2/catch.hpp>

#include "pipeline/scene/make_stepper.hpp"
#include "pipeline/tools/check.hpp"
#include "pipeline/tools/plan.hpp"
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
  CHECK(total_of(ran.summary.fields, "jumped").sum == 1);
  CHECK(total_of(ran.summary.fields, "jumped").first_frame == 1);
  CHECK_FALSE(is_clean(ran.summary));
  CHECK_THAT(summary_json(ran.summary), Catch::Contains("\"jumped\": 1"));
  CHECK_THAT(summary_text(ran.summary), Catch::Contains("jumped"));
}

// What is prescribed to a wall stands, so the pins give way, and the file must say where the run had both.
TEST_CASE("Where pins drive cloth into a wall, still or moving, they give way, and the file shows it",
          "[silent_outcomes]") {
  for (const char* motion : {"", "    motion: {keyframes: [{time: 0}, {time: 1, translate: [0, 0, -0.1]}]}\n"}) {
    INFO(motion);
    const fake::Folder folder("pin_into_wall");
    const Ran ran = run_and_check(folder, std::string("cloths:\n"
                                                      "  - rectangle: {size: [0.4, 0.4], resolution: 9}\n"
                                                      "    rotate: [90 deg, 0, 0]\n"
                                                      "    pins: [{group: top, motion: {keyframes: [{time: 0}, "
                                                      "{time: 0.5, translate: [0, 0, 0.4]}]}}]\n"
                                                      "obstacles:\n"
                                                      "  - box: {size: [1, 1, 0.1]}\n"
                                                      "    translate: [0, 0, 0.25]\n") +
                                              motion + "run: {frames: 13}\n");
    long pairs = 0;
    for (const int frame : ran.found.pairs_by_frame) pairs += frame;
    CHECK(pairs == ran.summary.pairs);
    CHECK(ran.found.inside_vertices == ran.summary.worst_inside);
    CHECK(pairs == 0);
    CHECK(total_of(ran.summary.fields, "obstacle_lag").largest == 0);
    CHECK(ran.summary.max_stretch < 1.05);
    CHECK(total_of(ran.summary.fields, "shortened").sum > 0);  // or the scene shows nothing
    CHECK(total_of(ran.summary.fields, "held_vertices").sum > 0);
  }
}

// Two blocks of one obstacle, their triangles outwards, -at and at on the x axis.
std::string two_blocks(double at) {
  std::string text;
  for (const double x : {-at, at})
    for (int v = 0; v < 8; ++v)
      text += fmt::format("v {} {} {}\n", x + (v & 1 ? 0.06 : -0.06), (v & 2 ? 0.06 : -0.06) + 0.1 * x,
                          (v & 4 ? 0.06 : -0.06) + 0.15 * x);
  const int corners[12][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                              {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  for (const int first : {1, 9})
    for (const auto& t : corners) text += fmt::format("f {} {} {}\n", t[0] + first, t[1] + first, t[2] + first);
  return text;
}

std::string between_blocks(const fake::Folder& folder) {
  for (int f = 0; f < 6; ++f) fake::write(folder, fmt::format("b_{}.obj", f), two_blocks(0.075 - 0.006 * f));
  return "cloths: [{rectangle: {size: [0.05, 0.05], resolution: 5}, rotate: [0, 0, 90 deg]}]\n"
         "obstacles: [{name: blocks, sequence: {pattern: b_%d.obj, count: 6, fps: 30}}]\n"
         "gravity: [0, 0, 0]\n"
         "run: {frames: 5}\n";
}

TEST_CASE("What contact switches off is said by obstacle: in the file, the summary and the plan", "[silent_outcomes]") {
  const fake::Folder folder("switched_off");
  const Ran ran = run_and_check(folder, between_blocks(folder));
  REQUIRE(ran.summary.switched_off.size() == 1);
  const RunSummary::SwitchedOff& blocks = ran.summary.switched_off[0];
  CHECK(blocks.frames > 0);
  CHECK(blocks.most > 0);
  int frames = 0, most = 0;
  const TrajectoryReader reader(folder.path / "out" / "run.h5");
  for (int i = 0; i < reader.frame_count(); ++i)
    for (const int off : reader.frame(i).report.switched_off) {
      frames += off > 0;
      most = std::max(most, off);
    }
  CHECK(frames == blocks.frames);
  CHECK(most == blocks.most);
  CHECK_THAT(summary_text(ran.summary), Catch::Contains(fmt::format("up to {} triangles of `blocks`", most)));
  CHECK_THAT(summary_json(ran.summary), Catch::Contains("\"obstacle\": \"blocks\""));
  CHECK_THAT(plan_text(read_setup(folder.path / "scene.yaml")),
             Catch::Contains("in   switching off") && Catch::Contains("can be switched off"));
}

TEST_CASE("A still obstacle of parts that overlap has nothing switched off, and the plan says so",
          "[silent_outcomes]") {
  const fake::Folder folder("nothing_off");
  fake::write(folder, "union.obj", two_blocks(0.05));
  const Ran ran = run_and_check(folder,
                                "cloths: [{rectangle: {size: [0.3, 0.3], resolution: 7}, translate: [0, 0.08, 0]}]\n"
                                "obstacles: [{name: union, mesh: union.obj}]\n"
                                "run: {frames: 3}\n");
  CHECK(ran.summary.switched_off.at(0).frames == 0);
  REQUIRE(ran.summary.warnings.size() == 1);
  CHECK_THAT(ran.summary.warnings[0], Catch::Contains("union.obj: crosses itself in"));
  CHECK_THAT(summary_json(ran.summary), Catch::Contains("\"switched_off\": []"));
  CHECK_THAT(plan_text(read_setup(folder.path / "scene.yaml")),
             Catch::Contains("out  switching off") && Catch::Contains("keeps its shape"));
}

}  // namespace selvedge::test_silent_outcomes
