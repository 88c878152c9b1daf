#include "pipeline/scene/setup_cloth.hpp"

#include <fmt/format.h>

#include "collision/geometry/counted.hpp"
#include "pipeline/formats/mesh_faults.hpp"
#include "pipeline/formats/mesh_io.hpp"
#include "pipeline/formats/mesh_weld.hpp"
#include "pipeline/host/bounds.hpp"
#include "pipeline/obstacles/setup_mesh.hpp"
#include "pipeline/obstacles/setup_motion.hpp"
#include "pipeline/obstacles/setup_paths.hpp"
#include "pipeline/scene/massless.hpp"
#include "pipeline/scene/materials.hpp"
#include "pipeline/scene/setup_garment.hpp"
#include "pipeline/scene/setup_seams.hpp"
#include "pipeline/scene/setup_selection.hpp"
#include "pipeline/scene/setup_sheet.hpp"
#include "pipeline/scene/setup_start.hpp"

namespace selvedge {
namespace {

// The flat pattern in the texture coordinates. Mirrored triangles are mirrored back, which keeps warp and weft.
std::vector<RestTriangle> pattern(const Config& at, const Mesh& mesh, double unit) {
  const bool whole = mesh.uv_triangles.rows() == mesh.triangles.rows() && mesh.uv_triangles.size() > 0;
  if (!whole || mesh.uv_triangles.minCoeff() < 0)
    at.fail("asks for texture coordinates, which " + std::string(whole ? "some faces" : "the cloth") + " lack",
            "give `vt` for every corner of a face, or rest: initial");
  std::vector<RestTriangle> rest(static_cast<std::size_t>(mesh.triangles.rows()));
  for (Eigen::Index t = 0; t < mesh.triangles.rows(); ++t) {
    RestTriangle& triangle = rest[static_cast<std::size_t>(t)];
    for (int k = 0; k < 3; ++k) triangle.col(k) = unit * mesh.uv.row(mesh.uv_triangles(t, k)).transpose();
    if (area(triangle) < 0) triangle.row(0) *= -1;
  }
  return rest;
}

// Weft of a shape without texture coordinates: up, or away from the viewer where the shape lies flat.
Vec3 weft_axis(const Points& x) {
  const Vec3 extent = (x.colwise().maxCoeff() - x.colwise().minCoeff()).transpose();
  return extent.y() > 1e-3 * extent.maxCoeff() ? Vec3(0, 1, 0) : Vec3(0, 0, -1);
}

void read_rest(const Config& section, const Mesh& made, bool generated, double scale,
               const std::filesystem::path& folder, ClothPart& part) {
  const Config& from = section["from"];
  part.rest_is_flat = section["flat"].flag();
  part.rest = scale * made.x;
  if (from.text() == "uv") {
    part.rest_triangle = pattern(from, made, section["uv_unit"].number());
    return;
  }
  if (from.text() == "mesh") {
    if (!section["file"].given) from.fail("needs a `file`", "name the mesh of the rest shape");
    Mesh rest = read_mesh(existing_path(section["file"], folder));
    if (made.welded.size() == static_cast<std::size_t>(rest.x.rows())) weld_as(made, rest);
    if (!same_faces(rest, made))
      section["file"].fail("has other vertices or faces than the cloth",
                           "the rest shape needs the same numbering as the cloth");
    part.rest = scale * read_unit(section["unit"]) * rest.x;
  } else if (section["file"].given) {
    section["file"].fail("is not used, since `from` is " + from.text(), "write from: mesh, or leave the file out");
  }
  part.rest_triangle = from.text() == "initial" && generated && made.uv.rows() > 0
                           ? pattern(from, made, scale)
                           : flattened(part.rest, made.triangles, weft_axis(part.rest));
}

// Pins that stay with the body.
PinPart following(const std::shared_ptr<const Wearing>& worn, const std::vector<int>& vertices,
                  const std::string& name) {
  return {name, vertices, [worn, vertices](double time) -> Points { return held_at(*worn, vertices, time); }};
}

PinPart read_pin(const Config& section, const ClothPart& part) {
  const std::vector<int> vertices = read_selection(section, part);
  const std::string name = selection_text(section);
  if (const Config& follow = section["follow"]; follow.given) {
    if (!part.worn)
      follow.fail("is given for a cloth that no body wears", "make the cloth a `garment`, or leave it out");
    if (section["motion"].given) section["motion"].fail("is given beside `follow`", "give one of them");
    return following(part.worn, vertices, name);
  }
  const Points start = part.mesh.x(vertices, Eigen::all);
  const Motion motion = read_motion(section["motion"], start);
  const bool keyed = section["motion"].given;
  if (!part.worn) return {name, vertices, [start, motion](double time) { return moved(motion, start, time); }, keyed};
  // A garment that is draped goes with the body until its pins begin to move.
  return {name, vertices,
          [start, motion, before = following(part.worn, vertices, name).at](double time) {
            return time < 0 ? before(time) : moved(motion, start, time);
          },
          keyed};
}

// Pieces that touch in single vertices, or lie edge to edge, fall apart, and their contact takes long.
void warn_of_coincident(const ClothPart& part, std::vector<std::string>& warnings) {
  const int count = coincident_vertices(part.rest);
  if (count == 0) return;
  const Welding seams = weldable(part.rest, part.mesh.triangles);
  const std::string welding =
      fmt::format("`weld: true` under `mesh` joins {}{}, ",
                  seams.joined == count ? by_number(count, "it", "them") : fmt::format("{} of them", seams.joined),
                  seams.layered ? ", if its layers are sewn there" : "");
  warnings.push_back(fmt::format("cloth `{}`: {} where {} and {} not joined to {}; {}`seams` join chosen ones",
                                 part.name, counted(count, "vertex lies", "vertices lie"),
                                 by_number(count, "another does", "others do"), by_number(count, "is", "are"),
                                 by_number(count, "it", "them"), seams.joined > 0 ? welding : ""));
  if (const int layered = coincident_triangles(part.rest, part.mesh.triangles); layered > 0)
    warnings.push_back(fmt::format(
        "cloth `{}`: {} on another; if its mesh is two-sided, delete one of the sides, since both are cloth", part.name,
        counted(layered, "triangle lies", "triangles lie")));
}

void warn_of_faults(const ClothPart& part, std::vector<std::string>& warnings) {
  for (const std::string& fault : mesh_faults(part.mesh.x, part.mesh.triangles))
    warnings.push_back("cloth `" + part.name + "`: " + fault);
}

// A rest shape from another file, or from texture coordinates, may have another unit than the cloth.
void warn_of_other_size(const Config& rest, const ClothPart& part, std::vector<std::string>& warnings) {
  if (!rest.given) return;
  constexpr double most = 4;  // of lengths
  double area_now = 0, area_at_rest = 0;
  for (Eigen::Index t = 0; t < part.mesh.triangles.rows(); ++t) {
    const auto corner = [&](int k) { return row(part.mesh.x, part.mesh.triangles(t, k)); };
    area_now += area(flatten(corner(0), corner(1), corner(2)));
    area_at_rest += area(part.rest_triangle[static_cast<std::size_t>(t)]);
  }
  const double times = std::sqrt(area_at_rest / area_now);
  if (!(times > most || times < 1 / most)) return;
  warnings.push_back(
      fmt::format("cloth `{}`: its rest shape is {:.3g} times as large as the cloth; if that is not "
                  "meant, correct `{}` under `rest`",
                  part.name, times, rest["from"].text() == "uv" ? "uv_unit" : "unit"));
}

// A sheet, placed, or a garment, worn: mesh, rest shape and velocity.
void read_shape(const Config& section, const std::filesystem::path& folder, std::vector<std::string>& warnings,
                ClothPart& part) {
  const bool worn = part.worn != nullptr;
  part.mesh = worn ? rest_mesh(*part.worn) : read_sheet(section, folder);
  const bool of_file = section["mesh"].given || (worn && section["garment"]["file"].given);
  part.sewn = worn && of_file && section["garment"]["weld"].flag() ? part.mesh.look.vertex : part.mesh.welded;
  warnings.insert(warnings.end(), part.mesh.warnings.begin(), part.mesh.warnings.end());
  const Config& placement = worn ? part.worn->by->section : section;
  read_rest(section["rest"], part.mesh, !section["mesh"].given, placement["scale"].number(), folder, part);
  part.mesh.x = worn ? skinned_at(*part.worn, 0) : placed(section, part.mesh.x);
  refuse_far(section, "cloth `" + part.name + "`", part.mesh.x);
  warn_of_other_size(section["rest"], part, warnings);
  if (section["mesh"].given && !section["mesh"]["unit"].given)
    warn_of_extent(section, "cloth `" + part.name + "`", largest_cloth, true, part.mesh.x, part.mesh.triangles,
                   warnings);
  if (!worn) sew(section["seams"], folder, part, warnings);
  if (section["mesh"].given) warn_of_coincident(part, warnings);
  if (of_file) warn_of_faults(part, warnings);
  if (worn) warn_of_seams(section["garment"], "cloth `" + part.name + "`", part.rest, part.mesh.triangles, warnings);
  leave_out_massless(part, warnings);
  if (part.mesh.triangles.rows() == 0)
    section.fail("has no triangle with an area in its rest shape", "repair the mesh, or give another `rest`");
  if (worn && section["start"]["moving"].flag())
    part.velocity = skinned_velocity(*part.worn, 0);
  else
    part.velocity = section["velocity"].vector().transpose().replicate(part.mesh.x.rows(), 1);
}

// Turned about the middle of its box and moved, `times` times over.
Points copied(const Config& copies, const Points& x, int times) {
  if (times == 0) return x;
  const Mat3 turn = rotation_matrix(times * copies["rotate"].vector());
  const Eigen::RowVector3d middle = 0.5 * (x.colwise().minCoeff() + x.colwise().maxCoeff());
  const Eigen::RowVector3d move = times * copies["translate"].vector().transpose();
  return ((x.rowwise() - middle) * turn.transpose()).rowwise() + (middle + move);
}

std::vector<ClothPart> read_copies(const Config& section, const std::filesystem::path& folder,
                                   std::vector<std::string>& warnings, ClothPart part) {
  read_shape(section, folder, warnings, part);
  const Config& copies = section["copies"];
  if (!copies.given) return {part};
  const int count = copies["count"].integer();
  if (const auto vertices = static_cast<std::int64_t>(count) * part.mesh.x.rows(); vertices > most_vertices)
    copies["count"].fail(fmt::format("asks for {} vertices; {} are the most", vertices, most_vertices),
                         "make fewer copies, or coarser ones");
  std::vector<ClothPart> parts(static_cast<std::size_t>(count), part);
  for (std::size_t k = 0; k < parts.size(); ++k) {
    parts[k].name = fmt::format("{}_{}", part.name, k);
    parts[k].mesh.x = copied(copies, part.mesh.x, static_cast<int>(k));
    refuse_far(copies, "cloth `" + parts[k].name + "`", parts[k].mesh.x);
  }
  return parts;
}

// The garments of an outfit are named after themselves.
std::vector<ClothPart> read_worn(const Config& section, const std::filesystem::path& folder, const Performances& bodies,
                                 std::vector<std::string>& warnings, const ClothPart& plain) {
  const bool is_outfit = section["garment"]["outfit"].given;
  std::vector<ClothPart> parts;
  for (auto& worn : read_wearings(section, folder, bodies, warnings)) {
    ClothPart& part = parts.emplace_back(plain);
    if (is_outfit) part.name = (section["name"].given ? plain.name + "_" : "") + worn->garment.name;
    part.worn = worn;
    read_shape(section, folder, warnings, part);
  }
  return parts;
}

// Start and pins of a cloth whose shape is read.
void finish_cloth(const Config& section, std::vector<std::string>& warnings, ClothPart& one) {
  apply_start(section["start"], one, warnings);
  one.first = one.mesh.x;
  for (const Config& pin : section["pins"].items) one.pins.push_back(read_pin(pin, one));
  if (one.worn && !one.worn->garment.pins.empty())
    one.pins.push_back(following(one.worn, one.worn->garment.pins, "of the garment"));
}

}  // namespace

std::vector<RestTriangle> flattened(const Points& x, const Triangles& triangles, const Vec3& weft) {
  std::vector<RestTriangle> rest(static_cast<std::size_t>(triangles.rows()));
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    const Vec3 a = row(x, triangles(t, 0)), b = row(x, triangles(t, 1)), c = row(x, triangles(t, 2));
    RestTriangle& triangle = rest[static_cast<std::size_t>(t)];
    triangle = flatten(a, b, c);
    const Vec3 normal = (b - a).cross(c - a).normalized();
    const Vec3 v_axis = weft - weft.dot(normal) * normal;
    // A triangle square to the weft direction keeps u along its first edge.
    if (!(v_axis.norm() > 1e-6) || (b - a).norm() == 0) continue;
    const Vec3 first = (b - a).normalized(), v = v_axis.normalized();
    const double cosine = v.dot(normal.cross(first)), sine = v.dot(first);
    // Turns the triangle in its plane until v is the second axis; `first` was the u axis.
    triangle = (Eigen::Matrix2d() << cosine, -sine, sine, cosine).finished() * triangle;
  }
  return rest;
}

std::vector<ClothPart> read_cloths(Config& section, const std::string& default_name,
                                   const std::filesystem::path& folder, const Performances& bodies,
                                   std::vector<std::string>& warnings) {
  ClothPart part;
  part.name = section["name"].given ? section["name"].text() : default_name;
  part.material = read_material(section["material"], folder);
  std::vector<ClothPart> parts;
  if (section["garment"].given)
    parts = read_worn(section, folder, bodies, warnings, part);
  else
    parts = read_copies(section, folder, warnings, part);
  for (ClothPart& one : parts) finish_cloth(section, warnings, one);
  return parts;
}

ClothPart worn_cloth(Config& section, const std::string& name, std::shared_ptr<const Wearing> worn,
                     const std::filesystem::path& folder, std::vector<std::string>& warnings) {
  ClothPart part;
  part.name = name;
  part.material = read_material(section["material"], folder);
  part.worn = std::move(worn);
  read_shape(section, folder, warnings, part);
  finish_cloth(section, warnings, part);
  return part;
}

}  // namespace selvedge
