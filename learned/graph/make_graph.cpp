#include "learned/graph/make_graph.hpp"

#include <algorithm>

#include "collision/contour/find_contours.hpp"
#include "collision/geometry/error.hpp"
#include "learned/graph/node_features.hpp"

namespace selvedge {
namespace {

void check_sizes(const GraphScene& scene, const RestGraph& rest, const GraphState& state) {
  const Eigen::Index cloth = scene.cloth.vertex_count, body = scene.body.vertex_count;
  const auto wrong = [](std::initializer_list<Eigen::Index> rows, Eigen::Index wanted) {
    return std::ranges::any_of(rows, [wanted](Eigen::Index n) { return n != wanted; });
  };
  if (wrong({state.x.rows(), state.previous.rows(), state.target.rows(), state.velocity.rows(),
             static_cast<Eigen::Index>(rest.vertex_levels.size())},
            cloth) ||
      (state.guess.rows() > 0 && state.guess.rows() != cloth) ||
      (state.force.rows() > 0 && state.force.rows() != cloth) ||
      (state.acceleration.rows() > 0 && state.acceleration.rows() != cloth) ||
      (state.elastic.rows() > 0 && state.elastic.rows() != cloth) ||
      (state.worn_motion.rows() > 0 && state.worn_motion.rows() != cloth) ||
      (state.worn_offset.rows() > 0 && state.worn_offset.rows() != cloth) ||
      wrong({state.body.rows(), state.body_previous.rows(), state.body_target.rows()}, body))
    throw Error("a state has another number of vertices than its scene", "graph of a learned stepper", "");
}

// Far beyond any scene. Squares and products of three fit into float.
constexpr double largest = 1e12;

bool is_usable(const Points& points) { return (points.array().abs() < largest).all(); }  // NaN fails too

std::string complaint(const GraphState& state) {
  if (!is_usable(state.x) || !is_usable(state.previous) || !is_usable(state.velocity) || !is_usable(state.target))
    return "a position or velocity of the cloth is not finite or far too large";
  if (!is_usable(state.guess) || !is_usable(state.force) || !is_usable(state.elastic))
    return "a guess or a force on the cloth is not finite or far too large";
  if (!is_usable(state.worn_motion) || !is_usable(state.worn_offset))
    return "a skinned target is not finite or far too large";
  if (!is_usable(state.acceleration)) return "an acceleration of the cloth is not finite or far too large";
  if (!is_usable(state.body) || !is_usable(state.body_previous) || !is_usable(state.body_target))
    return "a position of the body is not finite or far too large";
  return {};
}

// Drops pairs with omitted vertices, and lists the body vertices of the others, each once.
std::vector<int> active_vertices(const GraphScene& scene, GraphReport& report) {
  report.omitted_body_pairs = static_cast<int>(std::erase_if(report.body_pairs, [&](const BodyPair& pair) {
    return scene.body_types[static_cast<std::size_t>(pair.vertex)] == omitted_body_vertex;
  }));
  std::vector<char> has_edge(scene.body_types.size(), 0);
  for (const BodyPair& pair : report.body_pairs) has_edge[static_cast<std::size_t>(pair.vertex)] = 1;
  std::vector<int> vertices;
  for (std::size_t v = 0; v < has_edge.size(); ++v)
    if (has_edge[v]) vertices.push_back(static_cast<int>(v));
  return vertices;
}

void keep_within(const FeatureOptions& options, std::size_t queries, std::vector<ClothPair>& pairs,
                 GraphReport& report) {
  const auto most = static_cast<std::size_t>(std::max(options.cloth_pairs_per_vertex, 0)) * queries;
  report.cloth_pairs_beyond += keep_nearest_pairs(pairs, most);
}

// The vertices that have a triangle. Others, such as those of cut-out parts, get no pair.
std::vector<int> on_cloth(const Surface& cloth, std::vector<int> vertices) {
  std::erase_if(vertices, [&](int v) { return cloth.triangles_of(v).empty(); });
  return vertices;
}

// Pairs of pinned vertices with the cloth, all moved by their velocity.
std::vector<ClothPair> future_pairs(const GraphScene& scene, const RestGraph& rest, const GraphState& state,
                                    const SeenPositions& seen, const FeatureOptions& options, ClothSearch& search) {
  if (!options.future_pinned || rest.pinned.empty()) return {};
  const Points x = seen.mesh + state.velocity;
  std::vector<ClothPair> pairs =
      find_cloth_pairs(scene.cloth, x, on_cloth(scene.cloth, rest.pinned), options.cloth_radius, search);
  for (ClothPair& pair : pairs) pair.label = 1;
  return pairs;
}

void find_classes(const GraphScene& scene, const RestGraph& rest, const GraphState& state, const SeenPositions& seen,
                  const FeatureOptions& options, GraphSearch& search, GraphReport& report) {
  if (!options.cloth_edges || state.no_cloth_edges) return;
  std::vector<int> all(static_cast<std::size_t>(scene.cloth.vertex_count));
  for (std::size_t v = 0; v < all.size(); ++v) all[v] = static_cast<int>(v);
  std::vector<ClothPair> pairs =
      find_cloth_pairs(scene.cloth, seen.x, on_cloth(scene.cloth, all), options.cloth_radius, search.cloth);
  keep_within(options, all.size(), pairs, report);
  std::vector<ClothPair> future = future_pairs(scene, rest, state, seen, options, search.future);
  keep_within(options, rest.pinned.size(), future, report);
  pairs.insert(pairs.end(), future.begin(), future.end());
  if (options.contours == ContourRule::all_repel) {
    report.cloth_pairs.repulsion = std::move(pairs);
    return;
  }
  const SheetView cloth = refreshed_sheet(scene.cloth, seen.x, search.cloth);
  const Segments segments = find_segments(std::span(&cloth, 1));
  report.cloth_pairs =
      classify_pairs(pairs, cloth, segments, find_contours(std::span(&cloth, 1), segments), options.contours);
  if (!options.attraction_edges) report.cloth_pairs.attraction.clear();
}

PairQuestion question_of(const RestGraph& rest, const GraphState& state, const SeenPositions& seen,
                         const FeatureOptions& options) {
  const bool ahead = options.future_pinned && !rest.pinned.empty();
  return {seen.x, seen.mesh, ahead ? state.velocity : Points(), state.body, state.no_cloth_edges, state.no_space_edges};
}

bool same_rows(const Points& a, const Points& b) { return a.rows() == b.rows() && a == b; }

bool same_question(const PairQuestion& a, const PairQuestion& b) {
  return same_rows(a.x, b.x) && same_rows(a.mesh, b.mesh) && same_rows(a.ahead, b.ahead) && same_rows(a.body, b.body) &&
         a.no_cloth_edges == b.no_cloth_edges && a.no_space_edges == b.no_space_edges;
}

// All pairs, and the body vertices that have one. Those of the last search if nothing that they depend on has changed.
void find_pairs(const GraphScene& scene, const RestGraph& rest, const GraphState& state, const SeenPositions& seen,
                const FeatureOptions& options, GraphSearch& search, GraphReport& report) {
  PairQuestion question = question_of(rest, state, seen, options);
  if (!same_question(question, search.asked)) {
    search.asked = {};  // nothing is known if an exception leaves the search half done
    GraphReport& found = search.found = {};
    const bool with_body = !options.body_key.empty();
    if (with_body || options.body_inputs)
      found.body_pairs = find_body_pairs(scene, options, seen.x, state.body, search.body);
    std::erase_if(found.body_pairs, [&](const BodyPair& pair) { return scene.cloth.triangles_of(pair.cloth).empty(); });
    search.body_vertices = active_vertices(scene, found);
    if (!with_body) search.body_vertices.clear();
    find_classes(scene, rest, state, seen, options, search, found);
    if (options.space_edges && !state.no_space_edges)
      found.space_pairs = find_space_pairs(scene, seen.mesh, options.space, search.space);
    search.asked = std::move(question);
  }
  report = search.found;
}

// Both ways, the second half the reverse of the first; or one way, from the lower to the higher vertex, as released.
void fill_space_edges(const std::vector<SpacePair>& pairs, const GraphScene& scene, const GraphState& state,
                      const SeenPositions& seen, const Points& guess, const FeatureOptions& options, EdgeSet& set) {
  RestEdges edges{set.key, {}, {}, {}, {}};
  const int first = options.space.nearest > 0 || options.mesh_order == MeshOrder::smaller_sends ? 0 : 1;
  for (const bool back : {false, true}) {
    if (back && options.space.nearest > 0) break;
    const int sender = back ? 1 - first : first;
    for (const SpacePair& pair : pairs) {
      edges.senders.push_back(pair[sender]);
      edges.receivers.push_back(pair[1 - sender]);
    }
  }
  fill_rest_columns(scene, options, edges);
  fill_mesh_edges(edges, state, seen, guess, options, set);
}

// The state as it is seen from its heading.
GraphState turned_back(GraphState state) {
  for (Points* rows : {&state.x, &state.previous, &state.target, &state.velocity, &state.body, &state.body_previous,
                       &state.body_target, &state.acceleration, &state.guess, &state.force, &state.elastic,
                       &state.worn_motion, &state.worn_offset})
    *rows *= state.heading;  // each row times the inverse turn
  return state;
}

}  // namespace

void make_raw_graph(const GraphScene& scene, const RestGraph& rest, const GraphState& in_space,
                    const FeatureOptions& options, const FeatureTables& tables, GraphSearch& search, Graph& graph,
                    GraphReport& report) {
  check_sizes(scene, rest, in_space);
  report = {};
  report.refused = complaint(in_space);
  if (!report.refused.empty()) {
    graph = {};
    return;
  }
  const GraphState turned = options.base == OutputBase::carried ? turned_back(in_space) : GraphState();
  const GraphState& state = options.base == OutputBase::carried ? turned : in_space;
  const SeenPositions seen = seen_positions(rest, state, options);
  find_pairs(scene, rest, state, seen, options, search, report);
  graph.body_vertices = search.body_vertices;
  fill_node_rows(scene, rest, state, seen, options, tables, graph);
  const Points guess = guess_of(rest, state, seen, options), inertial = inertial_guess(rest, state, seen, options);
  fill_objective_columns(scene, state, seen, guess, inertial, options, report.body_pairs, graph);

  const std::vector<std::string> keys = edge_set_keys(options);
  graph.edge_sets.resize(keys.size());
  for (std::size_t i = 0; i < keys.size(); ++i) {
    EdgeSet& set = graph.edge_sets[i];
    set.key = keys[i];
    if (set.key == "space_edge")
      fill_space_edges(report.space_pairs.pairs, scene, state, seen, guess, options, set);
    else if (i < rest.sets.size())
      fill_mesh_edges(rest.sets[i], state, seen, guess, options, set);
    else if (!options.body_key.empty() && i == rest.sets.size())
      fill_body_edges(report.body_pairs, graph.body_vertices, state, seen, options, set);
    else
      fill_cloth_edges(keys[i] == "repulsion_edge" ? report.cloth_pairs.repulsion : report.cloth_pairs.attraction,
                       scene, state, seen, options, tables, set);
  }
}

void make_graph(const GraphScene& scene, const RestGraph& rest, const GraphState& state, const FeatureOptions& options,
                const FeatureTables& tables, GraphSearch& search, Graph& graph, GraphReport& report) {
  make_raw_graph(scene, rest, state, options, tables, search, graph, report);
  if (report.refused.empty()) normalise(options, tables, graph);
}

}  // namespace selvedge
