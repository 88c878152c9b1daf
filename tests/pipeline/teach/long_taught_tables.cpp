#include <catch2/catch.hpp>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <map>

#include <fmt/format.h>

#include "learned/steppers/learned_state.hpp"
#include "physics/energies/measures.hpp"
#include "physics/steppers/following_stepper.hpp"
#include "physics/steppers/proposal_trust.hpp"
#include "pipeline/cells/scene_cells.hpp"
#include "pipeline/compare/volume_table.hpp"
#include "pipeline/obstacles/setup_body.hpp"
#include "pipeline/obstacles/setup_paths.hpp"
#include "pipeline/run/simulate.hpp"
#include "pipeline/scene/make_stepper.hpp"
#include "pipeline/teach/taught_clip.hpp"
#include "pipeline/training/solver_frame.hpp"
#include "pipeline/weights/carried_model_hdf5.hpp"

namespace selvedge::long_taught_tables {

// How far steppers are from the solver after 1, 3 and 10 frames, from states of the solver's own run, and what they
// cost: a student that the solver has taught beside the carried guess with the same behind it, and the presets. Takes
// minutes for each outfit and clip. The solver makes its run as it makes the targets of a training (`converged`).
// SELVEDGE_WEIGHTS: the network; SELVEDGE_FITTED: coefficients by `selvedge teach`, where OUTFIT in the name stands for
// the outfit's; rows without a file are left out.
// SELVEDGE_TAUGHT_OUTFITS, SELVEDGE_TAUGHT_CLIPS: with commas between. SELVEDGE_TAUGHT_ROWS: those alone, with
// semicolons between. SELVEDGE_TAUGHT_FRAMES: of the solver's run.
// SELVEDGE_TAUGHT_EVERY: every so many of its states, which are 10 frames apart, begins a roll-out.

namespace {

constexpr std::array<int, 3> measured_at{1, 3, 10};

std::string given(const char* name, const std::string& otherwise) {
  const char* text = std::getenv(name);
  return text ? text : otherwise;
}

std::vector<std::string> names_in(const std::string& text, char between = ',') {
  std::vector<std::string> names(1);
  for (const char c : text) c == between ? (void)names.emplace_back() : names.back().push_back(c);
  return names;
}

struct Row {
  std::string name;
  std::vector<std::string> overrides;      // of the scene
  bool student = false;                    // a hybrid with the network
  std::optional<CarriedModel> guess = {};  // from which one rough solve begins, wherever that is
};

std::vector<Row> rows(const std::string& outfit) {
  const std::string weights = given("SELVEDGE_WEIGHTS", "");
  std::string fitted = given("SELVEDGE_FITTED", "");
  if (const auto at = fitted.find("OUTFIT"); at != std::string::npos) fitted.replace(at, 6, outfit);
  const auto hybrid = [&](const std::string& mode) {
    return std::vector<std::string>{"run.stepper=hybrid", "run.learned.weights=" + weights, "run.hybrid.mode=" + mode,
                                    "run.hybrid.stop_when_slow=false"};
  };
  std::vector<Row> all{{"carried", {"run.stepper=carried"}}};
  if (!fitted.empty()) all.push_back({"fitted", {"run.stepper=carried_fitted", "run.learned.weights=" + fitted}});
  if (!weights.empty()) {
    all.push_back({"student, response", hybrid("response"), true});
    std::vector<std::string> whole = hybrid("response");
    whole.push_back("run.learned.step_lengths=false");
    all.push_back({"student, whole output, response", std::move(whole), true});
  }
  all.push_back({"carried_rough", {"run.stepper=carried_rough"}});
  all.push_back({"carried guess, rough solve", {"run.stepper=conventional"}, false, CarriedModel{}});
  if (!fitted.empty())
    all.push_back({"fitted, rough solve", {"run.stepper=conventional"}, false, read_taught_carried(fitted).model});
  if (!weights.empty()) all.push_back({"student, rough solve", hybrid("rough"), true});
  all.push_back({"draft", {"run.stepper=conventional", "run.quality=draft"}});
  all.push_back({"preview", {"run.stepper=conventional", "run.quality=preview"}});
  if (const std::string wanted = given("SELVEDGE_TAUGHT_ROWS", ""); !wanted.empty())
    std::erase_if(all, [&](const Row& row) { return std::ranges::count(names_in(wanted, ';'), row.name) == 0; });
  return all;
}

// One rough solve that begins at the guess, then the response: what the hybrid's mode `rough` is, unjudged.
class SolveFromGuess final : public Stepper {
 public:
  SolveFromGuess(const Scene& scene, CarriedModel model)
      : scene_(scene), model_(std::move(model)), behind_(make_behind(scene, BehindNetwork::solve)) {
    traits_.name = "guess, rough solve";
    traits_.past_frames = past_frames(model_);
  }
  const StepperTraits& traits() const override { return traits_; }
  StepReport step(const State& from, const Drive& drive, double dt, State& to, const StepExtras&) override {
    const Points guess = carried_guess(scene_, from, drive, dt, model_);
    StepExtras extras;
    extras.guess = &guess;
    StepReport report = behind_->step(from, drive, dt, to, extras);
    if (report.status == StepStatus::accepted)
      replace_blocks("carried", carried_memory(from, drive, to.x, traits_.past_frames), to.memory);
    return report;
  }

 private:
  const Scene& scene_;
  CarriedModel model_;
  std::unique_ptr<Stepper> behind_;
  StepperTraits traits_;
};

Setup setup_of(const std::string& outfit, const std::string& clip, std::vector<std::string> overrides) {
  overrides.insert(overrides.begin(), {"cloths.0.garment.outfit=" + outfit, "obstacles.person.body.clip=" + clip,
                                       "run.frames=" + given("SELVEDGE_TAUGHT_FRAMES", "90")});
  Setup setup = read_setup(config_folder() / "compare" / "outfit.yaml", overrides);
  read_tissue(cache_folder(), setup.bodies);
  return setup;
}

std::unique_ptr<Stepper> stepper_of(const Setup& setup, const Row& row) {
  if (!row.guess) return make_stepper(setup);
  return make_following_stepper(setup.scene, setup.followers,
                                std::make_unique<SolveFromGuess>(setup.scene, *row.guess));
}

// The state as if the hybrid had made it, so that it asks for a proposal in the first frame too.
State known_to_hybrid(const TaughtClip& clip, State state) {
  State before;
  before.x = clip.run[static_cast<std::size_t>(state.frame - 1)];
  before.obstacles = clip.setup.drive_at((state.frame - 1) / clip.setup.run.fps).obstacles;
  carry_frame(before, state);
  remember(ProposalTrust{}, state);
  return state;
}

// What roll-outs of a row came to, of one outfit in one clip.
struct Measured {
  std::array<double, 3> squares{};  // summed RMS distances to the solver's run [m2]
  double log_distance = 0;          // summed logarithms of the last of them
  int rolls = 0, frames = 0, proposed = 0, pairs = 0, passed = 0, rejected = 0;
  double seconds = 0;  // of processor time
};

Measured measured(const TaughtClip& clip, const Row& row, const Setup& setup, int every) {
  Measured sum;
  const std::unique_ptr<Stepper> stepper = stepper_of(setup, row);
  for (std::size_t b = 0; b < clip.begins.size(); b += static_cast<std::size_t>(every)) {
    if (clip.begins[b].frame == 0) continue;
    State state = row.student ? known_to_hybrid(clip, clip.begins[b]) : clip.begins[b];
    const int first = state.frame;
    const std::clock_t started = std::clock();
    const StepReport last = simulate(
        setup.scene, *stepper, setup.drive_at, 1 / setup.run.fps, first + measured_at.back(), state,
        [&](const FrameEvent& event) {
          ++sum.frames;
          sum.pairs = std::max(sum.pairs, event.report.collision.pairs_after);
          sum.passed += event.report.collision.passed_through;
          sum.proposed += event.report.verdict == Verdict::admitted || event.report.verdict == Verdict::refined;
          const double distance = root_mean_square(event.state.x - clip.run[static_cast<std::size_t>(state.frame)]);
          for (std::size_t k = 0; k < measured_at.size(); ++k)
            if (state.frame == first + measured_at[k]) sum.squares[k] += distance * distance;
          if (state.frame == first + measured_at.back()) sum.log_distance += std::log(distance);
          return true;
        });
    sum.seconds += static_cast<double>(std::clock() - started) / CLOCKS_PER_SEC;
    sum.rejected += last.status != StepStatus::accepted;
    ++sum.rolls;
  }
  return sum;
}

void print_title(const std::string& what) {
  fmt::print(
      "\n| {} | 1 frame, mm | 3 | 10 | 10, geometric | proposals taken | pairs, worst frame | passed through | "
      "rejected | CPU ms a frame |\n|---|---|---|---|---|---|---|---|---|---|\n",
      what);
}

void print_row(const Row& row, const Measured& m) {
  const auto distance = [&](std::size_t k) { return 1e3 * std::sqrt(m.squares[k] / std::max(m.rolls, 1)); };
  const std::string taken = row.student ? fmt::format("{:.0f} %", 100.0 * m.proposed / std::max(m.frames, 1)) : "";
  fmt::print("| {} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {} | {} | {} | {} | {:.1f} |\n", row.name, distance(0),
             distance(1), distance(2), 1e3 * std::exp(m.log_distance / std::max(m.rolls, 1)), taken, m.pairs, m.passed,
             m.rejected, 1e3 * m.seconds / std::max(m.frames, 1));
  std::fflush(stdout);
}

void add(const Measured& one, Measured& all) {
  for (std::size_t k = 0; k < one.squares.size(); ++k) all.squares[k] += one.squares[k];
  all.log_distance += one.log_distance;
  all.rolls += one.rolls;
  all.frames += one.frames;
  all.proposed += one.proposed;
  all.pairs = std::max(all.pairs, one.pairs);
  all.passed += one.passed;
  all.rejected += one.rejected;
  all.seconds += one.seconds;
}

// How the last distance of one row stands to that of another: the geometric mean, with the interval of 95 % by a
// bootstrap over outfits and clips.
void print_ratio(const std::string& one, const std::string& other, std::map<std::string, std::vector<Measured>>& all) {
  if (all[one].empty() || all[other].empty()) return;
  std::vector<double> logs;
  for (std::size_t k = 0; k < all[one].size(); ++k)
    logs.push_back((all[one][k].log_distance - all[other][k].log_distance) / all[one][k].rolls);
  const MeanInterval mean = mean_interval(logs, 10000, 1);
  fmt::print(
      "after {} frames `{}` is at {:.2f} ({:.2f} to {:.2f}) times the distance of `{}`, over {} outfits and clips\n",
      measured_at.back(), one, std::exp(mean.mean), std::exp(mean.low), std::exp(mean.high), other, logs.size());
}

}  // namespace

TEST_CASE("taught network: distance from the solver's roll-outs, beside what learns nothing", "[.][taught_tables]") {
  const std::vector<std::string> converged{"run.stepper=conventional",       "run.substeps=1",
                                           "solver.velocity_tolerance=1e-4", "solver.relative_tolerance=1e-4",
                                           "solver.max_newton=60",           "solver.linear_tolerance=0.05"};
  const int every = std::stoi(given("SELVEDGE_TAUGHT_EVERY", "2"));
  std::map<std::string, std::vector<Measured>> all;
  const std::vector<std::string> outfits = names_in(given("SELVEDGE_TAUGHT_OUTFITS", "summer"));
  for (const std::string& outfit : outfits)
    for (const std::string& name : names_in(given("SELVEDGE_TAUGHT_CLIPS", "walk,dance_sway"))) {
      const std::optional<TaughtClip> clip = simulate_clip(setup_of(outfit, name, converged), name, {}, nullptr);
      REQUIRE(clip);
      keep_tissue(clip->setup, nullptr);  // so that no row pays for it
      print_title(outfit + ", " + name);
      for (const Row& row : rows(outfit)) {
        all[row.name].push_back(measured(*clip, row, setup_of(outfit, name, row.overrides), every));
        REQUIRE(all[row.name].back().rolls > 0);
        print_row(row, all[row.name].back());
      }
    }
  print_title("all");
  for (const Row& row : rows(outfits.front())) {
    Measured sum;
    for (const Measured& one : all[row.name]) add(one, sum);
    print_row(row, sum);
  }
  for (const char* one : {"student, response", "student, whole output, response"})
    for (const char* other : {"carried", "fitted"}) print_ratio(one, other, all);
  for (const char* other : {"carried_rough", "carried guess, rough solve", "fitted, rough solve", "draft", "preview"})
    print_ratio("student, rough solve", other, all);
}

}  // namespace selvedge::long_taught_tables
