#include "collision/bvh.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace selvedge {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr Box empty_box{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};

float round_down(double value) {
  const float nearest = static_cast<float>(value);
  return nearest > value ? std::nextafter(nearest, -infinity) : nearest;
}

float round_up(double value) { return -round_down(-value); }

Box join(const Box& a, const Box& b) {
  Box box;
  for (int k = 0; k < 3; ++k) {
    box.lo[k] = std::min(a.lo[k], b.lo[k]);
    box.hi[k] = std::max(a.hi[k], b.hi[k]);
  }
  return box;
}

double surface_area(const Box& box) {
  const double x = box.hi[0] - box.lo[0], y = box.hi[1] - box.lo[1], z = box.hi[2] - box.lo[2];
  return 2 * (x * y + y * z + z * x);
}

struct Centre {
  std::array<float, 3> at;
  int item;
};

// Twice the centre; 0 where it is undefined (empty and unbounded boxes), for NaN would break the order of the sort.
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

// Moves the half with the smaller centres to the front; ties go by item, so that the tree is unique.
std::size_t split_at_median(std::span<Centre> centres) {
  const int axis = longest_axis(centres);
  const std::size_t half = centres.size() / 2;
  std::nth_element(centres.begin(), centres.begin() + static_cast<std::ptrdiff_t>(half), centres.end(),
                   [axis](const Centre& a, const Centre& b) {
                     return a.at[axis] < b.at[axis] || (a.at[axis] == b.at[axis] && a.item < b.item);
                   });
  return half;
}

}  // namespace

void triangle_boxes(const Surface& surface, const Points& x0, const Points& x1, double radius,
                    std::vector<Box>& boxes) {
  const int count = static_cast<int>(surface.triangles.rows());
  boxes.resize(count);
#pragma omp parallel for schedule(static)
  for (int t = 0; t < count; ++t) {
    Box box = empty_box;
    for (int k = 0; k < 3; ++k) {
      double lo = std::numeric_limits<double>::infinity(), hi = -lo, sum = 0;
      for (int corner = 0; corner < 3; ++corner) {
        const double begin = x0(surface.triangles(t, corner), k), end = x1(surface.triangles(t, corner), k);
        lo = std::min({lo, begin, end});
        hi = std::max({hi, begin, end});
        sum += begin + end;
      }
      if (std::isnan(sum)) {
        box = empty_box;
        break;
      }
      box.lo[k] = round_down(lo - radius);
      box.hi[k] = round_up(hi + radius);
    }
    boxes[t] = box;
  }
}

Bvh build_bvh(std::span<const Box> items) {
  Bvh tree;
  tree.item_count = static_cast<int>(items.size());
  if (items.empty()) return tree;
  tree.nodes.resize(2 * items.size() - 1);
  std::vector<Centre> centres;
  centres.reserve(items.size());
  for (int i = 0; i < tree.item_count; ++i) centres.push_back(centre_of(items[i], i));

  struct Task {
    std::span<Centre> centres;
    int node;
  };
  std::vector<Task> stack{{centres, 0}};
  int made = 1;
  while (!stack.empty()) {
    const Task task = stack.back();
    stack.pop_back();
    Bvh::Node& node = tree.nodes[task.node];
    if (task.centres.size() == 1) {
      node.left = ~task.centres.front().item;
      continue;
    }
    node.left = made++;
    node.right = made++;
    const std::size_t half = split_at_median(task.centres);
    stack.push_back({task.centres.subspan(half), node.right});
    stack.push_back({task.centres.first(half), node.left});
  }
  refit(tree, items);
  return tree;
}

void refit(Bvh& tree, std::span<const Box> items) {
  assert(static_cast<int>(items.size()) == tree.item_count);
  for (auto node = tree.nodes.rbegin(); node != tree.nodes.rend(); ++node)
    node->box = node->left < 0 ? items[~node->left] : join(tree.nodes[node->left].box, tree.nodes[node->right].box);
}

double bvh_cost(const Bvh& tree) {
  if (tree.item_count < 2) return 0;
  double sum = 0;
  for (const Bvh::Node& node : tree.nodes)
    if (node.left >= 0) {
      const double area = surface_area(node.box);
      if (std::isfinite(area)) sum += area;
    }
  const double root = surface_area(tree.nodes.front().box);
  return root > 0 && std::isfinite(root) ? sum / root : 0;
}

}  // namespace selvedge
