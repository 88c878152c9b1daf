#include "learned/network/graph_plan.hpp"

#include <algorithm>
#include <numeric>

#include "collision/geometry/error.hpp"

namespace selvedge {
namespace {

const EdgeSet* find_set(const Graph& graph, const std::string& key) {
  for (const EdgeSet& set : graph.edge_sets)
    if (set.key == key) return &set;
  return nullptr;
}

void refuse(bool bad, const std::string& where, const std::string& what) {
  if (bad) throw Error(what, where, "the graph must be made for this network");
}

void check_set(const Architecture& a, const Graph& graph, const EdgeSet& set) {
  const std::string where = "graph: " + set.key;
  const int kind = edge_kind(a, set.key);
  refuse(kind < 0, where, "the network knows no edges of this kind");
  refuse(find_set(graph, set.key) != &set, where, "two sets have this key");
  const auto edges = static_cast<Eigen::Index>(set.senders.size());
  refuse(set.receivers.size() != set.senders.size() || set.features.rows() != edges, where,
         "senders, receivers and rows of features are not as many");
  const int inputs = a.encoders[a.edge_kinds[kind].encoder].inputs;
  refuse(
      edges > 0 && set.features.cols() != inputs, where,
      "features have " + std::to_string(set.features.cols()) + " columns, the network reads " + std::to_string(inputs));
  const Eigen::Index nodes = graph.nodes.rows();
  const auto outside = [nodes](int node) { return node < 0 || node >= nodes; };
  refuse(std::any_of(set.senders.begin(), set.senders.end(), outside) ||
             std::any_of(set.receivers.begin(), set.receivers.end(), outside),
         where, "an edge leads to a node that does not exist");
}

// Returns the nodes in `ends`, ascending. `at` becomes the index of each node there, or -1.
std::vector<int> occurring(const std::vector<int>& ends, Eigen::Index nodes, std::vector<int>& at) {
  at.assign(nodes, -1);
  for (const int node : ends) at[node] = 0;
  std::vector<int> occurs;
  for (int node = 0; node < nodes; ++node)
    if (at[node] == 0) {
      at[node] = static_cast<int>(occurs.size());
      occurs.push_back(node);
    }
  return occurs;
}

std::vector<int> chunks_of(const std::vector<int>& receiver, int chunk) {
  std::vector<int> begins{0};
  for (int e = 1; e < static_cast<int>(receiver.size()); ++e)
    if (e - begins.back() >= chunk && receiver[e] != receiver[e - 1]) begins.push_back(e);
  begins.push_back(static_cast<int>(receiver.size()));
  return begins;
}

// The edges of the set that pass all filters of its key, as rows of its sorted latents.
EdgeSelection select(const Graph& graph, int set, const std::vector<int>& order, const std::vector<EdgeFilter>& filters,
                     int chunk) {
  const EdgeSet& edges = graph.edge_sets[set];
  std::vector<char> takes_part(order.size(), true);
  for (const EdgeFilter& filter : filters) {
    const std::vector<char> passes = passes_filter(graph, edges, filter);
    for (std::size_t e = 0; e < order.size(); ++e) takes_part[e] = takes_part[e] && passes[order[e]];
  }
  EdgeSelection selection;
  selection.set = set;
  for (std::size_t e = 0; e < order.size(); ++e)
    if (takes_part[e]) {
      selection.edge.push_back(static_cast<int>(e));
      selection.receiver.push_back(edges.receivers[order[e]]);
      selection.sender.push_back(edges.senders[order[e]]);
    }
  std::vector<int> sender_at;
  selection.receivers = occurring(selection.receiver, graph.nodes.rows(), selection.receiver_at);
  selection.senders = occurring(selection.sender, graph.nodes.rows(), sender_at);
  for (int& node : selection.receiver) node = selection.receiver_at[node];
  for (int& node : selection.sender) node = sender_at[node];
  selection.chunks = chunks_of(selection.receiver, chunk);
  return selection;
}

}  // namespace

void check_graph(const Architecture& a, const Graph& graph) {
  refuse(graph.cloth_nodes < 0 || graph.cloth_nodes > graph.nodes.rows(), "graph",
         "it has fewer nodes than cloth nodes");
  refuse(graph.nodes.rows() > 0 && graph.nodes.cols() != a.node_inputs, "graph: nodes",
         "features have " + std::to_string(graph.nodes.cols()) + " columns, the network reads " +
             std::to_string(a.node_inputs));
  for (const EdgeSet& set : graph.edge_sets) check_set(a, graph, set);
}

std::vector<char> passes_filter(const Graph& graph, const EdgeSet& set, const EdgeFilter& filter) {
  std::vector<char> kept(graph.nodes.rows(), false);
  for (const std::string& key : filter.near)
    if (const EdgeSet* near = find_set(graph, key)) {
      for (const int node : near->senders) kept[node] = true;
      for (const int node : near->receivers) kept[node] = true;
    }
  for (Eigen::Index node = graph.cloth_nodes; node < graph.nodes.rows(); ++node) kept[node] = true;
  std::vector<char> passes(set.senders.size());
  for (std::size_t e = 0; e < passes.size(); ++e) passes[e] = kept[set.senders[e]] && kept[set.receivers[e]];
  return passes;
}

bool is_used(const GraphPlan& plan, std::size_t set) {
  return std::ranges::find(plan.selections, static_cast<int>(set), &EdgeSelection::set) != plan.selections.end();
}

GraphPlan plan_graph(const Architecture& a, const Graph& graph, int chunk) {
  GraphPlan plan;
  for (const EdgeSet& set : graph.edge_sets) {
    std::vector<int> order(set.senders.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&set](int i, int j) { return set.receivers[i] < set.receivers[j]; });
    plan.order.push_back(std::move(order));
  }
  std::vector<std::vector<EdgeFilter>> filters_of;  // one per selection
  for (const MessageStep& step : a.steps) {
    std::vector<int>& used = plan.steps.emplace_back();
    for (const std::string& key : step.edge_keys) {
      used.push_back(-1);
      const EdgeSet* set = find_set(graph, key);
      if (!set || set->senders.empty()) continue;
      const int index = static_cast<int>(set - graph.edge_sets.data());
      std::vector<EdgeFilter> filters;
      for (const EdgeFilter& filter : step.filters)
        if (filter.key == key) filters.push_back(filter);
      int& selection = used.back();
      for (std::size_t s = 0; s < plan.selections.size(); ++s)
        if (plan.selections[s].set == index && filters_of[s] == filters) selection = static_cast<int>(s);
      if (selection >= 0) continue;
      selection = static_cast<int>(plan.selections.size());
      plan.selections.push_back(select(graph, index, plan.order[index], filters, chunk));
      filters_of.push_back(std::move(filters));
    }
  }
  return plan;
}

}  // namespace selvedge
