#include "pipeline/drapes/drape_table.hpp"

#include <fmt/format.h>

#include <cmath>

#include "collision/distance/edge_pass.hpp"
#include "collision/geometry/stopwatch.hpp"
#include "learned/repulsion/smooth_push.hpp"

namespace selvedge {
namespace {

// Measurements of all drapes, one number per drape.
struct DrapeColumns {
  std::vector<double> vertex_error, inside, free, vertex_face, edge_edge, laplacian, overshoot, energy, pairs, pushed,
      backbone_ms, distance_ms, push_ms, edges_ms, alphas;
  std::vector<std::pair<double, double>> ratio_and_alpha;
};

// Applies the method to one drape and times its parts.
Points apply_method(const CollisionMethod& method, const DrapeModel& model, const DrapeTrainingOptions& options,
                    const DrapeLessons& lessons, DrapeBody& body, EdgePassMemory& edges, Points& before,
                    DrapeColumns& columns) {
  constexpr double milliseconds = 1e3;
  Stopwatch watch;
  before = drape_positions(model.drape, body.sample.drape);
  columns.backbone_ms.push_back(milliseconds * watch.lap());
  const bool by_network = method.by_network || (method.row && method.row->neural_layer);
  double asking = 0;
  const AskDistance plain = by_network ? body.by_network() : body.accurate();
  const AskDistance timed = [&](const Points& at, std::vector<SignedDistance>& found) {
    Stopwatch own;
    plain(at, found);
    asking += own.lap();
  };
  body.faces.clear();
  Repelled made;
  made.x = before;
  DrapeRecipe recipe = recipe_of(method.row ? *method.row : DrapeRow{}, options.layer);
  recipe.repulsion.recheck = options.layer.recheck;
  if (method.row) made = behind_drape(model, body.sample.drape, before, lessons.ring, timed, recipe);
  if (method.after == PostProcessing::naive) {
    recipe.layer = true;
    made = behind_drape({model.drape, {}, {}}, body.sample.drape, before, lessons.ring, timed, recipe);
  } else if (method.after == PostProcessing::smooth) {
    made.x = push_smoothly(before, lessons.ring, timed, {}).x;
  }
  columns.distance_ms.push_back(milliseconds * asking);
  columns.push_ms.push_back(milliseconds * (watch.lap() - asking));
  if (method.edge_pass > 0)
    pass_edges(*body.field, lessons.set->world.surface, {.rounds = method.edge_pass, .count = false}, made.x, {},
               &edges);
  columns.edges_ms.push_back(milliseconds * watch.lap());
  columns.pushed.push_back(static_cast<double>(made.pushed.size()));
  for (const PushedVertex& pushed : made.pushed) columns.alphas.push_back(pushed.alpha);
  if (!by_network || made.pushed.empty()) return made.x;
  const std::vector<SignedDistance> accurate = body.field->ask(before);
  for (const PushedVertex& pushed : made.pushed)
    if (const double f = accurate[static_cast<std::size_t>(pushed.vertex)].value; f < -1e-6)
      columns.ratio_and_alpha.emplace_back(pushed.at.value / f, pushed.alpha);
  return made.x;
}

std::string with_interval(const MeanOverModels& m, int digits) {
  return fmt::format("{:.{}f} +- {:.{}f}", m.mean, digits, m.half_width, digits);
}

}  // namespace

Points method_positions(const CollisionMethod& method, const DrapeModel& model, const DrapeTrainingOptions& options,
                        const DrapeLessons& lessons, DrapeBody& body) {
  EdgePassMemory edges;
  Points before;
  DrapeColumns columns;
  return apply_method(method, model, options, lessons, body, edges, before, columns);
}

DrapeTableRow measure_row(const CollisionMethod& method, const DrapeModel& model, const DrapeTrainingOptions& options,
                          DrapeLessons& lessons) {
  DrapeTableRow row;
  row.name = method.name;
  DrapeColumns columns;
  EdgePassMemory edges;
  for (const std::unique_ptr<DrapeBody>& body : lessons.test) {
    Points before;
    const Points x = apply_method(method, model, options, lessons, *body, edges, before, columns);
    const GarmentErrors errors =
        garment_errors(*body->field, lessons.set->world.surface, x, {&body->sample.drape.truth, &before});
    columns.vertex_error.push_back(*errors.vertex_error);
    columns.inside.push_back(errors.vertices_inside);
    columns.free.push_back(errors.collision_free ? 100 : 0);
    columns.vertex_face.push_back(errors.vertex_face);
    columns.edge_edge.push_back(errors.edge_edge);
    columns.energy.push_back(errors.energy);
    columns.pairs.push_back(errors.pairs);
    if (errors.laplacian_error) columns.laplacian.push_back(*errors.laplacian_error);
    if (errors.overshoot) columns.overshoot.push_back(*errors.overshoot);
    row.judges_differ += !errors.judges_agree;
  }
  row.vertex_error = mean_over_models(columns.vertex_error);
  row.inside = mean_over_models(columns.inside);
  row.free = mean_over_models(columns.free);
  row.vertex_face = mean_over_models(columns.vertex_face);
  row.edge_edge = mean_over_models(columns.edge_edge);
  row.laplacian = mean_over_models(columns.laplacian);
  row.overshoot = mean_over_models(columns.overshoot);
  row.energy = mean_over_models(columns.energy);
  row.pairs = mean_over_models(columns.pairs);
  row.pushed = mean_over_models(columns.pushed);
  row.backbone_ms = mean_over_models(columns.backbone_ms);
  row.distance_ms = mean_over_models(columns.distance_ms);
  row.push_ms = mean_over_models(columns.push_ms);
  row.edges_ms = mean_over_models(columns.edges_ms);
  row.alpha = mean_over_models(columns.alphas).mean;
  for (const double alpha : columns.alphas)
    row.alpha_deviation += std::pow(alpha - row.alpha, 2) / static_cast<double>(columns.alphas.size());
  row.alpha_deviation = std::sqrt(row.alpha_deviation);
  row.error_by_drape = std::move(columns.vertex_error);
  row.inside_by_drape = std::move(columns.inside);
  row.energy_by_drape = std::move(columns.energy);
  row.ratio_and_alpha = std::move(columns.ratio_and_alpha);
  return row;
}

std::string drape_table_text(const std::vector<DrapeTableRow>& rows) {
  std::string text =
      fmt::format("{:<28}{:>16}{:>18}{:>16}{:>9}{:>9}{:>9}{:>16}{:>16}{:>8}{:>7}{:>7}{:>8}{:>8}{:>8}{:>8}\n", "row",
                  "MPVE mm", "VFCP %", "CFMP %", "VF", "EE", "pairs", "Laplacian mm", "overshoot mm", "pushed", "alpha",
                  "dev.", "net ms", "dist ms", "push ms", "edge ms");
  for (const DrapeTableRow& r : rows)
    text += fmt::format(
        "{:<28}{:>16}{:>18}{:>16}{:>9.2f}{:>9.2f}{:>9.2f}{:>16}{:>16}{:>8.1f}{:>7.3f}{:>7.3f}{:>8.2f}{:>8.2f}{:>8.2f}"
        "{:>8.2f}\n",
        r.name, with_interval(r.vertex_error, 3), with_interval(r.inside, 4), with_interval(r.free, 1),
        r.vertex_face.mean, r.edge_edge.mean, r.pairs.mean, with_interval(r.laplacian, 3),
        with_interval(r.overshoot, 3), r.pushed.mean, r.alpha, r.alpha_deviation, r.backbone_ms.mean,
        r.distance_ms.mean, r.push_ms.mean, r.edges_ms.mean);
  return text;
}

std::string drape_table_csv(const std::vector<DrapeTableRow>& rows) {
  std::string csv = "row,models";
  constexpr std::array columns{"mpve_mm",     "vfcp",        "cfmp",         "vf",           "ee",
                               "pairs",       "energy",      "laplacian_mm", "overshoot_mm", "pushed",
                               "backbone_ms", "distance_ms", "push_ms",      "edges_ms"};
  for (const char* name : columns) csv += fmt::format(",{0},{0}_95", name);
  csv += ",alpha,alpha_deviation,judges_differ\n";
  for (const DrapeTableRow& r : rows) {
    csv += fmt::format("\"{}\",{}", r.name, r.vertex_error.models);  // names have commas
    for (const MeanOverModels* m :
         {&r.vertex_error, &r.inside, &r.free, &r.vertex_face, &r.edge_edge, &r.pairs, &r.energy, &r.laplacian,
          &r.overshoot, &r.pushed, &r.backbone_ms, &r.distance_ms, &r.push_ms, &r.edges_ms})
      csv += fmt::format(",{:.6g},{:.4g}", m->mean, m->half_width);
    csv += fmt::format(",{:.4f},{:.4f},{}\n", r.alpha, r.alpha_deviation, r.judges_differ);
  }
  return csv;
}

}  // namespace selvedge
