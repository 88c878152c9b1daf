#pragma once

#include <string>
#include <vector>

#include "learned/network/architecture.hpp"

namespace selvedge {

// The preset (learned/network/architecture.hpp) of a published checkpoint with these tensor names: hood, hood_cvpr,
// fine15, fine48 or contourcraft; empty: none. Tables of the names: published_names.cpp.
std::string published_kind(const std::vector<std::string>& tensors);

// The number of steps of a checkpoint of the fine baselines, by its names. Its kind is fine15 or fine48.
int fine_steps(const std::vector<std::string>& tensors);

// The name, in the checkpoint of that preset, of the trained array `name` of weight_arrays.
std::string published_name(const Architecture&, const std::string& name);

// The tensors in the checkpoint for the statistics named `set` in a weight file (node, mesh_edge, ..). Their shapes are
// [1], [1], [1, n] and [1, n].
struct PublishedSums {
  std::string rows, updates, sum, sum_squared;
};
PublishedSums published_sums(const std::string& set);

}  // namespace selvedge
