#include "collision/search/bvh.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace selvedge {
namespace {

constexpr std::size_t enough_blocks = 32;

struct Centre {
  std::array<float, 3> at;
  int item;
};

// Twice the centre; 0 where it is undefined (empty and unbounded boxes), since NaN would break the sort.
Centre centre_of(const Box& box, int item) {
  Centre centre{{}, item};
  for (int k = 0; k < 3; ++k) {
    const float sum = box.lo[k] + box.hi[k];
    centre.at[k] = std::isfinite(sum) ? sum : 0.0f;
  }
  return centre;
}

int longest_axis(std::span<const Centre> centres) {
  std::array<float, 3> lo = centres.front().at, hi = lo;
  for (const Centre& centre : centres)
    for (int k = 0; k < 3; ++k) {
      lo[k] = std::min(lo[k], centre.at[k]);
      hi[k] = std::max(hi[k], centre.at[k]);
    }
  int axis = 0;
  for (int k = 1; k < 3; ++k)
    if (hi[k] - lo[k] > hi[axis] - lo[axis]) axis = k;
  return axis;
}

// Moves the half with the smaller centres to the front; its size is a multiple of the leaf's. Ties are ordered by item,
// so that the tree is unique.
std::size_t split_at_median(std::span<Centre> centres) {
  constexpr std::size_t full = Bvh::leaf_size;
  const int axis = longest_axis(centres);
  const std::size_t half = (centres.size() / 2 + full - 1) / full * full;
  std::nth_element(centres.begin(), centres.begin() + static_cast<std::ptrdiff_t>(half), centres.end(),
                   [axis](const Centre& a, const Centre& b) {
                     return a.at[axis] < b.at[axis] || (a.at[axis] == b.at[axis] && a.item < b.item);
                   });
  return half;
}

int leaves_for(std::size_t items) { return static_cast<int>((items + Bvh::leaf_size - 1) / Bvh::leaf_size); }

// Items to distribute below a node. The node's descendants get the node numbers from `place` on.
struct Task {
  std::span<Centre> centres;
  int node, place;

  int end() const { return place + 2 * leaves_for(centres.size()) - 2; }
};

void fill_leaf(Bvh& tree, const Task& task) {
  Bvh::Node& node = tree.nodes[task.node];
  node.child = ~node.first;
  Bvh::Leaf& leaf = tree.leaves[node.first];
  std::ranges::fill(leaf.item, -1);
  std::transform(task.centres.begin(), task.centres.end(), leaf.item, [](const Centre& centre) { return centre.item; });
  std::sort(leaf.item, leaf.item + task.centres.size());
}

std::array<Task, 2> divide(Bvh& tree, const Task& task) {
  const std::size_t half = split_at_median(task.centres);
  tree.nodes[task.node].child = task.place;
  const Task lower{task.centres.first(half), task.place, task.place + 2};
  const Task upper{task.centres.subspan(half), task.place + 1, lower.end()};
  tree.nodes[lower.node].first = tree.nodes[task.node].first;
  tree.nodes[upper.node].first = tree.nodes[task.node].first + leaves_for(half);
  return {lower, upper};
}

void build_below(Bvh& tree, const Task& root) {
  std::vector<Task> stack{root};
  while (!stack.empty()) {
    const Task task = stack.back();
    stack.pop_back();
    if (task.centres.size() <= Bvh::leaf_size) {
      fill_leaf(tree, task);
      continue;
    }
    const auto [lower, upper] = divide(tree, task);
    stack.push_back(upper);
    stack.push_back(lower);
  }
}

void refit_node(Bvh& tree, int index, std::span<const Box> items) {
  Bvh::Node& node = tree.nodes[index];
  if (node.child < 0)
    node.box = set_leaf_boxes(tree.leaves[~node.child], [&](int item) { return items[item]; });
  else
    node.box = join(tree.nodes[node.child].box, tree.nodes[node.child + 1].box);
}

}  // namespace

void vertex_boxes(const Points& x0, const Points& x1, double radius, std::vector<Box>& boxes) {
  const int count = static_cast<int>(x0.rows());
  boxes.resize(count);
#pragma omp parallel for schedule(static)
  for (int v = 0; v < count; ++v) boxes[v] = moving_point_box(row(x0, v), row(x1, v), radius);
}

void triangle_boxes(const Surface& surface, std::span<const Box> vertices, std::vector<Box>& boxes) {
  const int count = static_cast<int>(surface.triangles.rows());
  boxes.resize(count);
  const Triangles& t = surface.triangles;
#pragma omp parallel for schedule(static)
  for (int i = 0; i < count; ++i) boxes[i] = hull(vertices[t(i, 0)], vertices[t(i, 1)], vertices[t(i, 2)]);
}

void triangle_boxes(const Surface& surface, const Points& x0, const Points& x1, double radius,
                    std::vector<Box>& boxes) {
  std::vector<Box> vertices;
  vertex_boxes(x0, x1, radius, vertices);
  triangle_boxes(surface, vertices, boxes);
}

Bvh build_bvh(std::span<const Box> items) {
  Bvh tree;
  tree.item_count = static_cast<int>(items.size());
  if (items.empty()) return tree;
  tree.leaves.resize(leaves_for(items.size()));
  tree.nodes.resize(2 * tree.leaves.size() - 1);
  std::vector<Centre> centres;
  centres.reserve(items.size());
  for (int i = 0; i < tree.item_count; ++i) centres.push_back(centre_of(items[i], i));

  std::vector<Task> tasks{{centres, 0, 1}}, next;
  while (tasks.size() < enough_blocks && tasks.back().centres.size() > 4 * Bvh::leaf_size) {
    next.clear();
    for (const Task& task : tasks) {
      tree.top.push_back(task.node);
      const auto halves = divide(tree, task);
      next.insert(next.end(), halves.begin(), halves.end());
    }
    tasks.swap(next);
  }
  for (const Task& task : tasks) tree.blocks.push_back({task.node, task.place, task.end()});
  const int count = static_cast<int>(tasks.size());
#pragma omp parallel for schedule(dynamic)
  for (int i = 0; i < count; ++i) build_below(tree, tasks[i]);
  refit(tree, items);
  return tree;
}

void refit(Bvh& tree, std::span<const Box> items) {
  assert(static_cast<int>(items.size()) == tree.item_count);
  const int count = static_cast<int>(tree.blocks.size());
#pragma omp parallel for schedule(dynamic)
  for (int b = 0; b < count; ++b) {
    const Bvh::Block& block = tree.blocks[b];
    for (int node = block.end - 1; node >= block.begin; --node) refit_node(tree, node, items);
    refit_node(tree, block.root, items);
  }
  for (auto node = tree.top.rbegin(); node != tree.top.rend(); ++node) refit_node(tree, *node, items);
}

double bvh_cost(const Bvh& tree) {
  if (tree.nodes.size() < 2) return 0;
  double sum = 0;
  for (const Bvh::Node& node : tree.nodes) {
    const double area = half_area(node.box);
    if (std::isfinite(area)) sum += area;
  }
  const double root = half_area(tree.nodes.front().box);
  return root > 0 && std::isfinite(root) ? sum / root : 0;
}

bool update(KeptBvh& tree, std::span<const Box> items) {
  if (tree.built && tree.bvh.item_count == static_cast<int>(items.size())) {
    refit(tree.bvh, items);
    if (bvh_cost(tree.bvh) <= 1.25 * tree.built_cost) return false;
  }
  tree.bvh = build_bvh(items);
  tree.built_cost = bvh_cost(tree.bvh);
  tree.built = true;
  return true;
}

}  // namespace selvedge
