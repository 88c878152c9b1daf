#include "collision/geometry/same_places.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "collision/geometry/box_diagonal.hpp"
#include "collision/geometry/disjoint_sets.hpp"

namespace selvedge {
namespace {

constexpr std::size_t many = 1000;  // more vertices at one place than the seams of a mesh have

// The largest distance of vertices at one place [m].
double same_place(const Points& x) { return 1e-6 * box_diagonal(x); }

}  // namespace

std::vector<int> same_places(const Points& x) {
  return x.rows() == 0 ? std::vector<int>() : same_places(x, same_place(x));
}

std::vector<int> same_places(const Points& x, double near) {
  const int n = static_cast<int>(x.rows());
  DisjointSets sets(n);
  if (n == 0) return {};
  const Eigen::RowVector3d low = x.colwise().minCoeff();
  // Vertices sorted by cubes of this edge; neighbours are found by binary search. Cube numbers stay exact in doubles.
  using Cube = std::array<double, 3>;
  const auto cube_of = [&](int v) {
    Cube cube{};
    for (int k = 0; k < 3 && near > 0; ++k) cube[static_cast<std::size_t>(k)] = std::floor((x(v, k) - low[k]) / near);
    return cube;
  };
  std::vector<std::pair<Cube, int>> sorted;
  for (int v = 0; v < n; ++v) sorted.emplace_back(cube_of(v), v);
  std::sort(sorted.begin(), sorted.end());
  for (int v = 0; v < n; ++v) {
    const Cube own = cube_of(v);
    for (int dx = -1; dx <= 1; ++dx)
      for (int dy = -1; dy <= 1; ++dy) {
        // A column of three cubes is contiguous.
        const Cube first{own[0] + dx, own[1] + dy, own[2] - 1};
        auto entry = std::lower_bound(sorted.begin(), sorted.end(), std::pair(first, -1));
        for (; entry != sorted.end() && entry->first[0] == first[0] && entry->first[1] == first[1] &&
               entry->first[2] <= own[2] + 1;
             ++entry) {
          if (sets.root(entry->second) == sets.root(v)) continue;
          if ((x.row(entry->second) - x.row(v)).norm() <= near) sets.join(entry->second, v);
        }
      }
  }
  std::vector<int> places(static_cast<std::size_t>(n));
  for (int v = 0; v < n; ++v) places[static_cast<std::size_t>(v)] = sets.root(v);
  return places;
}

void part_places(const std::function<bool(int, int)>& same, std::vector<int>& places) {
  std::vector<std::vector<int>> members(places.size());
  for (std::size_t v = 0; v < places.size(); ++v) members[places[v]].push_back(static_cast<int>(v));
  for (const std::vector<int>& group : members) {
    std::vector<int> lowest;  // of each place into which the group is split
    for (const int v : group) {
      const auto found =
          group.size() > many ? lowest.end() : std::ranges::find_if(lowest, [&](int w) { return same(v, w); });
      places[v] = found == lowest.end() ? v : *found;
      if (found == lowest.end()) lowest.push_back(v);
    }
  }
}

std::vector<int> same_places(std::span<const Points> frames) {
  std::vector<int> places = same_places(frames.front());
  for (const Points& x : frames.subspan(1)) {
    const double near = same_place(x);
    part_places([&](int v, int w) { return (x.row(v) - x.row(w)).norm() <= near; }, places);
  }
  return places;
}

}  // namespace selvedge
