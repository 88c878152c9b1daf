#include <fmt/format.h>

#include <cctype>
#include <iterator>
#include <set>

#include "pipeline/exports/export_formats.hpp"
#include "pipeline/host/growing_file.hpp"

namespace selvedge {
namespace {

// Letters, digits and underscores, none of them twice among the surfaces.
std::vector<std::string> prim_names(const std::vector<AnimatedSurface>& surfaces) {
  std::set<std::string> taken;
  std::vector<std::string> names;
  for (const AnimatedSurface& surface : surfaces) {
    std::string name = surface.name;
    for (char& c : name)
      if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
    if (name.empty() || std::isdigit(static_cast<unsigned char>(name[0]))) name = "_" + name;
    std::string free = name;
    for (int k = 1; !taken.insert(free).second; ++k) free = fmt::format("{}_{}", name, k);
    names.push_back(free);
  }
  return names;
}

void put_usd_points(std::string& text, const PointsF& x) {
  text += '[';
  for (Eigen::Index i = 0; i < x.rows(); ++i)
    fmt::format_to(std::back_inserter(text), "{}({:.6f}, {:.6f}, {:.6f})", i > 0 ? ", " : "", x(i, 0), x(i, 1),
                   x(i, 2));
  text += ']';
}

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

std::string prim_head(const AnimatedSurface& surface, const std::string& name) {
  return fmt::format(
      "    def Mesh \"{}\" (\n        prepend apiSchemas = [{}\"PhysicsCollisionAPI\"]\n    )\n    {{\n"
      "        uniform token subdivisionScheme = \"none\"\n        uniform bool doubleSided = 1\n"
      "        color3f[] primvars:displayColor = [({:.3f}, {:.3f}, {:.3f})]\n",
      name, surface.cloth ? "\"PhysicsDeformableBodyAPI\", \"PhysicsSurfaceDeformableSimAPI\", " : "",
      surface.colour[0], surface.colour[1], surface.colour[2]);
}

PointsF finite_positions(const AnimatedSurfaces& run, std::size_t number, int frame) {
  const PointsF x = run.frame(frame)[number];
  check_finite(run.surfaces[number], x, frame, "usda");
  return x;
}

void write_still(GrowingFile& file, const PointsF& x) {
  std::string text = "        point3f[] points = ";
  put_usd_points(text, x);
  file.write(text + "\n        float3[] extent = " + extent_text(x) + "\n");
}

void write_samples(GrowingFile& file, const AnimatedSurfaces& run, std::size_t number) {
  std::string extents;
  file.write("        point3f[] points.timeSamples = {\n");
  for (int i = 0; i < run.frame_count; ++i) {
    const PointsF x = finite_positions(run, number, i);
    std::string text = fmt::format("            {}: ", i);
    put_usd_points(text, x);
    file.write(text + ",\n");
    extents += fmt::format("            {}: {},\n", i, extent_text(x));
  }
  file.write("        }\n        float3[] extent.timeSamples = {\n" + extents + "        }\n");
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
  const std::vector<std::string> names = prim_names(run.surfaces);
  for (std::size_t s = 0; s < run.surfaces.size(); ++s) {
    file.write(prim_head(run.surfaces[s], names[s]) + topology_text(run.surfaces[s].triangles));
    if (run.surfaces[s].moving)
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
