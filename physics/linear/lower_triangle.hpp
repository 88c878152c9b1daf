#pragma once

#include <vector>

#include "physics/linear/linear_system.hpp"

namespace selvedge {

// Lower triangle of a LinearSystem's free part as compressed scalar columns, for a direct solver. The pattern has an
// entry for every pair of `pairs`, `flat` and `contacts`, even if its value is zero.
struct LowerTriangle {
  std::vector<int> free_index;              // of each vertex, -1 where not free
  std::vector<int> vertex;                  // of each free index
  std::vector<int> block_begin, block_row;  // block columns below the diagonal, over free indices, ascending
  std::vector<int> column_begin, row;       // scalar columns
  std::vector<double> value;
  std::vector<std::array<int, 4>> contact_nodes;  // the contacts that the pattern was made with
  int size() const { return 3 * static_cast<int>(vertex.size()); }
};

// Rebuilds the pattern if the contacts or the free vertices have changed; pairs and flat must always be the same. True
// if it was rebuilt (then a factorisation needs a new analysis).
bool update_pattern(const LinearSystem&, LowerTriangle&);

void fill_values(const LinearSystem&, std::span<const Mat3> diagonal, LowerTriangle&);

}  // namespace selvedge
