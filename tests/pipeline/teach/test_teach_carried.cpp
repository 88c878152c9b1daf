#include <catch2/catch.hpp>

#include "collision/geometry/error.hpp"
#include "pipeline/run/simulate.hpp"
#include "pipeline/scene/make_stepper.hpp"
#include "pipeline/teach/teach_carried.hpp"
#include "pipeline/tools/plan.hpp"
#include "tests/pipeline/fake_garment.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::test_teach_carried {

using Catch::Matchers::Contains;
using fake::Folder;

namespace {

// A person in a coarse skirt.
std::filesystem::path skirt_scene(const Folder& folder) {
  fake::write_skirt(folder, {.around = 20, .rings = 6});
  return fake::write(folder, "scene.yaml",
                     "cloths: [{name: skirt, garment: {file: skirt.h5}, start: {from: skinned}}]\n"
                     "obstacles: [{name: person, body: {model: mannequin, clip: walk}}]\n"
                     "run: {frames: 40, fps: 30, stepper: carried}\n");
}

TeachRequest request_of(const Folder& folder, const std::string& out = "w.h5") {
  TeachRequest request;
  request.scene = skirt_scene(folder);
  request.clips = {"walk", "squat"};
  request.held_out = {"kick"};
  request.out = folder.path / out;
  request.rounds = 1;
  return request;
}

Points end_of(const std::filesystem::path& scene, const std::vector<std::string>& overrides) {
  const Setup setup = read_setup(scene, overrides);
  State state = setup.initial;
  const StepReport last = simulate(setup.scene, *make_stepper(setup), setup.drive_at, 1 / setup.run.fps, 12, state,
                                   [](const FrameEvent&) { return true; });
  REQUIRE(last.status == StepStatus::accepted);
  return state.x;
}

}  // namespace

TEST_CASE("teach: coefficients that are fitted on clips are nearer to the solver on another one", "[teach]") {
  const Folder folder("teach");
  TeachRequest request = request_of(folder);
  const TeachReport report = teach_carried(request);
  REQUIRE(report.finished);
  REQUIRE(report.rounds.size() == 2);
  CHECK(report.rounds[0].after < report.rounds[0].before);
  CHECK(report.rounds[1].frames > report.rounds[0].frames);
  REQUIRE(report.rows.size() == 3);
  CHECK(report.rows[0].stepper == "carried");
  CHECK(report.rows[1].stepper == "carried_fitted");
  CHECK(report.rows[1].rolls.distance_after_one() < report.rows[0].rolls.distance_after_one());
  CHECK(report.rows[1].rolls.tens == 3);
  CHECK(report.rows[1].rolls.refused == 0);
  CHECK_THAT(teach_text(report), Contains("carried_rough") && Contains("kept") && Contains("motion_before"));
  CHECK_THAT(teach_json(report), Contains("\"after_10_mm\""));

  CHECK(read_taught_carried(request.out).model.scene == report.taught.model.scene);
  request.out = folder.path / "again.h5";
  const TeachReport again = teach_carried(request);
  CHECK(again.taught.model.scene == report.taught.model.scene);
  CHECK(teach_json(again) == teach_json(report));

  const Setup setup = read_setup(request.scene, {"run.stepper=carried_fitted", "run.learned.weights=w.h5"});
  CHECK_THAT(plan_text(setup), Contains("fitted on walk, squat"));
}

TEST_CASE("teach: a set for each vertex is of its own cloth", "[teach]") {
  const Folder folder("teach_own");
  TeachRequest request = request_of(folder);
  request.own = true;
  request.rounds = 0;
  request.held_out = {};
  const TeachReport report = teach_carried(request);
  CHECK(report.rows.empty());
  const TaughtCarried read = read_taught_carried(request.out);
  CHECK(read.clips == request.clips);
  REQUIRE(read.model.own.rows() == 120);
  CHECK(read.model.scene == report.taught.model.scene);
  CHECK(read.model.own.cast<float>() == report.taught.model.own.cast<float>());
  CHECK(teach_carried(request).taught.model.own == report.taught.model.own);
  const std::vector<std::string> fitted{"run.stepper=carried_fitted", "run.learned.weights=w.h5"};
  const Setup setup = read_setup(request.scene, fitted);
  CHECK_FALSE(make_stepper(setup)->traits().may_leave_out_cloths);

  fake::write_skirt(folder, {.around = 20, .rings = 7});
  const std::string file = request.out.string();
  CHECK_THROWS_WITH(make_stepper(read_setup(request.scene, fitted)),
                    Contains(file) && Contains("120 vertices, the scene has 140") && Contains("selvedge teach"));
  TaughtCarried shared = read;
  shared.model.own.resize(0, carried_term_count);
  write_taught_carried(request.out, shared);
  CHECK_NOTHROW(make_stepper(read_setup(request.scene, fitted)));  // one set serves all scenes
}

TEST_CASE("teach: the default coefficients make the frames of the stepper `carried`", "[teach]") {
  const Folder folder("teach_default");
  const std::filesystem::path scene = skirt_scene(folder);
  TaughtCarried taught{{}, {"walk"}, 1, 120};
  write_taught_carried(folder.path / "w.h5", taught);
  const std::vector<std::string> fitted{"run.stepper=carried_fitted", "run.learned.weights=w.h5"};
  const Points carried = end_of(scene, {"run.stepper=carried"});
  CHECK(end_of(scene, fitted) == carried);
  taught.model.scene[static_cast<int>(CarriedTerm::gravity)] = 0.1;
  write_taught_carried(folder.path / "w.h5", taught);
  CHECK(end_of(scene, fitted) != carried);
}

TEST_CASE("teach: what cannot be taught is said, with a cure", "[teach]") {
  const Folder folder("teach_errors");
  const auto with = [&](const auto& change) {
    TeachRequest request = request_of(folder);
    change(request);
    return request;
  };
  CHECK_THROWS_WITH(
      teach_carried(with([](TeachRequest& r) { r.clips = {"wolk"}; })),
      Contains("obstacles.0.body.clip") && Contains("unknown clip `wolk`") && Contains("did you mean `walk`"));
  CHECK_THROWS_WITH(teach_carried(with([](TeachRequest& r) { r.held_out = {"walk"}; })), Contains("--held-out"));
  CHECK_THROWS_WITH(teach_carried(with([](TeachRequest& r) { r.clips = {}; })), Contains("--clips"));
  CHECK_THROWS_WITH(teach_carried(with([](TeachRequest& r) { r.out = "w.yaml"; })), Contains(".h5"));
  CHECK_THROWS_WITH(teach_carried(with([](TeachRequest& r) { r.overrides = {"run.frames=10"}; })),
                    Contains("frames") && Contains("scene.yaml"));
  TeachRequest bare = request_of(folder);
  bare.scene = fake::write(folder, "bare.yaml", "cloths: [{name: sheet, rectangle: {size: [1, 1], resolution: 4}}]\n");
  CHECK_THROWS_WITH(teach_carried(bare), Contains("bare.yaml") && Contains("one body") && Contains("cure"));

  const std::vector<std::string> fitted{"run.stepper=carried_fitted"};
  CHECK_THROWS_WITH(make_stepper(read_setup(skirt_scene(folder), fitted)),
                    Contains("run.learned.weights") && Contains("selvedge teach"));
  fake::write(folder, "w.h5", "nothing");
  CHECK_THROWS_WITH(
      make_stepper(read_setup(skirt_scene(folder), {"run.stepper=carried_fitted", "run.learned.weights=w.h5"})),
      Contains("w.h5"));
}

}  // namespace selvedge::test_teach_carried
