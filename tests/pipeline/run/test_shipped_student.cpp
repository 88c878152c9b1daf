#include <catch2/catch.hpp>

#include "physics/energies/measures.hpp"
#include "pipeline/run/simulate.hpp"
#include "pipeline/scene/make_stepper.hpp"
#include "tests/source_root.hpp"

// The small network that ships beside the carried guess, with the response behind it: an outfit that it has not seen.
namespace selvedge::test_shipped_student {

namespace {

Setup dressed(std::vector<std::string> overrides) {
  overrides.emplace_back("run.frames=60");
  return read_setup(source_root() / "configs/compare/outfit.yaml", overrides);
}

struct Roll {
  State end;
  int admitted = 0;
  bool clean = true;
};

Roll roll_out(const Setup& setup, State state, int frames) {
  Roll roll;
  const auto note = [&](const FrameEvent& event) {
    roll.admitted += event.report.verdict == Verdict::admitted;
    roll.clean = roll.clean && event.state.clean;
    return true;
  };
  const int last = state.frame + frames;
  const StepReport end =
      simulate(setup.scene, *make_stepper(setup), setup.drive_at, 1 / setup.run.fps, last, state, note);
  CHECK(end.status == StepStatus::accepted);
  roll.end = std::move(state);
  return roll;
}

}  // namespace

TEST_CASE("student: the network that ships ends nearer to the solver than its guess where cloth moves fast",
          "[learned]") {
  constexpr int begin = 50, frames = 10;
  const Setup solver = dressed({"run.quality=preview"});
  const State from = roll_out(solver, solver.initial, begin).end;
  const State reference = roll_out(solver, from, frames).end;
  const Setup taught = dressed({"run.stepper=hybrid", "run.hybrid.mode=response", "run.quality=draft",
                                "run.learned.weights=" + (source_root() / "configs/weights/student.h5").string()});
  const Roll student = roll_out(taught, from, frames), guess = roll_out(dressed({"run.stepper=carried"}), from, frames);
  CHECK(2 * student.admitted > frames);
  CHECK(student.clean);
  CHECK(root_mean_square(student.end.x - reference.x) < 0.8 * root_mean_square(guess.end.x - reference.x));
}

}  // namespace selvedge::test_shipped_student
