#include "pipeline/exports/obj_objects.hpp"

#include <fmt/format.h>

#include <iterator>

#include "pipeline/exports/export_materials.hpp"
#include "pipeline/exports/moved_normals.hpp"
#include "pipeline/formats/mesh_mtl.hpp"

namespace selvedge {
namespace {

ExportMaterials materials_of(std::span<const AnimatedSurface> surfaces) {
  return export_materials({surfaces.begin(), surfaces.end()});
}

// A text in the making: rows that it has so far, by which the next surface's indices are shifted.
struct ObjText {
  std::string text;
  Eigen::Index vertices = 1, uvs = 1, normals = 1;

  template <class... Values>
  void add(fmt::format_string<Values...> form, Values&&... values) {
    fmt::format_to(std::back_inserter(text), form, std::forward<Values>(values)...);
  }
  void add_points(const char* word, const Points& x) {
    for (const auto& p : x.rowwise()) add("{} {} {} {}\n", word, p[0], p[1], p[2]);
  }
};

void add_triangles(const AnimatedSurface& surface, ObjText& obj) {
  for (const auto& t : surface.triangles.rowwise())
    obj.add("f {} {} {}\n", t[0] + obj.vertices, t[1] + obj.vertices, t[2] + obj.vertices);
}

void add_corner(const Look& look, const NormalSlots& slots, int corner, ObjText& obj) {
  const auto k = static_cast<std::size_t>(corner);
  obj.add(" {}", look.corners[k] + obj.vertices);
  const bool has_uv = !look.corner_uv.empty() && look.corner_uv[k] >= 0;
  if (has_uv) obj.add("/{}", look.corner_uv[k] + obj.uvs);
  if (!slots.of_corner.empty()) obj.add("{}{}", has_uv ? "/" : "//", slots.of_corner[k] + obj.normals);
}

// The lines of parts and materials where they change, and the faces.
void add_faces(const AnimatedSurface& surface, const NormalSlots& slots, const ExportMaterials& materials,
               const std::vector<int>& own_materials, ObjText& obj) {
  const Look& look = surface.look;
  LookPart now{surface.name};
  int material = -1;
  for (int face = 0; face < look.faces(); ++face) {
    const auto f = static_cast<std::size_t>(face);
    const LookPart part = look.parts.empty() ? LookPart{} : look.parts[static_cast<std::size_t>(look.face_part[f])];
    const std::string& object = part.object.empty() ? surface.name : part.object;
    if (object != now.object) obj.add("o {}\n", object);
    if (part.groups != now.groups) obj.add("g {}\n", part.groups.empty() ? "default" : part.groups);
    if (part.smoothing != now.smoothing) obj.add("s {}\n", part.smoothing.empty() ? "off" : part.smoothing);
    now = {object, part.groups, part.smoothing};
    const int its = look.materials.empty() ? -1 : look.face_material[f];
    if (its >= 0 && its != material)
      obj.add("usemtl {}\n",
              materials.all[static_cast<std::size_t>(own_materials[static_cast<std::size_t>(its)])].name);
    if (its < 0 && material >= 0) obj.add("usemtl\n");
    material = its;
    obj.text += 'f';
    for (int k = look.begin_of(face); k < look.end_of(face); ++k) add_corner(look, slots, k, obj);
    obj.text += '\n';
  }
}

void add_surface(const AnimatedSurface& surface, const PointsF& x, const ExportMaterials& materials,
                 const std::vector<int>& own_materials, ObjText& obj) {
  const Look& look = surface.look;
  obj.add_points("v", x.cast<double>());
  const NormalSlots slots = normal_slots(look);
  if (!look.corner_uv.empty())
    for (const auto& uv : look.uv.rowwise()) obj.add("vt {} {}\n", uv[0], uv[1]);
  if (slots.count > 0) obj.add_points("vn", moved_normals(look, slots, x).cast<double>());
  look.empty() ? add_triangles(surface, obj) : add_faces(surface, slots, materials, own_materials, obj);
  obj.vertices += x.rows();
  obj.uvs += look.corner_uv.empty() ? 0 : look.uv.rows();
  obj.normals += slots.count;
}

}  // namespace

std::string objects_text(std::span<const AnimatedSurface> surfaces, std::span<const PointsF> x,
                         const std::string& material_file) {
  const ExportMaterials materials = materials_of(surfaces);
  ObjText obj;
  if (!material_file.empty()) obj.add("mtllib {}\n", material_file);
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    if (surfaces.size() > 1 || !surfaces[s].look.empty()) obj.add("o {}\n", surfaces[s].name);
    add_surface(surfaces[s], x[s], materials, materials.of[s], obj);
  }
  return obj.text;
}

std::string objects_materials(std::span<const AnimatedSurface> surfaces) {
  return mtl_text(materials_of(surfaces).all);
}

}  // namespace selvedge
