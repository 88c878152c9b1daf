#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>
#include <vector>

#include "collision/geometry/parallel.hpp"
#include "collision/search/bvh_traversal.hpp"

namespace selvedge {

// One bit per place of the leaf. It is false only where the box is surely farther from p than sqrt(squared). Computed
// in float, with a margin for rounding.
inline unsigned may_be_within(const Bvh::Leaf& leaf, const Vec3& p, double squared) {
  const double reach = std::sqrt(squared) * (1 + 1e-5) + 1e-6 * p.cwiseAbs().maxCoeff();
  const auto most = static_cast<float>(reach * reach * (1 + 1e-5));
  LaneFlags flags[2];
  for (int half = 0; half < 2; ++half) {
    Bvh::Lanes sum{};
    for (int k = 0; k < 3; ++k) {
      const auto at = static_cast<float>(p[k]);
      const Bvh::Lanes below = leaf.lo[k][half] - at, above = at - leaf.hi[k][half];
      Bvh::Lanes out = below > above ? below : above;  // NaN in an empty place
      out = out < 0 ? Bvh::Lanes{} : out;
      sum += out * out;
    }
    flags[half] = sum <= most;
  }
  return bits_of(flags[0], flags[1]);
}

struct NearestItem {
  double squared = 0;  // distance [m2]
  int item = -1;       // -1: none is near enough
};

// Points that lie together, at most a leaf of them, and the nearest item of each.
struct NearGroup {
  int size = 0;
  std::array<Vec3, Bvh::leaf_size> p;
  std::array<NearestItem, Bvh::leaf_size> best;
  std::array<double, 3> lo{HUGE_VAL, HUGE_VAL, HUGE_VAL}, hi{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};

  void add(const Vec3& point, const NearestItem& guess) {
    p[static_cast<std::size_t>(size)] = point;
    best[static_cast<std::size_t>(size++)] = guess;
    for (std::size_t k = 0; k < 3; ++k) {
      lo[k] = std::min(lo[k], point[static_cast<int>(k)]);
      hi[k] = std::max(hi[k], point[static_cast<int>(k)]);
    }
  }

  // A squared lower bound of the distance from all points to the box. The margin keeps equal distances equal.
  double distance_to(const Box& box) const {
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double out =
          std::max({0.0, static_cast<double>(box.lo[k]) - hi[k], lo[k] - static_cast<double>(box.hi[k])});
      sum += out * out;
    }
    return sum * (1 - 1e-12);
  }

  double farthest() const {
    double most = 0;
    for (int i = 0; i < size; ++i) most = std::max(most, best[static_cast<std::size_t>(i)].squared);
    return most;
  }
};

// Finds the nearest item of the tree for each point of the group, the lowest of several, if it is nearer than `best`,
// or as near and lower (-1 is higher than any item). `squared_of(p, item)` is the squared distance. A good guess in
// `best` saves most of the search and does not change the result.
template <class SquaredOf>
void find_nearest(const Bvh& tree, NearGroup& group, SquaredOf&& squared_of) {
  if (tree.nodes.empty() || group.size == 0) return;
  std::array<std::pair<double, int>, 64> stack;  // a balanced tree needs two per level: 2^32 items
  std::size_t height = 0;
  stack[height++] = {group.distance_to(tree.nodes[0].box), 0};
  double limit = group.farthest();
  while (height > 0) {
    const auto [bound, index] = stack[--height];
    if (bound > limit) continue;
    const Bvh::Node& node = tree.nodes[static_cast<std::size_t>(index)];
    if (node.child >= 0) {
      const auto child = static_cast<std::size_t>(node.child);
      std::pair<double, int> near{group.distance_to(tree.nodes[child].box), node.child};
      std::pair<double, int> far{group.distance_to(tree.nodes[child + 1].box), node.child + 1};
      if (far < near) std::swap(near, far);
      if (far.first <= limit) stack[height++] = far;
      if (near.first <= limit) stack[height++] = near;
      continue;
    }
    const Bvh::Leaf& leaf = tree.leaves[static_cast<std::size_t>(~node.child)];
    for (std::size_t i = 0; i < static_cast<std::size_t>(group.size); ++i) {
      NearestItem& best = group.best[i];
      for (unsigned bits = may_be_within(leaf, group.p[i], best.squared); bits != 0; bits &= bits - 1) {
        const int item = leaf.item[std::countr_zero(bits)];
        const double squared = squared_of(group.p[i], item);
        const bool lower = best.item < 0 || item < best.item;
        if (squared < best.squared || (squared == best.squared && lower)) best = {squared, item};
      }
    }
    limit = group.farthest();
  }
}

// Finds the nearest item of a tree for each point, within sqrt(squared); -1 where there is none. `groups` is a tree of
// the points, whose leaves search together. `last` has an entry per point: a guess, such as the last result, and then
// the result. Guesses save time and change nothing. `squared_of(p, item)` is the squared distance.
template <class SquaredOf>
void find_nearest_of_all(const Points& points, const Bvh& groups, const Bvh& items, double squared,
                         std::vector<int>& last, SquaredOf&& squared_of) {
  const int count = static_cast<int>(groups.leaves.size());
  last.resize(static_cast<std::size_t>(points.rows()), -1);
  parallel_for(count, 16, [&](int leaf) {
    const auto& together = groups.leaves[static_cast<std::size_t>(leaf)].item;
    NearGroup group;
    for (const int v : together) {
      if (v < 0) break;
      NearestItem best{squared, -1};
      if (const int guess = last[static_cast<std::size_t>(v)]; guess >= 0 && guess < items.item_count)
        if (const double there = squared_of(row(points, v), guess); there <= best.squared) best = {there, guess};
      group.add(row(points, v), best);
    }
    find_nearest(items, group, squared_of);
    for (int i = 0; i < group.size; ++i)
      last[static_cast<std::size_t>(together[i])] = group.best[static_cast<std::size_t>(i)].item;
  });
}

}  // namespace selvedge
