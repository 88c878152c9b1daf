#pragma once

#include <vector>

#include "learned/graph/nearest_item.hpp"

namespace selvedge {

// Finds the nearest item of a tree for each point, within sqrt(squared); -1 where there is none. `groups` is a tree of
// the points, whose leaves search together. `last` has an entry per point: a guess, such as the last result, and then
// the result. Guesses save time and change nothing. `squared_of(p, item)` is the squared distance.
template <class SquaredOf>
void find_nearest_of_all(const Points& points, const Bvh& groups, const Bvh& items, double squared,
                         std::vector<int>& last, SquaredOf&& squared_of) {
  const int count = static_cast<int>(groups.leaves.size());
  last.resize(static_cast<std::size_t>(points.rows()), -1);
#pragma omp parallel for schedule(dynamic, 16)
  for (int leaf = 0; leaf < count; ++leaf) {
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
  }
}

}  // namespace selvedge
