#pragma once

#include <vector>

#include "learned/network/architecture.hpp"

namespace selvedge {

// Those edges of a set that take part in a step, sorted by receiver. Entries of `receiver` and `sender` point into
// `receivers` and `senders`, the nodes that occur, ascending.
struct EdgeSelection {
  int set = 0;                        // index into Graph::edge_sets
  std::vector<int> edge;              // rows of the set's latents, which GraphPlan::order sorts
  std::vector<int> receiver, sender;  // of each edge
  std::vector<int> receivers, senders;
  std::vector<int> receiver_at;  // of each node of the graph: its index in `receivers`, or -1
  // First edge of each chunk, and the end: chunks begin where a receiver begins, so that a sum has one owner.
  std::vector<int> chunks;
};

// What a network does with a graph: which selections of edges each step uses, by its keys; -1 where there is no edge.
struct GraphPlan {
  std::vector<std::vector<int>> order;  // of each set: its edges sorted by receiver, then as they came
  std::vector<EdgeSelection> selections;
  std::vector<std::vector<int>> steps;  // selection of each key of the step
};

// Throws Error where the graph does not fit the architecture: a key or a number of columns that it does not know, an
// index outside of the nodes, rows that are not as many as edges, two sets of one key.
void check_graph(const Architecture&, const Graph&);

// `chunk` is the least number of edges in a chunk (but the last).
GraphPlan plan_graph(const Architecture&, const Graph&, int chunk);

// Whether each edge of the set passes the filter: every cloth end of it has an edge in one of the sets `near`.
std::vector<char> passes_filter(const Graph&, const EdgeSet&, const EdgeFilter&);

}  // namespace selvedge
