#include "pipeline/formats/mesh_weld.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "collision/geometry/disjoint_sets.hpp"
#include "pipeline/formats/mesh_io.hpp"

namespace selvedge {
namespace {

constexpr double same_place = 1e-6;  // in diagonals of the box

void renumber(const std::vector<int>& numbers, int count, Mesh& mesh) {
  Points x(count, 3);
  for (std::size_t v = numbers.size(); v-- > 0;)  // the lowest comes last and stays
    x.row(numbers[v]) = mesh.x.row(static_cast<Eigen::Index>(v));
  mesh.x = std::move(x);
  for (Eigen::Index t = 0; t < mesh.triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k) mesh.triangles(t, k) = numbers[mesh.triangles(t, k)];
  for (int& corner : mesh.corners) corner = numbers[corner];
  for (auto& [name, vertices] : mesh.groups) {
    for (int& v : vertices) v = numbers[v];
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  }
}

}  // namespace

std::vector<int> same_places(const Points& x) {
  const int n = static_cast<int>(x.rows());
  DisjointSets sets(n);
  const Eigen::RowVector3d low = x.colwise().minCoeff(), high = x.colwise().maxCoeff();
  const double near = same_place * (high - low).norm();
  // Sorted by cubes of that edge, whose neighbours are looked up. Their numbers stay exact in doubles.
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
        // A column of three cubes lies side by side.
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

int coincident_vertices(const Points& x) {
  const std::vector<int> places = same_places(x);
  int count = 0;
  for (std::size_t v = 0; v < places.size(); ++v) count += places[v] != static_cast<int>(v);
  return count;
}

void weld(Mesh& mesh, const std::string& name) {
  const std::vector<int> places = same_places(mesh.x);
  mesh.welded.assign(places.size(), 0);
  int count = 0;
  for (std::size_t v = 0; v < places.size(); ++v)
    mesh.welded[v] = places[v] == static_cast<int>(v) ? count++ : mesh.welded[places[v]];
  renumber(mesh.welded, count, mesh);
  leave_out_repeated(mesh, name);
}

void weld_as(const Mesh& welded, Mesh& mesh) {
  if (welded.welded.empty()) return;
  renumber(welded.welded, static_cast<int>(welded.x.rows()), mesh);
  mesh.triangles = welded.triangles;
}

}  // namespace selvedge
