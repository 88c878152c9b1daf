#include <catch2/catch.hpp>

#include "learned/network/weights_hdf5.hpp"
#include "pipeline/compare/training_sequences.hpp"
#include "pipeline/scene/setup.hpp"
#include "pipeline/training/training_checkpoint_hdf5.hpp"
#include "tests/pipeline/training/own_data.hpp"

namespace selvedge::test_training_paths {

using fake::Folder;
using fake::has;
using fake::OwnData;
using fake::weights_of;
using fake::write_amass;

TEST_CASE("training paths: a folder that has moved goes on with the same bits", "[training]") {
  const Folder moved("training_people_moved");
  const OwnData own("training_people_before");
  const auto inside = own.folder.path / "data", there = moved.path / "data";
  std::filesystem::create_directory(inside);
  for (const char* name : {"body.npz", "skirt.obj", "moves", "own.yaml"})
    std::filesystem::rename(own.folder.path / name, inside / name);
  WeightFile earlier;
  TrainingOptions options = read_training(inside / "own.yaml");
  earlier.architecture = trained_architecture(options);
  earlier.weights = initial_weights(earlier.architecture, 3);
  write_weight_file(inside / "earlier.h5", earlier);
  const std::vector<std::string> overrides{"weights=earlier.h5"};
  options = read_training(inside / "own.yaml", overrides);
  auto whole = make_trainer(options);
  for (int k = 0; k < 2; ++k) train_step(*whole);
  write_training_checkpoint(inside / "checkpoint.h5", *whole, {"a\n", "b\n", 0, 0, 0});
  for (int k = 0; k < 2; ++k) train_step(*whole);
  CHECK_FALSE(has(fake::whole(inside / "checkpoint.h5"), own.folder.path.string()));

  std::filesystem::rename(inside, there);
  const TrainingOptions again = read_training(there / "own.yaml", overrides);
  TrainingHistory history;
  auto resumed = read_training_checkpoint(there / "checkpoint.h5", again, history);
  CHECK_FALSE(resumed->trained_on.whole);  // the earlier weights say nothing
  for (int k = 0; k < 2; ++k) train_step(*resumed);
  CHECK(weights_of(*resumed) == weights_of(*whole));
  write_amass(there / "moves" / "kick.npz", 40, 0.4);
  CHECK_THROWS_WITH(read_training_checkpoint(there / "checkpoint.h5", again, history),
                    Catch::Contains("kick.npz") && Catch::Contains("has changed since the run began"));
}

TEST_CASE("training paths: outfits are looked for beside the training file", "[training]") {
  const Folder folder("training_people_outfits");
  const std::string program = fake::whole(config_folder() / "outfits.yaml");
  fake::write(folder, "outfits.yaml",
              program + "  - {name: mine, garments: [skirt_short], edge: 0.05, small_edge: 0.05}\n");
  const auto training = fake::write(folder, "own.yaml",
                                    "base: " + (config_folder() / "training" / "tiny.yaml").string() +
                                        "\nsamples:\n  garments: none\n  people:\n    - name: doll\n"
                                        "      body: {model: mannequin}\n      clips: [walk, spin]\n"
                                        "      wear: [{garments: [{outfit: mine}]}]\n  split: {test: [spin]}\n");
  const TrainingOptions options = read_training(training);
  const TrainingWorld world = make_training_world(options.samples, 1);
  REQUIRE(world.wear.size() == 1);
  CHECK(world.wear[0].garments[0].name == "skirt_short");

  Comparison comparison;
  comparison.file = folder.path / "compare.yaml";
  comparison.sequences.training = "own.yaml";
  comparison.sequences.file = (config_folder() / "evaluation" / "garment.yaml").string();
  add_training_sequences(comparison);
  REQUIRE(comparison.scenes.size() == 1);
  const Setup setup = read_setup(comparison.scenes[0].file, comparison.scenes[0].overrides);
  CHECK(setup.scene.cloths[0].name == "skirt_short");
}

}  // namespace selvedge::test_training_paths
