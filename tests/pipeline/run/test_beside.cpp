#include <catch2/catch.hpp>

#include <set>

#include "collision/geometry/error.hpp"
#include "collision/geometry/parallel.hpp"
#include "physics/steppers/finish_step.hpp"
#include "pipeline/run/arrangement.hpp"
#include "pipeline/run/simulate.hpp"
#include "pipeline/scene/make_stepper.hpp"
#include "tests/pipeline/run/sheet_over_ball.hpp"

// What a run does beside its steps changes no frame.
namespace selvedge::test_beside {

namespace {

// A sheet that falls, and stops where a state is not clean. In planted frames the still tetrahedron goes through it.
class PlantedStepper final : public Stepper {
 public:
  explicit PlantedStepper(std::set<int> planted, int fails_at = 1 << 30)
      : planted_(std::move(planted)), fails_at_(fails_at) {}
  const StepperTraits& traits() const override { return traits_; }
  StepReport step(const State& from, const Drive& drive, double dt, State& to, const StepExtras&) override {
    ++steps;
    StepReport report;
    StepEnd end{from.x, from.v, drive.obstacles};
    if (from.clean)
      end.v.rowwise() += dt * drive.acceleration.transpose();
    else
      end.v.setZero();
    end.x += dt * end.v;
    if (planted_.contains(from.frame + 1)) end.obstacles[0] = fake::tetrahedron_points(0.5, end.x(0, 1) - 0.05);
    finish_step(from, drive, dt, std::move(end), to, report);
    if (to.frame >= fails_at_) report.status = StepStatus::rejected;
    return report;
  }
  int steps = 0;

 private:
  std::set<int> planted_;
  int fails_at_;
  StepperTraits traits_{"planted"};
};

struct Seen {
  int frame, pairs, wanted, audits;
  bool clean, pinched;
  StepStatus status;
  Reason reason;
  Doubts doubts;
  Points x, v;
  bool operator==(const Seen&) const = default;
};

struct Watched {
  std::vector<Seen> frames;
  State end;
  int steps = 0;
  std::string error;
};

Watched watch(int threads, const std::set<int>& planted, int frames, int fails_at = 1 << 30, int ends_at = 1 << 30,
              double no_drive_at = 1e9) {
  const ThreadLimit limit(threads);
  const Setup setup = fake::setup();
  PlantedStepper stepper(planted, fails_at);
  Watched watched;
  watched.end = setup.initial;
  watched.end.clean = true;
  const auto drive_at = [&](double time) {
    if (time > no_drive_at) throw Error("no drive", "here", "none");
    return setup.drive_at(time);
  };
  const auto sink = [&](const FrameEvent& event) {
    const CollisionReport& found = event.report.collision;
    watched.frames.push_back({event.state.frame, found.pairs_after, found.pairs_wanted, event.report.counts.audits,
                              event.state.clean, event.state.pinched, event.report.status, event.report.reason,
                              event.report.doubts, event.state.x, event.state.v});
    return event.state.frame < ends_at;
  };
  try {
    simulate(setup.scene, stepper, drive_at, 0.02, frames, watched.end, sink);
  } catch (const Error& error) {
    watched.error = error.what();
  }
  watched.steps = stepper.steps;
  return watched;
}

void check_same(const Watched& alone, const Watched& beside) {
  CHECK(alone.frames == beside.frames);
  CHECK(alone.end.frame == beside.end.frame);
  CHECK(alone.end.x == beside.end.x);
  CHECK(alone.end.clean == beside.end.clean);
  CHECK(alone.error == beside.error);
}

}  // namespace

TEST_CASE("beside: planted frames that are not clean give the same frames", "[beside]") {
  for (const std::set<int>& planted : std::vector<std::set<int>>{{}, {1}, {2}, {3}, {4}, {2, 3}, {1, 3, 5, 6}, {10}}) {
    const Watched alone = watch(1, planted, 10), beside = watch(2, planted, 10);
    REQUIRE(alone.frames.size() == 10);
    check_same(alone, beside);
    CHECK(alone.steps == 10);
    for (const Seen& seen : alone.frames) CHECK((seen.pairs > 0) == planted.contains(seen.frame));
  }
  // The first frames are made with a thread beside: what was stepped from the one that is not clean is stepped again.
  if (has_openmp()) CHECK(watch(2, {2}, 3).steps == 4);
}

TEST_CASE("beside: a run ends where it would without", "[beside]") {
  for (int at = 1; at <= 4; ++at) {
    check_same(watch(1, {}, 6, at), watch(2, {}, 6, at));      // a step is rejected
    check_same(watch(1, {at}, 6, at), watch(2, {at}, 6, at));  // one that is not clean
    check_same(watch(1, {at}, 6, at + 1), watch(2, {at}, 6, at + 1));
    check_same(watch(1, {}, 6, 1 << 30, at), watch(2, {}, 6, 1 << 30, at));  // the sink has enough
    const Watched alone = watch(1, {2}, 6, 1 << 30, 1 << 30, 0.02 * at + 0.01),
                  beside = watch(2, {2}, 6, 1 << 30, 1 << 30, 0.02 * at + 0.01);  // the world ends
    check_same(alone, beside);
    CHECK_FALSE(alone.error.empty());
    CHECK(static_cast<int>(alone.frames.size()) == at);
  }
}

TEST_CASE("beside: a scene has the same file on one thread and on two", "[beside]") {
  const fake::Folder folder("beside");
  const Setup setup = fake::sheet_over_ball(folder, 0.13, 14);
  const auto run = [&](int threads) {
    const ThreadLimit limit(threads);
    const std::filesystem::path out = folder.path / std::to_string(threads);
    fake::run(setup, *make_stepper(setup), out);
    return out / "run.h5";
  };
  const TrajectoryReader alone(run(1)), beside(run(2));
  REQUIRE(alone.frame_count() == 15);
  REQUIRE(beside.frame_count() == 15);
  int contacts = 0;
  for (int i = 0; i < 15; ++i) {
    const Frame a = alone.frame(i), b = beside.frame(i);
    CHECK(a.x == b.x);
    CHECK(a.report.counts.audits == b.report.counts.audits);
    CHECK(a.report.collision.passed_through == b.report.collision.passed_through);
    CHECK(a.report.collision.pairs_after == b.report.collision.pairs_after);
    contacts += a.report.collision.contacts;
  }
  CHECK(contacts > 0);
}

TEST_CASE("beside: the faster arrangement is kept, and the other tried again", "[beside]") {
  for (const bool beside_is_faster : {true, false}) {
    for (const double growth : {0.0, 0.1}) {  // of a frame's time, from each frame to the next
      INFO("beside is faster: " << beside_is_faster << ", growth " << growth);
      Arrangement arrangement;
      std::vector<bool> used;
      for (int frame = 0; frame < 120; ++frame) {
        used.push_back(arrangement.beside());
        const bool first = frame == 0 || used[used.size() - 2] != used.back();  // says nothing
        arrangement.took((1 + growth * frame) * (first ? 10 : used.back() == beside_is_faster ? 1 : 1.2));
      }
      CHECK(std::vector<bool>(used.begin(), used.begin() + 9) ==
            std::vector<bool>{true, true, true, false, false, false, true, true, true});
      const auto slower = std::count(used.begin() + 9, used.end(), !beside_is_faster);
      CHECK(slower >= 3 * 4);  // tried again and again
      CHECK(slower <= 3 * 6);
    }
  }
}

TEST_CASE("beside: all threads step only where that is faster by more than a twentieth", "[beside]") {
  for (const double alone : {0.97, 0.93}) {
    Arrangement arrangement;
    for (int frame = 0; frame < 9; ++frame) arrangement.took(arrangement.beside() ? 1 : alone);
    CHECK(arrangement.beside() == (alone > 0.95));
  }
}

}  // namespace selvedge::test_beside
