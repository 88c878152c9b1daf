#pragma once

#include <vector>

#include "learned/network/architecture.hpp"

namespace selvedge {

// The edges of a set that take part in a step, sorted by receiver. Entries of `receiver` and `sender` are indices into
// `receivers` and `senders`, the nodes with such an edge, ascending.
struct EdgeSelection {
  int set = 0;                        // index into Graph::edge_sets
  std::vector<int> edge;              // rows of the set's latents, sorted as GraphPlan::order
  std::vector<int> receiver, sender;  // one per edge
  std::vector<int> receivers, senders;
  std::vector<int> receiver_at;  // one per node of the graph: its index in `receivers`, or -1
  // The first edge of each chunk, and the end. Chunks begin where a receiver begins, so that a sum has one owner.
  std::vector<int> chunks;
};

// The selections of edges that each step of a network uses; -1 where there are no edges.
struct GraphPlan {
  std::vector<std::vector<int>> order;  // of each set: its edges sorted by receiver, stable
  std::vector<EdgeSelection> selections;
  std::vector<std::vector<int>> steps;  // selection of each key of each step
};

// Throws Error where the graph does not fit the architecture: for an unknown key or number of columns, an index outside
// of the nodes, another number of rows than of edges, or two sets of one key.
void check_graph(const Architecture&, const Graph&);

// `chunk` is the least number of edges in a chunk, except the last.
GraphPlan plan_graph(const Architecture&, const Graph&, int chunk);

// Whether a step uses the set.
bool is_used(const GraphPlan&, std::size_t set);

// One flag per edge of the set: each cloth end of it has an edge in one of the sets `near`.
std::vector<char> passes_filter(const Graph&, const EdgeSet&, const EdgeFilter&);

}  // namespace selvedge
