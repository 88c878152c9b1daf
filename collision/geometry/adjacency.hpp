#pragma once

#include <span>
#include <vector>

#include "collision/geometry/points.hpp"

namespace selvedge {

// Neighbours of each vertex of an undirected graph, ascending.
struct Adjacency {
  std::vector<int> begin;  // of vertex v: neighbour[begin[v] .. begin[v + 1])
  std::vector<int> neighbour;

  int vertex_count() const { return static_cast<int>(begin.size()) - 1; }
  std::span<const int> of(int vertex) const {
    return {neighbour.data() + begin[vertex], static_cast<std::size_t>(begin[vertex + 1] - begin[vertex])};
  }
};

// `edges` has each edge once.
Adjacency adjacency_of(int vertex_count, const Edges& edges);

// Are two vertices the same, adjacent, or do they have a common neighbour?
bool within_two_edges(const Adjacency&, int a, int b);

// Sets `depth` of each vertex: the number of edges from the nearest source, -1 where no source can be reached. Returns
// the vertices in the order in which they were reached.
std::vector<int> breadth_first(const Adjacency&, std::span<const int> sources, std::vector<int>& depth);

// Pairs, smaller first, as a sorted list without doubles.
Edges unique_edges(std::vector<std::pair<int, int>> pairs);

}  // namespace selvedge
