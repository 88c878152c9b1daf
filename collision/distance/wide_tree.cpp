#include "collision/distance/wide_tree.hpp"

#include <limits>

namespace selvedge {
namespace {

constexpr float nowhere = std::numeric_limits<float>::infinity();

// Up to eight nodes that together cover `root`, found by opening the largest ones first.
std::vector<int> open_node(const Bvh& tree, int root) {
  std::vector<int> open{root};
  while (open.size() < WideTree::width) {
    int largest = -1;
    double area = -1;
    for (int i = 0; i < static_cast<int>(open.size()); ++i)
      if (tree.nodes[open[i]].child >= 0 && half_area(tree.nodes[open[i]].box) > area) {
        largest = i;
        area = half_area(tree.nodes[open[i]].box);
      }
    if (largest < 0) break;
    const int child = tree.nodes[open[largest]].child;
    open[largest] = child;
    open.push_back(child + 1);
  }
  return open;
}

int add_wide_node(const Bvh& tree, int root, WideTree& wide) {
  const int at = static_cast<int>(wide.nodes.size());
  wide.nodes.emplace_back();
  const std::vector<int> open = open_node(tree, root);
  for (int i = 0; i < WideTree::width; ++i) {
    const int source = i < static_cast<int>(open.size()) ? open[i] : -1;
    int child = 0;
    if (source >= 0)
      child = tree.nodes[source].child < 0 ? tree.nodes[source].child : add_wide_node(tree, source, wide);
    wide.nodes[at].source[i] = source;
    wide.nodes[at].child[i] = child;
  }
  return at;
}

void fit_node(WideTree& wide, const Bvh& tree, WideTree::Node& node) {
  for (int i = 0; i < WideTree::width; ++i) {
    const bool used = node.source[i] >= 0 && !is_empty(tree.nodes[node.source[i]].box);
    for (int k = 0; k < 3; ++k) {
      node.lo[k][i] = used ? round_down(tree.nodes[node.source[i]].box.lo[k] - wide.origin[k]) : nowhere;
      node.hi[k][i] = used ? round_up(tree.nodes[node.source[i]].box.hi[k] - wide.origin[k]) : -nowhere;
    }
  }
}

void fit_leaf(WideTree& wide, const Surface& surface, const Points& x, std::span<const char> left_out, int at,
              const Bvh::Leaf& items) {
  WideTree::Leaf& leaf = wide.leaves[at];
  for (int i = 0; i < WideTree::width; ++i) {
    const int t = items.item[i];
    leaf.triangle[i] = t < 0 || (!left_out.empty() && left_out[t]) ? -1 : t;
    for (int c = 0; c < 3; ++c)
      for (int k = 0; k < 3; ++k)
        leaf.corner[c][k][i] = t < 0 ? 0.0f : static_cast<float>(x(surface.triangles(t, c), k) - wide.origin[k]);
  }
}

}  // namespace

WideTree widen(const Bvh& tree) {
  static_assert(WideTree::width == Bvh::leaf_size);
  WideTree wide;
  wide.leaves.resize(tree.leaves.size());
  if (!tree.nodes.empty()) add_wide_node(tree, 0, wide);
  return wide;
}

void refit(WideTree& wide, const Bvh& tree, const Surface& surface, const Points& x, std::span<const char> left_out) {
  if (tree.nodes.empty()) return;
  const Box& root = tree.nodes.front().box;
  double squared = 0;
  for (int k = 0; k < 3; ++k) {
    const double lo = root.lo[k], hi = root.hi[k];
    wide.origin[k] = 0.5 * (lo + hi);
    squared += 0.25 * (hi - lo) * (hi - lo);
  }
  wide.extent = std::sqrt(squared);
  const int nodes = static_cast<int>(wide.nodes.size()), leaves = static_cast<int>(wide.leaves.size());
#pragma omp parallel for schedule(static)
  for (int i = 0; i < nodes; ++i) fit_node(wide, tree, wide.nodes[i]);
#pragma omp parallel for schedule(static)
  for (int i = 0; i < leaves; ++i) fit_leaf(wide, surface, x, left_out, i, tree.leaves[i]);
}

}  // namespace selvedge
