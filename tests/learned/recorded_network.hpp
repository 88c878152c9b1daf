#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "learned/graph/graph.hpp"
#include "learned/network/weights.hpp"

namespace selvedge::recorded {

// Where the packs of the authors' numbers lie, beside the checkout; empty, with one line of warning, where they do not.
std::filesystem::path pack_folder();

// The steps that were recorded, by file name without extension, for model "hood" or "ccraft".
std::vector<std::string> step_cases(const std::string& model);

// The preset as recorded: with latents of 16.
Architecture recorded_architecture(const std::string& model);

// Weights by the formula of the packs' README, except the few columns of embeddings that it changes afterwards, and
// statistics: the networks read neither.
NetworkWeights formula_weights(const std::string& model);

// The graph that the network saw, from the recorded features and edges.
Graph recorded_graph(const std::filesystem::path& file);

FeatureRows recorded_rows(const std::filesystem::path& file, const std::string& name);

}  // namespace selvedge::recorded
