#include "pipeline/tools/untangle_mesh.hpp"

#include <fmt/format.h>

#include "collision/audit/audit.hpp"
#include "collision/geometry/error.hpp"
#include "pipeline/config/config_units.hpp"
#include "pipeline/formats/mesh_io.hpp"
#include "pipeline/formats/seam_places.hpp"
#include "pipeline/run/simulate.hpp"
#include "pipeline/shapes/outward_mesh.hpp"
#include "pipeline/tools/check.hpp"

namespace selvedge {
namespace {

struct Body {
  Surface surface;
  Points x;
};

std::vector<Body> read_bodies(const UntangleRequest& request, UntangleReport& report) {
  std::vector<Body> bodies;
  for (const std::filesystem::path& file : request.bodies) {
    Mesh mesh = read_mesh(file);
    report.warnings.insert(report.warnings.end(), mesh.warnings.begin(), mesh.warnings.end());
    const std::size_t said = report.warnings.size();
    turn_outward(file.string(), mesh, report.warnings);
    Surface surface = closed_surface({&mesh.x, 1}, mesh.triangles).surface;
    if (!is_closed(surface) && report.warnings.size() == said)
      report.warnings.push_back(file.string() + ": is open, so that nothing can be inside it");
    bodies.push_back({std::move(surface), std::move(mesh.x)});
  }
  return bodies;
}

Audit audited(const Surface& cloth, const Points& x, const std::vector<Body>& bodies) {
  std::vector<AuditBody> obstacles;
  for (const Body& body : bodies) obstacles.push_back({&body.surface, &body.x});
  return audit(cloth, x, obstacles);
}

void check_layers(const UntangleRequest& request, const Surface& cloth) {
  if (request.layers.empty() || static_cast<int>(request.layers.size()) == cloth.component_count) return;
  throw Error(fmt::format("{} places for {} pieces of cloth", request.layers.size(), cloth.component_count), "--layers",
              "give one number for each connected piece, in the order of their first vertices");
}

void to_metres(double metres, UntangleResult& result) {
  result.length_before *= metres;
  result.length_after *= metres;
  for (Remainder& left : result.left) left.length *= metres;
}

}  // namespace

UntangleReport untangle_mesh(const UntangleRequest& request) {
  const double metres = metres_per_unit(request.unit);
  UntangleReport report;
  const Mesh mesh = read_mesh(request.file);
  report.warnings = mesh.warnings;
  const std::vector<Body> bodies = read_bodies(request, report);
  const Surface cloth = make_surface(static_cast<int>(mesh.x.rows()), mesh.triangles);
  check_layers(request, cloth);
  std::vector<SheetView> obstacles;
  for (const Body& body : bodies) obstacles.push_back({&body.surface, &body.x});

  UntangleOptions options;
  options.layers = request.layers;
  options.iterations = request.iterations;
  options.progress = request.progress;
  const Clock::time_point start = Clock::now();
  report.result = untangle(cloth, mesh.x, obstacles, options);
  report.seconds = seconds_since(start);
  to_metres(metres, report.result);

  const Audit before = audited(cloth, mesh.x, bodies), after = audited(cloth, report.result.x, bodies);
  report.inside_before = before.inside_vertices;
  report.inside_after = after.inside_vertices;
  report.audited_pairs = after.intersecting_pairs();
  report.degenerate_before = count_degenerate(cloth, mesh.x);
  report.degenerate_after = count_degenerate(cloth, report.result.x);
  report.vertices = cloth.vertex_count;
  report.triangles = static_cast<int>(cloth.triangles.rows());
  report.bodies = static_cast<int>(bodies.size());
  report.mean_edge = metres * report.result.mean_edge;
  write_moved(request.file, request.out, report.result.x, mesh, report.warnings);
  return report;
}

bool is_clean(const UntangleReport& report) {
  return report.audited_pairs == 0 && report.result.pairs_after == 0 && report.result.vertex_pairs_after == 0 &&
         report.inside_after == 0;
}

}  // namespace selvedge
