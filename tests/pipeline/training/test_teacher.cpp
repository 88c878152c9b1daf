#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include "collision/geometry/error.hpp"
#include "collision/search/intersections.hpp"
#include "learned/steppers/learned_state.hpp"
#include "physics/steppers/carried_guess.hpp"
#include "physics/steppers/decorated_stepper.hpp"
#include "pipeline/host/csv_columns.hpp"
#include "pipeline/training/simulate_frames.hpp"
#include "pipeline/training/train.hpp"
#include "pipeline/training/training_checkpoint_hdf5.hpp"
#include "tests/pipeline/files.hpp"
#include "tests/pipeline/training/tiny_training.hpp"
#include "tests/threads.hpp"

namespace selvedge::test_teacher {

using fake::Folder;
using fake::weights_of;

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

// A student that learns from each state four times, from two at once.
TrainingOptions kept_training() {
  TrainingOptions options = taught_training();
  options.architecture = "student";
  options.width = 8;
  options.pool.passes = 1;
  options.pool.behind = BehindNetwork::response;
  options.optimiser.batch = 2;
  options.optimiser.decoder_scale = 0;
  options.samples.simulated_share = 0.5;
  options.samples.simulated_frames = 2;
  options.teacher.uses = 4;
  options.teacher.kept = 5;
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

TEST_CASE("teacher: kept states are learned from again, and a resumed training has the same bits", "[training]") {
  const Folder folder("teacher_kept");
  TrainingOptions options = kept_training();
  auto whole = make_trainer(options);
  std::vector<double> again;  // steps that take a kept state
  for (int k = 0; k < 16; ++k) {
    const long before = whole->counts.again;
    for (const SampleRecord& sample : train_step(*whole).samples) CHECK(sample.bad == "");
    again.push_back(static_cast<double>(whole->counts.again - before));
  }
  // Two states a step. Four of them are there after two steps; then one step of four takes new ones.
  CHECK(again == std::vector<double>{0, 0, 2, 2, 0, 2, 2, 2, 0, 2, 2, 2, 0, 2, 2, 2});
  CHECK(whole->counts.frames == 10);
  CHECK(whole->taught.all.size() == 5);  // no more are kept
  for (const auto& kept : whole->taught.all) {
    CHECK(kept->state.roll.body.empty());
    CHECK(kept->state.taught.get().x.rows() == kept->state.now.x.rows());
  }

  write_training_checkpoint(folder.path / "checkpoint.h5", *whole, {"a\n", "b\n", 0, 0, 0});
  TrainingHistory history;
  auto resumed = read_training_checkpoint(folder.path / "checkpoint.h5", options, history);
  CHECK(resumed->counts.again == whole->counts.again);
  CHECK(resumed->teacher->tally().targets == 0);  // what is kept has its target
  for (int k = 0; k < 16; ++k)
    for (Trainer* trainer : {whole.get(), resumed.get()}) train_step(*trainer);
  CHECK(weights_of(*whole) == weights_of(*resumed));
}

TEST_CASE("teacher: kept states are drawn at random, and the oldest one goes first", "[training]") {
  TaughtStates states;
  states.most = 3;
  std::vector<const TaughtState*> added;
  for (int k = 0; k < 5; ++k) {
    auto one = std::make_unique<TaughtState>();
    added.push_back(one.get());
    states.add(std::move(one));
  }
  REQUIRE(states.all.size() == 3);
  RandomStream random{7};
  std::map<const TaughtState*, int> drawn;
  for (int k = 0; k < 300; ++k) {
    const std::vector<TaughtState*> two = states.draw(random, 2);
    CHECK(two[0] != two[1]);
    for (const TaughtState* one : two) ++drawn[one];
  }
  CHECK(drawn.size() == 3);
  for (std::size_t k = 2; k < 5; ++k) CHECK(std::abs(drawn[added[k]] - 200) < 40);
}

TEST_CASE("teacher: a student without an output is the carried guess and the response, until it has learned",
          "[training]") {
  auto trainer = make_trainer(kept_training());
  RollRequest request;
  request.first_frame = 30;
  request.frames = 3;
  request.still = false;
  request.simulated = 6;
  TaughtRoll taught{make_roll(*trainer->maker, request), {}};
  const Scene& scene = taught.roll.scene->scene;
  const auto drive_at = [&](std::size_t k) {
    return drive_to(scene, taught.roll.forces, taught.roll.body[k].cast<double>(), taught.roll.cloth[k].cast<double>());
  };
  RollingState state;
  begin_roll(taught.roll, state);
  State before, at = solver_frame(state).from;
  before.x = state.now.previous;
  before.memory = carried_memory({}, drive_at(0), before.x);
  at.memory = carried_memory(before, drive_at(1), at.x);
  const auto behind = make_behind(scene, BehindNetwork::response);
  for (std::size_t k = 2; k < taught.roll.body.size(); ++k) {
    const Points guess = carried_guess(scene, at, drive_at(k), learned_dt);
    State to;
    REQUIRE(behind->step(at, drive_at(k), learned_dt, to, {.guess = &guess}).status == StepStatus::accepted);
    to.memory = carried_memory(at, drive_at(k), to.x);
    at = std::move(to);
  }
  taught.end = at.x;
  CHECK(taught_distance(*trainer, taught) < 1e-6);  // [mm]
  for (int k = 0; k < 3; ++k) train_step(*trainer);
  CHECK(taught_distance(*trainer, taught) > 1e-3);
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

TEST_CASE("teacher: what runs behind the network brings a frame out of the body", "[training]") {
  RollMaker maker = fake::tiny_maker();
  RollRequest request;
  request.first_frame = 30;
  request.frames = 3;
  request.still = false;
  request.simulated = 6;
  RollingState state;
  begin_roll(make_roll(maker, request), state);
  const Scene& scene = state.roll.scene->scene;
  const auto pairs_with_body = [&](const Points& x) {
    const Points body = state.now.body_target;
    Triangles all(scene.surface.triangles.rows() + scene.obstacles[0].surface.triangles.rows(), 3);
    all << scene.surface.triangles,
        (scene.obstacles[0].surface.triangles.array() + static_cast<int>(x.rows())).matrix();
    Points both(x.rows() + body.rows(), 3);
    both << x, body;
    const Surface whole = make_surface(static_cast<int>(both.rows()), all);
    IntersectionCache cache;
    const Eigen::Index cloth = scene.surface.triangles.rows();
    int count = 0;
    for (const auto& [a, b] : intersecting_pairs(whole, both, cache)) count += (a < cloth) != (b < cloth);
    return count;
  };
  // The network pulls the garment to the axis of the body.
  NextCloth proposed{state.now.target, state.now.velocity};
  const Eigen::RowVector3d middle = proposed.x.colwise().mean();
  for (const int column : {0, 2}) proposed.x.col(column) = 0.7 * proposed.x.col(column).array() + 0.3 * middle[column];
  const int pairs = pairs_with_body(proposed.x);
  REQUIRE(pairs > 100);
  for (const BehindNetwork behind : {BehindNetwork::response, BehindNetwork::solve}) {
    state.behind = make_behind(scene, behind);
    NextCloth next = proposed;
    REQUIRE(pass_behind(state, next));
    CHECK(pairs_with_body(next.x) < pairs);  // the start of the roll-out has pairs, too, which contact leaves alone
    CHECK((next.velocity - proposed.velocity - (next.x - proposed.x)).norm() < 1e-12);
  }
  state.behind = nullptr;
  NextCloth next = proposed;
  CHECK(pass_behind(state, next));
  CHECK(next.x == proposed.x);
}

TEST_CASE("teacher: shares of roll-outs begin with strong noise, or where the solver brings the cloth", "[training]") {
  RollMaker maker = fake::tiny_maker();
  TrainingOptions options = maker.options;
  options.samples.noise_share = 0.3;
  options.samples.simulated_share = 0.5;
  int noisy = 0, simulated = 0;
  for (std::uint64_t k = 0; k < 300; ++k) {
    const RollRequest before = draw_roll(maker.options, maker.world, k, 1);
    RollRequest request = draw_roll(options, maker.world, k, 1);
    CHECK((request.noise == 0 || (request.noise >= 1e-3 && request.noise <= 1e-2)));
    CHECK((request.simulated == 0 || (request.simulated == 20 && !request.still)));
    noisy += request.noise > 0;
    simulated += request.simulated > 0;
    request.noise = 0;
    request.simulated = 0;
    request.still = before.still;
    CHECK(request == before);  // shares change nothing else
  }
  CHECK(std::abs(noisy - 90) < 30);
  CHECK(std::abs(simulated - 150) < 35);
  options.samples.random_simulated = true;
  double frames = 0;
  for (std::uint64_t k = 0; k < 300; ++k) {
    RollRequest request = draw_roll(options, maker.world, k, 1);
    CHECK((request.simulated >= 0 && request.simulated <= 20));
    frames += request.simulated;
  }
  CHECK(std::abs(frames / simulated - 10.5) < 2);

  RollRequest request;
  request.first_frame = 30;
  request.still = false;
  request.simulated = 4;
  const Roll roll = make_roll(maker, request), again = make_roll(maker, request);
  CHECK(roll.usable);
  CHECK(roll.start == again.start);
  RollRequest shorter = request;
  shorter.first_frame = 29;
  shorter.simulated = 3;
  const Roll frame_before = make_roll(maker, shorter);
  CHECK((roll.start - frame_before.start - roll.velocity).norm() < 0.1 * roll.velocity.norm());
  RollingState state;
  begin_roll(roll, state);
  CHECK(state.now.velocity == roll.velocity);
  request.noise = 5e-3;
  const Points noise = make_roll(maker, request).start - roll.start;
  CHECK(std::sqrt(noise.squaredNorm() / static_cast<double>(noise.size())) == Approx(5e-3).epsilon(0.1));
  for (const auto v : roll.scene->rest.pinned) CHECK(noise.row(v).isZero(0));
}

TEST_CASE("teacher: the best weights are those that come nearest to the solver's roll-out", "[training]") {
  const Folder folder("teacher_best");
  std::ostringstream log;
  TrainRequest request{
      config_folder() / "training" / "tiny.yaml",
      {"steps=24", "pool.states=3", "pool.behind=response", "optimiser.warm_up=3", "watch.frames=3",
       "watch.fixed_states=2", "watch.taught_rolls=1", "watch.taught_frames=3", "watch.measurements=4",
       "samples.simulated_frames=3", "samples.still_share=0", "objective.targets.from=1", "objective.targets.to=1"},
      folder.path / "run",
      false,
      &log,
      {}};
  const TrainSummary summary = train(request);
  CHECK(summary.finished);
  CHECK(summary.score_unit == "mm");
  const CsvColumns measures(fake::whole(request.out / "measures.csv"));
  const std::vector<double>&distance = measures["taught_distance"], &step = measures["step"];
  REQUIRE(distance.size() == 5);
  const auto best = std::ranges::min_element(distance.begin() + 1, distance.end());  // not before the first step
  CHECK(summary.best_score == Approx(*best).epsilon(1e-3));
  CHECK(summary.best_step == static_cast<long>(step[static_cast<std::size_t>(best - distance.begin())]));
  CHECK(*best > 0.05);
  CHECK(*best < 100);
  CHECK(CsvColumns(fake::whole(request.out / "steps.csv"))["targets_per_second"].back() > 0);
  CHECK(log.str().find("targets/s by the solver") != std::string::npos);
  CHECK(log.str().find("mm from the solver after 3 frames") != std::string::npos);
}

TEST_CASE("teacher: no term asks for it, and it is not there", "[training]") {
  CHECK_FALSE(teacher_work(fake::tiny_training().objective).any());
  CHECK(teacher_work(taught_training().objective).any());
  CHECK_FALSE(make_empty_trainer(fake::tiny_training())->teacher);
  const std::filesystem::path file = config_folder() / "training" / "tiny.yaml";
  const std::string targets = "objective.targets.to=1";
  CHECK(teacher_work(read_training(file, {targets}).objective).targets);
  CHECK_THROWS_WITH(read_training(file, {targets, "samples.sample_materials=vertex"}),
                    Catch::Contains("no materials by vertex"));
  CHECK_THROWS_WITH(read_training(file, {targets, "samples.start=cut"}),
                    Catch::Contains("without their intersecting triangles"));
  CHECK_THROWS_WITH(read_training(file, {"pool.behind=response", "pool.safeguarded=true"}),
                    Catch::Contains("two responses"));
  CHECK_THROWS_WITH(read_training(file, {"objective.potential.to=1", "teacher.uses=2"}),
                    Catch::Contains("potential cannot be kept"));
  CHECK_THROWS_WITH(read_training(file, {targets, "teacher.uses=2", "teacher.kept=2", "optimiser.batch=3"}),
                    Catch::Contains("more samples than states are kept"));
  CHECK_THROWS_WITH(trained_architecture(read_training(file, {targets, "teacher.uses=2"})),
                    Catch::Contains("networks of one pass"));
}

}  // namespace selvedge::test_teacher
