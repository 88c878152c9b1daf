#include "pipeline/tools/push_mesh.hpp"

#include "collision/distance/edge_pass.hpp"
#include "collision/geometry/error.hpp"
#include "collision/geometry/stopwatch.hpp"
#include "learned/repulsion/repulsive_layer.hpp"
#include "learned/repulsion/smooth_push.hpp"
#include "pipeline/formats/mesh_io.hpp"
#include "pipeline/formats/seam_places.hpp"
#include "pipeline/shapes/outward_mesh.hpp"

namespace selvedge {
namespace {

BodyShape shape_named(const std::string& name) {
  if (name == "union") return BodyShape::united;
  if (name == "raw") return BodyShape::raw;
  throw Error("'" + name + "' is not a shape of the body", "--shape", "write union or raw");
}

Mesh read_truth(const PushRequest& request, const Mesh& garment) {
  Mesh truth = read_mesh(*request.truth);
  if (truth.x.rows() != garment.x.rows() || !same_triangles(truth.triangles, garment.triangles))
    throw Error("it has other faces than the garment", request.truth->string(), "give a mesh of the same faces");
  return truth;
}

void push_by_layer(const PushRequest& request, const Adjacency& ring, const AskDistance& ask, Points& x,
                   PushReport& report) {
  RepulsionOptions options;
  options.recheck = request.recheck;
  options.margin = request.margin;
  const AskScale scale = [&](std::span<const int> vertices, std::span<const double>) {
    return constant_scale(vertices, request.alpha);
  };
  Repelled made = repel(x, ring, ask, scale, options);
  x = std::move(made.x);
  report.pushed = static_cast<int>(made.pushed.size());
  report.deep = made.deep;
  report.torn = made.torn;
  report.projected = made.projected;
}

void push_by(const PushRequest& request, const DistanceField& body, const Surface& garment, Points& x,
             PushReport& report) {
  const Adjacency ring = adjacency_of(garment.vertex_count, garment.edges);
  std::vector<int> faces;
  const AskDistance ask = [&](const Points& at, std::vector<SignedDistance>& found) { body.ask(at, faces, found); };
  if (request.method == "layer") {
    push_by_layer(request, ring, ask, x, report);
  } else if (request.method == "smooth") {
    SmoothlyPushed made = push_smoothly(x, ring, ask, {});
    x = std::move(made.x);
    report.pushed = made.penetrating;
  } else if (request.method != "none") {
    throw Error("'" + request.method + "' is not a method", "--method", "write layer, smooth or none");
  }
}

}  // namespace

PushReport push_mesh(const PushRequest& request) {
  PushReport report;
  const Mesh mesh = read_mesh(request.file);
  Mesh solid = read_mesh(request.body);
  for (const Mesh* read : std::initializer_list<const Mesh*>{&mesh, &solid})
    report.warnings.insert(report.warnings.end(), read->warnings.begin(), read->warnings.end());
  turn_outward(request.body.string(), solid, report.warnings);
  const Surface garment = make_surface(static_cast<int>(mesh.x.rows()), mesh.triangles);
  const Surface surface = closed_surface({&solid.x, 1}, solid.triangles).surface;
  const std::optional<Mesh> truth = request.truth ? std::optional(read_truth(request, mesh)) : std::nullopt;
  DistanceField body(surface, shape_named(request.shape));
  body.move_to(solid.x);
  report.vertices = garment.vertex_count;
  report.triangles = static_cast<int>(garment.triangles.rows());
  report.body_triangles = static_cast<int>(surface.triangles.rows());
  report.body_closed = body.is_closed();
  report.body_crosses_itself = body.crosses_itself();

  Stopwatch watch;
  body.ask(mesh.x);
  report.seconds_distance = watch.lap();
  Points x = mesh.x;
  push_by(request, body, garment, x, report);
  report.seconds_push = watch.lap();
  if (request.edge_pass > 0) {
    const EdgePassReport passed = pass_edges(body, garment, {.rounds = request.edge_pass}, x);
    report.edges = passed.edges;
    report.faces = passed.faces;
  }
  report.seconds_edges = watch.lap();
  const KnownOfGarment known{truth ? &truth->x : nullptr, &mesh.x};
  report.before = garment_errors(body, garment, mesh.x, known);
  report.after = garment_errors(body, garment, x, known);
  if (request.out) write_moved(request.file, *request.out, x, mesh, report.warnings);
  return report;
}

}  // namespace selvedge
