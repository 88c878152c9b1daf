#pragma once

#include <span>

#include "learned/graph/graph.hpp"

namespace selvedge {

// One graph of several that no edge connects. Its nodes are the cloth vertices of all, graph by graph, then the
// obstacle vertices of all; `body_vertices` has those of each graph in turn. Each edge set has the edges of the first
// graph, then those of the next. The graphs have the same features; one may lack an edge set that others have.
void unite_graphs(std::span<const Graph* const> graphs, Graph& united);

}  // namespace selvedge
