#pragma once

#include <tuple>

#include "physics/linear/coarsening.hpp"
#include "physics/linear/linear_system.hpp"

namespace selvedge::testing {

// A linear system that owns the data of a LinearSystem.
struct LinearExample {
  PairPattern pattern;
  PairBlocks pairs;
  std::vector<double> diagonal, flat_scale;
  SparseMatrix flat;
  std::vector<ContactBlock> contacts;
  ContactLists lists;
  std::vector<char> free;
  std::vector<Mat3> blocks;  // on the diagonal

  LinearSystem system() const { return {pattern, pairs, diagonal, flat, flat_scale, contacts, lists, free}; }
  void finish() {  // call it after everything else
    lists = list_contacts(contacts, pattern.rows);
    diagonal_blocks(system(), blocks);
  }
};

// Two triangles per square of a side x side grid of vertices, as elements for make_pair_pattern().
struct GridElements {
  std::vector<int> begin{0}, nodes;
};
inline GridElements grid_elements(int side) {
  GridElements elements;
  for (int i = 0; i + 1 < side; ++i)
    for (int j = 0; j + 1 < side; ++j)
      for (const auto& t : {std::array{0, 1, side}, std::array{side + 1, side, 1}}) {
        for (int k : t) elements.nodes.push_back(i * side + j + k);
        elements.begin.push_back(static_cast<int>(elements.nodes.size()));
      }
  return elements;
}

// The graph Laplacian of the pattern, squared.
inline SparseMatrix squared_laplacian(const PairPattern& pattern) {
  std::vector<Eigen::Triplet<double>> entries;
  for (const auto& [i, j] : pattern.pairs)
    for (const auto& [a, b, v] :
         {std::tuple{i, j, 1.}, std::tuple{j, i, 1.}, std::tuple{i, i, -1.}, std::tuple{j, j, -1.}})
      entries.emplace_back(a, b, v);
  SparseMatrix laplacian(pattern.rows, pattern.rows);
  laplacian.setFromTriplets(entries.begin(), entries.end());
  return laplacian * laplacian;
}

inline Adjacency graph_of(const PairPattern& pattern) {
  Edges edges(pattern.pairs.size(), 2);
  for (std::size_t e = 0; e < pattern.pairs.size(); ++e) edges.row(e) << pattern.pairs[e][0], pattern.pairs[e][1];
  return adjacency_of(pattern.rows, edges);
}

}  // namespace selvedge::testing
