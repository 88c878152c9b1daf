#pragma once

#include <string>
#include <vector>

#include "learned/network/architecture.hpp"

namespace selvedge {

// The preset (learned/network/architecture.hpp) that a published checkpoint with these tensor names is of: hood,
// hood_cvpr, fine15, fine48 or contourcraft; empty for names of none of them. Tables of the names: published_names.cpp.
std::string published_kind(const std::vector<std::string>& tensors);

// Steps that a checkpoint of the fine baselines has by its names; its kind is fine15 or fine48.
int fine_steps(const std::vector<std::string>& tensors);

// What the checkpoint of that preset calls the array `name` of weight_arrays that is trained.
std::string published_name(const Architecture&, const std::string& name);

// The tensors that the checkpoint keeps for the statistics called `set` in a weight file (node, mesh_edge, ..): [1],
// [1], [1, n] and [1, n].
struct PublishedSums {
  std::string rows, updates, sum, sum_squared;
};
PublishedSums published_sums(const std::string& set);

}  // namespace selvedge
