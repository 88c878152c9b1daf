#include "pipeline/exports/obj_objects.hpp"

#include <fmt/format.h>

#include <iterator>
#include <set>

#include "pipeline/exports/export_materials.hpp"
#include "pipeline/formats/mesh_mtl.hpp"

namespace selvedge {
namespace {

// A text in the making: rows that it has so far, by which the next surface's indices are shifted, and the lines that
// hold for the next face.
struct ObjText {
  std::string text;
  Eigen::Index vertices = 1, uvs = 1, normals = 1;
  LookPart part;
  std::string material;
  std::string no_material = "default";  // of faces without: OBJ has no word that ends a material

  template <class... Values>
  void add(fmt::format_string<Values...> form, Values&&... values) {
    fmt::format_to(std::back_inserter(text), form, std::forward<Values>(values)...);
  }
  void add_points(const char* word, const Points& x) {
    for (const auto& p : x.rowwise()) add("{} {} {} {}\n", word, p[0], p[1], p[2]);
  }
  // Nor has it a word that ends a group, but the name `default` for what is in no other.
  void begin_face(const LookPart& its, const std::string& its_material) {
    if (its.object != part.object) add("o {}\n", its.object);
    if (its.groups != part.groups) add("g {}\n", its.groups.empty() ? "default" : its.groups);
    if (its.smoothing != part.smoothing) add("s {}\n", its.smoothing.empty() ? "off" : its.smoothing);
    if (its_material != material) add("usemtl {}\n", its_material.empty() ? no_material : its_material);
    part = its;
    material = its_material;
  }
};

// The part of a face as the text names it. An object without a name has the surface's, as has one whose name an earlier
// surface took.
LookPart named_part(const AnimatedSurface& surface, int face, const std::set<std::string>& taken) {
  const Look& look = surface.look;
  LookPart part = look.parts.empty()
                      ? LookPart{}
                      : look.parts[static_cast<std::size_t>(look.face_part[static_cast<std::size_t>(face)])];
  if (part.object.empty() || taken.contains(part.object)) part.object = surface.name;
  return part;
}

void add_triangles(const AnimatedSurface& surface, ObjText& obj) {
  if (!obj.part.object.empty()) obj.begin_face({surface.name}, "");
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

// materials: the names of the look's.
void add_faces(const AnimatedSurface& surface, const NormalSlots& slots, const std::vector<std::string>& materials,
               const std::set<std::string>& taken, ObjText& obj) {
  const Look& look = surface.look;
  for (int face = 0; face < look.faces(); ++face) {
    const int material = look.materials.empty() ? -1 : look.face_material[static_cast<std::size_t>(face)];
    obj.begin_face(named_part(surface, face, taken), material < 0 ? "" : materials[static_cast<std::size_t>(material)]);
    obj.text += 'f';
    for (int k = look.begin_of(face); k < look.end_of(face); ++k) add_corner(look, slots, k, obj);
    obj.text += '\n';
  }
}

void add_surface(const AnimatedSurface& surface, const NormalSlots& slots, const PointsF& x,
                 const std::vector<std::string>& materials, const std::set<std::string>& taken, ObjText& obj) {
  const Look& look = surface.look;
  obj.add_points("v", x.cast<double>());
  if (!look.corner_uv.empty())
    for (const auto& uv : look.uv.rowwise()) obj.add("vt {} {}\n", uv[0], uv[1]);
  if (slots.count > 0) obj.add_points("vn", moved_normals(look, slots, x).cast<double>());
  look.empty() ? add_triangles(surface, obj) : add_faces(surface, slots, materials, taken, obj);
  obj.vertices += x.rows();
  obj.uvs += look.corner_uv.empty() ? 0 : look.uv.rows();
  obj.normals += slots.count;
}

}  // namespace

std::vector<NormalSlots> normal_slots(std::span<const AnimatedSurface> surfaces) {
  std::vector<NormalSlots> slots;
  for (const AnimatedSurface& surface : surfaces) slots.push_back(normal_slots(surface.look));
  return slots;
}

std::string objects_text(std::span<const AnimatedSurface> surfaces, std::span<const NormalSlots> slots,
                         std::span<const PointsF> x, const std::string& material_file) {
  const ExportMaterials materials = export_materials(surfaces);
  ObjText obj;
  obj.no_material = unused_name(obj.no_material, materials.all);
  if (!material_file.empty()) obj.add("mtllib {}\n", material_file);
  std::set<std::string> taken;  // names of objects of earlier surfaces
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    const AnimatedSurface& surface = surfaces[s];
    std::vector<std::string> own;
    for (const int m : materials.of[s]) own.push_back(materials.all[static_cast<std::size_t>(m)].name);
    if (surfaces.size() > 1 || !surface.look.empty()) {
      obj.part.object = surface.look.empty() ? surface.name : named_part(surface, 0, taken).object;
      obj.add("o {}\n", obj.part.object);
    }
    add_surface(surface, slots[s], x[s], own, taken, obj);
    taken.insert(surface.name);
    for (const LookPart& part : surface.look.parts) taken.insert(part.object);
  }
  return obj.text;
}

std::string objects_materials(std::span<const AnimatedSurface> surfaces) {
  return mtl_text(export_materials(surfaces).all);
}

}  // namespace selvedge
