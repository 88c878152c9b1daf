#include <catch2/catch.hpp>

#include "learned/graph/make_graph.hpp"
#include "learned/network/weights_hdf5.hpp"
#include "learned/steppers/learned_scene.hpp"
#include "learned/steppers/learned_state.hpp"
#include "pipeline/scene/setup.hpp"
#include "pipeline/suites/stability.hpp"
#include "tests/learned/learned_scenes.hpp"
#include "tests/pipeline/files.hpp"
#include "tests/source_root.hpp"

// Rows of the suite of stability that steppers with a network go through.
namespace selvedge::test_network_rows {

using Catch::Matchers::Contains;
using fake::Folder;

namespace {

void write_network(const std::filesystem::path& file, const std::string& preset, double reach) {
  const fake::NarrowNetwork network = fake::narrow_network(preset, reach);
  write_weight_file(file, WeightFile{network.architecture, network.weights, "", {}, ""});
}

StabilityRequest request_of(const Folder& folder, const std::string& stepper, const std::string& runs) {
  fake::write(folder, "scene.yaml",
              "cloths: [{name: sheet, rectangle: {size: [0.3, 0.3], resolution: 6}, pins: [{group: [top_left]}]}]\n"
              "obstacles: [{name: ball, sphere: {radius: 0.1, edge: 0.05}, translate: [0, -0.2, 0]}]\n"
              "run: {frames: 8, fps: 30}\n");
  write_network(folder.path / "own.h5", "hood", 1e-3);
  write_network(folder.path / "other.h5", "contourcraft", 1e-3);
  StabilityRequest request;
  request.suite =
      fake::write(folder, "suite.yaml",
                  "limits: {growth: 1e9, speed: 1e9}\ncases: [{name: fall, scene: scene.yaml, runs: [" + runs + "]}]");
  request.stepper = stepper;
  request.weights = folder.path / "own.h5";
  request.out = folder.path / "out";
  return request;
}

}  // namespace

TEST_CASE("stability: a bare network ends finite or stops with a reason, and what else it does is told",
          "[stability]") {
  const Folder folder("bare_network");
  const std::vector<StabilityRow> rows =
      stability(request_of(folder, "learned", "given, {name: none, fault: nan}, {name: huge, fault: huge}"));
  REQUIRE(rows.size() == 3);
  INFO(stability_table(rows));
  CHECK(passed(rows));
  REQUIRE(rows[1].told.size() > 0);
  CHECK_THAT(rows[1].told[0], Contains("ended in frame 0 not_finite"));
  CHECK(rows[2].max_stretch > 1000);  // finite, and that is all
  CHECK_THAT(stability_markdown(rows), Contains("pass: ended in frame"));
  StabilityRequest same = request_of(folder, "hybrid", "{name: none, fault: nan}");
  const std::vector<StabilityRow> hybrid = stability(same);
  CHECK(passed(hybrid));
  CHECK(hybrid.at(0).frames == 8);
  CHECK(hybrid.at(0).proposed == 0);
}

TEST_CASE("stability: a run may name weights of its own", "[stability]") {
  const Folder folder("other_weights");
  const std::vector<StabilityRow> rows =
      stability(request_of(folder, "learned", "own, {name: other, set: [run.learned.weights=other.h5]}"));
  REQUIRE(rows.size() == 2);
  INFO(stability_table(rows));
  CHECK(rows[0].max_stretch != rows[1].max_stretch);
}

TEST_CASE("stability: the pile has more pairs within reach than a graph takes", "[stability]") {
  const Setup setup = read_setup(source_root() / "configs/stability/pile.yaml", {"run.stepper=conventional"});
  const GraphScene scene = learned_scene(setup.scene).graph;
  const Architecture architecture = architecture_preset("contourcraft");
  const State& start = setup.initial;
  GraphSearch search;
  GraphReport found;
  Graph graph;
  make_graph(scene, make_rest_graph(scene, architecture.features, {}),
             graph_state(setup.scene, start, setup.drive_at(0)), architecture.features,
             random_weights(architecture, 1).tables, search, graph, found);
  CHECK(found.refused.empty());
  CHECK(found.cloth_pairs_beyond > setup.scene.surface.vertex_count);
}

}  // namespace selvedge::test_network_rows
