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
    entry_.resize(cell_.size());
    for (int v = 0; v < count; ++v) entry_[next[bucket(cell_[v])]++] = {cell_[v], row(x, v), v};
  }
  // Calls visit(vertex, position) for the vertices of the 27 cells at that of a vertex.
  template <class Visit>
  void for_each_round(int vertex, const Visit& visit) const {
    const HashedCell& own = cell_[vertex];
    for (std::int64_t i = own[0] - 1; i <= own[0] + 1; ++i)
      for (std::int64_t j = own[1] - 1; j <= own[1] + 1; ++j) {
        const std::uint64_t line = mixed(mixed(0, i), j);
        for (std::int64_t k = own[2] - 1; k <= own[2] + 1; ++k) {
          const std::uint64_t b = bucket_of(mixed(line, k));
          for (int e = begin_[b]; e < begin_[b + 1]; ++e) {
            const HashedCell& cell = entry_[e].cell;
            if (cell[0] == i && cell[1] == j && cell[2] == k) visit(entry_[e].vertex, entry_[e].x);
          }
        }
      }
  }

 private:
  struct Entry {
    HashedCell cell;
    Vec3 x;
    int vertex;
  };
  static std::uint64_t mixed(std::uint64_t hash, std::int64_t k) {
    return (hash ^ static_cast<std::uint64_t>(k)) * 0x9e3779b97f4a7c15u;
  }
  std::uint64_t bucket_of(std::uint64_t hash) const { return (hash >> 32) & mask_; }
  std::uint64_t bucket(const HashedCell& cell) const {
    return bucket_of(mixed(mixed(mixed(0, cell[0]), cell[1]), cell[2]));
  }
  std::uint64_t mask_;
  std::vector<HashedCell> cell_;  // of each vertex
  std::vector<int> begin_;        // of each bucket
  std::vector<Entry> entry_;      // by bucket, ascending
};

struct NearVertex {
  double square;
  int vertex;
  bool operator<(const NearVertex& other) const {
    return std::tie(square, vertex) < std::tie(other.square, other.vertex);
  }
};

// Calls visit(vertex, squared distance) for each other vertex nearer than the radius.
template <class Visit>
void for_each_near(const HashedGrid& grid, const Points& x, int vertex, double radius, const Visit& visit) {
  const Vec3 at = row(x, vertex);
  grid.for_each_round(vertex, [&](int other, const Vec3& there) {
    const double square = (there - at).squaredNorm();
    if (other != vertex && square < radius * radius && square > least_distance * least_distance) visit(other, square);
  });
}

bool is_wanted(const GraphScene& scene, const SpaceOptions& options, const SpaceSearch& search, int a, int b) {
  const std::span<const int> joined = search.mesh.of(a);
  if (!options.mesh_pairs && std::binary_search(joined.begin(), joined.end(), b)) return false;
  return options.rest_pairs || (scene.rest.row(a) - scene.rest.row(b)).norm() >= search.radius;
}

// The pairs of a vertex with those behind it, ascending.
void list_behind(const GraphScene& scene, const Points& x, const SpaceOptions& options, const SpaceSearch& search,
                 const HashedGrid& grid, int v, std::vector<SpacePair>& list) {
  const auto first = static_cast<std::ptrdiff_t>(list.size());
  for_each_near(grid, x, v, search.radius, [&](int other, double) {
    if (other > v && is_wanted(scene, options, search, v, other)) list.push_back({v, other});
  });
  std::sort(list.begin() + first, list.end());
}

// The pairs of a vertex with the nearest ones that are wanted among the nearest.
void list_nearest(const GraphScene& scene, const Points& x, const SpaceOptions& options, const SpaceSearch& search,
                  const HashedGrid& grid, int v, std::vector<SpacePair>& list) {
  std::vector<NearVertex> near;
  for_each_near(grid, x, v, search.radius, [&](int other, double square) { near.push_back({square, other}); });
  std::sort(near.begin(), near.end());
  near.resize(std::min(near.size(), static_cast<std::size_t>(options.nearest)));
  for (const NearVertex& other : near)
    if (is_wanted(scene, options, search, v, other.vertex))
      list.push_back({std::min(v, other.vertex), std::max(v, other.vertex)});
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
    const auto list_of = options.nearest > 0 ? list_nearest : list_behind;
    for (int v = chunk * vertex_chunk; v < std::min(vertices, (chunk + 1) * vertex_chunk); ++v)
      list_of(scene, x, options, search, grid, v, list);
  }
  for (const std::vector<SpacePair>& list : search.lists)
    found.pairs.insert(found.pairs.end(), list.begin(), list.end());
  if (options.nearest > 0) {  // else they ascend, each once
    std::sort(found.pairs.begin(), found.pairs.end());
    found.pairs.erase(std::unique(found.pairs.begin(), found.pairs.end()), found.pairs.end());
  }
  keep_nearest(x, static_cast<std::size_t>(std::max(options.pairs_per_vertex, 0)) * static_cast<std::size_t>(vertices),
               found);
  return found;
}

}  // namespace selvedge
