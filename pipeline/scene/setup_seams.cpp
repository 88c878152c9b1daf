#include "pipeline/scene/setup_seams.hpp"

#include <algorithm>
#include <sstream>

#include <fmt/format.h>

#include "collision/geometry/counted.hpp"
#include "collision/geometry/disjoint_sets.hpp"
#include "collision/geometry/error.hpp"
#include "physics/energies/measures.hpp"
#include "pipeline/formats/mesh_weld.hpp"
#include "pipeline/host/read_file.hpp"
#include "pipeline/obstacles/setup_pairs.hpp"
#include "pipeline/obstacles/setup_paths.hpp"
#include "pipeline/scene/setup_selection.hpp"

namespace selvedge {
namespace {

constexpr double no_distance = 1e-6;  // of sewn vertices, in mean edge lengths

struct SewnPair {
  std::array<int, 2> vertices;  // of the cloth before it is sewn
  const Config* by = nullptr;
};

struct Weld {
  std::vector<SewnPair> pairs;
  std::vector<int> vertex;   // of each vertex before: its number once all are sewn
  std::vector<int> members;  // of each sewn vertex: how many it was

  // Throws at the pair that made vertex v.
  [[noreturn]] void fail(int v, const std::string& what, const std::string& cure) const {
    const auto pair = std::ranges::find_if(pairs, [&](const SewnPair& p) { return vertex[p.vertices[0]] == v; });
    pair->by->fail(fmt::format("sews vertices {} and {}, where {}", pair->vertices[0], pair->vertices[1], what), cure);
  }
};

const std::string edge_by_edge = "sew panels edge by edge, or join them by `springs`";

std::vector<std::array<int, 2>> read_pair_file(const std::filesystem::path& path, const ClothPart& part) {
  std::istringstream in(read_text_file(path, "seam"));
  std::vector<std::array<int, 2>> pairs;
  std::string text;
  for (int line = 1; std::getline(in, text); ++line) {
    const std::string where = fmt::format("{}:{}", path.string(), line);
    std::istringstream words(text.substr(0, text.find('#')));
    std::array<int, 2> pair{};
    std::string rest;
    if (!(words >> std::ws) || words.eof()) continue;
    if (!(words >> pair[0] >> pair[1]) || words >> rest)
      throw Error("`" + text + "` is not a pair of vertices", where, "write two indices a line, from 0");
    for (const int v : pair)
      if (v < 0 || v >= vertices_as_read(part))
        throw Error(fmt::format("names vertex {}, which does not exist", v), where,
                    fmt::format("allowed: 0 to {}", vertices_as_read(part) - 1));
    if (pair[0] == pair[1]) throw Error("pairs a vertex with itself", where, "write two different indices a line");
    for (int& v : pair) v = number_here(part, v);
    if (pair[0] != pair[1]) pairs.push_back(pair);  // others are welded already
  }
  return pairs;
}

std::vector<SewnPair> read_seams(const Config& list, const std::filesystem::path& folder, const ClothPart& part) {
  std::vector<SewnPair> sewn;
  for (const Config& seam : list.items) {
    const Config &from = seam["from"], &to = seam["to"];
    if (from.given != to.given) seam.fail("needs `from` and `to`, or `file`", "name both sides, or the file of pairs");
    const auto pairs = from.given ? read_pairs(seam, read_vertices(from, part), read_vertices(to, part), part.mesh.x)
                                  : read_pair_file(existing_path(seam["file"], folder), part);
    for (const auto& pair : pairs) sewn.push_back({pair, &seam});
  }
  return sewn;
}

Weld weld(std::vector<SewnPair> pairs, Eigen::Index count) {
  DisjointSets sets(static_cast<int>(count));
  for (const SewnPair& pair : pairs) sets.join(pair.vertices[0], pair.vertices[1]);
  Weld result{std::move(pairs), sets.numbers(), std::vector<int>(static_cast<std::size_t>(sets.count()), 0)};
  for (const int v : result.vertex) ++result.members[v];
  return result;
}

Triangles sewn_triangles(const Triangles& triangles, const Weld& weld) {
  Triangles sewn = triangles;
  for (Eigen::Index t = 0; t < sewn.rows(); ++t)
    for (int k = 0; k < 3; ++k) {
      sewn(t, k) = weld.vertex[triangles(t, k)];
      for (int m = 0; m < k; ++m)
        if (sewn(t, m) == sewn(t, k))
          weld.fail(sewn(t, k),
                    fmt::format("vertices {} and {} of triangle {} become one", triangles(t, m), triangles(t, k), t),
                    edge_by_edge);
    }
  return sewn;
}

// Edges that were several must have become one between two triangles.
void check_edges(const Surface& before, const Surface& after, const Weld& weld, const std::string& name,
                 std::vector<std::string>& warnings) {
  struct Edge {
    int was = -1, triangles = 0, opposite = -1, direction = 0;
    bool sewn = false;
  };
  std::vector<Edge> edges(static_cast<std::size_t>(after.edges.rows()));
  int clashing = 0;
  for (int t = 0; t < after.triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k) {
      const int a = after.triangles(t, k), b = after.triangles(t, (k + 1) % 3), c = after.triangles(t, (k + 2) % 3);
      Edge& edge = edges[after.triangle_edges(t, k)];
      edge.sewn = edge.sewn || (edge.was >= 0 && edge.was != before.triangle_edges(t, k));
      const int end = weld.members[a] > 1 ? a : b;
      if (++edge.triangles > 2 && edge.sewn) weld.fail(end, "more than two triangles meet in an edge", edge_by_edge);
      if (edge.sewn && edge.opposite == c) weld.fail(end, "two triangles become one", edge_by_edge);
      const int direction = a < b ? 1 : -1;
      clashing += edge.sewn && edge.direction == direction;
      edge.was = before.triangle_edges(t, k);
      edge.opposite = c;
      edge.direction = direction;
    }
  if (clashing > 0)
    warnings.push_back(
        fmt::format("cloth `{}`: panels face opposite ways along {}; if a seam is twisted, "
                    "list one of its sides the other way round",
                    name, counted(clashing, "sewn edge")));
}

// The triangles round a sewn vertex must be one fan.
void check_fans(const Surface& surface, const Weld& weld) {
  for (int v = 0; v < surface.vertex_count; ++v) {
    const auto own = surface.triangles_of(v);
    if (weld.members[v] < 2 || own.empty()) continue;
    std::vector<int> fan{own.front()};
    for (std::size_t i = 0; i < fan.size(); ++i)
      for (int k = 0; k < 3; ++k) {
        const int edge = surface.triangle_edges(fan[i], k);
        if (surface.edges(edge, 0) != v && surface.edges(edge, 1) != v) continue;
        for (const int t : surface.edge_triangles[edge])
          if (t >= 0 && std::ranges::find(fan, t) == fan.end()) fan.push_back(t);
      }
    if (fan.size() < own.size()) weld.fail(v, "panels meet in a point and not along an edge", edge_by_edge);
  }
}

Points means(const Points& x, const Weld& weld) {
  Points mean = Points::Zero(static_cast<Eigen::Index>(weld.members.size()), 3);
  for (Eigen::Index v = 0; v < x.rows(); ++v) mean.row(weld.vertex[v]) += x.row(v);
  for (std::size_t v = 0; v < weld.members.size(); ++v) mean.row(static_cast<Eigen::Index>(v)) /= weld.members[v];
  return mean;
}

}  // namespace

void sew(const Config& list, const std::filesystem::path& folder, ClothPart& part, std::vector<std::string>& warnings) {
  if (list.items.empty()) return;
  Mesh& mesh = part.mesh;
  const Weld welded = weld(read_seams(list, folder, part), mesh.x.rows());
  const Surface before = make_surface(static_cast<int>(mesh.x.rows()), mesh.triangles);
  mesh.triangles = sewn_triangles(mesh.triangles, welded);
  const Surface after = make_surface(static_cast<int>(welded.members.size()), mesh.triangles);
  check_edges(before, after, welded, part.name, warnings);
  check_fans(after, welded);
  for (const SewnPair& pair : welded.pairs)
    part.sewn_apart = std::max(part.sewn_apart, (row(mesh.x, pair.vertices[0]) - row(mesh.x, pair.vertices[1])).norm());
  renumber_look(welded.vertex, mesh);
  mesh.x = means(mesh.x, welded);
  part.rest = means(part.rest, welded);
  for (auto& [name, vertices] : mesh.groups) {
    for (int& v : vertices) v = welded.vertex[v];
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  }
  if (part.sewn.empty())
    part.sewn = welded.vertex;  // not welded before
  else
    for (int& v : part.sewn) v = welded.vertex[v];
}

void warn_of_stretched_seams(const std::vector<ClothPart>& parts, const Scene& scene, const Points& x,
                             std::vector<std::string>& warnings) {
  for (std::size_t c = 0; c < parts.size(); ++c) {
    const ClothPart& part = parts[c];
    if (part.sewn_apart <= no_distance * mean_edge_length(part.rest_triangle)) continue;
    const auto stretches = principal_stretches(scene, x);
    std::vector<int> members(static_cast<std::size_t>(part.mesh.x.rows()), 0);
    for (const int v : part.sewn) ++members[v];
    double most = 1;
    for (Eigen::Index t = 0; t < part.mesh.triangles.rows(); ++t)
      for (int k = 0; k < 3; ++k)
        if (members[part.mesh.triangles(t, k)] > 1)
          most = std::max(most, stretches(scene.cloths[c].first_triangle + t, 1));
    warnings.push_back(
        fmt::format("cloth `{}`: sewn vertices are up to {:.3g} m apart and start in their middle, which "
                    "stretches the cloth there by a factor of up to {:.3g}",
                    part.name, part.sewn_apart, most));
  }
}

}  // namespace selvedge
