#include "pipeline/run/prepare.hpp"

#include <catch2/catch.hpp>

#include "collision/audit/audit.hpp"
#include "pipeline/hdf5/checkpoint.hpp"
#include "pipeline/run/run_scene.hpp"
#include "pipeline/scene/make_stepper.hpp"
#include "pipeline/tools/plan.hpp"
#include "tests/pipeline/fake_garment.hpp"
#include "tests/pipeline/files.hpp"
#include "tests/threads.hpp"

namespace selvedge::test_prepare {

using Catch::Matchers::Contains;
using fake::farthest;
using fake::Folder;

namespace {

Setup read(const Folder& folder, const std::string& cloth, const std::string& more = "",
           const std::vector<std::string>& overrides = {}) {
  return read_setup(
      fake::write(folder, "scene.yaml",
                  "cloths:\n  - " + cloth + "\n" + more +
                      "obstacles:\n  - {name: person, body: {clip: knee_to_chest}, motion: {keyframes: [{time: "
                      "0, translate: [1, 0, 0]}, {time: 1, translate: [2, 0, 0]}]}}\n"
                      "contact: {thickness: 3 mm}\nrun: {fps: 20, frames: 5}\n"),
      overrides);
}

const std::string draped = "{garment: skirt.h5, start: {from: draped, seconds: 0.35, hold: 0.15}}";

Audit audit_of(const Scene& scene, const State& state) {
  const std::vector<AuditBody> bodies{{&scene.obstacles[0].surface, &state.obstacles[0]}};
  return audit(scene.surface, state.x, bodies);
}

}  // namespace

TEST_CASE("A scene with a draped start begins before time 0, in the pose that the garment was made in", "[prepare]") {
  const Folder folder("prepare_before");
  const Garment skirt = fake::write_skirt(folder);
  const BodyModel& body = fake::mannequin();
  const Setup setup = read(folder, draped), skinned = read(folder, "{garment: skirt.h5}");
  CHECK(skinned.initial.frame == 0);
  CHECK(setup.initial.frame == -10);
  CHECK(setup.initial.time == Approx(-0.5));
  CHECK(setup.initial.v.isZero());
  // As made, but for the body's place.
  const Eigen::RowVector3d place = setup.initial.x.row(0) - skirt.skin.rest.row(0);
  CHECK(farthest(setup.initial.x.rowwise() - place, skirt.skin.rest) < 1e-12);
  CHECK(farthest(setup.initial.obstacles[0].rowwise() - place, body.skin.rest) < 1e-12);
  CHECK(setup.scene.obstacles[0].moving);
  CHECK_THAT(plan_text(setup), Contains("10 frames before time 0"));
  // The body arrives where the clip begins, without a jump, holds still, and goes on as it would.
  CHECK(farthest(setup.drive_at(-0.001).obstacles[0], setup.drive_at(0).obstacles[0]) < 1e-9);
  CHECK(farthest(setup.drive_at(-0.15).obstacles[0], setup.drive_at(0).obstacles[0]) < 1e-9);
  CHECK(farthest(setup.drive_at(-0.2).obstacles[0], setup.drive_at(0).obstacles[0]) > 1e-3);
  for (const double time : {0.0, 0.5}) CHECK(setup.drive_at(time).obstacles[0] == skinned.drive_at(time).obstacles[0]);
  CHECK(setup.drive_at(0.5).pins == skinned.drive_at(0.5).pins);

  BodyPose bent{Points::Zero(24, 3)};
  bent.rotations.row(1) << -0.8, 0, 0;
  fake::write_skirt(folder, {.file = "bent.h5", .made_in = bent});
  const Setup other = read(folder, "{garment: bent.h5, start: {from: draped}}");
  CHECK(other.initial.frame == -30);
  const Points expected = posed(body, {}, bent);
  CHECK(farthest(other.initial.obstacles[0].rowwise() - place, expected) < 1e-9);
  CHECK(farthest(other.initial.x.rowwise() - place, other.scene.rest) < 1e-9);
  // Two that were made in different poses have the zero pose in common.
  for (const auto& [one, two] : {std::pair{"bent", "skirt"}, std::pair{"skirt", "bent"}}) {
    const auto cloth = [](const std::string& name) { return "{garment: " + name + ".h5, start: {from: draped}}"; };
    const Setup both = read(folder, cloth(one), "  - " + cloth(two) + "\n");
    CHECK(farthest(both.initial.obstacles[0].rowwise() - place, body.skin.rest) < 1e-12);
  }
}

TEST_CASE("Draped cloth is clean at time 0, where its pins and its body are wanted", "[prepare]") {
  const Folder folder("prepare_clean");
  const auto waist = static_cast<Eigen::Index>(fake::write_skirt(folder).pins.size());
  const std::string pin = "  - {rectangle: {size: [0.1, 0.1], resolution: 3}, translate: [3, 5, 0]}\n";
  const Setup setup = read(folder, draped, pin);
  int asked = 0;
  const std::optional<Start> start = prepare(setup, [&] { return ++asked > 100; });
  REQUIRE(start);
  CHECK(asked == 10);
  const State& state = start->state;
  CHECK(state.time == 0);
  CHECK(state.frame == 0);
  const Audit found = audit_of(setup.scene, state);
  CHECK(found.intersecting_pairs() == 0);
  CHECK(found.inside_vertices == 0);
  const Drive drive = setup.drive_at(0);
  CHECK(farthest(state.obstacles[0], drive.obstacles[0]) < 1e-12);
  CHECK(farthest(state.x(setup.scene.pins, Eigen::all), drive.pins) < 1e-12);
  CHECK_THAT(start->prepared, Contains("draped in 10 frames") && Contains("0 pairs"));
  // It moves as the body begins to; the pins' velocity is theirs to say. The sheet has fallen along.
  const Setup skinned = read(folder, "{garment: skirt.h5}", pin);
  CHECK(state.v == skinned.initial.v);
  CHECK(state.v.col(0).segment(waist, 50).mean() > 0.5);
  CHECK(state.x.bottomRows(9).col(1).maxCoeff() < 4.5);
  // A scene that begins at time 0 starts as it is.
  const std::optional<Start> as_it_is = prepare(skinned, [] { return true; });
  REQUIRE(as_it_is);
  CHECK(as_it_is->state.x == skinned.initial.x);
  CHECK(as_it_is->prepared.empty());
}

TEST_CASE("A draped start has the same bits whoever steps the scene, with any number of threads", "[prepare]") {
  const Folder folder("prepare_bits");
  fake::write_skirt(folder);
  const Setup one = read(folder, draped),
              two = read(folder, draped, "", {"run.stepper=icm", "run.substeps=1", "run.frames=9"});
  std::optional<Start> other;
  with_threads(most_threads() == 1 ? 2 : 1, [&] { other = prepare(two); });
  CHECK(prepare(one).value().state.x == other.value().state.x);
  CHECK_FALSE(prepare(one, [] { return true; }));
}

TEST_CASE("A run with a draped start that was interrupted is resumed without draping again", "[prepare]") {
  const Folder folder("prepare_resume");
  fake::write_skirt(folder);
  const Setup setup = read(folder, draped);
  const auto run = [&](const std::string& out, bool resume, int frames) {
    return fake::run(setup, *make_stepper(setup), folder.path / out, resume, frames);
  };
  const RunSummary whole = run("whole", false, 100);
  CHECK_THAT(summary_json(whole), Contains("draped in 10 frames"));
  CHECK(run("parts", false, 2).end == RunEnd::interrupted);
  CHECK(run("parts", true, 100).end == RunEnd::finished);
  const TrajectoryReader one(folder.path / "whole" / "run.h5"), other(folder.path / "parts" / "run.h5");
  REQUIRE(one.frame_count() == 6);
  REQUIRE(other.frame_count() == 6);
  CHECK(one.frame(0).report.by == "initial");
  for (int i = 0; i < 6; ++i) CHECK(one.frame(i).x == other.frame(i).x);
}

TEST_CASE("A draped start that was stopped or killed goes on from where it was kept, with the same bits", "[prepare]") {
  const Folder folder("prepare_kept");
  fake::write_skirt(folder);
  const Setup setup = read(folder, draped);
  const KeptDraping kept{folder.path / "out", false, 0}, goes_on{folder.path / "out", true, 0};
  std::filesystem::create_directories(kept.folder);
  std::ofstream(kept.folder / "run.h5") << "of an earlier run";
  int asked = 0;
  CHECK_FALSE(prepare(
      setup, [&] { return ++asked == 4; }, nullptr, {}, kept));
  CHECK_FALSE(std::filesystem::exists(kept.folder / "run.h5"));
  CHECK(read_checkpoint(draping_file(kept.folder), setup.initial.frame).state.frame == -6);
  const std::optional<Start> start = prepare(setup, {}, nullptr, {}, goes_on), whole = prepare(setup);
  REQUIRE((start && whole));
  CHECK(start->state.x == whole->state.x);
  CHECK(start->state.obstacles == whole->state.obstacles);
  CHECK_THAT(start->prepared, Contains("draped in 10 frames (4 of them before it was stopped)"));
  // A process that is killed leaves what was kept last; nothing is taken from another scene.
  const Setup other = read(folder, draped, "", {"contact.thickness=2 mm"});
  CHECK_THROWS_WITH(prepare(other, {}, nullptr, {}, goes_on),
                    Contains("draping.h5") && Contains("another configuration"));
  Checkpoint late = read_checkpoint(draping_file(kept.folder), setup.initial.frame);
  late.state.frame = 2;
  late.state.time = 2 / setup.run.fps;
  write_checkpoint(draping_file(kept.folder), late.state, late.inputs);
  CHECK_THROWS_WITH(prepare(setup, {}, nullptr, {}, goes_on), Contains("draping.h5: frame"));
  // The run has a checkpoint of its own from its first frame on.
  RunRequest request;
  request.out = kept.folder;
  request.stop = [] { return true; };
  run_scene(setup, *whole, *make_stepper(setup), request);
  CHECK_FALSE(std::filesystem::exists(draping_file(kept.folder)));
  CHECK(std::filesystem::exists(kept.folder / "checkpoint.h5"));
}

TEST_CASE("A draped garment's other pins go with the body until time 0", "[prepare]") {
  const Folder folder("prepare_pins");
  fake::write_skirt(folder);
  const std::string start = "start: {from: draped, seconds: 0.35, hold: 0.15}";
  const Setup setup =
      read(folder, "{garment: {file: skirt.h5, pins: false}, " + start +
                       ", pins: [{group: hem, motion: {keyframes: [{time: 0}, {time: 1, translate: [0, 1, 0]}]}}]}");
  const Setup follows =
      read(folder, "{garment: {file: skirt.h5, pins: false}, " + start + ", pins: [{group: hem, follow: body}]}");
  for (const double time : {-0.5, -0.3, -0.1, 0.0})
    CHECK(farthest(setup.drive_at(time).pins, follows.drive_at(time).pins) < 1e-9);
  CHECK(setup.drive_at(1).pins(0, 1) == Approx(setup.drive_at(0).pins(0, 1) + 1));
}

TEST_CASE("What is wrong with a draped start is named", "[prepare]") {
  const Folder folder("prepare_faulty");
  fake::write_skirt(folder);
  CHECK_THROWS_WITH(read(folder, "{rectangle: {resolution: 4}, start: {from: draped}}"),
                    Contains("scene.yaml:2") && Contains("no body wears"));
  CHECK_THROWS_WITH(read(folder, "{garment: skirt.h5, start: {from: draped, crumple: 1 mm}}"), Contains("crumple"));
  CHECK_THROWS_WITH(read(folder, draped, "  - {name: inner, garment: skirt.h5}\n"),
                    Contains("scene.yaml:3") && Contains("starts otherwise"));
  CHECK_THROWS_WITH(read(folder, "{garment: skirt.h5, start: {from: drapd}}"), Contains("did you mean `draped`"));
}

}  // namespace selvedge::test_prepare
