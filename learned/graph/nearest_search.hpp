#pragma once

#include <vector>

#include "learned/graph/nearest_item.hpp"

namespace selvedge {

// Finds the nearest item of a tree for each point of a leaf, within sqrt(squared); -1 where there is none. `last` has
// an entry per point: a guess, such as the last result, and then the result. Guesses save time and change nothing.
// `squared_of(p, item)` is the squared distance.
template <class SquaredOf>
void find_nearest_of_leaf(const Points& points, const Bvh::Leaf& group_leaf, const Bvh& items, double squared,
                          std::vector<int>& last, SquaredOf&& squared_of) {
  NearGroup group;
  for (const int v : group_leaf.item) {
    if (v < 0) break;
    NearestItem best{squared, -1};
    if (const int guess = last[static_cast<std::size_t>(v)]; guess >= 0 && guess < items.item_count)
      if (const double there = squared_of(row(points, v), guess); there <= best.squared) best = {there, guess};
    group.add(row(points, v), best);
  }
  find_nearest(items, group, squared_of);
  for (int i = 0; i < group.size; ++i)
    last[static_cast<std::size_t>(group_leaf.item[i])] = group.best[static_cast<std::size_t>(i)].item;
}

// The same for every point. `groups` is a tree of the points, whose leaves search together.
template <class SquaredOf>
void find_nearest_of_all(const Points& points, const Bvh& groups, const Bvh& items, double squared,
                         std::vector<int>& last, SquaredOf&& squared_of) {
  const int count = static_cast<int>(groups.leaves.size());
  last.resize(static_cast<std::size_t>(points.rows()), -1);
#pragma omp parallel for schedule(dynamic, 16)
  for (int leaf = 0; leaf < count; ++leaf)
    find_nearest_of_leaf(points, groups.leaves[static_cast<std::size_t>(leaf)], items, squared, last, squared_of);
}

}  // namespace selvedge
