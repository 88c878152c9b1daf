#include "learned/graph/space_pairs.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <compare>
#include <cstdint>
#include <numeric>
#include <span>
#include <tuple>

#include "collision/geometry/parallel.hpp"

namespace selvedge {
namespace {

constexpr double least_distance = 1e-7;  // [m]; vertices that are closer coincide
constexpr int vertex_chunk = 1024, cell_chunk = 64;

struct CellPlace {
  std::int64_t i, j, k;
  auto operator<=>(const CellPlace&) const = default;
};

// Vertices in the cells of an unbounded grid, which share a hash table.
class HashedGrid {
 public:
  struct Entry {
    Vec3 x;
    int vertex;
  };
  using Entries = std::span<const Entry>;
  struct Cell {
    CellPlace place;
    int begin, end;  // of its entries, sorted by vertex
  };

  HashedGrid(const Points& x, double edge) : mask_(std::bit_ceil(2 * static_cast<std::uint64_t>(x.rows()) + 1) - 1) {
    const int count = static_cast<int>(x.rows());
    std::vector<CellPlace> place(static_cast<std::size_t>(count));
    std::vector<std::uint64_t> bucket(place.size());
    parallel_for(chunks_of(count, vertex_chunk), 1, [&](int chunk) {
      for (int v = chunk * vertex_chunk; v < std::min(count, (chunk + 1) * vertex_chunk); ++v) {
        const auto along = [&](int axis) { return static_cast<std::int64_t>(std::floor(x(v, axis) / edge)); };
        place[v] = {along(0), along(1), along(2)};
        bucket[v] = bucket_of(place[v]);
      }
    });
    std::vector<int> begin(mask_ + 2, 0), order(place.size());
    for (const std::uint64_t b : bucket) ++begin[b + 1];
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    std::vector<int> next(begin.begin(), begin.end() - 1);
    for (int v = 0; v < count; ++v) order[next[bucket[v]]++] = v;
    begin_.reserve(begin.size());
    for (std::size_t b = 0; b + 1 < begin.size(); ++b) {
      begin_.push_back(static_cast<int>(cells_.size()));
      std::sort(order.begin() + begin[b], order.begin() + begin[b + 1],
                [&](int p, int q) { return std::tie(place[p], p) < std::tie(place[q], q); });
      for (int e = begin[b]; e < begin[b + 1]; ++e) {
        const bool opens = e == begin[b] || place[order[e]] != cells_.back().place;
        if (opens) cells_.push_back({place[order[e]], e, e});
        ++cells_.back().end;
      }
    }
    begin_.push_back(static_cast<int>(cells_.size()));
    entries_.resize(order.size());
    for (std::size_t e = 0; e < order.size(); ++e) entries_[e] = {row(x, order[e]), order[e]};
  }

  const std::vector<Cell>& cells() const { return cells_; }
  Entries entries(const Cell& cell) const { return Entries(entries_).subspan(cell.begin, cell.end - cell.begin); }

  // Lists the entries of the cells round a cell. With `half` each pair of neighbours is listed from one side only.
  void list_round(const CellPlace& own, bool half, std::vector<Entries>& found) const {
    found.clear();
    for (int step = half ? 14 : 0; step < 27; ++step) {
      const CellPlace place{own.i + step / 9 - 1, own.j + step / 3 % 3 - 1, own.k + step % 3 - 1};
      const std::uint64_t b = bucket_of(place);
      for (int c = begin_[b]; c < begin_[b + 1]; ++c)
        if (step != 13 && cells_[c].place == place) found.push_back(entries(cells_[c]));
    }
  }

 private:
  static std::uint64_t mixed(std::uint64_t hash, std::int64_t k) {
    return (hash ^ static_cast<std::uint64_t>(k)) * 0x9e3779b97f4a7c15u;
  }
  std::uint64_t bucket_of(const CellPlace& place) const {
    return (mixed(mixed(mixed(0, place.i), place.j), place.k) >> 32) & mask_;
  }

  std::uint64_t mask_;
  std::vector<int> begin_;      // first cell of each bucket
  std::vector<Cell> cells_;     // sorted by bucket
  std::vector<Entry> entries_;  // sorted by cell
};

struct NearVertex {
  double square;
  int vertex;
  bool operator<(const NearVertex& other) const {
    return std::tie(square, vertex) < std::tie(other.square, other.vertex);
  }
};

// Inputs of the lists of pairs.
struct PairLister {
  const GraphScene& scene;
  const SpaceOptions& options;
  const SpaceSearch& search;

  bool are_near(double square) const {
    return square < search.radius * search.radius && square > least_distance * least_distance;
  }
  bool are_wanted(int a, int b) const {
    if (!options.rest_pairs && (scene.rest.row(a) - scene.rest.row(b)).norm() < search.radius) return false;
    const std::span<const int> joined = search.mesh.of(a);
    return options.mesh_pairs || !std::binary_search(joined.begin(), joined.end(), b);
  }

  // Lists the pairs of a vertex with some others.
  void list_all(const HashedGrid::Entry& own, HashedGrid::Entries others, std::vector<SpacePair>& list) const {
    for (const HashedGrid::Entry& other : others)
      if (are_near((other.x - own.x).squaredNorm()) && are_wanted(own.vertex, other.vertex))
        list.push_back({std::min(own.vertex, other.vertex), std::max(own.vertex, other.vertex)});
  }

  // Lists the pairs of a vertex with its nearest vertices, as far as they are wanted.
  void list_nearest(const HashedGrid::Entry& own, const std::vector<HashedGrid::Entries>& round,
                    std::vector<SpacePair>& list) const {
    std::vector<NearVertex> near;
    for (const HashedGrid::Entries& others : round)
      for (const HashedGrid::Entry& other : others)
        if (const double square = (other.x - own.x).squaredNorm(); are_near(square) && other.vertex != own.vertex)
          near.push_back({square, other.vertex});
    std::sort(near.begin(), near.end());
    near.resize(std::min(near.size(), static_cast<std::size_t>(options.nearest)));
    for (const auto& [square, other] : near)
      if (are_wanted(own.vertex, other)) list.push_back({std::min(own.vertex, other), std::max(own.vertex, other)});
  }
};

// Sorts pairs and removes duplicates.
std::vector<SpacePair> sorted_pairs(const std::vector<std::vector<SpacePair>>& lists, int vertices) {
  std::vector<int> begin(static_cast<std::size_t>(vertices) + 1, 0);
  for (const std::vector<SpacePair>& list : lists)
    for (const SpacePair& pair : list) ++begin[pair[0] + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<SpacePair> pairs(static_cast<std::size_t>(begin.back()));
  std::vector<int> next(begin.begin(), begin.end() - 1);
  for (const std::vector<SpacePair>& list : lists)
    for (const SpacePair& pair : list) pairs[next[pair[0]]++] = pair;
  for (int v = 0; v < vertices; ++v) std::sort(pairs.begin() + begin[v], pairs.begin() + begin[v + 1]);
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

void keep_nearest(const Points& x, std::size_t most, SpacePairs& found) {
  if (found.pairs.size() <= most) return;
  found.beyond = static_cast<int>(found.pairs.size() - most);
  std::vector<std::pair<double, SpacePair>> sorted;
  for (const SpacePair& pair : found.pairs) sorted.emplace_back((x.row(pair[0]) - x.row(pair[1])).squaredNorm(), pair);
  std::sort(sorted.begin(), sorted.end());
  found.pairs.clear();
  for (std::size_t i = 0; i < most; ++i) found.pairs.push_back(sorted[i].second);
  std::sort(found.pairs.begin(), found.pairs.end());
}

}  // namespace

SpacePairs find_space_pairs(const GraphScene& scene, const Points& x, const SpaceOptions& options,
                            SpaceSearch& search) {
  const int vertices = scene.cloth.vertex_count;
  if (search.radius == 0) {
    search.mesh = adjacency_of(vertices, scene.cloth.edges);
    search.radius =
        options.radius_in_edges > 0 ? options.radius_in_edges * mean_edge(scene.cloth, scene.rest) : options.radius;
  }
  SpacePairs found;
  if (!(search.radius > 0)) return found;
  const HashedGrid grid(x, search.radius);
  const PairLister lister{scene, options, search};
  const int cells = static_cast<int>(grid.cells().size()), chunks = chunks_of(cells, cell_chunk);
  search.lists.resize(static_cast<std::size_t>(chunks));
  parallel_for(chunks, 1, [&](int chunk) {
    std::vector<SpacePair>& list = search.lists[chunk];
    list.clear();
    std::vector<HashedGrid::Entries> round;
    for (int c = chunk * cell_chunk; c < std::min(cells, (chunk + 1) * cell_chunk); ++c) {
      const HashedGrid::Cell& cell = grid.cells()[c];
      const HashedGrid::Entries own = grid.entries(cell);
      grid.list_round(cell.place, options.nearest == 0, round);
      if (options.nearest > 0) round.push_back(own);
      for (std::size_t e = 0; e < own.size(); ++e) {
        if (options.nearest > 0) {
          lister.list_nearest(own[e], round, list);
          continue;
        }
        lister.list_all(own[e], own.subspan(e + 1), list);
        for (const HashedGrid::Entries& others : round) lister.list_all(own[e], others, list);
      }
    }
  });
  found.pairs = sorted_pairs(search.lists, vertices);
  keep_nearest(x, static_cast<std::size_t>(std::max(options.pairs_per_vertex, 0)) * static_cast<std::size_t>(vertices),
               found);
  return found;
}

}  // namespace selvedge
