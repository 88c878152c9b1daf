#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>

#include "pipeline/exports/glb_look_json.hpp"

namespace selvedge {
namespace {

using OrderedJson = Json;

// Parts the vertices of one surface, whose triangles become those of parted vertices.
SplitVertices part_vertices(AnimatedSurface& surface) {
  const Look& look = surface.look;
  SplitVertices split;
  split.slots = normal_slots(look);
  split.own.resize(static_cast<std::size_t>(surface.vertex_count));
  for (int v = 0; v < surface.vertex_count; ++v) split.own[static_cast<std::size_t>(v)] = v;
  split.uv.assign(split.own.size(), -1);
  split.normal.assign(split.own.size(), -1);
  std::vector<char> used(split.own.size(), 0);
  std::map<std::array<int, 3>, int> known;
  const auto parted = [&](int corner) {
    const auto k = static_cast<std::size_t>(corner);
    const int vertex = look.corners[k], uv = look.corner_uv.empty() ? -1 : look.corner_uv[k];
    const int normal = split.slots.of_corner.empty() ? -1 : split.slots.of_corner[k];
    const auto [entry, fresh] = known.emplace(std::array{vertex, uv, normal}, vertex);
    if (!fresh) return entry->second;
    if (used[static_cast<std::size_t>(vertex)]) {
      entry->second = static_cast<int>(split.own.size());
      split.own.push_back(vertex);
      split.uv.push_back(uv);
      split.normal.push_back(normal);
    } else {
      used[static_cast<std::size_t>(vertex)] = 1;
      split.uv[static_cast<std::size_t>(vertex)] = uv;
      split.normal[static_cast<std::size_t>(vertex)] = normal;
    }
    return entry->second;
  };
  for (Eigen::Index i = 0; i < surface.cut.size(); ++i) surface.triangles.data()[i] = parted(surface.cut.data()[i]);
  surface.vertex_count = static_cast<int>(split.own.size());
  return split;
}

// As a URI has it: other bytes than letters, digits, and those that may stand in a path, as %XX.
std::string uri_of(const std::string& file) {
  std::string uri;
  for (const char c : file) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) || std::string_view("-._~/").find(c) != std::string_view::npos)
      uri += c;
    else
      uri += fmt::format("%{:02X}", byte);
  }
  return uri;
}

}  // namespace

AnimatedSurfaces split_vertices(const AnimatedSurfaces& run, std::vector<SplitVertices>& splits) {
  AnimatedSurfaces parted = run;
  for (AnimatedSurface& surface : parted.surfaces)
    splits.push_back(surface.look.empty() ? SplitVertices{} : part_vertices(surface));
  parted.frame = [&run, &splits](int index) {
    std::vector<PointsF> x = run.frame(index);
    for (std::size_t s = 0; s < x.size(); ++s)
      if (!splits[s].own.empty()) x[s] = x[s](splits[s].own, Eigen::all).eval();
    return x;
  };
  return parted;
}

Eigen::Matrix<float, Eigen::Dynamic, 2, Eigen::RowMajor> gltf_uv(const Look& look, const SplitVertices& split) {
  Eigen::Matrix<float, Eigen::Dynamic, 2, Eigen::RowMajor> uv(std::ssize(split.own), 2);
  for (Eigen::Index i = 0; i < uv.rows(); ++i) {
    const int row = split.uv[static_cast<std::size_t>(i)];
    const Eigen::RowVector2d own = row < 0 ? Eigen::RowVector2d(0, 0) : look.uv.row(row);
    uv.row(i) << static_cast<float>(own[0]), static_cast<float>(1 - own[1]);
  }
  return uv;
}

PointsF gltf_normals(const Look& look, const SplitVertices& split, const PointsF& x) {
  const PointsF moved = moved_normals(look, split.slots, x);  // its corners are among the surface's own vertices
  PointsF normals(x.rows(), 3);
  for (Eigen::Index i = 0; i < normals.rows(); ++i) {
    const int slot = split.normal[static_cast<std::size_t>(i)];
    normals.row(i) = slot < 0 ? Eigen::RowVector3f(0, 1, 0) : moved.row(slot);
  }
  return normals;
}

std::vector<GltfPrimitive> primitives_of(const AnimatedSurface& surface) {
  const Look& look = surface.look;
  std::vector<GltfPrimitive> primitives;
  for (Eigen::Index t = 0; t < surface.triangles.rows(); ++t) {
    int part = -1, material = -1;
    if (!look.empty()) {
      const auto face = std::ranges::upper_bound(look.begin, surface.cut(t, 0)) - look.begin.begin() - 1;
      if (!look.face_part.empty()) part = look.face_part[static_cast<std::size_t>(face)];
      if (!look.face_material.empty()) material = look.face_material[static_cast<std::size_t>(face)];
    }
    const auto same = [&](const GltfPrimitive& one) { return one.part == part && one.material == material; };
    auto known = std::ranges::find_if(primitives, same);
    if (known == primitives.end()) known = primitives.insert(primitives.end(), {part, material, {}});
    known->triangles.push_back(static_cast<int>(t));
  }
  return primitives;
}

void put_materials(const ExportMaterials& given, OrderedJson& materials, OrderedJson& all) {
  for (const LookMaterial& material : given.all) {
    const Vec3 c = material.colour.value_or(Vec3::Constant(material.texture.empty() ? 0.7 : 1));
    OrderedJson shading = {
        {"baseColorFactor", {c[0], c[1], c[2], 1.0}}, {"metallicFactor", 0.0}, {"roughnessFactor", 0.8}};
    if (!material.texture.empty()) {
      const std::size_t number = all.contains("images") ? all["images"].size() : 0;
      all["images"].push_back({{"uri", uri_of(material.texture)}});
      all["textures"].push_back({{"source", number}});
      shading["baseColorTexture"] = {{"index", number}};
    }
    materials.push_back({{"name", material.name}, {"doubleSided", true}, {"pbrMetallicRoughness", shading}});
  }
}

OrderedJson part_extras(const Look& look, int part) {
  OrderedJson extras = OrderedJson::object();
  if (part < 0) return extras;
  const LookPart& named = look.parts[static_cast<std::size_t>(part)];
  if (!named.object.empty()) extras["object"] = named.object;
  if (!named.groups.empty()) extras["groups"] = named.groups;
  return extras;
}

}  // namespace selvedge
