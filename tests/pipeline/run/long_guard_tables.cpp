#include <catch2/catch.hpp>

#include <fmt/format.h>

#include <cstdlib>
#include <iostream>
#include <map>

#include "collision/geometry/distance.hpp"
#include "learned/network/weights_hdf5.hpp"
#include "learned/steppers/learned_state.hpp"
#include "learned/steppers/learned_stepper.hpp"
#include "pipeline/run/prepare.hpp"
#include "pipeline/run/simulate.hpp"
#include "tests/frame.hpp"
#include "tests/physics/spoiled_steps.hpp"
#include "tests/pipeline/files.hpp"

// Prints tables of the guard on recorded conventional steps of garments on bodies. They have quantiles on training
// scenes, which set its bounds, and its refusals on validation scenes: of unchanged steps, of spoiled ones, and of a
// network's (SELVEDGE_WEIGHTS). SELVEDGE_GUARD_FRAMES: frames per scene.
namespace selvedge::test_guard_tables {

using fake::Folder;
using testing::RecordedStep;

namespace {

constexpr double dt = 1.0 / 30;

struct WornScene {
  std::string garment, clip;
};
const std::vector<WornScene> training_scenes{{"{cut: tshirt, edge: 35 mm}", "walk"},
                                             {"{cut: skirt_long, edge: 40 mm}", "run"},
                                             {"{cut: dress_tight, edge: 35 mm}", "dance_sway"},
                                             {"{cut: vest, edge: 35 mm}", "jumping_jacks"},
                                             {"{outfit: training_layers, form: small}", "spin"}};
const std::vector<WornScene> validation_scenes{{"{cut: long_sleeved_shirt, edge: 35 mm}", "twist"},
                                               {"{cut: skirt_flared, edge: 40 mm}", "kick"},
                                               {"{cut: trousers, edge: 35 mm}", "walk_turning"},
                                               {"{cut: dress_flowing, edge: 40 mm}", "dance_waltz"},
                                               {"{outfit: summer, form: small}", "arm_circles"}};

int frames_of_each() {
  const char* set = std::getenv("SELVEDGE_GUARD_FRAMES");
  return set ? std::atoi(set) : 200;
}

Setup worn(const Folder& folder, const WornScene& scene) {
  Setup setup = read_setup(fake::write(
      folder, "worn.yaml",
      fmt::format("cloths: [{{name: worn, garment: {}, start: {{from: draped}}, material: hood}}]\nobstacles: [{{name: "
                  "person, body: {{model: mannequin, clip: {}}}}}]\nrun: {{fps: 30}}\n",
                  scene.garment, scene.clip)));
  setup.initial = prepare(setup).value().state;
  return setup;
}

// Calls `see` with each conventional step.
template <class See>
void record(const Setup& setup, See&& see) {
  const auto stepper = make_recovering_conventional_stepper(setup.scene, setup.run.conventional);
  State before = setup.initial, from = setup.initial;
  for (int f = 0; f < frames_of_each(); ++f) {
    State to;
    const Drive drive = setup.drive_at(from.time + dt);
    const StepReport report = testing::frame(setup.scene, *stepper, from, drive, dt, to);
    REQUIRE(report.status == StepStatus::accepted);
    see(RecordedStep{before, from, to, drive}, report);
    before = std::move(from);
    from = std::move(to);
  }
}

// The guard's verdict of positions, contact included.
struct Judge {
  explicit Judge(const Scene& scene) : guard(scene, {}), stage(scene) {}
  Guard guard;
  ContactStage stage;
  GuardMeasures measures = {};
  AuditMemory audits = {};
  int pairs = 0, inside = 0, passed = 0;  // at the end, and on the straight path there, where contact was looked at

  Verdict operator()(const RecordedStep& step, const Points& x) {
    const Verdict verdict = judge(
        guard, step.from, step.drive, dt, x,
        [&] { return touching_vertices(stage, step.from, step.drive.obstacles, x); }, measures);
    if (verdict != Verdict::admitted) return verdict;
    const Audit audit = audit_positions(guard.scene, x, step.drive.obstacles, &audits);
    pairs = audit.intersecting_pairs();
    inside = audit.inside_vertices;
    passed = audit_path(stage.world, {}, gather_nodes(step.from.x, step.from.obstacles),
                        gather_nodes(x, step.drive.obstacles), audits)
                 .passed_through();
    return pairs + inside + passed == 0 ? Verdict::admitted : Verdict::penetrating;
  }
};

struct Counts {
  int all = 0, counted = 0, refused = 0;
  std::map<int, int> reasons = {};
  std::vector<std::string> missed = {};  // scene, frame, and errors
};

std::string text(const std::string& name, const Counts& c) {
  std::string reasons;
  for (const auto& [verdict, count] : c.reasons) reasons += fmt::format(" {}:{}", verdict, count);
  return fmt::format("{:<24} {:>6} {:>6} {:>6} {:>7.1f} % {}\n", name, c.all, c.counted, c.refused,
                     c.counted > 0 ? 100.0 * c.refused / c.counted : 0, reasons);
}

// What stands in for a step of another time of the body: worn cloth is carried along with the body for some frames.
Points of_another_body_frame(const Setup& setup, const RecordedStep& step) {
  constexpr int frames = 4;
  const Points later = setup.drive_at(step.to.time + frames * dt).skinned_targets;
  Points x = step.to.x;
  for (Eigen::Index v = 0; v < x.rows(); ++v)
    if (step.drive.skinned_targets.rows() > v && step.drive.skinned_targets.row(v).allFinite())
      x.row(v) += later.row(v) - step.drive.skinned_targets.row(v);
  for (const int pin : setup.scene.pins) x.row(pin) = step.to.x.row(pin);
  return x;
}

// The first cloth goes to the other side of each other that is near.
Points with_layers_swapped(const Setup& setup, const RecordedStep& step) {
  constexpr double near = 0.02;  // [m]
  Points x = step.to.x;
  const Eigen::Index own = setup.scene.cloths.front().vertex_count;
  for (Eigen::Index v = 0; v < own && own < x.rows(); ++v) {
    Eigen::Index nearest = 0;
    const double squared =
        (step.to.x.bottomRows(x.rows() - own).rowwise() - step.to.x.row(v)).rowwise().squaredNorm().minCoeff(&nearest);
    if (squared < near * near) x.row(v) = 2 * step.to.x.row(own + nearest) - step.to.x.row(v);
  }
  for (const int pin : setup.scene.pins) x.row(pin) = step.to.x.row(pin);
  return x;
}

double quantile(std::vector<double> values, double q) {
  if (values.empty()) return 0;
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1))];
}

}  // namespace

TEST_CASE("guard tables: what conventional steps of training scenes measure", "[guard_tables][.long]") {
  std::map<std::string, std::vector<double>> values;
  for (const WornScene& scene : training_scenes) {
    const Folder folder("guard_training");
    const Setup setup = worn(folder, scene);
    Judge judged(setup.scene);
    std::map<std::string, std::vector<double>> own;
    record(setup, [&](const RecordedStep& step, const StepReport&) {
      if (!step.from.clean || step.from.pinched) return;
      const GuardMeasures m = measure(judged.guard, step.from, step.drive, dt, step.to.x, [&] {
        return touching_vertices(judged.stage, step.from, step.drive.obstacles, step.to.x);
      });
      own["acceleration"].push_back(m.acceleration);
      own["mean_acceleration"].push_back(m.mean_acceleration);
      if (m.change_of_motion > 0.8)
        own["mean_acceleration where the change is over 0.8"].push_back(m.mean_acceleration);
      if (m.change_of_motion > 0.9)
        own["mean_acceleration where the change is over 0.9"].push_back(m.mean_acceleration);
      own["change_of_motion"].push_back(m.change_of_motion);
      own["stretch"].push_back(m.stretch);
      own["stretch growth"].push_back(m.stretch / m.stretch_before);
      own["energy_growth"].push_back(m.energy_growth);
      own["patch_acceleration"].push_back(m.patch_acceleration);
      own["imbalance [mm]"].push_back(1e3 * m.imbalance);
      own["decrement"].push_back(m.decrement);
      own["in contact"].push_back(m.in_contact);
    });
    std::cout << fmt::format("{} {}: {} clean steps\n", scene.garment, scene.clip, own["stretch"].size());
    for (const auto& [name, all] : own) {
      std::cout << fmt::format("  {:<20} median {:>9.4g}  99 % {:>9.4g}  99.9 % {:>9.4g}  most {:>9.4g}\n", name,
                               quantile(all, 0.5), quantile(all, 0.99), quantile(all, 0.999), quantile(all, 1));
      values[name].insert(values[name].end(), all.begin(), all.end());
    }
  }
  std::cout << fmt::format("all: {} clean steps\n", values["stretch"].size());
  for (const auto& [name, all] : values)
    std::cout << fmt::format("  {:<20} median {:>9.4g}  99 % {:>9.4g}  99.9 % {:>9.4g}  most {:>9.4g}\n", name,
                             quantile(all, 0.5), quantile(all, 0.99), quantile(all, 0.999), quantile(all, 1));
  CHECK(values["stretch"].size() > 100);
}

TEST_CASE("guard tables: what it refuses on validation scenes", "[guard_tables][.long]") {
  Counts conventional;
  std::map<std::string, Counts> spoiled, proposals;
  const char* weights = std::getenv("SELVEDGE_WEIGHTS");
  for (const WornScene& scene : validation_scenes) {
    const Folder folder("guard_validation");
    const Setup setup = worn(folder, scene);
    Judge judged(setup.scene);
    std::unique_ptr<Stepper> proposer;
    if (weights) {
      const WeightFile file = read_weight_file(weights);
      proposer = make_learned_stepper(setup.scene, file.architecture, file.weights);
    }
    record(setup, [&](const RecordedStep& step, const StepReport&) {
      if (!step.from.clean || step.from.pinched || step.from.frame < 1) return;
      const auto count = [&](Counts& c, const Points& x, bool counts, double error = 0) {
        ++c.all;
        if (!counts) return;
        ++c.counted;
        if (const Verdict verdict = judged(step, x); verdict != Verdict::admitted) {
          ++c.refused;
          ++c.reasons[static_cast<int>(verdict)];
        } else if (error > 0) {
          const GuardMeasures& m = judged.measures;
          c.missed.push_back(fmt::format(
              "{} {} frame {}: largest error {:.1f} mm, RMS {:.1f} mm; accelerations {:.1f} and {:.1f}, change {:.2f}, "
              "energy {:.3f}, patches {:.1f}, imbalance {:.3f} mm",
              scene.garment, scene.clip, step.from.frame, 1e3 * error,
              1e3 * std::sqrt((x - step.to.x).rowwise().squaredNorm().mean()), m.acceleration, m.mean_acceleration,
              m.change_of_motion, m.energy_growth, m.patch_acceleration, 1e3 * m.imbalance));
        }
      };
      const int refused = conventional.refused;
      count(conventional, step.to.x, true);
      if (conventional.refused > refused)
        conventional.missed.push_back(fmt::format(
            "{} {} frame {}: pairs {}, inside {}, passed through {}; mean acceleration {:.1f}, change {:.2f}",
            scene.garment, scene.clip, step.from.frame, judged.pairs, judged.inside, judged.passed,
            judged.measures.mean_acceleration, judged.measures.change_of_motion));
      const auto pairs = [&](const Points& x) {
        return audit_positions(setup.scene, x, step.drive.obstacles).intersecting_pairs();
      };
      const auto count_spoiled = [&](const std::string& name, const Points& x) {
        const double error = (x - step.to.x).rowwise().norm().maxCoeff();
        count(spoiled[name], x, !(error < 5e-3) || pairs(x) > 0, error);
      };
      if (step.from.frame % 4 == 0) {
        for (const auto& [name, spoil] : testing::spoils()) count_spoiled(name, spoil(setup.scene, step));
        count_spoiled("layers swapped", with_layers_swapped(setup, step));
        count_spoiled("wrong body frame", of_another_body_frame(setup, step));
      }
      if (!proposer || step.from.frame % 2) return;
      State start = step.from, made;
      carry_frame(step.before, start);
      if (proposer->step(start, step.drive, dt, made).status != StepStatus::accepted) return;
      const double error = 1e3 * (made.x - step.to.x).rowwise().norm().maxCoeff();
      const bool adds = pairs(made.x) > 0;
      const std::string bin = error < 2    ? "a: below 2 mm"
                              : error < 5  ? "b: 2 to 5 mm"
                              : error < 10 ? "c: 5 to 10 mm"
                              : error < 20 ? "d: 10 to 20 mm"
                                           : "e: over 20 mm";
      count(proposals[bin + (adds ? ", pairs" : ", clean")], made.x, true);
    });
  }
  std::cout << "verdicts by number, see Verdict in stepper.hpp\n"
            << fmt::format("{:<24} {:>6} {:>6} {:>6}\n", "", "all", "judged", "refused")
            << text("conventional", conventional);
  for (const std::string& line : conventional.missed) std::cout << "    refused: " << line << "\n";
  int counted = 0, refused = 0;
  for (const auto& [name, counts] : spoiled) {
    std::cout << text(name, counts);
    for (const std::string& line : counts.missed) std::cout << "    missed: " << line << "\n";
    counted += counts.counted;
    refused += counts.refused;
  }
  for (const auto& [name, counts] : proposals) std::cout << text("proposal, " + name, counts);
  CHECK(conventional.refused <= 0.01 * conventional.counted);
  CHECK(refused >= 0.99 * counted);
}

}  // namespace selvedge::test_guard_tables
