#include <catch2/catch.hpp>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "collision/geometry/error.hpp"
#include "physics/steppers/decorated_stepper.hpp"
#include "pipeline/hdf5/checkpoint.hpp"
#include "pipeline/run/record_frame.hpp"
#include "pipeline/run/simulate.hpp"
#include "tests/frame.hpp"
#include "tests/pipeline/fake_run.hpp"

namespace selvedge::test_simulate {

namespace {

nlohmann::json read_json(const std::filesystem::path& path) {
  std::ifstream stream(path);
  return nlohmann::json::parse(stream);
}

RunSummary run(const Setup& setup, const std::filesystem::path& out, int stop_after = 1 << 30, bool resume = false,
               int fails_at = 1 << 30) {
  fake::FallingStepper stepper(fails_at);
  return fake::run(setup, stepper, out, resume, stop_after);
}

}  // namespace

TEST_CASE("simulate steps to the last frame and asks the world for the end of each step") {
  const Setup setup = fake::setup(4);
  fake::FallingStepper stepper;
  State state = setup.initial;
  std::vector<double> asked;
  std::vector<int> seen;
  const auto drive_at = [&](double time) {
    asked.push_back(time);
    return setup.drive_at(time);
  };
  const StepReport last = simulate(setup.scene, stepper, drive_at, 0.5, 4, state, [&](const FrameEvent& event) {
    seen.push_back(event.state.frame);
    return true;
  });
  REQUIRE(last.status == StepStatus::accepted);
  REQUIRE(seen == std::vector<int>{1, 2, 3, 4});
  REQUIRE(asked == std::vector<double>{0.5, 1, 1.5, 2});
  REQUIRE(state.time == 2);
}

TEST_CASE("a rejected step ends the run and leaves the last accepted state") {
  const Setup setup = fake::setup();
  fake::FallingStepper stepper(3);
  State state = setup.initial;
  int events = 0;
  const StepReport last =
      simulate(setup.scene, stepper, setup.drive_at, 0.1, 10, state, [&](const FrameEvent&) { return ++events; });
  REQUIRE(last.status == StepStatus::rejected);
  REQUIRE(events == 3);
  REQUIRE(state.frame == 2);
  REQUIRE(state.x.allFinite());
}

TEST_CASE("a run leaves a trajectory, its sidecar, the configuration and a summary") {
  const fake::Folder folder("run");
  const Setup setup = fake::setup();
  const RunSummary summary = run(setup, folder.path);
  REQUIRE(summary.end == RunEnd::finished);
  REQUIRE(is_clean(summary));
  REQUIRE(summary.frames == 12);
  REQUIRE(summary.frame_seconds.size() == 12);
  REQUIRE(summary_text(summary).find("contacts") == std::string::npos);  // where none were looked for

  const TrajectoryReader reader(folder.path / "run.h5");
  REQUIRE(reader.closed());
  REQUIRE(reader.frame_count() == 13);
  REQUIRE(reader.frame(0).report.by == "initial");
  REQUIRE(reader.frame(0).x == setup.initial.x.cast<float>());
  REQUIRE(reader.frame(5).report.by == "falling");
  REQUIRE(reader.frame(12).time == Approx(12 / 30.0));
  REQUIRE(reader.frame(12).max_stretch == Approx(1).margin(1e-5));

  for (const char* name : {"run.xdmf", "config.yaml", "summary.json"})
    REQUIRE(std::filesystem::exists(folder.path / name));
  REQUIRE_FALSE(std::filesystem::exists(folder.path / "checkpoint.h5"));
  const nlohmann::json json = read_json(folder.path / "summary.json");
  REQUIRE(json["frames"] == 12);
  REQUIRE(json["end"] == "finished");
  REQUIRE(json["clean"] == true);
  REQUIRE(json["intersecting_pairs"] == 0);
  REQUIRE(json["ms_per_frame"]["by_phase"].contains("solve"));
  REQUIRE(json.contains("left_out"));
}

TEST_CASE("what is recorded is measured on the positions as written") {
  Setup setup = fake::setup();
  const Frame plain = record_initial(setup.scene, energy_terms(setup.scene), setup.initial, setup.drive_at(0));
  setup.initial.x *= 1 + 1e-9;  // lost in the rounding to float
  REQUIRE(principal_stretches(setup.scene, setup.initial.x).maxCoeff() != plain.max_stretch);
  const Frame frame = record_initial(setup.scene, energy_terms(setup.scene), setup.initial, setup.drive_at(0));
  REQUIRE(frame.max_stretch == plain.max_stretch);
  REQUIRE(frame.min_stretch == plain.min_stretch);
}

TEST_CASE("a frame that the stepper has audited is recorded as an audit of the file would have it") {
  for (const double height : {-0.05, -0.5}) {  // through the sheet, and below it
    Setup setup = fake::setup();
    setup.initial.obstacles[0] = fake::tetrahedron_points(0.5, height);
    const auto stepper = make_recovering_conventional_stepper(setup.scene, {});
    Drive drive = setup.drive_at(0);
    drive.obstacles = setup.initial.obstacles;
    State state;
    StepReport report = testing::frame(setup.scene, *stepper, setup.initial, drive, 1e-4, state);
    REQUIRE(report.audit);
    const EnergyTerms terms = energy_terms(setup.scene);
    const Frame told = record_frame(setup.scene, terms, {state, drive, report, 0});
    report.audit.reset();
    const Frame audited = record_frame(setup.scene, terms, {state, drive, report, 0});
    CHECK(told.bad_triangles == audited.bad_triangles);
    CHECK(told.obstacle_pairs == audited.obstacle_pairs);
    CHECK(told.inside_vertices == audited.inside_vertices);
    CHECK((told.obstacle_pairs > 0) == (height > -0.1));
  }
}

TEST_CASE("an intersection is found, marked and makes the run unclean") {
  const fake::Folder folder("dirty");
  Setup setup = fake::setup(2);
  setup.initial.obstacles[0] = fake::tetrahedron_points(0.5, -0.05);
  const auto far_drive = setup.drive_at;
  setup.drive_at = [=, held = setup.initial.obstacles[0]](double time) {
    Drive drive = far_drive(time);
    drive.acceleration.setZero();
    drive.obstacles[0] = held;
    return drive;
  };
  const RunSummary summary = run(setup, folder.path);
  REQUIRE_FALSE(is_clean(summary));
  REQUIRE(summary.worst_pairs > 0);
  const Frame frame = TrajectoryReader(folder.path / "run.h5").frame(1);
  REQUIRE(frame.obstacle_pairs == summary.worst_pairs);
  REQUIRE_FALSE(frame.bad_triangles.empty());
}

TEST_CASE("a rejected step is recorded and makes the run unclean") {
  const fake::Folder folder("rejected");
  const RunSummary summary = run(fake::setup(), folder.path, 1 << 30, false, 5);
  REQUIRE(summary.end == RunEnd::rejected);
  REQUIRE_FALSE(is_clean(summary));
  REQUIRE(summary.frames == 4);
  const TrajectoryReader reader(folder.path / "run.h5");
  REQUIRE(reader.frame_count() == 6);
  const Frame last = reader.frame(5);
  REQUIRE(last.report.status == StepStatus::rejected);
  REQUIRE(last.report.reason == Reason::not_converged);
  REQUIRE(last.x == reader.frame(4).x);
  REQUIRE(last.nonfinite == 0);
  REQUIRE(read_json(folder.path / "summary.json")["reason"] == "not_converged");
}

TEST_CASE("an interrupted run that is resumed gives the same bits") {
  const fake::Folder folder("resume");
  const Setup setup = fake::setup();
  REQUIRE(run(setup, folder.path / "whole").end == RunEnd::finished);
  REQUIRE(run(setup, folder.path / "parts", 5).end == RunEnd::interrupted);
  REQUIRE(TrajectoryReader(folder.path / "parts" / "run.h5").frame_count() == 6);
  const RunSummary resumed = run(setup, folder.path / "parts", 1 << 30, true);
  REQUIRE(resumed.end == RunEnd::finished);
  REQUIRE(resumed.frames == 12);
  const TrajectoryReader whole(folder.path / "whole" / "run.h5"), parts(folder.path / "parts" / "run.h5");
  REQUIRE(parts.frame_count() == whole.frame_count());
  for (int i = 0; i < whole.frame_count(); ++i) {
    const Frame a = whole.frame(i), b = parts.frame(i);
    REQUIRE(a.x == b.x);
    REQUIRE(a.time == b.time);
    REQUIRE(a.obstacles[1] == b.obstacles[1]);
    REQUIRE(a.energy.kinetic == b.energy.kinetic);
  }
  REQUIRE_THROWS_AS(run(setup, folder.path / "parts", 1 << 30, true), Error);
}

TEST_CASE("a resumed run is judged as one that was never stopped, with the same hashes") {
  const fake::Folder folder("judged");
  Setup setup = fake::setup();
  Outcome still{"obstacles are where they are wanted", Lag{}};
  still.from = 0;
  still.most = 0;
  Outcome falls{"falls", Drift{{0, 1}}};
  falls.from = 0;
  falls.least = 0.01;
  falls.once = true;
  Outcome flies{"flies", Drift{{0}}};
  flies.least = 100;
  setup.outcomes = {still, falls, flies};
  const RunSummary whole = run(setup, folder.path / "whole");
  REQUIRE(run(setup, folder.path / "parts", 9).end == RunEnd::interrupted);
  const RunSummary parts = run(setup, folder.path / "parts", 1 << 30, true);
  REQUIRE(parts.end == RunEnd::finished);
  REQUIRE(parts.outcomes.size() == 3);
  for (std::size_t k = 0; k < 3; ++k) {
    INFO(parts.outcome_lines[k]);
    CHECK(parts.outcomes[k].came_true == (k < 2));
    CHECK(parts.outcomes[k].frame == whole.outcomes[k].frame);
    CHECK(parts.outcomes[k].value == Approx(whole.outcomes[k].value).margin(1e-6));
  }
  CHECK(parts.positions_hash == whole.positions_hash);
  CHECK_FALSE(is_clean(parts));  // one outcome did not come true
  const nlohmann::json json = read_json(folder.path / "parts" / "summary.json");
  CHECK(json["clean"] == false);
  CHECK(json["outcomes"][2]["name"] == "flies");
  CHECK(json["outcomes"][2]["came_true"] == false);
  CHECK(json["positions_hash"] == read_json(folder.path / "whole" / "summary.json")["positions_hash"]);
  setup.initial.x(3, 1) += 0.01;
  CHECK(run(setup, folder.path / "other").positions_hash != whole.positions_hash);
}

TEST_CASE("a run that is killed soon after its start is resumed") {
  const fake::Folder folder("killed_soon");
  const Setup setup = fake::setup();
  fake::FallingStepper stepper;
  RunRequest request;
  request.out = folder.path;
  request.observe = [](const FrameEvent& event) {
    if (event.state.frame == 2) throw Error("as good as a kill", "frame 2", "");
  };
  REQUIRE_THROWS_AS(run_scene(setup, *prepare(setup), stepper, request), Error);
  REQUIRE(read_checkpoint(folder.path / "checkpoint.h5").state.frame == 0);
  CHECK(run(setup, folder.path, 1 << 30, true).end == RunEnd::finished);
}

TEST_CASE("what cannot be removed from the folder of a run is named with its cure") {
  const fake::Folder folder("not_removed");
  std::filesystem::create_directories(folder.path / "summary.json" / "inner");
  REQUIRE_THROWS_WITH(run(fake::setup(), folder.path),
                      Catch::Contains("summary.json: cannot be removed") && Catch::Contains("may be written"));
}

TEST_CASE("a run is resumed only under its own configuration") {
  const fake::Folder folder("other_config");
  Setup setup = fake::setup();
  run(setup, folder.path, 5);
  setup.config += "# other\n";
  REQUIRE_THROWS_AS(run(setup, folder.path, 1 << 30, true), Error);
}

TEST_CASE("a checkpoint keeps every bit") {
  const fake::Folder folder("checkpoint");
  State state = fake::setup().initial;
  state.frame = 7;
  state.time = 0.1 + 0.2;
  state.v.setConstant(1.0 / 3);
  if (GENERATE(false, true)) {
    state.memory = {{"dummy.positions", 0.7 * state.x, RowsOf::vertices, true},
                    {"dummy.seconds", MemoryRows::Constant(2, 1, 1.0 / 3), RowsOf::cloths},
                    {"other.nothing", MemoryRows(0, 3), RowsOf::obstacle_vertices},
                    {"other.wide", MemoryRows::Constant(3, 5, 0.1), RowsOf::none}};
  }
  write_checkpoint(folder.path / "c.h5", state, {"a: 1\n", {}, 0});
  const State read = read_checkpoint(folder.path / "c.h5").state;
  REQUIRE(read.frame == state.frame);
  REQUIRE(read.time == state.time);
  REQUIRE(read.x == state.x);
  REQUIRE(read.v == state.v);
  REQUIRE(read.obstacles == state.obstacles);
  REQUIRE(read.memory.size() == state.memory.size());
  for (std::size_t k = 0; k < read.memory.size(); ++k) {
    REQUIRE(read.memory[k].name == state.memory[k].name);
    REQUIRE(read.memory[k].rows == state.memory[k].rows);
    REQUIRE(read.memory[k].rows_of == state.memory[k].rows_of);
    REQUIRE(read.memory[k].positions == state.memory[k].positions);
  }
}

TEST_CASE("a run that fails leaves no results of the run before it") {
  const fake::Folder folder("stale");
  const Setup setup = fake::setup();
  run(setup, folder.path);
  Setup broken = setup;
  broken.drive_at = [](double) -> Drive { throw Error("a frame is missing", "body.obj", "add it"); };
  REQUIRE_THROWS_AS(run(broken, folder.path), Error);
  REQUIRE_FALSE(std::filesystem::exists(folder.path / "summary.json"));
  REQUIRE_FALSE(std::filesystem::exists(folder.path / "run.xdmf"));
}

TEST_CASE("progress is plain lines without a terminal and names the time left on one") {
  std::ostringstream plain, terminal;
  Progress quiet(plain, false), lively(terminal, true);
  const auto begun = Clock::now();
  quiet.begin(0, 100);
  quiet.frame(1);
  const bool soon = seconds_since(begun) < 5;  // a line every five seconds, and a busy machine may take as long
  REQUIRE((plain.str().empty() || !soon));
  lively.begin(0, 100);
  const auto start = Clock::now();
  while (seconds_since(start) < 0.12) continue;
  lively.frame(50);
  REQUIRE(terminal.str().find("frame 50 of 100") != std::string::npos);
  REQUIRE(terminal.str().find("left") != std::string::npos);
  REQUIRE(duration_text(59) == "59 s");
  REQUIRE(duration_text(200) == "3 min 20 s");
  REQUIRE(duration_text(7500) == "2 h 5 min");
}

TEST_CASE("times are summed up by frame") {
  RunSummary summary;
  Frame frame = fake::frame(fake::scene(), 0);
  add_frame(summary, 0, frame);
  REQUIRE(summary.frame_seconds.empty());
  for (const double seconds : {0.1, 0.2, 0.6, 0.4}) {
    frame.seconds = seconds;
    add_frame(summary, 1, frame);
  }
  REQUIRE(mean_milliseconds(summary) == Approx(325));
  REQUIRE(median_milliseconds(summary) == Approx(300));
}

TEST_CASE("a summary says in how many frames the audit of the motion was not whole") {
  RunSummary summary;
  for (int index = 0; index < 3; ++index) add_frame(summary, index, fake::frame(fake::scene(), index));
  REQUIRE(total_of(summary.fields, "out_of_proofs").frames == 1);
  REQUIRE_THAT(summary_json(summary), Catch::Contains("\"out_of_proofs_frames\": 1"));
  REQUIRE_THAT(summary_text(summary), Catch::Contains("out of proofs"));
}

TEST_CASE("a summary says how far solves were off where the stepper knows it, and counts one frame as one") {
  RunSummary summary;
  Frame frame = fake::frame(fake::scene(), 1);
  frame.report.doubts.not_converged = true;
  frame.report.unsolved = 0;
  add_frame(summary, 1, frame);
  CHECK_THAT(summary_text(summary), Catch::Contains("not converged       1 frame\n"));
  frame.report.unsolved = 2e-3;
  add_frame(summary, 2, frame);
  CHECK_THAT(summary_text(summary), Catch::Contains("not converged       2 frames: 0.002 m off at most\n"));
}

TEST_CASE("a summary says in how many frames an accepted step left something in doubt, each doubt by itself") {
  RunSummary summary;
  for (int index = 0; index < 6; ++index) {
    Frame frame = fake::frame(fake::scene(), index);
    frame.report.doubts = {index > 1, index > 2, index > 3};
    add_frame(summary, index, frame);
  }
  for (const char* part : {"\"not_converged_frames\": 4", "\"penetrating_frames\": 3", "\"energy_gains\": 2",
                           "\"energy_gains_first_frame\": 4"})
    CHECK_THAT(summary_json(summary), Catch::Contains(part));
  for (const char* label : {"energy from nowhere", "not converged"})
    CHECK_THAT(summary_text(summary), Catch::Contains(label));
}

}  // namespace selvedge::test_simulate
