#include "pipeline/weights/parity_dump.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "collision/geometry/error.hpp"
#include "learned/graph/coarse_levels.hpp"

namespace selvedge {
namespace {

const char* const dump_cure = "docs/weights.md says what such a file holds and how it is made";

[[noreturn]] void refuse_array(const Npz& file, const std::string& name, const std::string& what) {
  throw Error(what, file.place(name).text(), dump_cure);
}

Points dumped_points(const Npz& file, const std::string& name, Eigen::Index rows) {
  const NpyArray<double> array = file.numbers(name);
  if (array.shape.size() != 2 || array.shape[1] != 3 || (rows >= 0 && array.shape[0] != rows))
    refuse_array(file, name,
                 fmt::format("has the shape [{}] instead of [{}, 3]", fmt::join(array.shape, ", "),
                             rows >= 0 ? std::to_string(rows) : "vertices"));
  return Eigen::Map<const Points>(array.values.data(), array.shape[0], 3);
}

double dumped_number(const Npz& file, const std::string& name) {
  const NpyArray<double> array = file.numbers(name);
  if (array.values.size() != 1) refuse_array(file, name, fmt::format("has {} numbers, not 1", array.values.size()));
  return array.values[0];
}

std::vector<int> dumped_indices(const Npz& file, const std::string& name, std::int64_t below) {
  std::vector<int> indices;
  for (const std::int64_t index : file.integers(name).values) {
    if (index < 0 || index >= below)
      refuse_array(file, name, fmt::format("has {}, which is not in 0 to {}", index, below - 1));
    indices.push_back(static_cast<int>(index));
  }
  return indices;
}

std::vector<int> dumped_types(const Npz& file, const std::string& name, Eigen::Index count) {
  std::vector<int> types = dumped_indices(file, name, 4);
  if (static_cast<Eigen::Index>(types.size()) != count)
    refuse_array(file, name, fmt::format("has {} values for {} vertices", types.size(), count));
  return types;
}

Surface dumped_surface(const Npz& file, const std::string& name, Eigen::Index vertices) {
  const std::vector<int> corners = dumped_indices(file, name, vertices);
  if (corners.size() % 3 != 0) refuse_array(file, name, "has no rows of three");
  for (std::size_t c = 0; c < corners.size(); c += 3)
    if (corners[c] == corners[c + 1] || corners[c] == corners[c + 2] || corners[c + 1] == corners[c + 2])
      refuse_array(file, name, fmt::format("has a face with one corner twice, number {}", c / 3));
  return make_surface(static_cast<int>(vertices),
                      Eigen::Map<const Triangles>(corners.data(), static_cast<Eigen::Index>(corners.size() / 3), 3));
}

void read_cloth(ParityDump& dump) {
  const Npz& file = dump.file;
  GraphState& state = dump.state;
  GraphScene& scene = dump.scene;
  state.x = dumped_points(file, "cloth_pos", -1);
  const Eigen::Index vertices = state.x.rows();
  state.previous = dumped_points(file, "cloth_prev_pos", vertices);
  state.target = dumped_points(file, "cloth_target_pos", vertices);
  state.velocity = dumped_points(file, "cloth_velocity", vertices);
  state.timestep = dumped_number(file, "timestep");
  state.is_init = file.has("is_init") && dumped_number(file, "is_init") != 0;
  state.no_cloth_edges =
      file.has("world_edges") ? dumped_number(file, "world_edges") == 0 : state.is_init && !file.has("proximity_pair");
  scene.cloth = dumped_surface(file, "cloth_faces", vertices);
  scene.rest = dumped_points(file, "cloth_rest_pos", vertices);
  scene.mass = file.numbers("cloth_mass").values;
  scene.types = dumped_types(file, "cloth_vertex_type", vertices);
  scene.materials.resize(vertices, 3);
  int column = 0;
  for (const char* name : {"bending_coeff_input", "lame_mu_input", "lame_lambda_input"})
    scene.materials.col(column++).setConstant(static_cast<float>(dumped_number(file, name)));
}

void read_body(ParityDump& dump) {
  const Npz& file = dump.file;
  GraphState& state = dump.state;
  const bool has_body = file.has("body_pos");
  state.body = has_body ? dumped_points(file, "body_pos", -1) : Points(0, 3);
  const Eigen::Index vertices = state.body.rows();
  state.body_previous = has_body ? dumped_points(file, "body_prev_pos", vertices) : Points(0, 3);
  state.body_target = has_body ? dumped_points(file, "body_target_pos", vertices) : Points(0, 3);
  dump.scene.body = has_body ? dumped_surface(file, "body_faces", vertices) : make_surface(0, Triangles(0, 3));
  if (has_body) dump.scene.body_types = dumped_types(file, "body_vertex_type", vertices);
}

using EdgePair = std::pair<int, int>;

// The recorded coarse edges, each once with the smaller vertex first, sorted.
std::vector<EdgePair> recorded_level(const Npz& file, int level, Eigen::Index vertices) {
  const std::string name = fmt::format("coarse{}_edge_index", level);
  if (!file.has(name)) return {};
  const std::vector<int> flat = dumped_indices(file, name, vertices);
  std::vector<EdgePair> edges;
  for (std::size_t e = 0; e < flat.size() / 2; ++e) edges.emplace_back(std::minmax(flat[e], flat[flat.size() / 2 + e]));
  std::ranges::sort(edges);
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

// Whether the edges in one component of the cloth are the same.
bool follow_from(const std::vector<std::vector<EdgePair>>& recorded, const CoarseLevels& ours,
                 const std::vector<int>& components, int component) {
  for (std::size_t level = 0; level < recorded.size(); ++level) {
    std::vector<EdgePair> theirs, mine;
    for (const EdgePair& edge : recorded[level])
      if (components[static_cast<std::size_t>(edge.first)] == component) theirs.push_back(edge);
    for (const auto& edge : ours.levels[level].rowwise())
      if (components[static_cast<std::size_t>(edge[0])] == component) mine.emplace_back(edge[0], edge[1]);
    if (theirs != mine) return false;
  }
  return true;
}

// The authors take one of several centres, and their samples record only the edges. A centre has depth 0, so it is in
// every level of its component; few vertices are.
std::vector<int> centres_of(const ParityDump& dump, int levels) {
  const Surface& cloth = dump.scene.cloth;
  std::vector<std::vector<EdgePair>> recorded;
  std::vector<int> deepest(static_cast<std::size_t>(cloth.vertex_count), 0);
  for (int level = 0; level < levels; ++level) {
    recorded.push_back(recorded_level(dump.file, level, cloth.vertex_count));
    for (const auto& [a, b] : recorded.back())
      deepest[static_cast<std::size_t>(a)] = deepest[static_cast<std::size_t>(b)] = level + 1;
  }
  std::vector<int> centres;
  for (int component = 0; component < cloth.component_count; ++component) {
    std::vector<int> candidates;
    int most = 1, centre = -1;
    for (int v = 0; v < cloth.vertex_count; ++v) {
      const int level = deepest[static_cast<std::size_t>(v)];
      if (cloth.component[static_cast<std::size_t>(v)] != component || level < most) continue;
      if (level > most) candidates.clear();
      most = level;
      candidates.push_back(v);
    }
    for (const int& candidate : candidates)
      if (centre < 0 && follow_from(recorded, make_coarse_levels(cloth, levels, std::span(&candidate, 1)),
                                    cloth.component, component))
        centre = candidate;
    if (centre < 0 && !candidates.empty())
      refuse_array(dump.file, "coarse0_edge_index",
                   fmt::format("follows from no centre in the piece of vertex {}", candidates.front()));
    if (centre >= 0) centres.push_back(centre);
  }
  return centres;
}

}  // namespace

ParityDump read_parity_dump(const std::filesystem::path& path, const Architecture& architecture) {
  ParityDump dump{Npz(path), {}, {}, {}, false};
  dump.gathered = dump.file.has("after_node_normalizer_acc_sum");
  read_cloth(dump);
  read_body(dump);
  dump.centres = centres_of(dump, architecture.features.coarse_levels);
  return dump;
}

}  // namespace selvedge
