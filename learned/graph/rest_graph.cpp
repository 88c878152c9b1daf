#include "learned/graph/rest_graph.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "collision/geometry/error.hpp"

namespace selvedge {
namespace {

void refuse_if(bool wrong, const std::string& what) {
  if (wrong) throw Error(what, "graph of a learned stepper", "");
}

void check(const GraphScene& scene) {
  const Eigen::Index cloth = scene.cloth.vertex_count, body = scene.body.vertex_count;
  refuse_if(scene.rest.rows() != cloth, "a rest position is needed for each cloth vertex");
  refuse_if(static_cast<Eigen::Index>(scene.mass.size()) != cloth, "a mass is needed for each cloth vertex");
  refuse_if(static_cast<Eigen::Index>(scene.types.size()) != cloth, "a type is needed for each cloth vertex");
  refuse_if(scene.materials.rows() != cloth || scene.materials.cols() != 3,
            "three material inputs are needed for each cloth vertex");
  refuse_if(static_cast<Eigen::Index>(scene.body_types.size()) != body, "a type is needed for each body vertex");
  refuse_if(!scene.rest.allFinite() || !scene.materials.allFinite() ||
                !std::ranges::all_of(scene.mass, [](double m) { return std::isfinite(m); }),
            "rest positions, masses and materials must be finite");
  const auto is_type = [](int type) { return type >= free_vertex && type <= pinned_vertex; };
  refuse_if(!std::ranges::all_of(scene.springs,
                                 [&](const Spring& spring) {
                                   return std::min(spring.a, spring.b) >= 0 && std::max(spring.a, spring.b) < cloth &&
                                          spring.a != spring.b && std::isfinite(spring.rest_length);
                                 }),
            "a spring joins two vertices of the cloth");
  refuse_if(!std::ranges::all_of(scene.types, is_type) || !std::ranges::all_of(scene.body_types, is_type),
            "vertex types are 0 to 3");
}

using VertexPair = std::pair<int, int>;  // the larger vertex first

VertexPair pair_of(int a, int b) { return {std::max(a, b), std::min(a, b)}; }

// Edges of triangles, and springs between vertices that no triangle joins, each once. Sorted by the larger vertex, then
// by the smaller one.
Edges mesh_order(const Edges& edges, const std::vector<Spring>& springs) {
  std::vector<VertexPair> sorted;
  for (const auto& edge : edges.rowwise()) sorted.emplace_back(edge[1], edge[0]);
  for (const Spring& spring : springs) sorted.push_back(pair_of(spring.a, spring.b));
  std::sort(sorted.begin(), sorted.end());
  sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
  Edges result(static_cast<Eigen::Index>(sorted.size()), 2);
  for (std::size_t i = 0; i < sorted.size(); ++i)
    result.row(static_cast<Eigen::Index>(i)) << sorted[i].second, sorted[i].first;
  return result;
}

RestEdges both_ways(std::string key, const Edges& edges, MeshOrder order) {
  RestEdges set{std::move(key), {}, {}, {}, {}};
  const int first = order == MeshOrder::larger_sends ? 1 : 0;
  for (const int sender : {first, 1 - first})
    for (const auto& edge : edges.rowwise()) {
      set.senders.push_back(edge[sender]);
      set.receivers.push_back(edge[1 - sender]);
    }
  return set;
}

// A vertex without triangles has no mass; it gets the logarithm of a microgram.
float mass_column(const FeatureOptions& options, double mass) {
  return static_cast<float>(options.log_mass ? std::log(std::max(mass, 1e-9)) : mass);
}

}  // namespace

void fill_rest_columns(const GraphScene& scene, const FeatureOptions& options, RestEdges& set) {
  const auto count = static_cast<Eigen::Index>(set.senders.size());
  const bool vector = options.rest == RestFeature::vector;
  set.rest.resize(count, vector ? 4 : 1);
  set.materials.resize(count, 3);
  for (Eigen::Index e = 0; e < count; ++e) {
    const int s = set.senders[static_cast<std::size_t>(e)], r = set.receivers[static_cast<std::size_t>(e)];
    const Vec3 relative = row(scene.rest, s) - row(scene.rest, r);
    if (vector) set.rest.row(e).head<3>() = relative.cast<float>();
    set.rest(e, vector ? 3 : 0) = static_cast<float>(relative.norm());
    set.materials.row(e) = 0.5f * (scene.materials.row(s) + scene.materials.row(r));
  }
}

namespace {

// A spring's rest length holds, wherever its ends lie in the rest shape.
void set_spring_lengths(const GraphScene& scene, const FeatureOptions& options, RestEdges& set) {
  std::map<VertexPair, double> lengths;
  for (const Spring& spring : scene.springs) lengths[pair_of(spring.a, spring.b)] = spring.rest_length;
  for (const auto& edge : scene.cloth.edges.rowwise()) lengths.erase(pair_of(edge[0], edge[1]));
  if (lengths.empty()) return;
  const bool vector = options.rest == RestFeature::vector;
  for (std::size_t e = 0; e < set.senders.size(); ++e) {
    const auto spring = lengths.find(pair_of(set.senders[e], set.receivers[e]));
    if (spring == lengths.end()) continue;
    auto columns = set.rest.row(static_cast<Eigen::Index>(e));
    const auto length = static_cast<float>(spring->second);
    float& known = columns(vector ? 3 : 0);
    if (vector && known > 0) columns.head<3>() *= length / known;
    known = length;
  }
}

}  // namespace

RestGraph make_rest_graph(const GraphScene& scene, const FeatureOptions& options, std::span<const int> centres) {
  check(scene);
  RestGraph result;
  result.coarse = options.coarse_form == CoarseForm::discs
                      ? make_coarse_discs(scene.cloth, scene.rest, options.coarse_levels)
                      : make_coarse_levels(scene.cloth, options.coarse_levels, centres, options.approximate_centre);
  result.sets.push_back(both_ways("mesh_edge", mesh_order(scene.cloth.edges, scene.springs), options.mesh_order));
  for (const int level : options.coarse_sets) {
    const bool is_built = level >= 0 && level < options.coarse_levels;
    refuse_if(!is_built, "coarse level " + std::to_string(level) + " is not built");
    result.sets.push_back(both_ways("coarse_edge" + std::to_string(level),
                                    result.coarse.levels[static_cast<std::size_t>(level)], MeshOrder::smaller_sends));
  }
  for (RestEdges& set : result.sets) fill_rest_columns(scene, options, set);
  set_spring_lengths(scene, options, result.sets.front());
  for (const int level : result.coarse.vertex_level)
    result.vertex_levels.push_back(std::min(level, options.highest_level));
  for (const double mass : scene.mass) result.mass.push_back(mass_column(options, mass));
  for (int v = 0; v < scene.cloth.vertex_count; ++v)
    if (scene.types[static_cast<std::size_t>(v)] == pinned_vertex) result.pinned.push_back(v);
  return result;
}

}  // namespace selvedge
