#include <catch2/catch.hpp>

#include "learned/network/engine.hpp"
#include "learned/network/packed_network.hpp"
#include "tests/learned/network_by_definition.hpp"
#include "tests/learned/recorded_network.hpp"

namespace selvedge::test_network_parity {

namespace {

float difference(const FeatureRows& a, const FeatureRows& b) {
  REQUIRE(a.rows() == b.rows());
  REQUIRE(a.cols() == b.cols());
  return a.size() == 0 ? 0 : (a - b).cwiseAbs().maxCoeff();
}

const FeatureRows& latents_of(const Graph& graph, const std::vector<FeatureRows>& latents, const std::string& key) {
  for (std::size_t set = 0; set < graph.edge_sets.size(); ++set)
    if (graph.edge_sets[set].key == key) return latents[set];
  throw std::logic_error(key);
}

// Limits of the packs' README.
constexpr float output_limit = 2e-5f, latent_limit = 1e-4f;

void check_nodes(const std::filesystem::path& file, const Graph& graph, const LatentTrace& trace) {
  const FeatureRows cloth = recorded::recorded_rows(file, "latent_cloth");
  const FeatureRows body = recorded::recorded_rows(file, "latent_body_active");
  const int nodes = graph.cloth_nodes, others = static_cast<int>(graph.nodes.rows()) - nodes;
  REQUIRE(trace.nodes.size() == 16);
  for (int step = 0; step < 16; ++step) {
    INFO("after step " << step);
    CHECK(difference(trace.nodes[step].topRows(nodes), cloth.middleRows(step * nodes, nodes)) < latent_limit);
  }
  CHECK(difference(trace.nodes.front().bottomRows(others), body.topRows(others)) < latent_limit);
  CHECK(difference(trace.nodes.back().bottomRows(others), body.bottomRows(others)) < latent_limit);
}

void check_edges(const std::filesystem::path& file, const std::string& name, const std::string& key, const Graph& graph,
                 const LatentTrace& trace, bool first) {
  INFO(name);
  if (first)
    CHECK(difference(latents_of(graph, trace.edges_first, key),
                     recorded::recorded_rows(file, "latent_" + name + "_enc")) < latent_limit);
  CHECK(difference(latents_of(graph, trace.edges_last, key),
                   recorded::recorded_rows(file, "latent_" + name + "_last")) < latent_limit);
}

void check_body_edges(const std::filesystem::path& file, const std::string& name, const Graph& graph,
                      const LatentTrace& trace) {
  for (const bool last : {false, true}) {
    const std::string end = last ? "_last" : "_enc";
    const FeatureRows down = recorded::recorded_rows(file, "latent_" + name + "_cloth_to_body" + end);
    const FeatureRows up = recorded::recorded_rows(file, "latent_" + name + "_body_to_cloth" + end);
    const FeatureRows& ours = latents_of(graph, last ? trace.edges_last : trace.edges_first, name + "_edge");
    CHECK(difference(ours.topRows(down.rows()), down) < latent_limit);
    CHECK(difference(ours.bottomRows(up.rows()), up) < latent_limit);
  }
}

void check_latents(const std::string& model, const std::filesystem::path& file, const Graph& graph,
                   const LatentTrace& trace) {
  check_nodes(file, graph, trace);
  check_edges(file, "mesh", "mesh_edge", graph, trace, false);
  if (model == "hood") {
    CHECK(difference(latents_of(graph, trace.edges_first, "coarse_edge2"),
                     recorded::recorded_rows(file, "latent_coarse2_enc")) < latent_limit);
    for (const std::string level : {"0", "1"})
      check_edges(file, "coarse" + level, "coarse_edge" + level, graph, trace, false);
    check_body_edges(file, "world", graph, trace);
  } else {
    for (const std::string name : {"repulsion", "attraction"})
      check_edges(file, name, name + "_edge", graph, trace, true);
    check_edges(file, "coarse3", "coarse_edge3", graph, trace, true);
    check_body_edges(file, "body", graph, trace);
  }
}

// `infer(graph, trace)` against every recorded step.
template <class Infer>
void check_all(const std::string& model, const Infer& infer) {
  const std::filesystem::path folder = recorded::pack_folder();
  if (folder.empty()) return;
  for (const std::string& name : recorded::step_cases(model)) {
    INFO(name);
    const std::filesystem::path file = folder / (name + ".npz");
    const Graph graph = recorded::recorded_graph(file);
    LatentTrace trace;
    const FeatureRows output = infer(graph, &trace);
    CHECK(difference(output, recorded::recorded_rows(file, "decoder_output")) < output_limit);
    if (name == "hood_step2" || name == "ccraft_fold_step1") check_latents(model, file, graph, trace);
  }
}

}  // namespace

TEST_CASE("network parity: by definition, every recorded step has the authors' output and latents", "[learned]") {
  for (const std::string model : {"hood", "ccraft"}) {
    const Architecture a = recorded::recorded_architecture(model);
    const NetworkWeights weights = recorded::formula_weights(model);
    check_all(model,
              [&](const Graph& graph, LatentTrace* trace) { return by_definition::infer(a, weights, graph, trace); });
  }
}

TEST_CASE("network parity: the engine has the authors' output and latents with every instruction set", "[learned]") {
  for (const InstructionSet set : {InstructionSet::plain, InstructionSet::avx2, InstructionSet::avx512}) {
    if (!is_supported(set)) {
      WARN("skipped: this machine has no " + name_of(set));
      continue;
    }
    INFO(name_of(set));
    for (const std::string model : {"hood", "ccraft"}) {
      const auto network = pack_network(recorded::recorded_architecture(model), recorded::formula_weights(model), set);
      check_all(model, [&](const Graph& graph, LatentTrace* trace) { return infer(*network, graph, trace); });
    }
  }
}

}  // namespace selvedge::test_network_parity
