#include <catch2/catch.hpp>

#include <sstream>

#include "pipeline/training/train.hpp"
#include "tests/pipeline/files.hpp"
#include "tests/pipeline/training/tiny_training.hpp"

// Stages of training: all three with the configuration `tiny` from scratch, and what the third one starts from.
namespace selvedge::test_training_stages {

using fake::Folder;

namespace {

using Overrides = std::vector<std::string>;

// What stages 2 and 3 change (configs/training/only_repulsive.yaml and contourcraft.yaml), shorter.
const Overrides repulsive{"contact.edges=true",
                          "samples.start=untangle",
                          "pool.safeguarded=true",
                          "pool.no_contact_share=0.5",
                          "objective.collision.weight.from=1e6",
                          "objective.repulsion.weight.to=2e6",
                          "objective.repulsion.weight.begin=0",
                          "objective.repulsion.weight.end=0.2",
                          "optimiser.learning_rate=7e-4",
                          "steps=900"};
const Overrides contours{"samples.start=tangled",
                         "samples.shapes=2",
                         "samples.shape_spread=3",
                         "pool.safeguarded=false",
                         "contact.classify=true",
                         "objective.repulsion.weight.from=2e6",
                         "objective.contours.weight.to=30",
                         "objective.contours.weight.begin=0",
                         "objective.contours.weight.end=0.2",
                         "contour_force=30",
                         "steps=1500"};

std::filesystem::path tiny() { return config_folder() / "training" / "tiny.yaml"; }

Overrides after(const Folder& folder, const std::string& stage, std::initializer_list<const Overrides*> parts) {
  Overrides all;
  for (const Overrides* part : parts) all.insert(all.end(), part->begin(), part->end());
  all.push_back("weights=" + (folder.path / stage / "weights.h5").string());
  return all;
}

void train_stage(const Folder& folder, const std::string& stage, const Overrides& overrides, std::ostream& log) {
  log << "stage " << stage << "\n";
  const TrainSummary summary = train({tiny(), overrides, folder.path / stage, false, &log, {}});
  CHECK(summary.finished);
  CHECK(summary.counts.bad == 0);
}

enum class Judge { everything, cloth_apart, no_contact };

// The weights of a stage on skinned states and a roll-out of `arm_circles`, which is of the validation split: by the
// whole objective, without contact of cloth with cloth, or without the body's contact too, which is most of the gap.
TrainingMeasure judged(const std::filesystem::path& stage, Overrides overrides, Judge by) {
  if (by != Judge::everything) overrides.push_back("contact.edges=false");
  TrainingOptions options = read_training(tiny(), overrides);
  options.weights = (stage / "weights.h5").string();
  if (by == Judge::no_contact) options.objective.collision.weight = {0, 0, 0, 0};
  options.samples.start = GarmentStart::skinned;
  options.samples.clips = {options.watch.clip = "arm_circles"};
  options.watch.frames = 30;
  options.watch.fixed_states = 8;
  const auto trainer = make_trainer(options);
  TrainingWatch watch = make_training_watch(options, *trainer);
  return measure(*trainer, watch);
}

// Mean intersecting pairs of four roll-outs of 30 frames that start tangled in `arm_circles`, the same for all stages.
double tangled_pairs(const std::filesystem::path& stage, Overrides overrides) {
  for (const char* start : {"samples.start=tangled", "samples.shapes=2", "samples.shape_spread=3"})
    overrides.push_back(start);
  TrainingOptions options = read_training(tiny(), overrides);
  options.weights = (stage / "weights.h5").string();
  options.samples.clips = {"arm_circles"};
  const auto trainer = make_trainer(options);
  RollMaker maker{
      options, trained_architecture(options).features, make_training_world(options.samples, options.seed), {}};
  double pairs = 0;
  for (const std::uint64_t number : {0u, 2u, 4u, 6u}) {
    RollRequest request = draw_roll(options, maker.world, number, 1);
    request.still = request.mirrored = false;
    request.cloth_contact = true;
    request.frames = 30;
    request.first_frame = 0;
    const RollMeasure measure = measure_roll(*trainer, make_roll(maker, request));
    CHECK(measure.finite);
    pairs += measure.pairs / 4;
  }
  return pairs;
}

}  // namespace

TEST_CASE("training: three stages of `tiny` from scratch, judged on an unseen clip", "[training][.long]") {
  const Folder folder("tiny_stages");
  std::ostringstream log;
  train_stage(folder, "first", {"steps=3600"}, log);
  const Overrides second = after(folder, "first", {&repulsive});
  train_stage(folder, "second", second, log);
  const Overrides third = after(folder, "second", {&repulsive, &contours});
  train_stage(folder, "third", third, log);

  const TrainingMeasure first = judged(folder.path / "first", {}, Judge::cloth_apart),
                        alone = judged(folder.path / "third", third, Judge::no_contact),
                        before = judged(folder.path / "second", second, Judge::everything),
                        end = judged(folder.path / "third", third, Judge::everything);
  for (const auto& [name, m] : {std::pair("first", &first), std::pair("third, without contact", &alone),
                                std::pair("second", &before), std::pair("third", &end)})
    log << name << ": gap closed " << m->skinned.closed << " worn, " << m->minimised.closed << " minimised, pairs "
        << m->roll.pairs << ", at the end " << m->roll.pairs_at_end << ", strain " << m->roll.strain << "\n";
  const double tangled_before = tangled_pairs(folder.path / "second", second),
               tangled_end = tangled_pairs(folder.path / "third", third);
  log << "from tangled starts: pairs " << tangled_before << " before the third stage, " << tangled_end << " after it\n";
  WARN(log.str());
  CHECK(first.skinned.closed > 0.5);
  CHECK(alone.skinned.closed > 0.5);
  CHECK(tangled_end < tangled_before);
  for (const TrainingMeasure* m : {&first, &before, &end}) {
    CHECK(m->roll.finite);
    CHECK(m->roll.frames == 30);
  }
}

TEST_CASE("training: at least half of the third stage's starts have 20 pairs or more", "[training][.long]") {
  const TrainingOptions options = read_training(config_folder() / "training" / "contourcraft.yaml");
  RollMaker maker{
      options, trained_architecture(options).features, make_training_world(options.samples, options.seed), {}};
  int with_contact = 0, tangled = 0;
  for (std::uint64_t number = 0; with_contact < 30; ++number) {
    const RollRequest asked = draw_roll(options, maker.world, number, 1);
    if (!asked.cloth_contact) continue;
    int pairs = 0;
    tangled_place(maker, asked, pairs);
    ++with_contact;
    tangled += pairs >= 20;
  }
  WARN(tangled << " of " << with_contact << " starts have 20 pairs or more");
  CHECK(2 * tangled >= with_contact);
}

}  // namespace selvedge::test_training_stages
