#include <fmt/format.h>

#include <iterator>

#include "pipeline/exports/export_formats.hpp"
#include "pipeline/exports/usda_look.hpp"
#include "pipeline/host/growing_file.hpp"

namespace selvedge {
namespace {

std::string extent_text(const PointsF& x) {
  const Eigen::RowVector3f low = x.colwise().minCoeff(), high = x.colwise().maxCoeff();
  return fmt::format("[({:.6f}, {:.6f}, {:.6f}), ({:.6f}, {:.6f}, {:.6f})]", low[0], low[1], low[2], high[0], high[1],
                     high[2]);
}

std::string topology_text(const Triangles& triangles) {
  std::string counts, corners;
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    counts += t > 0 ? ", 3" : "3";
    fmt::format_to(std::back_inserter(corners), "{}{}, {}, {}", t > 0 ? ", " : "", triangles(t, 0), triangles(t, 1),
                   triangles(t, 2));
  }
  return "        int[] faceVertexCounts = [" + counts + "]\n        int[] faceVertexIndices = [" + corners + "]\n";
}

// The schemas of a mesh.
std::string schemas_of(const AnimatedSurface& surface) {
  std::string schemas = surface.cloth ? "\"PhysicsDeformableBodyAPI\", \"PhysicsSurfaceDeformableSimAPI\", " : "";
  return schemas + "\"PhysicsCollisionAPI\"" + (surface.look.materials.empty() ? "" : ", \"MaterialBindingAPI\"");
}

std::string prim_head(const AnimatedSurface& surface, const std::string& name) {
  return fmt::format(
      "    def Mesh \"{}\" (\n        prepend apiSchemas = [{}]\n    )\n    {{\n"
      "        uniform token subdivisionScheme = \"none\"\n        uniform bool doubleSided = 1\n"
      "        color3f[] primvars:displayColor = [({:.3f}, {:.3f}, {:.3f})]\n",
      name, schemas_of(surface), surface.colour[0], surface.colour[1], surface.colour[2]);
}

PointsF finite_positions(const AnimatedSurfaces& run, std::size_t number, int frame) {
  const PointsF x = run.frame(frame)[number];
  check_finite(run.surfaces[number], x, frame, "usda");
  return x;
}

void write_still(GrowingFile& file, const PointsF& x) {
  file.write("        point3f[] points = [" + usd_rows(x, 6) + "]\n        float3[] extent = " + extent_text(x) + "\n");
}

void write_samples(GrowingFile& file, const AnimatedSurfaces& run, std::size_t number) {
  std::string extents;
  file.write("        point3f[] points.timeSamples = {\n");
  for (int i = 0; i < run.frame_count; ++i) {
    const PointsF x = finite_positions(run, number, i);
    file.write(fmt::format("            {}: [{}],\n", i, usd_rows(x, 6)));
    extents += fmt::format("            {}: {},\n", i, extent_text(x));
  }
  file.write("        }\n        float3[] extent.timeSamples = {\n" + extents + "        }\n");
}

void write_normals(GrowingFile& file, const AnimatedSurfaces& run, std::size_t number) {
  const Look& look = run.surfaces[number].look;
  const NormalSlots slots = normal_slots(look);
  file.write(usd_normals_text(slots) + "        normal3f[] primvars:normals.timeSamples = {\n");
  for (int i = 0; i < (run.surfaces[number].moving ? run.frame_count : 1); ++i) {
    const PointsF normals = moved_normals(look, slots, finite_positions(run, number, i));
    file.write(fmt::format("            {}: [{}],\n", i, usd_rows(normals, 4)));
  }
  file.write("        }\n");
}

}  // namespace

std::vector<std::filesystem::path> export_usda(const AnimatedSurfaces& run, const ExportRequest& request) {
  const std::filesystem::path path = request.one_file();
  GrowingFile file(path);
  file.write(
      fmt::format("#usda 1.0\n(\n    defaultPrim = \"run\"\n    endTimeCode = {}\n    framesPerSecond = {}\n"
                  "    metersPerUnit = 1\n    startTimeCode = 0\n    timeCodesPerSecond = {}\n    upAxis = \"Y\"\n)\n\n"
                  "def Xform \"run\"\n{{\n",
                  run.frame_count - 1, run.fps, run.fps));
  const ExportMaterials materials = export_materials(run.surfaces);
  const UsdMaterials made = usd_materials(materials);
  file.write(made.text);
  PrimNames names;
  if (!made.text.empty()) names("Looks");
  for (std::size_t s = 0; s < run.surfaces.size(); ++s) {
    const AnimatedSurface& surface = run.surfaces[s];
    std::vector<std::string> own;
    for (const int m : materials.of[s]) own.push_back(made.paths[static_cast<std::size_t>(m)]);
    file.write(prim_head(surface, names(surface.name)));
    file.write(surface.look.empty() ? topology_text(surface.triangles) : usd_look_text(surface.look, own));
    if (!surface.look.corner_normal.empty()) write_normals(file, run, s);
    if (surface.moving)
      write_samples(file, run, s);
    else
      write_still(file, finite_positions(run, s, 0));
    file.write("    }\n");
  }
  file.write("}\n");
  file.keep();
  return {path};
}

}  // namespace selvedge
