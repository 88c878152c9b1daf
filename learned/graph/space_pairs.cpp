#include "learned/graph/space_pairs.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <tuple>

namespace selvedge {
namespace {

constexpr double least_distance = 1e-7;  // [m]; what lies closer is one place
constexpr int vertex_chunk = 256;

using HashedCell = std::array<std::int64_t, 3>;

// Vertices by the cells of an endless grid, which share a table.
class HashedGrid {
 public:
  HashedGrid(const Points& x, double edge) : mask_(std::bit_ceil(2 * static_cast<std::uint64_t>(x.rows()) + 1) - 1) {
    const int count = static_cast<int>(x.rows());
    cell_.resize(static_cast<std::size_t>(count));
    begin_.assign(mask_ + 2, 0);
    for (int v = 0; v < count; ++v) {
      for (int k = 0; k < 3; ++k) cell_[v][k] = static_cast<std::int64_t>(std::floor(x(v, k) / edge));
      ++begin_[bucket(cell_[v]) + 1];
    }
    for (std::size_t b = 1; b < begin_.size(); ++b) begin_[b] += begin_[b - 1];
    std::vector<int> next(begin_.begin(), begin_.end() - 1);
    vertex_.resize(cell_.size());
    for (int v = 0; v < count; ++v) vertex_[next[bucket(cell_[v])]++] = v;
  }
  const HashedCell& cell_of(int vertex) const { return cell_[vertex]; }
  // Visits the vertices of a cell, ascending.
  template <class Visit>
  void for_each_in(const HashedCell& cell, const Visit& visit) const {
    const std::uint64_t b = bucket(cell);
    for (int i = begin_[b]; i < begin_[b + 1]; ++i)
      if (cell_[vertex_[i]] == cell) visit(vertex_[i]);
  }

 private:
  std::uint64_t bucket(const HashedCell& cell) const {
    std::uint64_t hash = 0;
    for (const std::int64_t k : cell) hash = (hash ^ static_cast<std::uint64_t>(k)) * 0x9e3779b97f4a7c15u;
    return (hash >> 32) & mask_;
  }
  std::uint64_t mask_;
  std::vector<HashedCell> cell_;
  std::vector<int> begin_, vertex_;
};

struct NearVertex {
  double square;
  int vertex;
  bool operator<(const NearVertex& other) const {
    return std::tie(square, vertex) < std::tie(other.square, other.vertex);
  }
};

// Of each other vertex, or of those behind it alone.
void list_near(const HashedGrid& grid, const Points& x, int vertex, double radius, bool behind,
               std::vector<NearVertex>& near) {
  near.clear();
  const HashedCell& own = grid.cell_of(vertex);
  for (int i = -1; i <= 1; ++i)
    for (int j = -1; j <= 1; ++j)
      for (int k = -1; k <= 1; ++k)
        grid.for_each_in({own[0] + i, own[1] + j, own[2] + k}, [&](int other) {
          if (other == vertex || (behind && other < vertex)) return;
          const double square = (x.row(other) - x.row(vertex)).squaredNorm();
          if (square < radius * radius && square > least_distance * least_distance) near.push_back({square, other});
        });
  std::sort(near.begin(), near.end());
}

bool is_wanted(const GraphScene& scene, const SpaceOptions& options, const SpaceSearch& search, int a, int b) {
  const std::span<const int> joined = search.mesh.of(a);
  if (!options.mesh_pairs && std::binary_search(joined.begin(), joined.end(), b)) return false;
  return options.rest_pairs || (scene.rest.row(a) - scene.rest.row(b)).norm() >= search.radius;
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
  const int vertices = scene.cloth.vertex_count, chunks = (vertices + vertex_chunk - 1) / vertex_chunk;
  if (search.radius == 0) {
    search.mesh = adjacency_of(vertices, scene.cloth.edges);
    search.radius =
        options.radius_in_edges > 0 ? options.radius_in_edges * mean_edge(scene.cloth, scene.rest) : options.radius;
  }
  SpacePairs found;
  if (!(search.radius > 0)) return found;
  const HashedGrid grid(x, search.radius);
  search.lists.resize(static_cast<std::size_t>(chunks));
#pragma omp parallel for schedule(dynamic)
  for (int chunk = 0; chunk < chunks; ++chunk) {
    std::vector<SpacePair>& list = search.lists[static_cast<std::size_t>(chunk)];
    list.clear();
    std::vector<NearVertex> near;
    for (int v = chunk * vertex_chunk; v < std::min(vertices, (chunk + 1) * vertex_chunk); ++v) {
      list_near(grid, x, v, search.radius, options.nearest == 0, near);
      if (options.nearest > 0 && near.size() > static_cast<std::size_t>(options.nearest))
        near.resize(static_cast<std::size_t>(options.nearest));
      for (const NearVertex& other : near)
        if (is_wanted(scene, options, search, v, other.vertex))
          list.push_back({std::min(v, other.vertex), std::max(v, other.vertex)});
    }
  }
  for (const std::vector<SpacePair>& list : search.lists)
    found.pairs.insert(found.pairs.end(), list.begin(), list.end());
  std::sort(found.pairs.begin(), found.pairs.end());
  found.pairs.erase(std::unique(found.pairs.begin(), found.pairs.end()), found.pairs.end());
  keep_nearest(x, static_cast<std::size_t>(std::max(options.pairs_per_vertex, 0)) * static_cast<std::size_t>(vertices),
               found);
  return found;
}

}  // namespace selvedge
