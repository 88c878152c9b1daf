#include <catch2/catch.hpp>

#include "learned/steppers/learned_state.hpp"
#include "learned/steppers/learned_stepper.hpp"
#include "physics/energies/measures.hpp"
#include "physics/steppers/carried_stepper.hpp"
#include "physics/steppers/decorated_stepper.hpp"
#include "physics/steppers/hybrid_stepper.hpp"
#include "tests/frame.hpp"
#include "tests/learned/learned_scenes.hpp"

// Networks whose output is added to the carried guess, behind the stepper interface.
namespace selvedge::test_student {

namespace {

constexpr double frame_dt = 1.0 / 30;

// A sheet that a plate wears, without gravity: its skinned targets turn and move with the plate, and into it, by `sink`
// times the number of the frame [m].
fake::LearnedCase worn_sheet(int frames, double sink = 1.5e-3) {
  fake::Mesh plate = fake::grid(5, 5, 0.04);
  plate.x.col(1).array() -= 0.012;
  fake::LearnedCase worn = fake::learned_case(fake::grid(7, 8), plate, {0, 0, 0}, frames);
  worn.state.clean = true;
  for (int frame = 1; frame <= frames; ++frame) {
    Drive& drive = worn.drives[static_cast<std::size_t>(frame - 1)];
    const Mat3 turn = Eigen::AngleAxisd(0.04 * frame, Vec3(0.2, 1, 0.1).normalized()).toRotationMatrix();
    const auto carried = [&](const Points& x) -> Points {
      return (x * turn.transpose()).rowwise() + 1e-3 * frame * Eigen::RowVector3d(1, 2, 0);
    };
    drive.skinned_targets = carried(worn.state.x);
    drive.skinned_targets.col(1).array() -= sink * frame;
    drive.acceleration.setZero();
    drive.obstacles = {carried(plate.x)};
    drive.pins = drive.skinned_targets.topRows(1);
  }
  return worn;
}

double stretch_of(const Scene& scene, const Points& x) { return principal_stretches(scene, x).col(1).maxCoeff(); }

// All weights of the decoder are zero.
fake::NarrowNetwork silent_student() {
  fake::NarrowNetwork student = fake::narrow_network("student");
  for (AffineLayer& layer : student.weights.decoder.layers) {
    layer.weight.setZero();
    std::ranges::fill(layer.bias, 0.f);
  }
  return student;
}

std::unique_ptr<Stepper> learned(const Scene& scene, const fake::NarrowNetwork& network) {
  return make_learned_stepper(scene, network.architecture, network.weights);
}

// Nothing is solved behind the response, so that cloth which meets the plate is stretched.
std::unique_ptr<Stepper> hybrid(const Scene& scene, const fake::NarrowNetwork& network, HybridMode mode,
                                double stretch = 10) {
  HybridParts parts{learned(scene, network), make_recovering_conventional_stepper(scene)};
  parts.hand_over = [features = network.architecture.features](const State& from, const Drive& drive, State& to) {
    carry_frame(features, from, drive, to);
  };
  HybridOptions options;
  options.mode = mode;
  options.longest_stretch = 1;
  options.guard.stretch = stretch;
  return make_hybrid_stepper(scene, std::move(parts), options);
}

}  // namespace

TEST_CASE("student: without an output it makes the carried guess", "[learned][student]") {
  const fake::LearnedCase worn = worn_sheet(4);
  const auto silent = learned(worn.scene, silent_student()),
             speaking = learned(worn.scene, fake::narrow_network("student"));
  State from = worn.state;
  for (const Drive& drive : worn.drives) {
    State to, other;
    REQUIRE(testing::frame(worn.scene, *silent, from, drive, frame_dt, to).status == StepStatus::accepted);
    CHECK(fake::same_points(to.x, carried_guess(worn.scene, from, drive, frame_dt)));
    REQUIRE(testing::frame(worn.scene, *speaking, from, drive, frame_dt, other).status == StepStatus::accepted);
    CHECK_FALSE(fake::same_points(to.x, other.x));
    CHECK(carried_targets(to));
    from = to;
  }
}

TEST_CASE("student: without an output, and with the response behind it, it is the stepper `carried`, bit for bit",
          "[learned][student][hybrid]") {
  // It touches the plate, and does not meet it so deep that the response's stretch is energy from nowhere.
  const fake::LearnedCase worn = worn_sheet(12, 1e-3);
  const auto stepper = hybrid(worn.scene, silent_student(), HybridMode::response);
  const auto carried = make_carried_stepper(worn.scene);
  State from = worn.state;
  int proposed = 0, touched = 0;
  for (const Drive& drive : worn.drives) {
    State to, baseline;
    const StepReport report = testing::frame(worn.scene, *stepper, from, drive, frame_dt, to);
    REQUIRE(report.status == StepStatus::accepted);
    testing::frame(worn.scene, *carried, from, drive, frame_dt, baseline);
    if (report.verdict == Verdict::admitted) {
      ++proposed;
      touched += report.collision.impulses;
      CHECK(fake::same_points(to.x, baseline.x));
      CHECK(fake::same_points(to.v, baseline.v));
      for (const MemoryBlock& block : baseline.memory) {
        INFO(block.name);
        const MemoryRows* kept = find_rows(to.memory, block.name, block.rows.rows());
        REQUIRE(kept);
        CHECK((kept->array() == block.rows.array()).all());
      }
    }
    from = to;
  }
  CHECK(proposed >= 3);
  CHECK(touched > 0);
}

TEST_CASE("student: cloth that the response has stretched too far is refused", "[learned][student][hybrid]") {
  const fake::LearnedCase worn = worn_sheet(12);
  const GuardOptions bounds;
  const auto stepper = hybrid(worn.scene, silent_student(), HybridMode::response, bounds.stretch);
  State from = worn.state;
  int refused = 0;
  for (const Drive& drive : worn.drives) {
    State to;
    const StepReport report = testing::frame(worn.scene, *stepper, from, drive, frame_dt, to);
    REQUIRE(report.status == StepStatus::accepted);
    refused += report.verdict == Verdict::overstretched;
    const double most = std::max(bounds.stretch, bounds.stretch_growth * stretch_of(worn.scene, from.x));
    if (report.verdict == Verdict::admitted) CHECK(stretch_of(worn.scene, to.x) <= most);
    from = to;
  }
  CHECK(refused > 0);
}

TEST_CASE("student: the frames that turn its output are those of the skinned targets", "[learned][student]") {
  const fake::LearnedCase worn = worn_sheet(2);
  State from = worn.state;
  from.memory = carried_memory({}, worn.drives[0], worn.drives[0].skinned_targets);
  GraphState state = graph_state(worn.scene, from, worn.drives[1]);
  set_carried_base(worn.scene, from, worn.drives[1], frame_dt, state);
  REQUIRE(state.frames.size() == 56);
  const Mat3 turn = Eigen::AngleAxisd(0.04, Vec3(0.2, 1, 0.1).normalized()).toRotationMatrix();
  CHECK((state.frames[10] - turn * state.heading).norm() < 1e-9);
  const Drive &before = worn.drives[0], &now = worn.drives[1];
  CHECK((state.worn_motion - (now.skinned_targets - before.skinned_targets)).norm() < 1e-12);
  CHECK((state.worn_offset - (from.x - before.skinned_targets)).norm() < 1e-12);
  const double angle = std::atan2(state.heading(0, 2), state.heading(0, 0));
  CHECK(angle == Approx(0.08).epsilon(0.1));  // most of the turn is about the vertical
  CHECK((state.heading - Eigen::AngleAxisd(angle, Vec3::UnitY()).toRotationMatrix()).norm() < 1e-12);
  from.memory.clear();  // nothing is known of the last frame
  set_carried_base(worn.scene, from, worn.drives[1], frame_dt, state);
  CHECK(state.frames.empty());
  CHECK(state.heading == Mat3::Identity());
  CHECK(state.worn_offset.rows() == 0);
  Drive bare = worn.drives[1];
  bare.skinned_targets.resize(0, 3);
  bare.acceleration = {0, -9.81, 0};
  set_carried_base(worn.scene, from, bare, frame_dt, state);
  CHECK(state.frames.empty());
  CHECK(state.guess(20, 1) == Approx(from.x(20, 1) - 9.81 * frame_dt * frame_dt));
}

TEST_CASE("student: a scene that is turned about the vertical gives the same cloth, turned", "[learned][student]") {
  const fake::LearnedCase worn = worn_sheet(4);
  const Mat3 by = Eigen::AngleAxisd(2.3, Vec3::UnitY()).toRotationMatrix();
  const auto turned = [&](const Points& x) -> Points { return x * by.transpose(); };
  const fake::NarrowNetwork network = fake::narrow_network("student");
  const bool step_lengths = GENERATE(false, true);
  const auto stepper = [&] {
    return make_learned_stepper(worn.scene, network.architecture, network.weights, {.step_lengths = step_lengths});
  };
  const auto here = stepper(), there = stepper();  // the rest shape is the same
  State from = worn.state;
  int compared = 0;
  for (const Drive& drive : worn.drives) {
    State other = from;
    other.x = turned(from.x);
    other.v = turned(from.v);
    other.obstacles = {turned(from.obstacles[0])};
    for (MemoryBlock& block : other.memory) block.rows = (block.rows * by.transpose()).eval();
    Drive same = drive;
    same.skinned_targets = turned(drive.skinned_targets);
    same.obstacles = {turned(drive.obstacles[0])};
    same.pins = turned(drive.pins);
    State to, turned_to;
    REQUIRE(here->step(from, drive, frame_dt, to).status == StepStatus::accepted);
    REQUIRE(there->step(other, same, frame_dt, turned_to).status == StepStatus::accepted);
    if (carried_targets(from)) {  // before, nothing is known of how the cloth is worn
      CHECK((turned(to.x) - turned_to.x).cwiseAbs().maxCoeff() < 1e-7);
      if (!step_lengths) CHECK((to.x - carried_guess(worn.scene, from, drive, frame_dt)).cwiseAbs().maxCoeff() > 1e-5);
      ++compared;
    }
    from = std::move(to);
  }
  CHECK(compared == 3);
}

TEST_CASE("student: random weights end clean behind the response and behind a rough solve",
          "[learned][student][hybrid]") {
  const fake::LearnedCase worn = worn_sheet(7);
  for (const HybridMode mode : {HybridMode::response, HybridMode::rough})
    for (const double reach : {1e-4, 1e-2, 1e3}) {
      INFO("mode " << static_cast<int>(mode) << ", reach " << reach);
      fake::NarrowNetwork student = fake::narrow_network("student", reach);
      const auto stepper = hybrid(worn.scene, student, mode);
      State from = worn.state;
      for (const Drive& drive : worn.drives) {
        State to;
        const StepReport report = testing::frame(worn.scene, *stepper, from, drive, frame_dt, to);
        REQUIRE(report.status == StepStatus::accepted);
        CHECK(report.collision.passed_through == 0);
        CHECK(to.clean);
        from = to;
      }
    }
}

TEST_CASE("student: it never settles, and knows gravity and wind", "[learned][student]") {
  const fake::LearnedCase worn = worn_sheet(1);
  const fake::NarrowNetwork student = fake::narrow_network("student");
  CHECK_FALSE(may_settle(student.architecture));
  const StepperTraits traits = learned_traits(student.architecture);
  CHECK(std::ranges::find(traits.ignores, "wind") == traits.ignores.end());
  const std::vector<PlanLine> lines = learned_plan_lines(worn.scene, student.architecture, {.settle = true});
  const auto settling = std::ranges::find(lines, "settling pass", &PlanLine::feature);
  REQUIRE(settling != lines.end());
  CHECK_FALSE(settling->in);
  State settled, plain;
  const auto one = make_learned_stepper(worn.scene, student.architecture, student.weights, {.settle = true});
  testing::frame(worn.scene, *one, worn.state, worn.drives[0], frame_dt, settled);
  testing::frame(worn.scene, *learned(worn.scene, student), worn.state, worn.drives[0], frame_dt, plain);
  CHECK(fake::same_state(settled, plain));
}

}  // namespace selvedge::test_student
