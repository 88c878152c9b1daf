#include <catch2/catch.hpp>

#include <cmath>

#include "collision/geometry/error.hpp"
#include "physics/steppers/decorated_stepper.hpp"
#include "pipeline/training/training_checkpoint_hdf5.hpp"
#include "tests/pipeline/files.hpp"
#include "tests/pipeline/training/tiny_training.hpp"
#include "tests/threads.hpp"

namespace selvedge::test_teacher {

using fake::Folder;

namespace {

// The tiny training with the distance to the solver's frames as the only loss.
TrainingOptions taught_training() {
  TrainingOptions options = fake::tiny_training();
  LossOptions& objective = options.objective;
  for (LossRamp* ramp :
       {&objective.stretching, &objective.bending, &objective.gravity, &objective.inertia, &objective.collision.weight})
    *ramp = {0, 0};
  objective.targets = {1, 1};
  options.steps = 60;
  options.pool.states = 3;
  options.samples.still_share = 0;
  options.optimiser.warm_up = 4;
  return options;
}

RollingState state_in_motion(int frame) {
  RollRequest request;
  request.first_frame = frame;
  request.frames = 3;
  request.still = false;
  RollingState state;
  begin_roll(make_roll(fake::tiny_maker(), request), state);
  return state;
}

std::vector<float> weights_of(Trainer& trainer) {
  std::vector<float> all;
  for (const WeightArray& array : weight_arrays(trainer.architecture, trainer.network.weights))
    all.insert(all.end(), array.data, array.data + array.rows * array.columns);
  return all;
}

}  // namespace

TEST_CASE("teacher: its frames are those of the solver from the same state, and are made once", "[training]") {
  RollingState state = state_in_motion(30);
  const SolverFrame frame = solver_frame(state);
  CHECK(frame.dt == Approx(1.0 / 30));
  CHECK((frame.from.v / 30 - state.now.velocity).norm() < 1e-12);
  CHECK(frame.drive.pins.rows() == static_cast<Eigen::Index>(state.roll.scene->scene.pins.size()));
  const auto solver = make_recovering_conventional_stepper(state.roll.scene->scene);
  State to;
  REQUIRE(solver->step(frame.from, frame.drive, frame.dt, to).status == StepStatus::accepted);

  Teacher teacher({TeacherQuality::standard}, {.targets = true});
  RollingState other = state_in_motion(70);
  teacher.ask(other);  // what came before changes nothing
  for (int k = 0; k < 2; ++k) {
    teacher.ask(state);
    CHECK(teacher.wait(state).x == to.x);
  }
  CHECK(teacher.tally().targets <= 2);
  const SeenPositions seen = seen_positions(state.roll.scene->rest, state.now, fake::tiny_making().features);
  CHECK(inputs_of(state, seen, to.x, 1).target == &state.taught.get().x);

  // The next frame has no target yet.
  FrameMaking making = fake::tiny_making();
  making.passes = 1;
  take_pass(making, {to.x, to.x - state.now.x}, 1, state);
  CHECK_FALSE(state.taught.valid());
}

TEST_CASE("teacher: a training by targets goes on with the same bits when it is resumed", "[training]") {
  const Folder folder("teacher_resume");
  TrainingOptions options = taught_training();
  options.optimiser.batch = 2;
  options.objective.potential = {0, 1, 0, 0.05};
  auto whole = make_trainer(options), other = make_trainer(options);
  for (int k = 0; k < 8; ++k) {
    with_threads(1, [&] {
      for (const SampleRecord& sample : train_step(*whole).samples) {
        CHECK(sample.bad == "");
        REQUIRE(sample.terms.size() >= 1);
        CHECK(sample.terms[0].name == "targets");
        CHECK(sample.terms[0].value > 0.1);
        CHECK(sample.terms[0].value < 200);  // [mm]
      }
    });
    with_threads(2, [&] { train_step(*other); });
  }
  CHECK(weights_of(*whole) == weights_of(*other));
  write_training_checkpoint(folder.path / "checkpoint.h5", *whole, {"a\n", "b\n", 0, 0, 0});
  TrainingHistory history;
  auto resumed = read_training_checkpoint(folder.path / "checkpoint.h5", options, history);
  for (int k = 0; k < 8; ++k)
    for (Trainer* trainer : {whole.get(), resumed.get()}) train_step(*trainer);
  CHECK(weights_of(*whole) == weights_of(*resumed));
  CHECK(whole->teacher->tally().targets > 0);
}

TEST_CASE("teacher: targets and potential are mixed, and agree about where the frame ends", "[training]") {
  RollingState state = state_in_motion(30);
  Teacher teacher({}, {.targets = true, .potential = true});
  teacher.ask(state);
  const TeacherStep& taught = teacher.wait(state);
  CHECK(taught.refused == "");
  LossOptions objective = taught_training().objective;
  objective.potential = {2, 2};
  const SeenPositions seen = seen_positions(state.roll.scene->rest, state.now, fake::tiny_making().features);
  const auto terms_at = [&](const Points& x) {
    Points gradient = Points::Zero(x.rows(), 3);
    return add_losses(inputs_of(state, seen, x, 1), objective, state.losses, &gradient);
  };
  const Points guess = inertial_guess(state.roll.scene->rest, state.now, seen, fake::tiny_making().features);
  const std::vector<LossTerm> at_guess = terms_at(guess), at_target = terms_at(taught.x);
  REQUIRE(at_guess.size() == 2);
  CHECK(at_guess[1].name == "potential");
  CHECK(at_target[0].value == 0);
  CHECK(at_target[1].value < at_guess[1].value);
  CHECK(at_target[1].gradient_norm < 0.3 * at_guess[1].gradient_norm);
}

TEST_CASE("teacher: a network that learns from targets comes nearer to them", "[training]") {
  TrainingOptions options = taught_training();
  options.steps = 240;
  options.pool.states = 8;
  options.optimiser.warm_up = 12;
  auto trainer = make_trainer(options);
  double first = 0, last = 0;
  constexpr int some = 60;
  for (int k = 0; k < options.steps; ++k) {
    const double distance = train_step(*trainer).samples[0].sum;
    if (k < some) first += distance / some;
    if (k >= options.steps - some) last += distance / some;
  }
  CHECK(trainer->counts.bad == 0);
  INFO(first << " mm, then " << last << " mm");
  CHECK(last < 0.9 * first);
}

TEST_CASE("teacher: no term asks for it, and it is not there", "[training]") {
  CHECK_FALSE(teacher_work(fake::tiny_training().objective).any());
  CHECK(teacher_work(taught_training().objective).any());
  CHECK_FALSE(make_empty_trainer(fake::tiny_training())->teacher);
  const std::filesystem::path file = config_folder() / "training" / "tiny.yaml";
  const std::string targets = "objective.targets.to=1";
  CHECK(teacher_work(read_training(file, {targets}).objective).targets);
  CHECK_THROWS_WITH(read_training(file, {targets, "samples.sample_materials=vertex"}),
                    Catch::Contains("cannot teach materials by vertex"));
  CHECK_THROWS_WITH(read_training(file, {targets, "samples.start=cut"}),
                    Catch::Contains("without their intersecting triangles"));
}

}  // namespace selvedge::test_teacher
