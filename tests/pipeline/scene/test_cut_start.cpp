#include <catch2/catch.hpp>

#include "pipeline/hdf5/trajectory_hdf5.hpp"
#include "pipeline/scene/make_stepper.hpp"
#include "pipeline/scene/setup.hpp"
#include "pipeline/tools/check.hpp"
#include "pipeline/tools/plan.hpp"
#include "tests/pipeline/fake_garment.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::test_cut_start {

using Catch::Matchers::Contains;
using fake::Folder;

namespace {

// A skirt, and the mannequin with a rod through it: a box that is drawn out sideways.
Setup read(const Folder& folder, const std::string& cloth, const std::string& more = "", double speed = 0.9) {
  return read_setup(
      fake::write(folder, "scene.yaml",
                  "cloths:\n  - " + cloth + "\n" + more +
                      "obstacles:\n  - {name: person, body: {}}\n"
                      "  - {name: rod, box: {size: [0.3, 0.04, 0.04]}, translate: [0.3, -0.2, 0], motion: {keyframes: "
                      "[{time: 0}, {time: 1, translate: [" +
                      std::to_string(speed) + ", 0, 0]}]}}\ncontact: {thickness: 3 mm}\nrun: {fps: 30, frames: 8}\n"));
}

const std::string cut = "{garment: skirt.h5, start: {from: cut}}";

RunSummary run(const Setup& setup, const Folder& folder, const std::string& out, bool resume = false, int stop = 100) {
  return fake::run(setup, *make_stepper(setup), folder.path / out, resume, stop);
}

}  // namespace

TEST_CASE("A cut start has no pair in any frame, says what is out, and ends whole", "[cut_start]") {
  const Folder folder("cut_start");
  fake::write_skirt(folder, {.room = 0.03});
  const Setup setup = read(folder, cut), skinned = read(folder, "{garment: skirt.h5}");
  CHECK(setup.initial.frame == 0);
  CHECK(setup.initial.x == skinned.initial.x);
  CHECK(skinned.initial.cut_out.empty());
  CHECK(skinned.drive_at(0).skinned_targets == skinned.initial.x);
  const int out = static_cast<int>(setup.initial.cut_out.size());
  CHECK(out > 2);
  CHECK(out < setup.scene.surface.triangles.rows() / 4);
  CHECK(setup.drive_at(0).skinned_targets == setup.initial.x);
  CHECK_THAT(plan_text(setup), Contains("cut start") && Contains("cut: " + std::to_string(out) + " of "));

  const RunSummary summary = run(setup, folder, "whole");
  CHECK(is_clean(summary));
  CHECK(total_of(summary.fields, "cut_out").at_start == out);
  CHECK(total_of(summary.fields, "cut_out").at_end == 0);
  CHECK(total_of(summary.fields, "cut_out").last_frame > 0);
  CHECK_THAT(summary_text(summary), Contains("cut out") && Contains("none after frame"));
  CHECK_THAT(summary_json(summary), Contains("\"cut_out_triangles\": " + std::to_string(out)));
  const TrajectoryReader reader(folder.path / "whole" / "run.h5");
  CHECK(reader.frame(0).report.collision.cut_out == out);
  CHECK(reader.frame(0).obstacle_pairs + reader.frame(0).inside_vertices == 0);
  CHECK(reader.frame(8).report.collision.cut_out == 0);

  // Who looks at positions alone finds what was cut, and is told.
  CheckRequest request;
  request.file = folder.path / "whole" / "run.h5";
  const CheckReport checked = check(request);
  CHECK(checked.pairs_by_frame.front() > 0);
  CHECK(checked.pairs_by_frame.back() == 0);
  REQUIRE_FALSE(checked.warnings.empty());
  CHECK_THAT(checked.warnings.back(), Contains("cut triangles out up to frame " +
                                               std::to_string(total_of(summary.fields, "cut_out").last_frame)));
}

TEST_CASE("A run that ends with triangles cut out is not clean", "[cut_start]") {
  const Folder folder("cut_stays");
  fake::write_skirt(folder, {.room = 0.03});
  const RunSummary summary = run(read(folder, cut, "", 0), folder, "stays");
  CHECK(summary.end == RunEnd::finished);
  CHECK(summary.pairs + summary.worst_inside == 0);
  CHECK(total_of(summary.fields, "cut_out").at_end > 0);
  CHECK_FALSE(is_clean(summary));
  CHECK_THAT(summary_text(summary), Contains("no pair is counted of them"));
}

TEST_CASE("A run with a cut start is resumed to the same bits", "[cut_start]") {
  const Folder folder("cut_resume");
  fake::write_skirt(folder, {.room = 0.03});
  const Setup setup = read(folder, cut);
  run(setup, folder, "whole");
  CHECK(run(setup, folder, "parts", false, 2).end == RunEnd::interrupted);
  CHECK(run(setup, folder, "parts", true).end == RunEnd::finished);
  const TrajectoryReader one(folder.path / "whole" / "run.h5"), other(folder.path / "parts" / "run.h5");
  REQUIRE(one.frame_count() == 9);
  REQUIRE(other.frame_count() == 9);
  CHECK(one.frame(2).report.collision.cut_out > 0);
  for (int i = 0; i < 9; ++i) {
    CHECK(one.frame(i).x == other.frame(i).x);
    CHECK(one.frame(i).report.collision.cut_out == other.frame(i).report.collision.cut_out);
  }
}

TEST_CASE("A cut start of what is clean cuts nothing; one that cannot be is named", "[cut_start]") {
  const Folder folder("cut_faulty");
  fake::write_skirt(folder, {.room = 0.03});
  const Setup clean = read_setup(
      fake::write(folder, "clean.yaml", "cloths:\n  - " + cut + "\nobstacles:\n  - {name: person, body: {}}\n"));
  CHECK(clean.initial.cut_out.empty());
  CHECK_THAT(clean.prepared, Contains("cut: 0 of "));
  CHECK_THROWS_WITH(read(folder, "{rectangle: {resolution: 4}, start: {from: cut}}"), Contains("no body wears"));
  CHECK_THROWS_WITH(read(folder, "{garment: skirt.h5, start: {from: cut, crumple: 1 mm}}"), Contains("crumple"));
  CHECK_THROWS_WITH(read(folder, cut, "  - {name: inner, garment: skirt.h5}\n"), Contains("starts otherwise"));
}

}  // namespace selvedge::test_cut_start
