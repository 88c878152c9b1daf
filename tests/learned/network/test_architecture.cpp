#include <catch2/catch.hpp>

#include <map>

#include "collision/geometry/error.hpp"
#include "learned/network/weights.hpp"

namespace selvedge::test_architecture {

TEST_CASE("architecture: the presets have the published numbers of parameters", "[learned]") {
  // Counted from the shapes in reference/checkpoints; `small` is ours.
  const std::map<std::string, long long> published = {
      {"hood", 5146852}, {"hood_cvpr", 5076964}, {"fine15", 3854164}, {"fine48", 12027604}, {"contourcraft", 8517451}};
  for (const auto& [name, count] : published) {
    INFO(name);
    CHECK(parameter_count(architecture_preset(name)) == count);
  }
  CHECK(parameter_count(architecture_preset("small")) / 1000 == 449);
}

TEST_CASE("architecture: every preset can be built, and its arrays hold what it counts", "[learned]") {
  for (const std::string& name : preset_names()) {
    INFO(name);
    const Architecture a = architecture_preset(name);
    CHECK(a.name == name);
    CHECK_NOTHROW(check_architecture(a, "preset"));
    NetworkWeights weights = blank_weights(a);
    CHECK_NOTHROW(check_weights(a, weights, "preset"));
    long long trained = 0;
    for (const WeightArray& array : weight_arrays(a, weights))
      if (array.trained) trained += static_cast<long long>(array.rows) * array.columns;
    CHECK(trained == parameter_count(a));
    for (const EdgeKind& kind : a.edge_kinds) CHECK(kind.normalised <= a.encoders[kind.encoder].inputs);
  }
}

TEST_CASE("architecture: ContourCraft's paper form has two coarse levels and a node network of 128 x 7", "[learned]") {
  const Architecture a = architecture_preset("contourcraft_paper");
  CHECK(blank_weights(a).steps.front().node.layers.front().weight.cols() == 128 * 7);
  CHECK(a.features.coarse_levels == 2);
  CHECK(blank_weights(architecture_preset("contourcraft")).steps.front().node.layers.front().weight.cols() == 128 * 6);
}

TEST_CASE("architecture: the inputs are as many as the feature options make", "[learned]") {
  for (const std::string& name : preset_names()) {
    INFO(name);
    const Architecture a = architecture_preset(name);
    const FeatureOptions& f = a.features;
    CHECK(node_widths(f).all == a.node_inputs);
    CHECK(node_widths(f).normalised == a.statistics.node);
    CHECK(f.type_columns == a.node_type.columns);
    CHECK(f.level_columns == a.vertex_level.columns);
    CHECK((f.level_columns == 0 || f.highest_level + 1 == a.vertex_level.rows));
    for (const std::string& key : edge_set_keys(f)) {
      INFO(key);
      const bool of_cloth = key == "repulsion_edge" || key == "attraction_edge";
      const FeatureWidths widths = of_cloth            ? cloth_edge_widths(f)
                                   : key == f.body_key ? body_edge_widths(f)
                                                       : mesh_edge_widths(f);
      REQUIRE(edge_kind(a, key) >= 0);
      const EdgeKind& kind = a.edge_kinds[edge_kind(a, key)];
      CHECK(widths.all == a.encoders[kind.encoder].inputs);
      CHECK(widths.normalised == kind.normalised);
    }
    CHECK(edge_set_keys(f).size() == a.edge_kinds.size());
  }
}

TEST_CASE("architecture: what cannot be built is an error", "[learned]") {
  CHECK_THROWS_AS(architecture_preset("hod"), Error);
  const auto refused = [](auto change) {
    Architecture a = architecture_preset("hood");
    change(a);
    CHECK_THROWS_AS(check_architecture(a, "test"), Error);
  };
  refused([](Architecture& a) { a.width = 0; });
  refused([](Architecture& a) { a.width = 1 << 30; });
  refused([](Architecture& a) { a.hidden_layers = 0; });
  refused([](Architecture& a) { a.node_inputs = -1; });
  refused([](Architecture& a) { a.edge_kinds[1].encoder = 77; });
  refused([](Architecture& a) { a.edge_kinds[1].key = "mesh_edge"; });
  refused([](Architecture& a) { a.steps[0].edge_keys = {"world_edge", "mesh_edge"}; });
  refused([](Architecture& a) { a.steps[0].edge_keys = {"gravity_edge"}; });
  refused([](Architecture& a) { a.steps[4].filters[0].near = {"gravity_edge"}; });
  refused([](Architecture& a) { a.steps.resize(5000); });
}

TEST_CASE("weights: an array of the wrong shape is named", "[learned]") {
  const Architecture a = architecture_preset("small");
  const auto problem = [&a](auto change) {
    NetworkWeights weights = blank_weights(a);
    change(weights);
    try {
      check_weights(a, weights, "test");
    } catch (const Error& error) {
      return error.where();
    }
    return std::string("none");
  };
  CHECK(problem([](NetworkWeights&) {}) == "none");
  CHECK(problem([](NetworkWeights& w) { w.steps[2].edges[1].layers[0].weight.resize(64, 128); }) ==
        "test: steps/002/edges/coarse_edge1/layer0/weight");
  CHECK(problem([](NetworkWeights& w) { w.decoder.layers.pop_back(); }) == "test: decoder/layer1/weight");
  CHECK(problem([](NetworkWeights& w) { w.decoder.scale = {1, 1, 1}; }) == "test: decoder/norm/scale");
  CHECK(problem([](NetworkWeights& w) { w.tables.output.mean.clear(); }) == "test: statistics/output/mean");
}

TEST_CASE("weights: random ones follow from the seed", "[learned]") {
  const Architecture a = architecture_preset("small");
  NetworkWeights first = random_weights(a, 7), again = random_weights(a, 7), other = random_weights(a, 8);
  CHECK(first.decoder.layers[0].weight == again.decoder.layers[0].weight);
  CHECK(first.decoder.layers[0].weight != other.decoder.layers[0].weight);
  CHECK(first.decoder.layers[0].weight != first.steps[0].node.layers[1].weight);
}

}  // namespace selvedge::test_architecture
