#include "pipeline/tools/garment_errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "collision/contour/segments.hpp"
#include "collision/geometry/error.hpp"
#include "collision/search/intersections.hpp"
#include "collision/search/obstacle.hpp"
#include "pipeline/tools/check_opinion.hpp"

namespace selvedge {
namespace {

constexpr double counts_as_inside = -1e-6;  // [m]
constexpr double millimetres = 1e3;

void check_rows(const Points& points, const Surface& garment, const std::string& what) {
  if (points.rows() != garment.vertex_count)
    throw Error(what + " has " + std::to_string(points.rows()) + " vertices and the garment " +
                    std::to_string(garment.vertex_count),
                "errors of a garment", "compare meshes of the same faces");
  if (!points.allFinite()) throw Error(what + " is not finite", "errors of a garment", "look for what made it");
}

Vec3 from_ring(const Adjacency& ring, const Points& x, int v) {
  const auto neighbours = ring.of(v);
  Vec3 sum = Vec3::Zero();
  for (const int next : neighbours) sum += row(x, next);
  return neighbours.empty() ? Vec3::Zero() : Vec3(row(x, v) - sum / static_cast<double>(neighbours.size()));
}

// A crossing of two triangles has two ends. If both lie on edges of one triangle, a vertex has gone through a face.
// Otherwise edges cross.
void count_kinds(const DistanceField& body, const Surface& garment, const Points& x, GarmentErrors& errors) {
  const std::array<SheetView, 2> sheets{SheetView{&garment, &x}, SheetView{&body.surface(), &body.positions()}};
  const Segments found = find_segments(sheets);
  std::vector<char> of_vertex(static_cast<std::size_t>(garment.triangles.rows())), of_edges = of_vertex;
  for (const Segment& segment : found.segments) {
    if (segment.sheet[1] != 1 || segment.at_vertex()) continue;
    const bool same = found.crossings[segment.end[0]].edge_sheet == found.crossings[segment.end[1]].edge_sheet;
    (same ? of_vertex : of_edges)[segment.triangle[0]] = true;
  }
  errors.vertex_face = static_cast<int>(std::ranges::count(of_vertex, true));
  errors.edge_edge = static_cast<int>(std::ranges::count(of_edges, true));
}

void count_pairs(const DistanceField& body, const Surface& garment, const Points& x, GarmentErrors& errors) {
  IntersectionCache own, theirs;
  auto pairs = intersecting_pairs(garment, x, own, body.surface(), body.positions(), theirs);
  std::ranges::sort(pairs);
  errors.pairs = static_cast<int>(pairs.size());
  const AuditBody solid{&body.surface(), &body.positions()};
  if (obstacle_available()) errors.judges_agree = agrees_on_bodies(garment, x, {&solid, 1}, pairs);
}

// Measures the vertices that were inside before.
void judge_moved(const DistanceField& body, const Surface& garment, const Points& x,
                 const std::vector<SignedDistance>& now, const KnownOfGarment& known, GarmentErrors& errors) {
  if (!known.before) return;
  const std::vector<SignedDistance> then = body.ask(*known.before);
  const Adjacency ring = adjacency_of(garment.vertex_count, garment.edges);
  double laplacian = 0, overshoot = 0;
  int count = 0;
  for (int v = 0; v < garment.vertex_count; ++v) {
    if (!(then[v].value < 0)) continue;
    ++count;
    overshoot += std::max(now[v].value, 0.0);
    if (known.truth) laplacian += (from_ring(ring, x, v) - from_ring(ring, *known.truth, v)).norm();
  }
  if (count == 0) return;
  errors.overshoot = millimetres * overshoot / count;
  if (known.truth) errors.laplacian_error = millimetres * laplacian / count;
}

}  // namespace

GarmentErrors garment_errors(const DistanceField& body, const Surface& garment, const Points& predicted,
                             const KnownOfGarment& known) {
  check_rows(predicted, garment, "the prediction");
  if (known.truth) check_rows(*known.truth, garment, "the truth");
  if (known.before) check_rows(*known.before, garment, "the garment before");
  GarmentErrors errors;
  if (garment.vertex_count == 0) return errors;
  const std::vector<SignedDistance> found = body.ask(predicted);
  int inside = 0;
  for (const SignedDistance& at : found) {
    inside += at.value < counts_as_inside;
    errors.energy += std::pow(std::min(at.value, 0.0), 2);
  }
  errors.vertices_inside = 100.0 * inside / garment.vertex_count;
  if (known.truth) errors.vertex_error = millimetres * (predicted - *known.truth).rowwise().norm().mean();
  count_pairs(body, garment, predicted, errors);
  count_kinds(body, garment, predicted, errors);
  errors.collision_free = errors.pairs == 0 && errors.judges_agree && inside == 0;
  judge_moved(body, garment, predicted, found, known, errors);
  return errors;
}

MeanOverModels mean_over_models(std::span<const double> values) {
  MeanOverModels result;
  result.models = static_cast<int>(values.size());
  if (values.empty()) return result;
  for (const double value : values) result.mean += value;
  result.mean /= result.models;
  if (result.models < 2) return result;
  double squares = 0;
  for (const double value : values) squares += (value - result.mean) * (value - result.mean);
  result.half_width = 1.96 * std::sqrt(squares / (result.models - 1) / result.models);
  return result;
}

std::string errors_text(const GarmentErrors& errors) {
  const auto length = [](const std::optional<double>& mm) {
    return mm ? fmt::format("{:.3f} mm", *mm) : std::string("not known");
  };
  return fmt::format(
      "vertices inside (VFCP)      {:.4f} %\n"
      "collision-free (CFMP)       {}{}\n"
      "pairs that meet             {}\n"
      "triangles crossed, VF / EE  {} / {}\n"
      "penetration energy          {:.3e} m2\n"
      "vertex error (MPVE)         {}\n"
      "Laplacian error             {}\n"
      "mean overshoot              {}\n",
      errors.vertices_inside, errors.collision_free ? "yes" : "no",
      errors.judges_agree ? "" : " (FCL and exact signs differ)", errors.pairs, errors.vertex_face, errors.edge_edge,
      errors.energy, length(errors.vertex_error), length(errors.laplacian_error), length(errors.overshoot));
}

}  // namespace selvedge
