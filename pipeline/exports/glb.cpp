#include <algorithm>
#include <cstdint>
#include <cstring>

#include "collision/geometry/error.hpp"
#include "pipeline/exports/export_formats.hpp"
#include "pipeline/exports/glb_look_json.hpp"
#include "pipeline/host/bytes_of.hpp"
#include "pipeline/host/growing_file.hpp"

namespace selvedge {
namespace {

using Level = Eigen::Matrix<int, 1, 3>;
using Levels = Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor>;

constexpr int grid_steps = 65534;
// Component types and what a view is for, by the numbers of the format.
constexpr int unsigned_byte = 5121, signed_short = 5122, unsigned_short = 5123, unsigned_int = 5125, real = 5126;
constexpr int vertex_data = 34962, index_data = 34963;

// The smallest and the largest positions over the run: of the whole surface and of each vertex.
struct Ranges {
  PointsF low, high;
  Eigen::RowVector3d origin = Eigen::RowVector3d::Zero();
  double step = 1;  // [m]
};

Levels levels_of(const Ranges& ranges, const PointsF& x) {
  return ((x.cast<double>().rowwise() - ranges.origin) / ranges.step).array().round().cast<int>();
}

std::vector<Ranges> ranges_of(const AnimatedSurfaces& run) {
  std::vector<Ranges> all(run.surfaces.size());
  for (int i = 0; i < run.frame_count; ++i) {
    const std::vector<PointsF> x = run.frame(i);
    for (std::size_t s = 0; s < all.size(); ++s) {
      check_finite(run.surfaces[s], x[s], i, "glb");
      all[s].low = i == 0 ? x[s] : all[s].low.cwiseMin(x[s]);
      all[s].high = i == 0 ? x[s] : all[s].high.cwiseMax(x[s]);
    }
  }
  for (Ranges& ranges : all) {
    ranges.origin = ranges.low.colwise().minCoeff().cast<double>();
    const double side = (ranges.high.colwise().maxCoeff().cast<double>() - ranges.origin).maxCoeff();
    if (side > 0) ranges.step = side / grid_steps;
  }
  return all;
}

// The binary chunk and the tables of what lies where in it.
struct Chunk {
  std::string bytes;
  Json views = Json::array(), accessors = Json::array();

  void align() { bytes.append((4 - bytes.size() % 4) % 4, '\0'); }
  // What has been appended since `begin` as a view.
  int view(std::size_t begin, const Json& more = Json::object()) {
    views.push_back({{"buffer", 0}, {"byteOffset", begin}, {"byteLength", bytes.size() - begin}});
    views.back().update(more);
    align();
    return static_cast<int>(views.size()) - 1;
  }
  int accessor(const Json& description) {
    accessors.push_back(description);
    return static_cast<int>(accessors.size()) - 1;
  }
  template <class Value>
  void put(Value value) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    bytes.append(raw, sizeof value);
  }
};

int put_corners(Chunk& chunk, const AnimatedSurface& surface, const std::vector<int>& triangles) {
  const std::size_t begin = chunk.bytes.size();
  const bool few = surface.vertex_count < 65535;
  for (const int t : triangles)
    for (const int corner : surface.triangles.row(t))
      few ? chunk.put(static_cast<std::uint16_t>(corner)) : chunk.put(static_cast<std::uint32_t>(corner));
  const int view = chunk.view(begin, {{"target", index_data}});
  return chunk.accessor({{"bufferView", view},
                         {"componentType", few ? unsigned_short : unsigned_int},
                         {"count", 3 * triangles.size()},
                         {"type", "SCALAR"}});
}

// A surface in the making: where its vertices are in the middle of their ways, and what each frame adds to that.
struct Track {
  Levels middle;
  std::string bytes;  // of the middle, then of every frame: x y z and two bytes that bring a vertex to eight
  Json accessors = Json::array();
  PointsF first_normals;             // without rows: there are none
  std::vector<std::string> normals;  // those of frame 0, then what every frame adds to them: three floats a vertex

  // x: the positions in a frame; those of the first call are the mesh's own.
  void put_normals(const Look& look, const SplitVertices& split, const PointsF& x, bool as_target) {
    if (split.slots.count == 0) return;
    const PointsF all = gltf_normals(look, split, x);
    if (normals.empty()) {
      first_normals = all;
      normals.emplace_back(bytes_of(all));
    }
    if (!as_target) return;
    normals.emplace_back(bytes_of(PointsF(all - first_normals)));
  }
  void put(const Levels& values, bool middle_itself) {
    const std::size_t begin = bytes.size();
    for (Eigen::Index i = 0; i < values.rows(); ++i)
      for (int k = 0; k < 4; ++k) {
        const std::uint16_t word = k < 3 ? static_cast<std::uint16_t>(values(i, k)) : 0;
        bytes.append(reinterpret_cast<const char*>(&word), 2);
      }
    const Level low = values.colwise().minCoeff(), high = values.colwise().maxCoeff();
    accessors.push_back({{"byteOffset", begin},
                         {"componentType", middle_itself ? unsigned_short : signed_short},
                         {"count", values.rows()},
                         {"type", "VEC3"},
                         {"min", {low[0], low[1], low[2]}},
                         {"max", {high[0], high[1], high[2]}}});
  }
};

std::vector<Track> tracks_of(const AnimatedSurfaces& run, const std::vector<Ranges>& ranges,
                             const std::vector<SplitVertices>& splits) {
  std::vector<Track> tracks(run.surfaces.size());
  for (std::size_t s = 0; s < tracks.size(); ++s) {
    const Levels low = levels_of(ranges[s], ranges[s].low), high = levels_of(ranges[s], ranges[s].high);
    tracks[s].middle = ((low + high).array() / 2).matrix();
    tracks[s].put(tracks[s].middle, true);
    if (ranges[s].low == ranges[s].high) tracks[s].put_normals(run.surfaces[s].look, splits[s], ranges[s].low, false);
  }
  const bool any_moves = std::ranges::any_of(ranges, [](const Ranges& r) { return r.low != r.high; });
  for (int i = 0; any_moves && i < run.frame_count; ++i) {
    const std::vector<PointsF> x = run.frame(i);
    for (std::size_t s = 0; s < tracks.size(); ++s) {
      if (ranges[s].low == ranges[s].high) continue;
      tracks[s].put(levels_of(ranges[s], x[s]) - tracks[s].middle, false);
      tracks[s].put_normals(run.surfaces[s].look, splits[s], x[s], true);
    }
  }
  return tracks;
}

// Floats of so many rows as an attribute.
int put_floats(Chunk& chunk, std::string_view floats, Eigen::Index rows, const char* type) {
  const std::size_t begin = chunk.bytes.size();
  chunk.bytes += floats;
  const int view = chunk.view(begin, {{"target", vertex_data}});
  return chunk.accessor({{"bufferView", view}, {"componentType", real}, {"count", rows}, {"type", type}});
}

// Texture coordinates, and normals with a target a frame.
void put_look(Chunk& chunk, const Look& look, const SplitVertices& split, Track& track, Json& attributes,
              Json& targets) {
  if (!look.corner_uv.empty()) {
    const auto uv = gltf_uv(look, split);
    attributes["TEXCOORD_0"] = put_floats(chunk, bytes_of(uv), uv.rows(), "VEC2");
  }
  for (std::size_t k = 0; k < track.normals.size(); ++k)
    (k == 0 ? attributes : targets[k - 1])["NORMAL"] =
        put_floats(chunk, track.normals[k], track.first_normals.rows(), "VEC3");
  track.normals = {};
}

// A mesh with a primitive a part and material. material: the number in the file of a material of the look, or of the
// surface's own for -1.
template <class MaterialNumber>
Json mesh_of(Chunk& chunk, const AnimatedSurface& surface, const SplitVertices& split, Track& track,
             const MaterialNumber& material) {
  const std::size_t begin = chunk.bytes.size();
  chunk.bytes += track.bytes;
  track.bytes = {};
  const int view = chunk.view(begin, {{"byteStride", 8}, {"target", vertex_data}});
  std::vector<int> numbers;
  for (Json& description : track.accessors) {
    description["bufferView"] = view;
    numbers.push_back(chunk.accessor(description));
  }
  Json attributes = {{"POSITION", numbers[0]}}, targets = Json::array();
  for (std::size_t k = 1; k < numbers.size(); ++k) targets.push_back({{"POSITION", numbers[k]}});
  put_look(chunk, surface.look, split, track, attributes, targets);
  Json mesh = {{"name", surface.name}};
  if (numbers.size() > 1) {
    Json weights = Json::array({1});
    for (std::size_t k = 2; k < numbers.size(); ++k) weights.push_back(0);
    mesh["weights"] = weights;  // without animation: frame 0
  }
  mesh["primitives"] = Json::array();
  for (const GltfPrimitive& one : primitives_of(surface)) {
    Json primitive = {{"attributes", attributes},
                      {"indices", put_corners(chunk, surface, one.triangles)},
                      {"material", material(one.material)}};
    if (!targets.empty()) primitive["targets"] = targets;
    if (const Json extras = part_extras(surface.look, one.part); !extras.empty()) primitive["extras"] = extras;
    mesh["primitives"].push_back(primitive);
  }
  return mesh;
}

// At the time of frame i the weight of target i is 1 and the others are 0.
Json animation_of(Chunk& chunk, const AnimatedSurfaces& run, const std::vector<int>& nodes) {
  std::size_t begin = chunk.bytes.size();
  for (int i = 0; i < run.frame_count; ++i) chunk.put(static_cast<float>(i / run.fps));
  const int times = chunk.accessor({{"bufferView", chunk.view(begin)},
                                    {"componentType", real},
                                    {"count", run.frame_count},
                                    {"type", "SCALAR"},
                                    {"min", Json::array({0.0})},
                                    {"max", Json::array({static_cast<float>((run.frame_count - 1) / run.fps)})}});
  begin = chunk.bytes.size();
  for (int i = 0; i < run.frame_count; ++i)
    for (int k = 0; k < run.frame_count; ++k) chunk.bytes += i == k ? '\xff' : '\0';
  const int weights = chunk.accessor({{"bufferView", chunk.view(begin)},
                                      {"componentType", unsigned_byte},
                                      {"normalized", true},
                                      {"count", static_cast<std::int64_t>(run.frame_count) * run.frame_count},
                                      {"type", "SCALAR"}});
  Json channels = Json::array();
  for (const int node : nodes) channels.push_back({{"sampler", 0}, {"target", {{"node", node}, {"path", "weights"}}}});
  const Json sampler = {{"input", times}, {"output", weights}, {"interpolation", "LINEAR"}};
  return {{"name", "run"}, {"samplers", Json::array({sampler})}, {"channels", channels}};
}

Json material_of(const AnimatedSurface& surface) {
  const Eigen::Vector3d& c = surface.colour;
  return {{"name", surface.name},
          {"doubleSided", true},
          {"pbrMetallicRoughness",
           {{"baseColorFactor", {c[0], c[1], c[2], 1.0}}, {"metallicFactor", 0.0}, {"roughnessFactor", 0.8}}}};
}

void check_size(const std::filesystem::path& path, const AnimatedSurfaces& run) {
  double bytes = 1.0 * run.frame_count * run.frame_count;
  for (const AnimatedSurface& surface : run.surfaces)
    bytes += (surface.look.corner_normal.empty() ? 8.0 : 20.0) * surface.vertex_count * (run.frame_count + 1) +
             (surface.look.corner_uv.empty() ? 0.0 : 8.0) * surface.vertex_count +
             4.0 * static_cast<double>(surface.triangles.size());
  if (bytes > 4.0e9)
    throw Error("would be larger than the 4 GiB that the format allows", path.string(),
                "export fewer frames or without --obstacles, or to usda, pc2 or mdd");
}

void write_chunks(const std::filesystem::path& path, std::string text, const std::string& bytes) {
  text.append((4 - text.size() % 4) % 4, ' ');
  const auto word = [](std::size_t value) {
    const auto small = static_cast<std::uint32_t>(value);
    return std::string(reinterpret_cast<const char*>(&small), 4);
  };
  GrowingFile file(path);
  file.write("glTF" + word(2) + word(12 + 8 + text.size() + 8 + bytes.size()));
  file.write(word(text.size()) + "JSON" + text);
  file.write(word(bytes.size()) + std::string("BIN\0", 4));
  file.write(bytes);
  file.keep();
}

// A mesh and a node of every surface, and the materials that they have.
struct SurfaceTables {
  Json meshes = Json::array(), nodes = Json::array(), materials = Json::array();
  Json more = Json::object();  // images and textures
  std::vector<int> roots, moving;
};

SurfaceTables put_surfaces(Chunk& chunk, const AnimatedSurfaces& run, const std::vector<Ranges>& ranges,
                           const std::vector<SplitVertices>& splits, std::vector<Track>& tracks) {
  SurfaceTables tables;
  const ExportMaterials looks = export_materials(run.surfaces);
  put_materials(looks, tables.materials, tables.more);
  for (std::size_t s = 0; s < run.surfaces.size(); ++s) {
    const int number = static_cast<int>(s);
    const Eigen::RowVector3d& o = ranges[s].origin;
    if (tracks[s].accessors.size() > 1) tables.moving.push_back(number);
    int by_default = -1;
    const auto material = [&](int of_look) {
      if (of_look >= 0) return looks.of[s][static_cast<std::size_t>(of_look)];
      if (by_default < 0) {
        by_default = static_cast<int>(tables.materials.size());
        tables.materials.push_back(material_of(run.surfaces[s]));
      }
      return by_default;
    };
    tables.meshes.push_back(mesh_of(chunk, run.surfaces[s], splits[s], tracks[s], material));
    tables.nodes.push_back({{"name", run.surfaces[s].name},
                            {"mesh", number},
                            {"translation", {o[0], o[1], o[2]}},
                            {"scale", {ranges[s].step, ranges[s].step, ranges[s].step}}});
    tables.roots.push_back(number);
  }
  return tables;
}

}  // namespace

std::vector<std::filesystem::path> export_glb(const AnimatedSurfaces& given, const ExportRequest& request) {
  const std::filesystem::path path = request.one_file();
  std::vector<SplitVertices> splits;
  const AnimatedSurfaces run = split_vertices(given, splits);
  check_size(path, run);
  const std::vector<Ranges> ranges = ranges_of(run);
  std::vector<Track> tracks = tracks_of(run, ranges, splits);
  Chunk chunk;
  const SurfaceTables tables = put_surfaces(chunk, run, ranges, splits, tracks);
  const Json extensions = Json::array({"KHR_mesh_quantization"}), scene = {{"nodes", tables.roots}};
  Json all = {{"asset", {{"version", "2.0"}, {"generator", "selvedge"}}},
              {"extensionsUsed", extensions},
              {"extensionsRequired", extensions},
              {"scene", 0},
              {"scenes", Json::array({scene})},
              {"nodes", tables.nodes},
              {"meshes", tables.meshes},
              {"materials", tables.materials}};
  all.update(tables.more);
  if (!tables.moving.empty()) all["animations"] = Json::array({animation_of(chunk, run, tables.moving)});
  all["bufferViews"] = chunk.views;
  all["accessors"] = chunk.accessors;
  const Json buffer = {{"byteLength", chunk.bytes.size()}};
  all["buffers"] = Json::array({buffer});
  write_chunks(path, json_line(all), chunk.bytes);
  return {path};
}

}  // namespace selvedge
