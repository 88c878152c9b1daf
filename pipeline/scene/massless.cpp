#include "pipeline/scene/massless.hpp"

#include <algorithm>
#include <limits>
#include <map>

#include <fmt/format.h>

#include "collision/geometry/counted.hpp"
#include "collision/geometry/disjoint_sets.hpp"
#include "collision/geometry/distance.hpp"

namespace selvedge {
namespace {

constexpr double without_area = 1e-6;  // altitude of a triangle, in its longest edges

bool has_area(const RestTriangle& triangle) {
  double longest = 0;
  for (int k = 0; k < 3; ++k) longest = std::max(longest, (triangle.col(k) - triangle.col((k + 1) % 3)).norm());
  return smallest_altitude(triangle) > without_area * longest;
}

// For each vertex without mass the triangles with area that it reaches through triangles without; for others none.
class JoinedTriangles {
 public:
  JoinedTriangles(const Triangles& triangles, const std::vector<char>& sound, const std::vector<char>& massless)
      : groups_(static_cast<int>(massless.size())), of_group_(massless.size()) {
    std::vector<std::vector<int>> sound_round(massless.size());
    for (int t = 0; t < triangles.rows(); ++t) {
      int first = -1;
      for (int k = 0; k < 3; ++k) {
        const int v = triangles(t, k);
        if (sound[static_cast<std::size_t>(t)]) sound_round[static_cast<std::size_t>(v)].push_back(t);
        if (massless[static_cast<std::size_t>(v)]) groups_.join(first < 0 ? first = v : first, v);
      }
    }
    for (const auto& triangle : triangles.rowwise()) {
      const auto one =
          std::ranges::find_if(triangle, [&](int v) { return massless[static_cast<std::size_t>(v)] != 0; });
      if (one == triangle.end()) continue;
      for (const int v : triangle) {
        const std::vector<int>& more = sound_round[static_cast<std::size_t>(v)];
        of(*one).insert(of(*one).end(), more.begin(), more.end());
      }
    }
    for (std::vector<int>& found : of_group_) {
      std::ranges::sort(found);
      found.erase(std::unique(found.begin(), found.end()), found.end());
    }
  }
  std::vector<int>& of(int vertex) { return of_group_[static_cast<std::size_t>(groups_.root(vertex))]; }

 private:
  DisjointSets groups_;                     // vertices without mass that triangles join
  std::vector<std::vector<int>> of_group_;  // by the group's root, ascending
};

std::optional<Follower> follower_of(int vertex, const Triangles& triangles, const std::vector<int>& candidates,
                                    const Points& rest) {
  std::optional<Follower> best;
  double nearest = std::numeric_limits<double>::infinity();
  for (const int t : candidates) {
    const std::array<int, 3> of{triangles(t, 0), triangles(t, 1), triangles(t, 2)};
    const Closest found = point_triangle(row(rest, vertex), row(rest, of[0]), row(rest, of[1]), row(rest, of[2]));
    if (!(found.squared_distance < nearest)) continue;
    nearest = found.squared_distance;
    best = Follower{vertex, of, -found.weights.tail<3>()};
  }
  return best;
}

// Triangles with an edge that no other has: taken away they open nothing.
std::vector<char> at_the_rim(const Triangles& triangles) {
  std::map<std::pair<int, int>, int> count;
  const auto edge = [&](Eigen::Index t, int k) -> std::pair<int, int> {
    return std::minmax(triangles(t, k), triangles(t, (k + 1) % 3));
  };
  for (Eigen::Index t = 0; t < triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k) ++count[edge(t, k)];
  std::vector<char> rim(static_cast<std::size_t>(triangles.rows()), 0);
  for (Eigen::Index t = 0; t < triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k) rim[static_cast<std::size_t>(t)] |= count[edge(t, k)] == 1;
  return rim;
}

void keep_triangles(const std::vector<char>& kept, ClothPart& part) {
  Mesh& mesh = part.mesh;
  Eigen::Index next = 0;
  for (Eigen::Index t = 0; t < mesh.triangles.rows(); ++t) {
    if (!kept[static_cast<std::size_t>(t)]) continue;
    mesh.triangles.row(next) = mesh.triangles.row(t);
    if (mesh.uv_triangles.rows() > 0) mesh.uv_triangles.row(next) = mesh.uv_triangles.row(t);
    part.rest_triangle[static_cast<std::size_t>(next)] = part.rest_triangle[static_cast<std::size_t>(t)];
    ++next;
  }
  mesh.triangles.conservativeResize(next, 3);
  if (mesh.uv_triangles.rows() > 0) mesh.uv_triangles.conservativeResize(next, 3);
  part.rest_triangle.resize(static_cast<std::size_t>(next));
}

}  // namespace

void leave_out_massless(ClothPart& part, std::vector<std::string>& warnings) {
  const Triangles triangles = part.mesh.triangles;
  std::vector<char> sound, massless(static_cast<std::size_t>(part.rest.rows()), 1);
  for (const RestTriangle& triangle : part.rest_triangle) sound.push_back(has_area(triangle));
  for (Eigen::Index t = 0; t < triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k)
      if (sound[static_cast<std::size_t>(t)]) massless[triangles(t, k)] = 0;
  const std::vector<char> rim = at_the_rim(triangles);
  std::vector<char> kept(sound.size());
  int left_out = 0;
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    const auto i = static_cast<std::size_t>(t);
    bool goes = !sound[i] && rim[i];
    for (int k = 0; k < 3; ++k) goes = goes || massless[triangles(t, k)];
    kept[i] = !goes;
    left_out += goes;
  }
  if (left_out == 0) return;
  JoinedTriangles joined(triangles, sound, massless);
  for (int v = 0; v < part.rest.rows(); ++v)
    if (massless[v])
      if (const auto found = follower_of(v, triangles, joined.of(v), part.rest)) part.followers.push_back(*found);
  keep_triangles(kept, part);
  std::string warning = fmt::format("cloth `{}`: {} of zero rest area {} left out", part.name,
                                    counted(left_out, "triangle"), by_number(left_out, "is", "are"));
  if (std::ranges::find(massless, 1) != massless.end())
    warning +=
        fmt::format(", and {} the cloth that {} to",
                    counted(std::ssize(part.followers), "vertex without mass follows", "vertices without mass follow"),
                    by_number(std::ssize(part.followers), "it was joined", "they were joined"));
  warnings.push_back(warning);
}

std::vector<Follower> followers_of(const std::vector<ClothPart>& parts, const Scene& scene) {
  std::vector<Follower> all;
  for (std::size_t c = 0; c < parts.size(); ++c)
    for (Follower one : parts[c].followers) {
      const bool pinned = std::ranges::any_of(
          parts[c].pins, [&](const PinPart& pin) { return std::ranges::binary_search(pin.vertices, one.vertex); });
      if (pinned) continue;
      one.vertex += scene.cloths[c].first_vertex;
      for (int& v : one.of) v += scene.cloths[c].first_vertex;
      all.push_back(one);
    }
  return all;
}

}  // namespace selvedge
