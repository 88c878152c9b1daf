#include "pipeline/compare/repulsion_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

namespace selvedge {
namespace {

struct ReportedMethod {
  const char *title, *row;
};
struct ReportedMetric {
  const char* title;
  int digits;
  MeanOverModels DrapeTableRow::*of;
};

constexpr ReportedMetric mpve_metric{"MPVE mm", 2, &DrapeTableRow::vertex_error},
    vfcp_metric{"VFCP %", 3, &DrapeTableRow::inside}, cfmp_metric{"CFMP %", 1, &DrapeTableRow::free},
    vertex_face_metric{"Avg. VF", 1, &DrapeTableRow::vertex_face},
    edge_edge_metric{"Avg. EE", 1, &DrapeTableRow::edge_edge}, pairs_metric{"pairs", 1, &DrapeTableRow::pairs},
    laplacian_metric{"Laplacian mm", 2, &DrapeTableRow::laplacian},
    overshoot_metric{"overshoot mm", 2, &DrapeTableRow::overshoot};

constexpr ReportedMethod compared_methods[]{{"backbone", "backbone"},
                                            {"control (as long, without)", "control"},
                                            {"naive, approx.", "control, naive, approximate"},
                                            {"naive, acc.", "control, naive"},
                                            {"optimisation, approx.", "control, smooth, approximate"},
                                            {"optimisation, acc.", "control, smooth"},
                                            {"collision loss, approx.", "collision_loss_approximate"},
                                            {"collision loss, acc.", "collision_loss"},
                                            {"ReFU, approx.", "approximate"},
                                            {"ReFU, acc.", "learned"},
                                            {"ReFU, hybrid", "hybrid"},
                                            {"neighbours, acc.", "neighbours"}};

const DrapeTableRow* find_row(const MeasuredDrapes& drapes, const std::string& name) {
  const auto found = std::ranges::find(drapes.rows, name, &DrapeTableRow::name);
  return found == drapes.rows.end() ? nullptr : &*found;
}

std::string mean_text(const MeanOverModels& mean, int digits) {
  return fmt::format("{:.{}f} +- {:.{}f}", mean.mean, digits, mean.half_width, digits);
}

using UsedDrapes = std::vector<const MeasuredDrapes*>;

UsedDrapes used_for(const std::vector<MeasuredDrapes>& all, DrapesUse use) {
  UsedDrapes found;
  for (const MeasuredDrapes& one : all)
    if (one.use == use && one.trouble.empty()) found.push_back(&one);
  return found;
}

std::string head_line(std::span<const ReportedMetric> metrics) {
  std::string text = fmt::format("  {:<28}", "");
  for (const ReportedMetric& metric : metrics) text += fmt::format("{:>18}", metric.title);
  return text + "\n";
}

std::string methods_table(const MeasuredDrapes& drapes, std::span<const ReportedMethod> methods,
                          std::span<const ReportedMetric> metrics) {
  std::string text = fmt::format("  {} ({} test models)\n", drapes.name, drapes.test) + head_line(metrics);
  for (const ReportedMethod& method : methods) {
    text += fmt::format("  {:<28}", method.title);
    if (const DrapeTableRow* row = find_row(drapes, method.row))
      for (const ReportedMetric& metric : metrics)
        text += fmt::format("{:>18}", mean_text(row->*metric.of, metric.digits));
    else
      text += fmt::format("  left out: the run has no row `{}`", method.row);
    text += "\n";
  }
  return text;
}

// One block a garment.
std::string garments_table(const std::string& title, const UsedDrapes& all, std::span<const ReportedMethod> methods,
                           std::span<const ReportedMetric> metrics, const std::string& without) {
  std::string text = title + "\n";
  if (all.empty()) text += "  left out: " + without + "\n";
  for (const MeasuredDrapes* one : all) text += methods_table(*one, methods, metrics);
  return text + "\n";
}

std::string trend_text(double value, double from) {
  return from == 0 ? std::string("-") : fmt::format("{:+.1f} %", 100 * (value / from - 1));
}

std::string all_garments_text(const std::vector<MeasuredDrapes>& all) {
  constexpr ReportedMetric metrics[]{mpve_metric, vfcp_metric, cfmp_metric};
  std::string text = "  all garments, weighted by test models; trends over the backbone of the same garments\n";
  text += fmt::format("  {:<28}{:>10}", "", "garments");
  for (const ReportedMetric& metric : metrics) text += fmt::format("{:>18}{:>12}", metric.title, "trend");
  text += "\n";
  for (const ReportedMethod& method : compared_methods) {
    text += fmt::format("  {:<28}", method.title);
    const MeanOverGarments first = mean_over_garments(all, method.row, mpve_metric.of);
    if (first.garments == 0) {
      text += "  left out: no garment that counts has it\n";
      continue;
    }
    text += fmt::format("{:>10}", first.garments);
    for (const ReportedMetric& metric : metrics) {
      const MeanOverGarments mean = mean_over_garments(all, method.row, metric.of);
      text += fmt::format("{:>18}{:>12}", mean_text(mean.value, metric.digits),
                          trend_text(mean.value.mean, mean.backbone.mean));
    }
    text += "\n";
  }
  return text + "\n";
}

std::string data_table(const std::vector<MeasuredDrapes>& all) {
  std::string text = "Table 1: data sets\n" + fmt::format("  {:<28}{:>10}{:>10}{:>10}{:>10}  {}\n", "", "vertices",
                                                          "training", "test", "shapes", "dropped, by reason");
  for (const MeasuredDrapes& one : all) {
    if (!one.trouble.empty()) {
      text += fmt::format("  {:<28}  left out: {}\n", one.name, one.trouble);
      continue;
    }
    text +=
        fmt::format("  {:<28}{:>10}{:>10}{:>10}{:>10} ", one.name, one.vertices, one.training, one.test, one.shapes);
    for (const auto& [reason, count] : one.dropped) text += fmt::format(" {} {};", count, reason);
    text += one.dropped.empty() ? " none\n" : "\n";
  }
  return text + "\n";
}

std::string distances_table(const UsedDrapes& all) {
  std::string text = "Table 4: distances by a network, on the bodies to measure on\n" +
                     fmt::format("  {:<28}{:>14}{:>14}{:>18}{:>14}\n", "", "absolute mm", "relative %",
                                 "within 5 cm mm", "wrong side %");
  for (const MeasuredDrapes* one : all) {
    text += fmt::format("  {:<28}", one->name);
    text += one->distance ? fmt::format("{:>14.2f}{:>14.1f}{:>18.2f}{:>14.1f}\n", 1e3 * one->distance->absolute,
                                        one->distance->relative, 1e3 * one->distance->near, one->distance->wrong_side)
                          : std::string("  left out: no row with distances by a network was trained\n");
  }
  return text + "\n";
}

std::string times_table(const UsedDrapes& all) {
  struct TimedPart {
    const char *title, *row;
    MeanOverModels DrapeTableRow::*of;
  };
  constexpr TimedPart parts[]{{"approx. f", "approximate", &DrapeTableRow::distance_ms},
                              {"acc. f", "learned", &DrapeTableRow::distance_ms},
                              {"layer", "learned", &DrapeTableRow::push_ms},
                              {"backbone", "backbone", &DrapeTableRow::backbone_ms},
                              {"an edge pass", "learned, edges 1", &DrapeTableRow::edges_ms}};
  std::string text = "Table 8: time of the components, ms a model (wall time of this machine as it was)\n" +
                     fmt::format("  {:<28}", "");
  for (const TimedPart& part : parts) text += fmt::format("{:>16}", part.title);
  text += "\n";
  bool lacks = false;
  for (const MeasuredDrapes* one : all) {
    text += fmt::format("  {:<28}", one->name);
    for (const TimedPart& part : parts) {
      const DrapeTableRow* row = find_row(*one, part.row);
      text += fmt::format("{:>16}", row ? mean_text(row->*part.of, 2) : "left out");
      lacks |= !row;
    }
    text += "\n";
  }
  return text + (lacks ? "  left out: the run has no such row\n\n" : "\n");
}

std::string edge_passes_table(const UsedDrapes& all) {
  constexpr ReportedMethod methods[]{{"naive", "control, naive"},
                                     {"fixed scale", "fixed"},
                                     {"learned scale", "learned"},
                                     {"neighbours", "neighbours"}};
  std::string text = "Passes over edges (beyond the paper)\n";
  for (const MeasuredDrapes* one : all) {
    text += "  " + one->name + "\n" +
            fmt::format("  {:<28}{:>16}{:>16}{:>16}{:>14}{:>14}{:>14}{:>16}\n", "", "CFMP %, 0", "1", "3", "pairs, 0",
                        "1", "3", "MPVE mm, 1 - 0");
    for (const ReportedMethod& method : methods) {
      const std::string name = method.row;
      const DrapeTableRow *none = find_row(*one, name), *single = find_row(*one, name + ", edges 1"),
                          *three = find_row(*one, name + ", edges 3");
      text += fmt::format("  {:<28}", method.title);
      if (!none || !single || !three)
        text += fmt::format("  left out: the run has no row `{}`\n", name);
      else
        text += fmt::format("{:>16}{:>16}{:>16}{:>14.1f}{:>14.1f}{:>14.1f}{:>16.3f}\n", mean_text(none->free, 1),
                            mean_text(single->free, 1), mean_text(three->free, 1), none->pairs.mean, single->pairs.mean,
                            three->pairs.mean, single->vertex_error.mean - none->vertex_error.mean);
    }
  }
  return text + "\n";
}

}  // namespace

MeanOverGarments mean_over_garments(const std::vector<MeasuredDrapes>& all, const std::string& row,
                                    MeanOverModels DrapeTableRow::*metric) {
  MeanOverGarments mean;
  const auto add = [](const MeanOverModels& one, double weight, MeanOverModels& sum) {
    sum.mean += weight * one.mean;
    sum.half_width = std::hypot(sum.half_width, weight * one.half_width);
  };
  double total = 0;
  for (const MeasuredDrapes& one : all) {
    const DrapeTableRow *found = find_row(one, row), *backbone = find_row(one, "backbone");
    if (!one.counted || one.use != DrapesUse::garments || !found || !backbone) continue;
    ++mean.garments;
    total += one.test;
    mean.value.models += one.test;
    add(found->*metric, one.test, mean.value);
    add(backbone->*metric, one.test, mean.backbone);
  }
  for (MeanOverModels* sum : {&mean.value, &mean.backbone}) {
    sum->mean /= std::max(total, 1.0);
    sum->half_width /= std::max(total, 1.0);
  }
  return mean;
}

std::string repulsion_tables(const std::vector<MeasuredDrapes>& all) {
  const UsedDrapes garments = used_for(all, DrapesUse::garments);
  const std::string none = "no run of a garment has come to its end";
  constexpr ReportedMetric three[]{mpve_metric, vfcp_metric, cfmp_metric};
  constexpr ReportedMetric kinds[]{mpve_metric,        vfcp_metric,      cfmp_metric,
                                   vertex_face_metric, edge_edge_metric, pairs_metric};
  constexpr ReportedMetric details[]{laplacian_metric, overshoot_metric};
  constexpr ReportedMethod scales[]{{"control", "control"},
                                    {"fixed scale, approx.", "fixed_approximate"},
                                    {"fixed scale, acc.", "fixed"},
                                    {"predicted scale, approx.", "approximate"},
                                    {"predicted scale, acc.", "learned"},
                                    {"predicted scale, hybrid", "hybrid"},
                                    {"neighbours, acc.", "neighbours"}};
  constexpr ReportedMethod graph[]{{"GCNN", "backbone"},
                                   {"ReFU, approx.", "approximate"},
                                   {"ReFU, acc.", "learned"},
                                   {"ReFU, hybrid", "hybrid"},
                                   {"ReFU, acc., one edge pass", "learned, edges 1"}};
  constexpr ReportedMethod shapes[]{
      {"baseline", "control"}, {"ReFU, approx.", "approximate"}, {"ReFU, acc.", "learned"}};
  constexpr ReportedMethod alternatives[]{{"control", "control"},
                                          {"Alt. 1, shared latent", "shared_latent"},
                                          {"Alt. 2, distance alone", "distance_only"},
                                          {"ReFU", "learned"}};
  constexpr ReportedMethod local[]{{"optimisation, approx.", "control, smooth, approximate"},
                                   {"optimisation, acc.", "control, smooth"},
                                   {"ReFU, approx.", "approximate"},
                                   {"ReFU, acc.", "learned"},
                                   {"ReFU, hybrid", "hybrid"},
                                   {"neighbours, acc.", "neighbours"}};
  std::string text = "Repulsive layer: the tables of Tan et al. 2022 in form, on our own data; +- 95 % over models\n\n";
  text += data_table(all);
  text += garments_table("Table 2: fixed and predicted scales", garments, scales, kinds, none);
  text += garments_table("Table 3: ways to handle collisions", garments, compared_methods, three, none);
  if (!garments.empty()) text += all_garments_text(all);
  text += distances_table(garments);
  text +=
      garments_table("Table 5: a graph network, with the layer from scratch", used_for(all, DrapesUse::graph_network),
                     graph, three, "no run of a graph network has come to its end");
  text += garments_table("Table 6: few and many shapes, unseen clips", used_for(all, DrapesUse::clips), shapes, three,
                         "no run of drapes along clips has come to its end");
  text += garments_table("Table 7: networks of the scale", garments, alternatives, three, none);
  text += times_table(garments);
  text += garments_table("Table 9: local Laplacian error where vertices were inside", garments, local, details, none);
  return text + edge_passes_table(garments);
}

}  // namespace selvedge
