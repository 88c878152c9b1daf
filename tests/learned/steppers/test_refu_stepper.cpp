#include <catch2/catch.hpp>

#include <cstring>

#include "learned/steppers/refu_stepper.hpp"
#include "tests/collision/solids.hpp"
#include "tests/frame.hpp"
#include "tests/learned/learned_scenes.hpp"

namespace selvedge::test_refu_stepper {

namespace {

// Moves all cloth by a way a step, whatever is there, and reports what a stepper with contact would.
class BlindStepper final : public Stepper {
 public:
  BlindStepper(const Scene& scene, Eigen::RowVector3d way) : scene_(scene), way_(std::move(way)) {}
  const StepperTraits& traits() const override { return traits_; }
  StepReport step(const State& from, const Drive& drive, double dt, State& to, const StepExtras& = {}) override {
    StepReport report;
    report.by = traits_.name;
    report.status = way_.allFinite() ? StepStatus::accepted : StepStatus::rejected;
    to = from;
    to.time += dt;
    ++to.frame;
    to.x.rowwise() += way_;
    for (std::size_t k = 0; k < scene_.pins.size(); ++k)
      to.x.row(scene_.pins[k]) = drive.pins.row(static_cast<Eigen::Index>(k));
    to.v = (to.x - from.x) / dt;
    to.obstacles = drive.obstacles;
    to.memory = {{"learned.velocity", to.v / 30}};
    return report;
  }

 private:
  const Scene& scene_;
  Eigen::RowVector3d way_;
  StepperTraits traits_{"blind"};
};

// A sheet above a ball.
fake::LearnedCase sheet_over_ball() {
  const testing::Solid ball = testing::ball(10);
  fake::Mesh body{0.1 * ball.x, ball.surface.triangles}, cloth = fake::grid(9, 9);
  cloth.x.rowwise() += Eigen::RowVector3d(-0.08, 0.12, -0.08);
  return fake::learned_case(cloth, body, {0, 0.001, 0}, 3);
}

bool same_report(const StepReport& a, const StepReport& b) {
  return a.status == b.status && a.reason == b.reason && a.doubts == b.doubts &&
         a.collision.pushed_out == b.collision.pushed_out && a.audit.has_value() == b.audit.has_value();
}

}  // namespace

TEST_CASE("refu stepper: the same bits where nothing is inside, and where a step is rejected", "[refu]") {
  const fake::LearnedCase made = sheet_over_ball();
  for (const double down : {0.001, std::numeric_limits<double>::quiet_NaN()}) {
    const Eigen::RowVector3d way(0, -down, 0);
    BlindStepper plain(made.scene, way);
    const auto refu = make_refu_stepper(made.scene, std::make_unique<BlindStepper>(made.scene, way));
    State expected, found;
    const StepReport a = testing::frame(made.scene, plain, made.state, made.drives[0], 1.0 / 30, expected);
    const StepReport b = testing::frame(made.scene, *refu, made.state, made.drives[0], 1.0 / 30, found);
    CHECK(same_report(a, b));
    if (a.status == StepStatus::accepted) CHECK(fake::same_state(expected, found));
  }
  CHECK(make_refu_stepper(made.scene, std::make_unique<BlindStepper>(made.scene, Eigen::RowVector3d(0, 0, 0)))
            ->traits()
            .name == "blind");
}

TEST_CASE("refu stepper: what is inside comes out, no faster than the body, and pins stay", "[refu]") {
  const fake::LearnedCase made = sheet_over_ball();
  const Eigen::RowVector3d way(0, -0.04, 0);
  for (const bool budget : {true, false}) {
    RefuOptions options;
    options.budget = budget;
    const auto refu = make_refu_stepper(made.scene, std::make_unique<BlindStepper>(made.scene, way), options);
    State from = made.state, to;
    int pushed = 0;
    for (const Drive& drive : made.drives) {
      State blind;
      BlindStepper(made.scene, way).step(from, drive, 1.0 / 30, blind);
      const StepReport report = testing::frame(made.scene, *refu, from, drive, 1.0 / 30, to);
      REQUIRE(report.status == StepStatus::accepted);
      pushed += report.collision.pushed_out;
      DistanceField field(made.scene.obstacles[0].surface);
      field.move_to(to.obstacles[0]);
      const std::vector<SignedDistance> found = field.ask(to.x);
      for (int v = 0; v < to.x.rows(); ++v) {
        const SignedDistance& at = found[static_cast<std::size_t>(v)];
        if (v == made.scene.pins[0]) {
          CHECK(to.x.row(v) == blind.x.row(v));
        } else {
          CHECK(at.value > -1e-6);
        }
        if (to.x.row(v) == blind.x.row(v)) {
          CHECK(to.v.row(v) == blind.v.row(v));
          continue;
        }
        const Vec3 body_velocity(0, 0.001 * 30, 0);
        const double before = at.gradient.dot(row(blind.v, v)), after = at.gradient.dot(row(to.v, v));
        CHECK(after >= before - 1e-9);
        CHECK(after <= std::max(before, at.gradient.dot(body_velocity)) + 1e-6);
        CHECK((to.memory[0].rows.row(v) - to.v.row(v) / 30).norm() < 1e-12);
      }
      if (report.collision.pushed_out > 0) CHECK(report.audit.has_value());
      from = to;
    }
    CHECK(pushed > 5);
  }
}

TEST_CASE("refu stepper: the motion to where cloth is pushed is audited", "[refu]") {
  const fake::LearnedCase made = sheet_over_ball();
  const auto passed = [&](double down) {
    const auto refu =
        make_refu_stepper(made.scene, std::make_unique<BlindStepper>(made.scene, Eigen::RowVector3d(0, -down, 0)));
    State to;
    const StepReport report = testing::frame(made.scene, *refu, made.state, made.drives[0], 1.0 / 30, to);
    CHECK(report.collision.pushed_out > 0);
    return report.collision.passed_through;
  };
  CHECK(passed(0.19) > 0);  // through the ball: its far side is the nearest
  CHECK(passed(0.04) < passed(0.19));
}

TEST_CASE("refu stepper: scales by neighbours push farther than the surface, and nothing else moves", "[refu]") {
  const fake::LearnedCase made = sheet_over_ball();
  const Eigen::RowVector3d way(0, -0.04, 0);
  RefuOptions plain, scaled;
  NeighbourScale scales = make_neighbour_scale({}, 2);
  scales.end.layers.back().weight.setZero();
  scales.end.layers.back().bias[0] = 1;  // 1 + log(1 + e) times the depth
  scaled.neighbours = std::make_shared<const NeighbourScale>(scales);
  State surface, farther;
  const auto step = [&](const RefuOptions& options, State& to) {
    return testing::frame(made.scene,
                          *make_refu_stepper(made.scene, std::make_unique<BlindStepper>(made.scene, way), options),
                          made.state, made.drives[0], 1.0 / 30, to)
        .collision.pushed_out;
  };
  const int pushed = step(plain, surface);
  CHECK(step(scaled, farther) == pushed);
  DistanceField field(made.scene.obstacles[0].surface);
  field.move_to(surface.obstacles[0]);
  const std::vector<SignedDistance> near = field.ask(surface.x), far = field.ask(farther.x);
  int moved = 0;
  for (int v = 0; v < surface.x.rows(); ++v) {
    if (surface.x.row(v) == farther.x.row(v)) continue;
    ++moved;
    CHECK(far[static_cast<std::size_t>(v)].value > near[static_cast<std::size_t>(v)].value);
  }
  CHECK(moved > 3);
  CHECK(moved <= pushed);
}

TEST_CASE("refu stepper: vertices on faces, edges and corners, and flat bodies, leave the cloth finite", "[refu]") {
  for (const Vec3& half : {Vec3(0.08, 0.02, 0.08), Vec3(0.08, 0, 0.08), Vec3(0, 0, 0)}) {
    const testing::Solid body = testing::block(-half, half, 2);
    fake::Mesh cloth = fake::grid(9, 9);
    cloth.x.rowwise() += Eigen::RowVector3d(-0.08, half.y(), -0.08);  // its rim over that of the body's top
    const fake::LearnedCase made = fake::learned_case(cloth, {body.x, body.surface.triangles}, {0, 0, 0}, 1);
    for (const double down : {0.0, 0.01}) {
      const Eigen::RowVector3d way(0, -down, 0);
      State to;
      const StepReport report =
          testing::frame(made.scene, *make_refu_stepper(made.scene, std::make_unique<BlindStepper>(made.scene, way)),
                         made.state, made.drives[0], 1.0 / 30, to);
      REQUIRE(report.status == StepStatus::accepted);
      CHECK(to.x.allFinite());
      CHECK(to.v.allFinite());
      CHECK((to.x - made.state.x).rowwise().norm().maxCoeff() < 0.05);
      DistanceField field(made.scene.obstacles[0].surface);
      field.move_to(to.obstacles[0]);
      for (const SignedDistance& at : field.ask(to.x)) CHECK(at.value > -1e-6);
    }
  }
}

TEST_CASE("refu stepper: where a body or the cloth is not finite, the step is as the inner stepper made it", "[refu]") {
  const fake::LearnedCase made = sheet_over_ball();
  for (const bool in_body : {true, false}) {
    State from = made.state, expected, found;
    Drive drive = made.drives[0];
    (in_body ? drive.obstacles[0] : from.x)(5, 1) = std::numeric_limits<double>::quiet_NaN();
    const Eigen::RowVector3d way(0, -0.04, 0);
    BlindStepper(made.scene, way).step(from, drive, 1.0 / 30, expected);
    testing::frame(made.scene, *make_refu_stepper(made.scene, std::make_unique<BlindStepper>(made.scene, way)), from,
                   drive, 1.0 / 30, found);
    REQUIRE(found.x.rows() == expected.x.rows());
    CHECK(std::memcmp(found.x.data(), expected.x.data(), sizeof(double) * static_cast<std::size_t>(found.x.size())) ==
          0);
    CHECK(std::memcmp(found.v.data(), expected.v.data(), sizeof(double) * static_cast<std::size_t>(found.v.size())) ==
          0);
  }
}

TEST_CASE("refu stepper: without a closed body it is left out", "[refu]") {
  fake::LearnedCase made = sheet_over_ball();
  made.scene.obstacles.clear();
  auto inner = std::make_unique<BlindStepper>(made.scene, Eigen::RowVector3d(0, -0.01, 0));
  const Stepper* kept = inner.get();
  CHECK(make_refu_stepper(made.scene, std::move(inner)).get() == kept);
}

}  // namespace selvedge::test_refu_stepper
