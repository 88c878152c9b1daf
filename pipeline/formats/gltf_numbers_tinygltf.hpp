#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "collision/geometry/error.hpp"

namespace tinygltf {
class Model;
}

namespace selvedge {

using GltfNumbers = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// An entry of one of a glTF file's lists. `where`, the file and the part of it, is that of the Error for none.
template <class Entry>
const Entry& gltf_entry(const std::vector<Entry>& list, int index, const std::string& where) {
  if (index < 0 || index >= std::ssize(list))
    throw Error("names entry " + std::to_string(index) + " of " + std::to_string(list.size()), where, "export it anew");
  return list[static_cast<std::size_t>(index)];
}

// The numbers of an accessor, one row per element, also of one that is stored sparsely or, all zeros, not at all.
// Throws Error for other than `columns` columns, rows beyond a buffer, and what is not finite.
GltfNumbers gltf_numbers(const tinygltf::Model&, int accessor, int columns, const std::string& where);

}  // namespace selvedge
