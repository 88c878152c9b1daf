#include "physics/steppers/hybrid_stepper.hpp"

#include "collision/geometry/error.hpp"
#include "physics/steppers/finish_step.hpp"
#include "physics/steppers/icm_stepper.hpp"
#include "physics/steppers/one_rough_solve.hpp"
#include "physics/steppers/proposal_trust.hpp"
#include "tests/frame.hpp"
#include "tests/physics/spoiled_steps.hpp"
#include "tests/threads.hpp"

namespace selvedge::test_hybrid_stepper {

using testing::World;

namespace {

constexpr double dt = 1.0 / 30;

// Proposes what a function makes of the state and what the conventional stepper makes of it.
using Propose = std::function<Points(const State& from, const Points& solved)>;
class FakeProposer final : public Stepper {
 public:
  FakeProposer(const Scene& scene, Propose propose, int past_frames = 0)
      : solver_(make_recovering_conventional_stepper(scene)),
        propose_(std::move(propose)),
        traits_{.name = "fake", .past_frames = past_frames} {}
  const StepperTraits& traits() const override { return traits_; }
  StepReport step(const State& from, const Drive& drive, double h, State& to, const StepExtras&) override {
    solver_->step(from, drive, h, to);
    Points x = propose_(from, to.x);
    StepReport report;
    report.by = "fake";
    report.status = StepStatus::rejected;
    report.reason = Reason::not_finite;
    if (!x.allFinite()) return report;
    report.reason = Reason::none;
    Points v = (x - from.x) / h;
    finish_step(from, drive, h, {std::move(x), std::move(v), drive.obstacles, {{"fake.x", from.x}}}, to, report);
    return report;
  }

 private:
  std::unique_ptr<Stepper> solver_;
  Propose propose_;
  StepperTraits traits_;
};

// Another stepper, with something that is done at each of its steps.
class CountedStepper final : public Stepper {
 public:
  CountedStepper(std::unique_ptr<Stepper> inner, std::function<void()> count)
      : inner_(std::move(inner)), count_(std::move(count)) {}
  const StepperTraits& traits() const override { return inner_->traits(); }
  StepReport step(const State& from, const Drive& drive, double h, State& to, const StepExtras& extras) override {
    count_();
    return inner_->step(from, drive, h, to, extras);
  }

 private:
  std::unique_ptr<Stepper> inner_;
  std::function<void()> count_;
};

// The conventional stepper's steps, at twice the velocity: positions alone do not tell.
class HastyProposer final : public Stepper {
 public:
  explicit HastyProposer(const Scene& scene) : solver_(make_recovering_conventional_stepper(scene)) {}
  const StepperTraits& traits() const override { return traits_; }
  StepReport step(const State& from, const Drive& drive, double h, State& to, const StepExtras& extras) override {
    const StepReport report = solver_->step(from, drive, h, to, extras);
    to.v *= 2;
    return report;
  }

 private:
  std::unique_ptr<Stepper> solver_;
  StepperTraits traits_{"hasty"};
};

Points as_solved(const State&, const Points& solved) { return solved; }
Points nowhere(const State& from, const Points&) {
  return Points::Constant(from.x.rows(), 3, std::numeric_limits<double>::quiet_NaN());
}
Points frozen(const State& from, const Points&) { return from.x; }
Points far_away(const State& from, const Points&) { return from.x.array() + 1e6; }
Points noise(const State& from, const Points& solved) {
  Points x = solved;
  for (Eigen::Index i = 0; i < x.rows(); ++i)
    x(i, i % 3) += 0.02 * std::sin(17.0 * static_cast<double>(i) + from.frame);
  return x;
}

// Vertices from `first` on go up and down by `size` [m].
Propose shaken(double size, Eigen::Index first = 0) {
  return [=](const State& from, const Points& solved) {
    Points x = solved;
    for (Eigen::Index i = first; i < x.rows(); ++i)
      x(i, 1) += size * std::sin(17.0 * static_cast<double>(i) + from.frame);
    return x;
  };
}

void hand_over(const State& from, const Drive&, State& to) { replace_blocks("fake", {{"fake.x", from.x}}, to.memory); }

HybridOptions in_mode(HybridMode mode) {
  HybridOptions options;
  options.mode = mode;
  return options;
}

std::unique_ptr<Stepper> hybrid(const Scene& scene, const Propose& propose, const HybridOptions& options = {}) {
  return make_hybrid_stepper(
      scene,
      {std::make_unique<FakeProposer>(scene, propose, 1), make_recovering_conventional_stepper(scene), {}, hand_over},
      options);
}

// A sheet that hangs by one side over a plate, and swings into it.
World swinging() {
  World w = testing::swinging_sheet();
  add_obstacle(w, testing::tilted(testing::sheet(4, 0.8, 0), 0.3));
  w.state.obstacles[0].col(1).array() -= 0.25;
  w.drive.obstacles = w.state.obstacles;
  return w;
}

struct Seen {
  State state;
  std::vector<Verdict> verdicts;
  int pairs = 0, passed = 0, fell_back = 0;
};

Seen follow(Stepper& stepper, const World& w, State state, int frames) {
  Seen seen{std::move(state), {}};
  for (int f = 0; f < frames; ++f) {
    State to;
    const StepReport report = testing::frame(w.scene, stepper, seen.state, w.drive, dt, to);
    REQUIRE(report.status == StepStatus::accepted);
    REQUIRE(to.x.allFinite());
    REQUIRE(to.v.allFinite());
    seen.verdicts.push_back(report.verdict);
    seen.pairs += report.collision.pairs_after;
    seen.passed += report.collision.passed_through;
    seen.fell_back += report.fell_back;
    seen.state = to;
  }
  return seen;
}

constexpr std::array all_modes{HybridMode::fallback, HybridMode::corrected, HybridMode::response, HybridMode::rough};

}  // namespace

TEST_CASE("hybrid: good proposals are the steps, after one frame that the proposer has to see", "[hybrid]") {
  const World w = testing::swinging_sheet();
  const auto stepper = hybrid(w.scene, as_solved);
  CHECK(stepper->traits().name == "hybrid");
  State to;
  StepReport report = testing::frame(w.scene, *stepper, w.state, w.drive, dt, to);
  CHECK(report.verdict == Verdict::no_history);
  CHECK(report.by == "hybrid: conventional");
  CHECK_FALSE(report.fell_back);
  State next;
  report = testing::frame(w.scene, *stepper, to, w.drive, dt, next);
  CHECK(report.verdict == Verdict::admitted);
  CHECK(report.by == "hybrid: fake");
  const auto solver = make_recovering_conventional_stepper(w.scene);
  State solved;
  testing::frame(w.scene, *solver, to, w.drive, dt, solved);
  CHECK(same_bits(next.x, solved.x));
}

TEST_CASE("hybrid: whatever is proposed, in every mode, the cloth stays finite and clean", "[hybrid]") {
  const World w = swinging();
  for (const HybridMode mode : all_modes)
    for (const auto& [name, propose] : std::vector<std::pair<std::string, Propose>>{
             {"NaN", nowhere}, {"frozen", frozen}, {"1e6", far_away}, {"noise", noise}}) {
      INFO("mode " << static_cast<int>(mode) << ", " << name);
      HybridOptions options;
      options.mode = mode;
      options.longest_stretch = 2;
      const Seen seen = follow(*hybrid(w.scene, propose, options), w, w.state, 12);
      CHECK(seen.pairs == 0);
      CHECK(seen.passed == 0);
      CHECK(seen.state.clean);
      if (mode == HybridMode::fallback && name != "frozen") CHECK(seen.fell_back > 0);
    }
}

TEST_CASE("hybrid: a proposal whose energy comes from nowhere is refused", "[hybrid]") {
  const World w = testing::swinging_sheet();
  State state = w.state, to;
  const auto solver = make_recovering_conventional_stepper(w.scene);
  for (int f = 0; f < 5; ++f) {
    testing::frame(w.scene, *solver, state, w.drive, dt, to);
    std::swap(state, to);
  }
  const HybridOptions options = in_mode(HybridMode::fallback);  // the proposal with its own velocities
  const auto stepper = make_hybrid_stepper(
      w.scene, {std::make_unique<HastyProposer>(w.scene), make_recovering_conventional_stepper(w.scene), {}, {}},
      options);
  const StepReport report = testing::frame(w.scene, *stepper, state, w.drive, dt, to);
  CHECK(report.verdict == Verdict::energy_gain);
  CHECK(report.by == "hybrid: conventional");
  CHECK(report.reason == Reason::none);
  CHECK_FALSE(report.doubts.any());
  State solved;
  testing::frame(w.scene, *solver, state, w.drive, dt, solved);
  CHECK(same_bits(to.v, solved.v));
}

TEST_CASE("hybrid: refused proposals wait for longer and longer, and come back", "[hybrid]") {
  const World w = testing::swinging_sheet();
  HybridOptions options;
  options.longest_stretch = 4;
  const Seen seen = follow(*hybrid(w.scene, nowhere, options), w, w.state, 18);
  std::vector<int> asked;
  for (int f = 0; f < 18; ++f)
    if (seen.verdicts[static_cast<std::size_t>(f)] == Verdict::not_made) asked.push_back(f);
  CHECK(asked == std::vector<int>{1, 3, 6, 11, 16});

  ProposalTrust trust{0, 4, 0};
  for (int k = 0; k < 3; ++k) trust = after_admission(trust, HybridOptions{}.admitted_to_halve);
  CHECK(trust.next_wait == 2);
  CHECK(after_refusal(trust, 32).wait == 2);
  CHECK(after_refusal(trust, 32).next_wait == 4);
}

TEST_CASE("hybrid: with a clock it costs at most a tenth more than its parent, whatever proposals cost and come to",
          "[hybrid]") {
  constexpr int frames = 100;
  constexpr double parent_work = 1;
  const World w = testing::swinging_sheet();
  HybridOptions timed;
  timed.stop_when_slow = true;
  struct Priced {
    const char* name;
    Propose propose;
    double work;  // of a proposal, beside the parent's
    double most;  // of the work of all steps, beside the parent's for all
    int least_taken, most_asked;
  };
  for (const Priced& one : std::vector<Priced>{{"cheap and good", as_solved, 0.25, 0.5, 80, frames},
                                               {"as dear as the parent, refused", nowhere, 1, 1.1, 0, 10},
                                               {"dear and refused", nowhere, 4, 1.1, 0, 2},
                                               {"dear and good", as_solved, 3, 1.1, 1, 5}}) {
    INFO(one.name);
    double work = 0;  // counted, not timed
    const auto proposer = [&](const State& from, const Points& solved) {
      work += one.work * parent_work;
      return one.propose(from, solved);
    };
    auto stepper = make_hybrid_stepper(
        w.scene,
        {std::make_unique<FakeProposer>(w.scene, proposer, 1),
         std::make_unique<CountedStepper>(make_recovering_conventional_stepper(w.scene), [&] { work += parent_work; }),
         {},
         hand_over,
         [&] { return work; }},
        timed);
    const Seen seen = follow(*stepper, w, w.state, frames);
    CHECK(work <= one.most * frames * parent_work);
    CHECK(std::ranges::count(seen.verdicts, Verdict::admitted) >= one.least_taken);
    const auto asked = [](Verdict v) { return v == Verdict::admitted || v == Verdict::not_made; };
    CHECK(std::ranges::count_if(seen.verdicts, asked) <= one.most_asked);
    if (one.work > 1) CHECK(std::ranges::count(seen.verdicts, Verdict::too_slow) > frames / 2);
  }
}

TEST_CASE("hybrid: a new stepper goes on with the same bits", "[hybrid]") {
  const World w = swinging();
  const Propose now_and_then = [](const State& from, const Points& solved) {
    return from.frame % 4 == 2 ? noise(from, solved) : solved;
  };
  for (const HybridMode mode : all_modes) {
    INFO("mode " << static_cast<int>(mode));
    const Seen straight = follow(*hybrid(w.scene, now_and_then, in_mode(mode)), w, w.state, 10);
    State state = w.state;
    for (int f = 0; f < 10; ++f) state = follow(*hybrid(w.scene, now_and_then, in_mode(mode)), w, state, 1).state;
    CHECK(same_bits(state.x, straight.state.x));
    CHECK(same_bits(state.v, straight.state.v));
  }
}

TEST_CASE("hybrid: a new stepper goes on with the same bits where so little moves that lists of pairs are kept",
          "[hybrid]") {
  World w = testing::make_world(testing::sheet(8, 0.2, 0.0021));
  add_obstacle(w, testing::sheet(3, 0.6, 0));
  const double rise = 2e-4;  // of the plate, a frame [m]; the thickness is 2e-3
  for (const HybridMode mode : {HybridMode::corrected, HybridMode::response}) {
    INFO("mode " << static_cast<int>(mode));
    const auto one = hybrid(w.scene, shaken(2e-4), in_mode(mode));
    State straight = w.state, by_new = w.state, to;
    for (int f = 1; f <= 16; ++f) {
      Drive drive = w.drive;
      drive.obstacles[0].col(1).array() += rise * f;
      const Verdict verdict = testing::frame(w.scene, *one, straight, drive, dt, to).verdict;
      straight = to;
      const auto fresh = hybrid(w.scene, shaken(2e-4), in_mode(mode));
      CHECK(testing::frame(w.scene, *fresh, by_new, drive, dt, to).verdict == verdict);
      by_new = to;
      CHECK(same_bits(by_new.x, straight.x));
      REQUIRE(by_new.memory.size() == straight.memory.size());
      for (std::size_t b = 0; b < by_new.memory.size(); ++b) CHECK(by_new.memory[b].rows == straight.memory[b].rows);
    }
  }
}

TEST_CASE("hybrid: what a refused proposal cost is in the report", "[hybrid]") {
  World w = testing::make_world(testing::sheet(8, 0.2, 0.0021));
  add_obstacle(w, testing::sheet(3, 0.6, 0));
  const auto refused = [&](const Propose& propose) {
    const auto stepper = hybrid(w.scene, propose);
    const State second = follow(*stepper, w, w.state, 1).state;
    State to;
    const StepReport report = testing::frame(w.scene, *stepper, second, w.drive, dt, to);
    REQUIRE(report.fell_back);
    return report;
  };
  const StepReport none = refused(nowhere), unbalanced = refused(shaken(0.004));
  CHECK(none.verdict == Verdict::not_made);
  CHECK((unbalanced.verdict != Verdict::not_made && unbalanced.verdict != Verdict::moved_too_far));
  CHECK(unbalanced.iterations == none.iterations);
  CHECK(unbalanced.counts.swept > none.counts.swept);
}

TEST_CASE("hybrid: a tangled start is left to the parent until it is clean", "[hybrid]") {
  World w = testing::make_world(testing::tilted(testing::sheet(6, 0.2, 0), 1.2));
  add_obstacle(w, testing::sheet(3, 0.6, 0.003));
  const Seen seen = follow(*hybrid(w.scene, as_solved), w, w.state, 4);
  REQUIRE(seen.verdicts.size() > 1);
  CHECK(seen.verdicts[0] == Verdict::no_history);
  CHECK(seen.verdicts[1] == Verdict::tangled);
  CHECK(seen.fell_back == 0);
}

TEST_CASE("hybrid: any two steppers go together in the mode fallback", "[hybrid]") {
  const World w = testing::swinging_sheet();
  auto other = make_hybrid_stepper(
      w.scene, {make_icm_stepper(w.scene, {}), make_recovering_conventional_stepper(w.scene), {}, {}}, {});
  const Seen seen = follow(*other, w, w.state, 6);
  CHECK(std::ranges::count(seen.verdicts, Verdict::admitted) > 0);
  auto turned = make_hybrid_stepper(
      w.scene, {make_recovering_conventional_stepper(w.scene), make_icm_stepper(w.scene, {}), {}, {}}, {});
  CHECK(std::ranges::count(follow(*turned, w, w.state, 6).verdicts, Verdict::admitted) > 0);
}

TEST_CASE("hybrid: parts that lack what a mode needs are refused", "[hybrid]") {
  const World w = testing::swinging_sheet();
  HybridOptions options = in_mode(HybridMode::rough);
  CHECK_THROWS_AS(
      make_hybrid_stepper(w.scene,
                          {std::make_unique<FakeProposer>(w.scene, as_solved), make_icm_stepper(w.scene, {}), {}, {}},
                          options),
      Error);
  options.mode = HybridMode::corrected;
  CHECK_THROWS_AS(make_hybrid_stepper(w.scene,
                                      {std::make_unique<FakeProposer>(w.scene, as_solved, 1),
                                       make_recovering_conventional_stepper(w.scene),
                                       {},
                                       {}},
                                      options),
                  Error);
}

TEST_CASE("hybrid: behind the response, motion, audits and energy alone decide", "[hybrid]") {
  const World w = testing::swinging_sheet();
  const auto verdict = [&](HybridMode mode, double size) {
    return follow(*hybrid(w.scene, shaken(size, 11), in_mode(mode)), w, w.state, 2).verdicts.back();
  };
  CHECK(verdict(HybridMode::response, 0) == Verdict::admitted);
  CHECK(verdict(HybridMode::response, 10) == Verdict::moved_too_far);
  bool elastic = false, energy = false;
  for (double size = 1e-4; size < 0.05; size *= 2) {
    INFO("noise of " << size << " m");
    const Verdict judged = verdict(HybridMode::corrected, size), behind = verdict(HybridMode::response, size);
    if (behind == Verdict::moved_too_far) continue;
    CHECK((behind == Verdict::admitted || behind == Verdict::energy_gain));
    elastic = elastic || (judged == Verdict::unbalanced && behind == Verdict::admitted);
    energy = energy || behind == Verdict::energy_gain;
    CHECK(verdict(HybridMode::rough, size) == Verdict::refined);
  }
  CHECK(elastic);  // a Jacobi sweep finds noise that stores little energy
  CHECK(energy);
}

TEST_CASE("hybrid: behind the response, stretch that a proposal makes at moving pins is no work of theirs",
          "[hybrid]") {
  World w = testing::swinging_sheet();
  w.drive.acceleration.setZero();  // pins and cloth rise as one
  const double rise = 0.005;       // a frame [m]
  w.state.v.col(1).setConstant(rise / dt);
  const auto verdicts = [&](double drawn) {
    const Propose stretch = [drawn](const State&, const Points& solved) {
      Points x = solved;
      x.bottomRows(x.rows() - 11).col(2).array() += drawn;  // the cloth is drawn off its pins
      return x;
    };
    const HybridOptions options = in_mode(HybridMode::response);
    const auto stepper = hybrid(w.scene, stretch, options);
    State from = w.state, to;
    std::vector<Verdict> all;
    for (int frame = 1; frame <= 2; ++frame) {
      Drive drive = w.drive;
      drive.pins = w.state.x(w.scene.pins, Eigen::all);
      drive.pins.col(1).array() += rise * frame;
      all.push_back(testing::frame(w.scene, *stepper, from, drive, dt, to).verdict);
      from = to;
    }
    return all.back();
  };
  CHECK(verdicts(0) == Verdict::admitted);
  CHECK(verdicts(0.002) == Verdict::energy_gain);
}

TEST_CASE("hybrid: a rough step is made by the refiner from the proposal", "[hybrid]") {
  const World w = testing::swinging_sheet();
  const HybridOptions options = in_mode(HybridMode::rough);
  ConventionalOptions rough = one_rough_solve({});
  rough.name = "rough";
  const auto made = [&](const Propose& propose, int frames) {
    HybridParts parts{std::make_unique<FakeProposer>(w.scene, propose, 1),
                      make_recovering_conventional_stepper(w.scene),
                      make_recovering_conventional_stepper(w.scene, rough), hand_over};
    return follow(*make_hybrid_stepper(w.scene, std::move(parts), options), w, w.state, frames);
  };
  const Seen begun = made(as_solved, 3), good = made(as_solved, 4), other = made(frozen, 4);
  State solved;
  testing::frame(w.scene, *make_recovering_conventional_stepper(w.scene), begun.state, w.drive, dt, solved);
  CHECK(good.verdicts.back() == Verdict::refined);
  CHECK((good.state.x - solved.x).rowwise().norm().maxCoeff() < 0.02);
  CHECK_FALSE(same_bits(good.state.x, solved.x));
  CHECK_FALSE(same_bits(good.state.x, other.state.x));
}

TEST_CASE("hybrid: without a refiner the parent makes the solve, and its step is as good as its own", "[hybrid]") {
  const World w = testing::swinging_sheet();
  const HybridOptions options = in_mode(HybridMode::rough);
  const auto stepper = hybrid(w.scene, as_solved, options);
  const auto solver = make_recovering_conventional_stepper(w.scene);
  const Seen begun = follow(*stepper, w, w.state, 3);
  State refined, solved;
  const StepReport report = testing::frame(w.scene, *stepper, begun.state, w.drive, dt, refined);
  testing::frame(w.scene, *solver, begun.state, w.drive, dt, solved);
  CHECK(report.verdict == Verdict::refined);
  CHECK((refined.x - solved.x).rowwise().norm().maxCoeff() < 2e-3);
}

}  // namespace selvedge::test_hybrid_stepper
