#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "learned/network/weights_hdf5.hpp"
#include "pipeline/scene/make_stepper.hpp"
#include "pipeline/scene/network_warnings.hpp"
#include "pipeline/training/training_options.hpp"
#include "tests/learned/learned_scenes.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::test_network_warnings {
using Catch::Matchers::Contains;

namespace {

Scene scene_of(const std::string& material) {
  const fake::Folder folder("network_warnings");
  return read_setup(fake::write(folder, "scene.yaml",
                                "cloths:\n  - {name: towel, rectangle: {size: [1, 1], resolution: [2, 2]}, material: " +
                                    material + "}\n"))
      .scene;
}

// Of a towel that an untrained network moves.
std::vector<std::string> warnings_of(const std::string& preset, const std::string& gravity, bool spoiled = false,
                                     const std::string& stepper = "learned") {
  const fake::Folder folder("network_warnings");
  fake::NarrowNetwork network = fake::narrow_network(preset);
  if (spoiled)
    weight_arrays(network.architecture, network.weights)[0].data[0] = std::numeric_limits<float>::quiet_NaN();
  write_weight_file(folder.path / "w.h5", {network.architecture, network.weights, "", {}, ""});
  return scene_warnings(
      read_setup(fake::write(folder, "scene.yaml",
                             "cloths: [{rectangle: {size: [1, 1], resolution: 2}}]\ngravity: " + gravity +
                                 "\nrun: {stepper: " + stepper + ", learned: {weights: w.h5}}\n")));
}

}  // namespace

TEST_CASE("network warnings: the training text of a weight file says what it was trained with", "[run]") {
  TrainingOptions options;
  options.samples.material = {0.3, 20, 30, 4e-5};
  options.samples.edge = 0.03;
  CHECK(trained_with(training_yaml(options)).material == options.samples.material);
  CHECK(trained_with(training_yaml(options)).edge == 0.03);
  options.samples.sample_materials = MaterialSampling::garment;
  CHECK(!trained_with(training_yaml(options)).material);
  CHECK(!trained_with("").material);  // imported
  CHECK(!trained_with("").edge);
  CHECK(!trained_with("samples: {material: {mu: 1}}").material);  // of another version
  CHECK(!trained_with("samples: [\n\t- {").material);             // no YAML
}

TEST_CASE("network warnings: cloth that the network does not know is named", "[run]") {
  const VertexMaterial hood;
  CHECK(unlike_training(scene_of("hood"), {hood, {}}).empty());
  const std::vector<std::string> cotton = unlike_training(scene_of("cotton"), {hood, {}});
  REQUIRE(cotton.size() == 1);  // as dense and as hard to bend
  CHECK_THAT(cotton[0], Contains("towel") && Contains("mu is 385 N/m") && Contains("11.1 N/m"));
  VertexMaterial light = hood;
  light.density = 0.05;
  CHECK(unlike_training(scene_of("hood"), {light, {}}).size() == 1);
}

TEST_CASE("network warnings: edges of another length than in training are named", "[run]") {
  const double mean = (2 + std::sqrt(2.0)) / 3;  // of a square's two triangles
  CHECK(unlike_training(scene_of("hood"), {{}, mean / 1.4}).empty());
  CHECK(unlike_training(scene_of("hood"), {{}, 1.4 * mean}).empty());
  for (const double trained : {mean / 1.6, 1.6 * mean}) {
    const std::vector<std::string> sentences = unlike_training(scene_of("hood"), {{}, trained});
    REQUIRE(sentences.size() == 1);
    CHECK_THAT(sentences[0], Contains("towel") && Contains("1.14e+03 mm"));
  }
}

TEST_CASE("network warnings: gravity that a network does not see is named", "[run]") {
  CHECK(warnings_of("hood", "[0, -9.81, 0]").empty());
  const std::vector<std::string> moon = warnings_of("hood", "[0, -1.62, 0]");
  REQUIRE(moon.size() == 1);
  CHECK_THAT(moon[0], Contains("gravity is [0, -1.62, 0] m/s2"));
  CHECK(warnings_of("hood", "[0, -1.62, 0]", false, "conventional").empty());
  CHECK(warnings_of("small_senc", "[0, -1.62, 0]").empty());
}

TEST_CASE("network warnings: numbers of a network that are not finite are counted", "[run]") {
  for (const std::string stepper : {"learned", "hybrid"}) {
    const std::vector<std::string> sentences = warnings_of("hood", "[0, -9.81, 0]", true, stepper);
    REQUIRE(sentences.size() == 1);
    CHECK_THAT(sentences[0], Contains("w.h5") && Contains("1 of the network's numbers"));
  }
}

}  // namespace selvedge::test_network_warnings
