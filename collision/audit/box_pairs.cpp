#include "collision/audit/box_pairs.hpp"

#include <algorithm>

namespace selvedge {
namespace {

constexpr int in_a_leaf = 8;
constexpr int uneven = 16;              // A half holds at least one in so many boxes of its node.
constexpr std::size_t many_parts = 64;  // of a search

using Four [[gnu::vector_size(16)]] = float;

struct Centre {
  Four at;  // the last one is 0
  int item;
};

// The axis along which the centres are spread the widest, and their mean along it.
struct Spread {
  int axis;
  float mean;
};

Spread spread_of(std::span<const Centre> centres) {
  Four lo = centres[0].at, hi = lo, sum{};
  for (const Centre& centre : centres) {
    lo = centre.at < lo ? centre.at : lo;
    hi = centre.at > hi ? centre.at : hi;
    sum += centre.at;
  }
  const Four width = hi - lo;
  int axis = 0;
  for (int k = 1; k < 3; ++k)
    if (width[k] > width[axis]) axis = k;
  return {axis, sum[axis] / static_cast<float>(centres.size())};
}

// Sorts the centres into a lower and an upper part, and returns how many are in the lower one: at the mean, or at the
// median where the mean leaves one of them too few.
int halve(std::span<Centre> centres) {
  const Spread spread = spread_of(centres);
  const auto count = static_cast<int>(centres.size());
  const auto middle = std::partition(centres.begin(), centres.end(),
                                     [&](const Centre& centre) { return centre.at[spread.axis] < spread.mean; });
  const int lower = static_cast<int>(middle - centres.begin());
  if (uneven * lower >= count && uneven * (count - lower) >= count) return lower;
  std::nth_element(centres.begin(), centres.begin() + count / 2, centres.end(),
                   [&](const Centre& a, const Centre& b) { return a.at[spread.axis] < b.at[spread.axis]; });
  return count / 2;
}

BoxSides hull_of(const BoxSides& a, const BoxSides& b) {
  BoxSides hull;
  hull.first = a.first < b.first ? a.first : b.first;
  hull.second = a.second < b.second ? a.second : b.second;
  hull.third = a.third < b.third ? a.third : b.third;
  return hull;
}

// Appends the node of the boxes from `begin` on, and all below it. Returns its place.
int add_node(std::span<Centre> centres, int begin, std::span<const ExactBox> boxes, BoxTree& tree) {
  const int place = static_cast<int>(tree.nodes.size()), count = static_cast<int>(centres.size());
  tree.nodes.push_back({{}, begin, begin + count, 0});
  if (count <= in_a_leaf) {
    BoxSides hull(boxes[centres[0].item]);
    for (const Centre& centre : centres) {
      tree.boxes.emplace_back(boxes[centre.item]);
      tree.item.push_back(centre.item);
      hull = hull_of(hull, tree.boxes.back());
    }
    tree.nodes[place].box = hull;
    return place;
  }
  const int lower = halve(centres);
  add_node(centres.first(lower), begin, boxes, tree);
  const int upper = add_node(centres.subspan(lower), begin + lower, boxes, tree);
  tree.nodes[place].upper = upper;
  tree.nodes[place].box = hull_of(tree.nodes[place + 1].box, tree.nodes[upper].box);
  return place;
}

}  // namespace

ExactBox box_of(const Surface& surface, const Points& x, int triangle, double margin) {
  const int* v = surface.triangles.data() + 3 * triangle;
  const double *a = x.data() + 3 * v[0], *b = x.data() + 3 * v[1], *c = x.data() + 3 * v[2];
  ExactBox box;
  for (int k = 0; k < 3; ++k) {
    box.lo[k] = std::min(std::min(a[k], b[k]), c[k]) - margin;
    box.hi[k] = std::max(std::max(a[k], b[k]), c[k]) + margin;
  }
  return box;
}

ExactBox hull_of(std::span<const ExactBox> boxes) {
  ExactBox hull{{endless, endless, endless}, {-endless, -endless, -endless}};
  for (const ExactBox& box : boxes)
    for (int k = 0; k < 3; ++k) {
      hull.lo[k] = std::min(hull.lo[k], box.lo[k]);
      hull.hi[k] = std::max(hull.hi[k], box.hi[k]);
    }
  return hull;
}

bool overlap(const ExactBox& a, const ExactBox& b) {
  bool meet = true;
  for (int k = 0; k < 3; ++k) meet &= (a.lo[k] <= b.hi[k]) & (b.lo[k] <= a.hi[k]);
  return meet;
}

BoxTree::BoxTree(std::span<const ExactBox> given) {
  if (given.empty()) return;
  std::vector<Centre> centres(given.size());
  const auto centre = [](const ExactBox& box, int k) { return static_cast<float>(0.5 * box.lo[k] + 0.5 * box.hi[k]); };
  for (std::size_t i = 0; i < given.size(); ++i)
    centres[i] = Centre{Four{centre(given[i], 0), centre(given[i], 1), centre(given[i], 2), 0}, static_cast<int>(i)};
  boxes.reserve(given.size());
  item.reserve(given.size());
  nodes.reserve(given.size());
  add_node(centres, 0, given, *this);
}

BoxPairs::BoxPairs(std::span<const ExactBox> first, std::span<const ExactBox> second, bool within_first)
    : first_(first), second_(second) {
  std::vector<Nodes> open, leaves;
  if (within_first && !first.empty()) open.push_back({0, 0, true});
  if (!first.empty() && !second.empty()) open.push_back({0, 0, false});
  while (!open.empty() && open.size() < many_parts) {
    std::vector<Nodes> next;
    for (const Nodes& nodes : open)
      if (are_leaves(nodes))
        leaves.push_back(nodes);
      else
        split(nodes, next);
    open = std::move(next);
  }
  parts_ = std::move(leaves);
  parts_.insert(parts_.end(), open.begin(), open.end());
}

// Appends the pairs of children that may hold pairs of boxes.
void BoxPairs::split(const Nodes& nodes, std::vector<Nodes>& to) const {
  const BoxTree::Node &a = node_a(nodes), &b = node_b(nodes);
  const auto add = [&](int i, int j) {
    if (overlap(first_.nodes[i].box, FacingSides(tree_b(nodes).nodes[j].box))) to.push_back({i, j, nodes.within});
  };
  if (nodes.within && nodes.a == nodes.b) {
    to.push_back({nodes.a + 1, nodes.a + 1, true});
    to.push_back({a.upper, a.upper, true});
    add(nodes.a + 1, a.upper);
  } else if (b.upper == 0 || (a.upper != 0 && a.end - a.begin >= b.end - b.begin)) {
    add(nodes.a + 1, nodes.b);
    add(a.upper, nodes.b);
  } else {
    add(nodes.a, nodes.b + 1);
    add(nodes.a, b.upper);
  }
}

}  // namespace selvedge
