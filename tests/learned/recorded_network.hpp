#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "learned/graph/graph.hpp"
#include "learned/network/weights.hpp"

namespace selvedge::recorded {

// The folder with packs of the authors' numbers, beside the checkout; empty, with one line of warning: there is none.
std::filesystem::path pack_folder();

// The recorded steps, as file names without extension, for model "hood" or "ccraft".
std::vector<std::string> step_cases(const std::string& model);

// The recorded preset, with latents of 16.
Architecture recorded_architecture(const std::string& model);

// Weights by the formula of the packs' README, except the few columns of embeddings that it changes afterwards, and
// statistics: the networks read neither.
NetworkWeights formula_weights(const std::string& model);

// The network's graph, from the recorded features and edges.
Graph recorded_graph(const std::filesystem::path& file);

FeatureRows recorded_rows(const std::filesystem::path& file, const std::string& name);

}  // namespace selvedge::recorded
