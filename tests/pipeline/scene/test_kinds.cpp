#include "pipeline/scene/kinds.hpp"

#include <catch2/catch.hpp>

#include "collision/geometry/error.hpp"
#include "physics/steppers/finish_step.hpp"
#include "pipeline/hdf5/checkpoint.hpp"
#include "pipeline/scene/config_scene.hpp"
#include "pipeline/scene/make_stepper.hpp"
#include "tests/frame.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::test_kinds {

using Catch::Matchers::Contains;
using fake::Folder;

namespace {

// Lets the second of two cloths sink, and counts the steps of all that it steps.
class CountingStepper final : public Stepper {
 public:
  CountingStepper(const Scene& scene, double speed, StepperNeeds needs)
      : scene_(scene), speed_(speed), traits_{.name = "counting", .past_frames = 1, .needs = needs} {}
  const StepperTraits& traits() const override { return traits_; }
  StepReport step(const State& from, const Drive& drive, double dt, State& to, const StepExtras&) override {
    StepEnd end{from.x, Points::Zero(from.x.rows(), 3), drive.obstacles};
    for (const Cloth& cloth : scene_.cloths)
      if (cloth.name == "sinks") end.x.middleRows(cloth.first_vertex, cloth.vertex_count).col(1).array() -= speed_ * dt;
    const auto counted = [&](const std::string& name, Eigen::Index rows, RowsOf rows_of) {
      const MemoryRows* before = find_rows(from.memory, name, rows);
      const MemoryRows count = before ? MemoryRows(before->array() + 1) : MemoryRows::Ones(rows, 1);
      end.memory.push_back({name, count, rows_of});
    };
    counted("counting.vertices", from.x.rows(), RowsOf::vertices);
    counted("counting.cloths", std::ssize(scene_.cloths), RowsOf::cloths);
    counted("counting.steps", 1, RowsOf::none);
    StepReport report;
    report.by = traits_.name;
    finish_step(from, drive, dt, std::move(end), to, report);
    return report;
  }

 private:
  const Scene& scene_;
  double speed_;
  StepperTraits traits_;
};

const Section& counting_section() {
  static const Section section{
      "counting", "", {table::number("speed", Unit::speed, table::positive, "1", "of what sinks")}};
  return section;
}

Kinds with_counting(StepperNeeds needs = {}) {
  Kinds kinds = known_kinds();
  kinds.add({"counting", &counting_section(), [needs](const Setup&, const Config& given) -> MakeStepper {
               return [speed = given["speed"].number(), needs](const Scene& scene) {
                 return std::make_unique<CountingStepper>(scene, speed, needs);
               };
             }});
  return kinds;
}

Setup read(const Folder& folder, const std::string& run, const Kinds& kinds) {
  return read_setup(
      fake::write(folder, "scene.yaml",
                  "cloths:\n  - {name: rests, rectangle: {size: [0.1, 0.1], resolution: 2}, translate: [3, 0, 0]}\n"
                  "  - {name: sinks, rectangle: {size: [0.2, 0.2], resolution: 3}}\nrun: " +
                      run + "\n"),
      {}, kinds);
}

double last(const Memory& memory, const std::string& name) {
  for (const MemoryBlock& block : memory)
    if (block.name == name) return block.rows(block.rows.rows() - 1, 0);
  return -1;
}

}  // namespace

TEST_CASE("kinds: one that a caller adds is read with its options and runs", "[kinds]") {
  const Folder folder("kinds");
  const Setup setup = read(folder, "{frames: 3, stepper: counting, counting: {speed: 2}}", with_counting());
  CHECK(setup.run.frames == 3);
  const auto stepper = make_stepper(setup);
  CHECK(stepper->traits().name == "counting");
  State to;
  testing::frame(setup.scene, *stepper, setup.initial, setup.drive_at(1.0 / 30), 1.0 / 30, to);
  CHECK(to.x(to.x.rows() - 1, 1) == Approx(setup.initial.x(to.x.rows() - 1, 1) - 2.0 / 30));
  CHECK(last(to.memory, "counting.steps") == 1);
  const Setup copy = setup;  // its tables live on
  CHECK_NOTHROW(make_stepper(copy));
  CHECK_THAT(setup.config, Contains("counting:"));
}

TEST_CASE("kinds: without it the file is refused, and faults in its options are named", "[kinds]") {
  const Folder folder("kinds_refused");
  CHECK_THROWS_WITH(read(folder, "{stepper: counting}", known_kinds()),
                    Contains("run.stepper") && Contains("conventional"));
  CHECK_THROWS_WITH(read(folder, "{counting: {speed: 1}}", known_kinds()), Contains("counting"));
  CHECK_THROWS_WITH(read(folder, "{stepper: countin}", with_counting()), Contains("did you mean `counting`"));
  CHECK_THROWS_WITH(read(folder, "{stepper: counting, counting: {sped: 1}}", with_counting()),
                    Contains("did you mean `speed`"));
  CHECK_THROWS_WITH(read(folder, "{stepper: counting, counting: {speed: -1}}", with_counting()), Contains("speed"));
  Kinds kinds = with_counting();
  CHECK_THROWS_AS(kinds.add({.name = "icm"}), Error);
  CHECK(kinds.names() == std::vector<std::string>{"conventional", "carried", "carried_fitted", "carried_rough", "icm",
                                                  "learned", "hybrid", "counting"});
  CHECK_FALSE(kinds.find("other"));
}

TEST_CASE("kinds: the table says who reads weights, by no name", "[kinds]") {
  const Folder folder("kinds_weights");
  const Kinds known = known_kinds();
  for (const StepperKind& kind : known.all()) {
    INFO(kind.name);
    CHECK(reads_weights(read(folder, "{stepper: " + kind.name + "}", known_kinds())) ==
          (kind.name == "learned" || kind.name == "hybrid" || kind.name == "carried_fitted"));
  }
  Setup own = read(folder, "{stepper: counting}", with_counting());
  CHECK_FALSE(reads_weights(own));
  own.kind.coefficients = true;
  CHECK(reads_weights(own));
}

TEST_CASE("kinds: one error names all that a scene lacks", "[kinds]") {
  const Folder folder("kinds_needs");
  const Setup setup =
      read(folder, "{stepper: counting}", with_counting({.skinned_targets = true, .bodies = true, .obstacles = true}));
  CHECK_THROWS_WITH(make_stepper(setup), Contains("`counting` does not take this scene") &&
                                             Contains("it needs an obstacle") && Contains("it needs a body") &&
                                             Contains("it needs cloth that a body wears"));
}

TEST_CASE("kinds: memory of a stepper rests with its cloth, goes into a checkpoint and comes back", "[kinds]") {
  const Folder folder("kinds_memory");
  const Setup setup = read(folder, "{frames: 24, stepper: counting}", with_counting());
  fake::run(setup, *make_stepper(setup), folder.path / "half", false, 20);
  const State saved = read_checkpoint(folder.path / "half" / "checkpoint.h5").state;
  CHECK(last(saved.memory, "counting.steps") == saved.frame);
  CHECK(last(saved.memory, "counting.vertices") == saved.frame);
  CHECK(last(saved.memory, "counting.cloths") == saved.frame);
  CHECK(last(saved.memory, "resting.seconds") == 0);
  CHECK(find_rows(saved.memory, "counting.vertices", saved.x.rows())->operator()(0, 0) == 0);  // it rests
  State end, straight;
  const auto watch = [](State& state) { return [&state](const FrameEvent& event) { state = event.state; }; };
  RunRequest request;
  request.out = folder.path / "half";
  request.observe = watch(end);
  resume_scene(setup, *make_stepper(setup), request);
  request = {};
  request.out = folder.path / "whole";
  request.observe = watch(straight);
  run_scene(setup, *prepare(setup), *make_stepper(setup), request);
  CHECK(end.frame == 24);
  CHECK(end.x == straight.x);
  REQUIRE(end.memory.size() == straight.memory.size());
  for (std::size_t k = 0; k < end.memory.size(); ++k) {
    CHECK(end.memory[k].name == straight.memory[k].name);
    CHECK(end.memory[k].rows == straight.memory[k].rows);
  }
  CHECK(last(end.memory, "counting.steps") == 24);
}

}  // namespace selvedge::test_kinds
