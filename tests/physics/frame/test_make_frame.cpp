#include "physics/frame/make_frame.hpp"

#include "collision/geometry/parallel.hpp"
#include "physics/scene/part_of_scene.hpp"
#include "physics/steppers/finish_step.hpp"
#include "tests/physics/worlds.hpp"

namespace selvedge::test_make_frame {

using testing::World;

namespace {

constexpr double dt = 1.0 / 30;

Points raised(Points x, double height) {
  x.col(1).array() += height;
  return x;
}

// Lifts or lowers all cloth, substep by substep, whatever is there.
class LiftingStepper final : public Stepper {
 public:
  explicit LiftingStepper(std::vector<double> heights, std::optional<Exemption> left_alone = {})
      : heights_(std::move(heights)), left_alone_(std::move(left_alone)) {}
  const StepperTraits& traits() const override { return traits_; }
  StepReport step(const State& from, const Drive& drive, double h, State& to, const StepExtras&) override {
    StepReport report;
    report.by = traits_.name;
    report.path.start = gather_nodes(from.x, from.obstacles);
    for (const double height : heights_)
      report.path.substeps.push_back({gather_nodes(raised(from.x, height), drive.obstacles), left_alone_});
    const double end = heights_.empty() ? 0 : heights_.back();
    finish_step(from, drive, h, {raised(from.x, end), from.v, drive.obstacles}, to, report);
    return report;
  }

 private:
  std::vector<double> heights_;
  std::optional<Exemption> left_alone_;
  StepperTraits traits_{"lifting"};
};

struct Made {
  StepReport report;
  State to;
};

Made make(const World& w, Stepper& stepper, const StepExtras& extras = {}) {
  Made made;
  made.report = testing::frame(w.scene, stepper, w.state, w.drive, dt, made.to, extras);
  return made;
}

Made lift(const World& w, std::vector<double> heights, std::optional<Exemption> left_alone = {}) {
  LiftingStepper stepper(std::move(heights), std::move(left_alone));
  return make(w, stepper);
}

}  // namespace

TEST_CASE("make_frame: an excursion between two substeps is found, though the frame ends where it began",
          "[make_frame]") {
  const World w = testing::sheet_over_plate();
  const Made there_and_back = lift(w, {-0.1, 0.0});
  const Made there = lift(w, {-0.1});  // half of the way
  CHECK(there.report.collision.passed_through > 0);
  CHECK(there_and_back.report.collision.passed_through == 2 * there.report.collision.passed_through);
  CHECK(there_and_back.report.collision.pairs_after == 0);
  CHECK(there_and_back.report.counts.audits == 3);
  CHECK(there_and_back.to.clean);
  const Made above = lift(w, {-0.02, 0.0});
  CHECK(above.report.collision.passed_through == 0);
  CHECK(above.report.path.substeps.empty());  // nobody needs it any more
}

TEST_CASE("make_frame: a step that names no path is audited along the straight one", "[make_frame]") {
  const World w = testing::sheet_over_plate();
  class Falling final : public Stepper {
   public:
    const StepperTraits& traits() const override { return traits_; }
    StepReport step(const State& from, const Drive& drive, double h, State& to, const StepExtras&) override {
      StepReport report;
      finish_step(from, drive, h, {raised(from.x, -0.1), from.v, drive.obstacles}, to, report);
      return report;
    }

   private:
    StepperTraits traits_{"falling"};
  } falling;
  CHECK(make(w, falling).report.collision.passed_through > 0);
}

TEST_CASE("make_frame: the state's verdict names what crosses", "[make_frame]") {
  World w = testing::sheet_over_plate();
  const Made clean = lift(w, {0.01});
  CHECK(clean.to.clean);
  REQUIRE(clean.report.audit);
  CHECK_FALSE(clean.report.doubts.any());

  for (int v = 0; v < 12; ++v) w.state.x(v, 1) -= 0.1;
  const Made crossing = lift(w, {0.001});
  CHECK(crossing.report.status == StepStatus::accepted);
  CHECK(crossing.report.collision.pairs_after > 0);
  CHECK(crossing.report.collision.pairs_wanted == crossing.report.collision.pairs_after);
  CHECK(crossing.report.reason == Reason::none);
  CHECK(crossing.report.doubts == Doubts{.penetrating = true});
  CHECK_FALSE(crossing.to.clean);

  State to;  // it stands beside what the step says itself
  StepReport rough;
  rough.doubts.not_converged = true;
  finish_step(w.state, w.drive, dt, {w.state.x, w.state.v, w.drive.obstacles}, to, rough);
  FrameAudits audits(w.scene);
  CHECK_FALSE(judge_frame(audits, w.state, w.drive, to, rough));
  CHECK(rough.doubts == Doubts{.not_converged = true, .penetrating = true});
}

TEST_CASE("make_frame: pairs that a substep left alone are not asked about, and without a word what crosses is not",
          "[make_frame]") {
  const World w = testing::sheet_over_plate();
  Exemption all;
  all.body.assign(static_cast<std::size_t>(w.state.x.rows()), 1);
  CHECK(lift(w, {-0.1}, all).report.collision.passed_through == 0);
  CHECK(lift(w, {-0.1}, Exemption{}).report.collision.passed_through > 0);

  World tangled = testing::sheet_over_plate();  // half of it hangs below the plate, and moves aside
  for (int v = 0; v < 12; ++v) tangled.state.x(v, 1) -= 0.1;
  tangled.state.clean = false;
  const Made made = lift(tangled, {0.001});
  CHECK(made.report.collision.left_alone > 0);
  CHECK(made.report.collision.passed_through < lift(tangled, {0.001}, Exemption{}).report.collision.passed_through);
}

TEST_CASE("make_frame: of a step of a part of the scene that part's motion is audited, and the whole state",
          "[make_frame]") {
  World w = make_world(testing::join(testing::sheet(4, 0.2, 0.05), testing::sheet(4, 0.2, 0.2)));
  w.scene.cloths = {w.scene.cloths[0], w.scene.cloths[0]};
  for (int c = 0; c < 2; ++c) {
    w.scene.cloths[c].first_vertex = 25 * c;
    w.scene.cloths[c].vertex_count = 25;
    w.scene.cloths[c].first_triangle = 32 * c;
    w.scene.cloths[c].triangle_count = 32;
  }
  add_obstacle(w, testing::sheet(2, 0.6, 0));
  w.state.clean = true;
  // Steps the upper sheet alone, through the plate and back, or onto the lower one.
  class UpperOnly final : public Stepper {
   public:
    UpperOnly(const Scene& scene, std::vector<double> heights)
        : part_(std::make_shared<const PartOfScene>(part_of(scene, std::vector<char>{0, 1}))),
          heights_(std::move(heights)) {}
    const StepperTraits& traits() const override { return traits_; }
    StepReport step(const State& from, const Drive& drive, double h, State& to, const StepExtras&) override {
      LiftingStepper lifting(heights_);
      State end;
      to = from;
      StepReport report = lifting.step(state_of(*part_, from), drive_of(*part_, drive), h, end, {});
      put(*part_, end, to);
      report.path.part = part_;
      return report;
    }

   private:
    std::shared_ptr<const PartOfScene> part_;
    std::vector<double> heights_;
    StepperTraits traits_{"upper only"};
  };
  UpperOnly through(w.scene, {-0.25, 0.0}), onto(w.scene, {-0.15});
  const Made back = make(w, through);
  CHECK(back.report.collision.passed_through > 0);
  CHECK(back.to.clean);
  for (int v = 25; v < 50; v += 2) w.state.x(v, 1) += 0.01;
  CHECK_FALSE(make(w, onto).to.clean);
}

TEST_CASE("make_frame: what the stepper has audited itself is not audited again", "[make_frame]") {
  const World w = testing::sheet_over_plate();
  class Audited final : public Stepper {
   public:
    explicit Audited(const Scene& scene) : audits_(scene) {}
    const StepperTraits& traits() const override { return inner_.traits(); }
    StepReport step(const State& from, const Drive& drive, double h, State& to, const StepExtras&) override {
      StepReport report = inner_.step(from, drive, h, to, {});
      to.clean = judge_frame(audits_, from, drive, to, report);
      return report;
    }

   private:
    LiftingStepper inner_{{-0.1, 0.0}};
    FrameAudits audits_;
  } audited(w.scene);
  const Made made = make(w, audited), once = lift(w, {-0.1, 0.0});
  CHECK(made.report.counts.audits == once.report.counts.audits);
  CHECK(made.report.collision.passed_through == once.report.collision.passed_through);
  CHECK(made.to.clean);
}

TEST_CASE("make_frame: a stop ends the audits, too, and a rejected step is not audited", "[make_frame]") {
  const World w = testing::sheet_over_plate();
  LiftingStepper stepper({-0.1, 0.0});
  const ThreadLimit alone(1);  // with others this thread may get nothing of so small a loop, and then it does not ask
  const Made stopped = make(w, stepper, {.stop = [] { return true; }});
  CHECK(stopped.report.status == StepStatus::rejected);
  CHECK(stopped.report.reason == Reason::stopped);

  World broken = w;
  broken.state.x(3, 1) = std::numeric_limits<double>::quiet_NaN();
  const auto conventional = testing::conventional(w.scene);
  const Made rejected = make(broken, *conventional);
  CHECK(rejected.report.reason == Reason::not_finite);
  CHECK(rejected.report.counts.audits == 0);
  CHECK_FALSE(rejected.report.audit);
}

TEST_CASE("audit of a motion: what it gave up is labelled, and counts as passed through", "[make_frame]") {
  StepReport report;
  MotionAudit whole, part;
  whole.passed.resize(2);
  add(whole, report);
  CHECK(report.collision.passed_through == 2);
  CHECK_FALSE(report.out_of_proofs);
  part.given_up = 3;
  add(part, report);
  add(whole, report);
  CHECK(report.collision.passed_through == 7);
  CHECK(report.out_of_proofs);
}

}  // namespace selvedge::test_make_frame
