#include <catch2/catch.hpp>

#include "collision/geometry/error.hpp"
#include "pipeline/formats/checkpoint.hpp"
#include "pipeline/scene/make_stepper.hpp"
#include "tests/pipeline/run/sheet_over_ball.hpp"

namespace selvedge::test_resume {

namespace {

State stepped(const Setup& setup, Stepper& stepper, const State& from) {
  State to;
  const double dt = 1 / setup.run.fps;
  REQUIRE(stepper.step(from, setup.drive_at(from.time + dt), dt, to).status == StepStatus::accepted);
  return to;
}

}  // namespace

// A sheet falls on a ball. What a run does next must be in its state, wherever it is stopped: no list that the stepper
// keeps may decide anything.
TEST_CASE("A run that is resumed after any frame of an impact goes on with the same bits", "[resume]") {
  const fake::Folder folder("resume");
  const Setup setup = fake::sheet_over_ball(folder, 0.5, 200);
  const std::unique_ptr<Stepper> stepper = make_stepper(setup);
  State state = setup.initial;
  constexpr int before = 8, frames = 24;  // the ball is met in frame 9
  while (state.frame < frames) {
    const State next = stepped(setup, *stepper, state);
    if (state.frame >= before) {
      const std::filesystem::path file = folder.path / "checkpoint.h5";
      write_checkpoint(file, state, setup.config);
      const State read = read_checkpoint(file, setup.config);
      CHECK_NOTHROW(check_fits(file, read, setup.scene));
      const State resumed = stepped(setup, *make_stepper(setup), read);
      INFO("stopped after frame " << state.frame << ": off by " << (resumed.x - next.x).cwiseAbs().maxCoeff());
      CHECK(resumed.x == next.x);
      CHECK(resumed.v == next.v);
    }
    state = next;
  }
}

TEST_CASE("Checkpoints that are damaged or of another scene are refused", "[resume]") {
  const fake::Folder folder("unfit");
  const std::filesystem::path file = folder.path / "checkpoint.h5";
  const Setup setup = fake::setup();
  const auto refusal = [&](const std::function<void(State&)>& damage) -> std::string {
    State state = setup.initial;
    damage(state);
    write_checkpoint(file, state, "");
    try {
      check_fits(file, read_checkpoint(file, ""), setup.scene);
    } catch (const Error& error) {
      return error.what();
    }
    return {};
  };
  CHECK(refusal([](State&) {}).empty());
  CHECK_THAT(refusal([](State& s) { s.v.conservativeResize(3, 3); }), Catch::Contains("numbers of vertices"));
  CHECK_THAT(refusal([](State& s) { s.x(2, 1) = std::nan(""); }), Catch::Contains("not finite"));
  CHECK_THAT(refusal([](State& s) { s.cut_out = {4, 2}; }), Catch::Contains("cut_out"));
  CHECK_THAT(refusal([](State& s) { s.cut_out = {1000}; }), Catch::Contains("another scene"));
  CHECK_THAT(refusal([](State& s) { s.obstacles.pop_back(); }), Catch::Contains("another scene"));
  CHECK_THAT(refusal([](State& s) {
               s.memory = {{"a.b", MemoryRows::Zero(3, 3), RowsOf::triangles}};
             }),
             Catch::Contains("another scene"));
  CHECK_THAT(refusal([](State& s) {
               s.memory = {{"a.b", MemoryRows::Zero(3, 3), static_cast<RowsOf>(9)}};
             }),
             Catch::Contains("memory_rows_of"));
}

}  // namespace selvedge::test_resume
