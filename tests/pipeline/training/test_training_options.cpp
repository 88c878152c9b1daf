#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <set>

#include "pipeline/drapes/drape_training_options.hpp"
#include "pipeline/host/csv_columns.hpp"
#include "pipeline/obstacles/setup_paths.hpp"
#include "pipeline/training/objective_options.hpp"
#include "pipeline/training/training_options.hpp"
#include "pipeline/training/training_tables.hpp"
#include "tests/pipeline/files.hpp"
#include "tests/refusal.hpp"
#include "tests/source_root.hpp"

namespace selvedge::test_training_options {

using fake::Folder;

namespace {

std::vector<std::filesystem::path> training_files() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(config_folder() / "training"))
    if (entry.is_regular_file() && !is_drape_training(entry.path())) files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

std::string error_of(const std::filesystem::path& file, const std::vector<std::string>& overrides = {}) {
  return testing::refusal([&] { read_training(file, overrides); });
}

}  // namespace

TEST_CASE("training options: every loss of every configuration reaches its full weight", "[training]") {
  REQUIRE(training_files().size() >= 8);
  for (const std::filesystem::path& file : training_files()) {
    INFO(file);
    const TrainingOptions options = read_training(file);
    CHECK(unfinished_ramps(options).empty());
    const LossOptions& losses = options.objective;
    for (const LossRow& row : loss_rows()) CHECK(weight_at(row.weight(losses), 0.9) == row.weight(losses).to);
    if (losses.targets.to > 0) continue;  // the solver's frame stands for the energies
    CHECK(losses.stretching.to == 1);
    CHECK(losses.collision.weight.to >= 5e5);
  }
  TrainingOptions late;
  late.objective.repulsion.weight = {0, 2e6, 0.5, 1};
  REQUIRE(unfinished_ramps(late).size() == 1);
  CHECK(unfinished_ramps(late)[0].find("objective.repulsion.weight") == 0);
}

TEST_CASE("training options: each weight of the objective is that of a term, and each term has a key", "[training]") {
  std::set<std::string> keys, weighed;
  for (const Key& key : objective_options().section.keys) {
    if (!key.section) continue;
    const bool is_ramp = key.section == &ramp_options().section;
    if (is_ramp || std::ranges::find(key.section->keys, "weight", &Key::name) != key.section->keys.end())
      keys.insert(is_ramp ? key.name : key.name + ".weight");
  }
  for (const LossRow& row : loss_rows()) {
    INFO(row.name);
    weighed.insert(row.weighs);
    const TrainingOptions options =
        read_training(config_folder() / "training" / "tiny.yaml", {"objective." + std::string(row.weighs) + ".to=7.5"});
    CHECK(row.weight(options.objective).to == 7.5);
  }
  CHECK(keys == weighed);
}

TEST_CASE("training tables: every term has its columns, also in a history of other columns", "[training]") {
  const CsvColumns titles(steps_header());
  for (const LossRow& row : loss_rows())
    for (const std::string ending : {"", "_share"}) CHECK(std::ranges::count(titles.names, row.name + ending) == 1);
  StepWindow window;
  StepRecord record{.samples = {{}}, .adam = {}};
  for (const LossRow& row : loss_rows()) record.samples[0].terms.push_back({&row, row.name, 1, 2, 3});
  window.add(record);
  const Trainer trainer;
  const std::string now = steps_header() + window.take_line(trainer, trainer.counts, 1);
  const CsvColumns table(now);
  for (const LossRow& row : loss_rows()) CHECK(table[row.name] == std::vector<double>{2});
  CHECK(with_columns_of_now(now) == now);
  const CsvColumns old(with_columns_of_now("step,contours,bending,gone\n100000,5,-6.25,7\n200000,8,9,10\n"));
  CHECK(old.names == titles.names);
  CHECK(old["step"] == std::vector<double>{100000, 200000});
  CHECK(old["bending"] == std::vector<double>{-6.25, 9});
  CHECK(old["contours"] == std::vector<double>{5, 8});
  CHECK(old["volume"] == std::vector<double>{0, 0});
}

TEST_CASE("training options: ablations differ from their base by what they are named for", "[training]") {
  const auto read = [](const std::string& name) {
    return read_training(config_folder() / "training" / (name + ".yaml"));
  };
  const TrainingOptions hood = read("hood"), repulsive = read("only_repulsive"), full = read("contourcraft");
  CHECK_FALSE(hood.contact.edges);
  CHECK(hood.objective.repulsion.weight.to == 0);
  CHECK(repulsive.contact.edges);
  CHECK_FALSE(repulsive.contact.classify);
  CHECK(repulsive.pool.safeguarded);
  CHECK(repulsive.objective.contours.weight.to == 0);
  CHECK(full.contact.classify);
  CHECK(full.contact.attraction);
  CHECK_FALSE(full.pool.safeguarded);
  CHECK(full.objective.contours.weight.to > 0);
  const TrainingOptions without = read("without_ic_loss"), distorting = read("full_gradient");
  CHECK(without.objective.contours.weight.to == 0);
  CHECK_FALSE(without.contact.attraction);
  CHECK(distorting.objective.contours.gradient == ContourGradient::full);
  CHECK(full.objective.contours.gradient == ContourGradient::translational);
  // Rows that are compared differ in the loss alone, or in what the network is shown alone.
  const auto written = [](TrainingOptions options, double weight, double shown) {
    options.name = "row";
    options.objective.contours.weight.to = weight;
    options.contour_force = shown;
    return training_yaml(options);
  };
  CHECK(full.contour_force == 0);
  CHECK(without.contour_force == 0);
  for (const char* name : {"contourcraft_control", "contourcraft_only_shown", "contourcraft_shown"})
    CHECK(written(read(name), 0, 0) == written(full, 0, 0));
  CHECK(written(read("contourcraft_control"), 300, 0) == written(full, 300, 0));
  CHECK(read("contourcraft_control").objective.contours.weight.to == 0);
  CHECK(read("contourcraft_only_shown").objective.contours.weight.to == 0);
  CHECK(read("contourcraft_only_shown").contour_force == read("contourcraft_shown").contour_force);
  CHECK(read("contourcraft_shown").contour_force == 30);
  CHECK(read("contourcraft_shown").objective.contours.weight.to == full.objective.contours.weight.to);
  // All from one base: what none of them names is the same.
  for (const TrainingOptions* options : {&repulsive, &full, &without, &distorting}) {
    CHECK(options->architecture == hood.architecture);
    // Those of the first stage, and from the second on outfits of them too.
    for (const std::string& garment : hood.samples.garments)
      CHECK(std::ranges::count(options->samples.garments, garment) == 1);
    CHECK(options->samples.garments == repulsive.samples.garments);
    CHECK(options->optimiser.normalise_samples == hood.optimiser.normalise_samples);
  }
}

TEST_CASE("training options: those of SENC differ from their base by what they are named for", "[training]") {
  const auto read = [](const std::string& name) {
    return read_training(config_folder() / "training" / (name + ".yaml"));
  };
  const TrainingOptions senc = read("senc"), second = read("senc_second");
  CHECK(weight_at(senc.objective.volume.weight, 0.6319) == 0);
  CHECK(weight_at(senc.objective.volume.weight, 0.6321) == 3e4);
  CHECK(senc.watch.keep_at == 0.632);
  CHECK(second.steps == std::lround(0.368 * senc.steps));
  CHECK(senc.samples.forces.strongest == 10);
  CHECK(read("senc_no_edges").space.radius == 0);
  CHECK(read("senc_mesh_edges").space.mesh_pairs);
  // One value each: without it the file is its base.
  const auto without = [&](TrainingOptions options, const TrainingOptions& base) {
    options.name = base.name;
    options.objective.volume = base.objective.volume;
    options.objective.vertex_repulsion = base.objective.vertex_repulsion;
    options.space = base.space;
    return training_yaml(options);
  };
  for (const char* name : {"senc_no_edges", "senc_mesh_edges"}) CHECK(without(read(name), senc) == training_yaml(senc));
  for (const char* name : {"senc_frozen", "senc_area", "senc_winding", "senc_vertex_repulsion"}) {
    INFO(name);
    CHECK(without(read(name), second) == training_yaml(second));
    CHECK(training_yaml(read(name)) != training_yaml(second));
  }
  const TrainingOptions layers = read("senc_layers"), layers_second = read("senc_layers_second");
  CHECK(layers.contact.classify);
  CHECK(layers_second.steps == second.steps);
  CHECK(layers_second.objective.volume.weight.from == 3e4);
  CHECK(layers_second.objective.volume.saturation == layers.objective.volume.saturation);
  CHECK(layers_second.contour_force == layers.contour_force);
}

TEST_CASE("training options: a base is replaced key by key, and what is written reads back", "[training]") {
  const Folder folder("training_options");
  fake::write(folder, "base.yaml", "steps: 77\nseed: 5\nobjective: {collision: {thickness: 4 mm}}\n");
  const auto file =
      fake::write(folder, "own.yaml", "base: base.yaml\nseed: 6\nobjective: {collision: {radius: 2 cm}}\n");
  const TrainingOptions options = read_training(file, {"pool.states=3"});
  CHECK(options.name == "own");
  CHECK(options.steps == 77);
  CHECK(options.seed == 6);
  CHECK(options.pool.states == 3);
  CHECK(options.objective.collision.thickness == Approx(4e-3));
  CHECK(options.objective.collision.radius == Approx(2e-2));
  CHECK(options.objective.collision.weight.to == fast_losses().collision.weight.to);

  const auto again = fake::write(folder, "again.yaml", training_yaml(options));
  CHECK(training_yaml(read_training(again)) == training_yaml(options));
}

TEST_CASE("training options: nothing of the validation split, and one clear error each", "[training]") {
  const Folder folder("training_errors");
  const auto file = fake::write(folder, "a.yaml", "steps: 10\n");
  CHECK(error_of(file).empty());
  CHECK(error_of(file, {"samples.garments=[tank_top]"}).find("is not for training") != std::string::npos);
  CHECK(error_of(file, {"samples.garments=[summer]"}).find("is not for training") != std::string::npos);
  CHECK(error_of(file, {"samples.garments=[training_layers]"}).empty());
  CHECK(error_of(file, {"samples.clips=[walk_turning]"}).find("is not for training") != std::string::npos);
  CHECK(error_of(file, {"watch.clip=hug"}).find("is not for training") != std::string::npos);
  CHECK(error_of(file, {"watch.garment=vest"}).find("watch.garment") != std::string::npos);
  CHECK(error_of(file, {"width=100000"}).find("0 to 4096") != std::string::npos);
  CHECK(error_of(file, {"message_steps=100000"}).find("0 to 1024") != std::string::npos);
  CHECK(error_of(file, {"steps=0"}).find("steps") != std::string::npos);
  CHECK(error_of(file, {"optimiser.decay=slow"}).find("halving") != std::string::npos);
  CHECK(error_of(file, {"optimiser.batch=5", "pool.states=4"}).find("give `pool.states`") != std::string::npos);
  CHECK(error_of(file, {"learning_rate=1"}).find("learning_rate") != std::string::npos);
  fake::write(folder, "b.yaml", "base: c.yaml\n");
  const auto circle = fake::write(folder, "c.yaml", "base: b.yaml\n");
  CHECK(error_of(circle).find("leads back") != std::string::npos);
  const auto lost = fake::write(folder, "d.yaml", "base: nowhere.yaml\n");
  CHECK(error_of(lost).find("nowhere.yaml") != std::string::npos);
}

TEST_CASE("training options: learning rates fall as they are said to", "[training]") {
  CHECK(learning_factor(Decay::cosine, 0, 0, 1, 0) == 1);
  CHECK(learning_factor(Decay::cosine, 0.5, 0, 1, 0) == Approx(0.5));
  CHECK(learning_factor(Decay::cosine, 1, 0, 1, 0) == Approx(0).margin(1e-15));
  CHECK(learning_factor(Decay::none, 0.7, 9, 1, 0) == 1);
  // HOOD: 0.5^floor(n / 50,000) + 0.01.
  CHECK(learning_factor(Decay::halving, 0, 49999, 50000, 0.01) == Approx(1.01));
  CHECK(learning_factor(Decay::halving, 0, 150000, 50000, 0.01) == Approx(0.135));
}

namespace {

const std::filesystem::path training_page_file = source_root() / "docs" / "training.md";
const std::string reference_begins = "<!-- written by: selvedge_tests \"[write-docs]\" -->\n";

}  // namespace

TEST_CASE("docs/training.md has the tables as the program has them", "[training]") {
  const std::string text = fake::whole(training_page_file);
  const std::size_t at = text.find(reference_begins);
  REQUIRE(at != std::string::npos);
  CHECK(text.substr(at + reference_begins.size()) == "\n" + training_reference());
}

TEST_CASE("docs/training.md is written anew", "[.][write-docs]") {
  const std::string text = fake::whole(training_page_file);
  std::ofstream(training_page_file) << text.substr(0, text.find(reference_begins) + reference_begins.size()) << "\n"
                                    << training_reference();
}

}  // namespace selvedge::test_training_options
