#include "pipeline/formats/mesh_io.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "collision/geometry/counted.hpp"
#include "collision/geometry/error.hpp"
#include "collision/geometry/surface.hpp"
#include "pipeline/formats/mesh_obj.hpp"
#include "pipeline/formats/mesh_ply.hpp"
#include "pipeline/formats/polygon.hpp"
#include "pipeline/host/file_formats.hpp"
#include "pipeline/host/lower_extension.hpp"
#include "pipeline/host/read_file.hpp"
#include "pipeline/host/write_file.hpp"

namespace selvedge {
namespace {

namespace fs = std::filesystem;

void keep_rows(Triangles& triangles, const std::vector<int>& kept) {
  if (triangles.rows() == 0) return;
  Triangles result(static_cast<Eigen::Index>(kept.size()), 3);
  for (std::size_t t = 0; t < kept.size(); ++t) result.row(static_cast<Eigen::Index>(t)) = triangles.row(kept[t]);
  triangles = std::move(result);
}

void note_topology(Mesh& mesh, const std::string& name) {
  const Surface surface = make_surface(static_cast<int>(mesh.x.rows()), mesh.triangles);
  if (surface.nonmanifold_edges > 0)
    mesh.warnings.push_back(
        fmt::format("{}: {} (more than two triangles)", name, counted(surface.nonmanifold_edges, "non-manifold edge")));
  if (surface.isolated_vertices > 0)
    mesh.warnings.push_back(fmt::format("{}: {} (in no triangle)", name,
                                        counted(surface.isolated_vertices, "isolated vertex", "isolated vertices")));
}

}  // namespace

void leave_out_repeated(Mesh& mesh, const std::string& name) {
  std::vector<std::pair<std::array<int, 3>, int>> sorted;
  int degenerate = 0;
  for (int t = 0; t < mesh.triangles.rows(); ++t) {
    std::array<int, 3> corners{mesh.triangles(t, 0), mesh.triangles(t, 1), mesh.triangles(t, 2)};
    std::sort(corners.begin(), corners.end());
    if (corners[0] == corners[1] || corners[1] == corners[2])
      ++degenerate;
    else
      sorted.emplace_back(corners, t);
  }
  std::sort(sorted.begin(), sorted.end());
  std::vector<int> kept;
  for (std::size_t i = 0; i < sorted.size(); ++i)
    if (i == 0 || sorted[i].first != sorted[i - 1].first) kept.push_back(sorted[i].second);
  const std::size_t duplicate = sorted.size() - kept.size();
  std::sort(kept.begin(), kept.end());
  keep_rows(mesh.uv_triangles, kept);
  keep_rows(mesh.triangles, kept);
  if (degenerate > 0)
    mesh.warnings.push_back(fmt::format("{}: {} left out", name, counted(degenerate, "degenerate triangle")));
  if (duplicate > 0)
    mesh.warnings.push_back(
        fmt::format("{}: {} left out", name, counted(static_cast<int>(duplicate), "duplicate triangle")));
}

bool same_triangles(const Triangles& a, const Triangles& b) { return a.rows() == b.rows() && a == b; }

bool same_faces(const Mesh& a, const Mesh& b) {
  if (a.x.rows() != b.x.rows()) return false;
  if (!a.corners.empty() && a.corners == b.corners && a.corner_begin == b.corner_begin) return true;
  return same_triangles(a.triangles, b.triangles);
}

Mesh read_mesh(const fs::path& path) {
  const std::string extension = lower_extension(path), name = path.string();
  if (extension != ".obj" && extension != ".ply")
    throw Error("has an extension that no mesh reader knows", name,
                is_gltf(path) ? "known: .obj, .ply; a rigged body of glTF is read as `body: {model: ..}`"
                              : export_cure(path, ".obj or .ply", "known: .obj, .ply"));
  const std::string text = extension == ".obj" ? read_text_file(path, "mesh") : read_headed_file(path, "mesh");
  if (text.empty()) throw Error("is empty", name, "name a mesh file with vertices and faces");
  Mesh mesh = extension == ".obj" ? parse_obj(text, name) : parse_ply(text, name);
  if (mesh.x.rows() == 0) throw Error("has no vertices", name, "name a mesh file with vertices and faces");
  if (mesh.look.empty() && mesh.corners.size() != 3 * mesh.corner_begin.size())  // polygons
    mesh.look = plain_look(static_cast<std::size_t>(mesh.x.rows()), mesh.corners, mesh.corner_begin);
  if (const int crossed = crossed_quads(mesh.x, mesh.corners, mesh.corner_begin); crossed > 0)
    mesh.warnings.push_back(fmt::format("{}: the edges of {} cross; {} read with the corners in order round it", name,
                                        counted(crossed, "face"), by_number(crossed, "it is", "each is")));
  for (auto& [folder, file] : mesh.material_files) folder = path.parent_path();
  leave_out_repeated(mesh, name);
  if (mesh.triangles.rows() == 0) throw Error("has no faces", name, "name a mesh file with vertices and faces");
  note_topology(mesh, name);
  return mesh;
}

void write_mesh(const fs::path& path, const Points& x, const Triangles& triangles) {
  const std::string extension = lower_extension(path);
  if (extension != ".obj" && extension != ".ply")
    throw Error("has an extension that no mesh writer knows", path.string(), "known: .obj, .ply");
  extension == ".obj" ? write_obj(path, x, triangles) : write_ply(path, x, triangles);
}

void write_moved(const fs::path& from, const fs::path& to, const Points& x, const Mesh& mesh,
                 std::vector<std::string>& warnings) {
  if (lower_extension(from) != ".obj" || lower_extension(to) != ".obj") {
    write_mesh(to, x, mesh.triangles);
    if (mesh.uv.rows() > 0 || !mesh.groups.empty())
      warnings.push_back(to.string() + ": texture coordinates, groups and polygons are not written to this format");
    return;
  }
  const std::string text = read_text_file(from, "mesh");
  write_file(to, moved_obj_text(text, x));
  if (text.find("\nvn ") != std::string::npos)
    warnings.push_back(to.string() + ": the normals (vn) are still those of the input");
}

void write_obj(const fs::path& path, const Points& x, const Triangles& triangles) {
  write_file(path, obj_text(x, triangles));
}

void write_ply(const fs::path& path, const Points& x, const Triangles& triangles) {
  write_file(path, ply_text(x, triangles));
}

}  // namespace selvedge
