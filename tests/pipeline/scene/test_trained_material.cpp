#include <catch2/catch.hpp>

#include "learned/steppers/learned_scene.hpp"
#include "pipeline/scene/trained_material_yaml.hpp"
#include "pipeline/training/training_options.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::test_trained_material {
using Catch::Matchers::Contains;

namespace {

Scene scene_of(const std::string& material) {
  const fake::Folder folder("trained_material");
  return read_setup(fake::write(folder, "scene.yaml",
                                "cloths:\n  - {name: towel, rectangle: {size: [1, 1], resolution: [2, 2]}, material: " +
                                    material + "}\n"))
      .scene;
}

}  // namespace

TEST_CASE("trained material: the training text of a weight file names it", "[scene]") {
  TrainingOptions options;
  options.samples.material = {0.3, 20, 30, 4e-5};
  CHECK(trained_material(training_yaml(options)) == options.samples.material);
  options.samples.sample_materials = MaterialSampling::garment;
  CHECK(!trained_material(training_yaml(options)));
  CHECK(!trained_material(""));                              // imported
  CHECK(!trained_material("samples: {material: {mu: 1}}"));  // of another version
  CHECK(!trained_material("samples: [\n\t- {"));             // no YAML
}

TEST_CASE("trained material: cloth that the network does not know is named", "[scene]") {
  const VertexMaterial hood;
  CHECK(unlike_training(scene_of("hood"), hood).empty());
  const std::vector<std::string> cotton = unlike_training(scene_of("cotton"), hood);
  REQUIRE(cotton.size() == 1);  // as dense and as hard to bend
  CHECK_THAT(cotton[0], Contains("towel") && Contains("mu is 385 N/m") && Contains("11.1 N/m"));
  VertexMaterial light = hood;
  light.density = 0.05;
  CHECK(unlike_training(scene_of("hood"), light).size() == 1);
}

}  // namespace selvedge::test_trained_material
