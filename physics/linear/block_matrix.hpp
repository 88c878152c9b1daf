#pragma once

#include <array>
#include <span>
#include <vector>

#include "collision/geometry/points.hpp"

namespace selvedge {

// Sparsity of a symmetric matrix of 3 x 3 blocks whose rows of blocks sum to zero (elastic energies do not change under
// translation). Only the blocks of unordered vertex pairs are stored: a diagonal block is minus the sum of its row.
struct PairPattern {
  int rows = 0;
  std::vector<std::array<int, 2>> pairs;  // smaller vertex first, ascending
  std::vector<int> row_begin;             // size rows + 1: row i has the entries row_begin[i] .. row_begin[i + 1]
  std::vector<int> column;                // neighbour of each entry, ascending within a row
  std::vector<int> pair;                  // pair of each entry; its block is transposed where column < row
};

// One block per pair: rows of the smaller vertex, columns of the larger one [N/m].
using PairBlocks = std::vector<Mat3>;

// Element e has the nodes element_nodes[element_begin[e] .. element_begin[e + 1]); every two of them make a pair.
PairPattern make_pair_pattern(int rows, std::span<const int> element_begin, std::span<const int> element_nodes);

// Index of the pair (a, b) in any order; it must exist (assert).
int find_pair(const PairPattern&, int a, int b);

// Row `row` of K u: sum_j K_ij (u_j - u_i).
Vec3 multiply_row(const PairPattern&, const PairBlocks&, const Points& u, int row);

// K_ii = -sum_j K_ij, symmetrised.
Mat3 diagonal_block(const PairPattern&, const PairBlocks&, int row);

}  // namespace selvedge
