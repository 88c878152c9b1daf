#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "pipeline/compare/compare.hpp"
#include "pipeline/compare/compare_plots.hpp"
#include "pipeline/compare/evaluation.hpp"
#include "pipeline/host/html_text.hpp"
#include "pipeline/measures/run_measures.hpp"
#include "pipeline/plots/page_html.hpp"
#include "pipeline/tools/info.hpp"

namespace selvedge {
namespace {

constexpr const char* page_style =
    "body{font:15px/1.45 system-ui,sans-serif;margin:2em auto;max-width:1320px;padding:0 1em;color:#222}"
    "h1{font-size:1.5em}h2{font-size:1.2em;margin-top:2em;border-top:1px solid #ccc;padding-top:.8em}"
    "figure{display:inline-block;margin:0 1em 1em 0;vertical-align:top}figcaption{font-weight:600}"
    "figure p{margin:.2em 0;max-width:620px}"
    ".wide{overflow-x:auto}"
    "table{border-collapse:collapse;font-size:13px;margin:.6em 0}td,th{padding:.15em .55em;text-align:right;"
    "border-bottom:1px solid #eee;white-space:nowrap}th{background:#f6f6f6}td:first-child,th:first-child,.left"
    "{text-align:left}tr.front td{background:#fdeeee}tr.trouble td{color:#a00}pre{background:#f6f6f6;padding:.6em;"
    "overflow-x:auto;font-size:12.5px}.note{color:#555}";

struct PageColumn {
  const char *name, *title;
  double factor;
  const char* format;
};
// What a scene's table shows of RunMeasures, CompareErrors and times; compare.csv has all.
constexpr PageColumn page_columns[]{{"temporal_1", "temporal 1 [mm]", 1000, "{:.3g}"},
                                    {"algebraic_1", "algebraic 1 [mm]", 1000, "{:.3g}"},
                                    {"algebraic_end", "algebraic end [mm]", 1000, "{:.3g}"},
                                    {"l2_mm", "l2_mm", 1, "{:.3g}"},
                                    {"e3d", "e3d", 1, "{:.2g}"},
                                    {"excess", "E - E* [J]", 1, "{:.2g}"},
                                    {"residual", "residual", 1, "{:.3g}"},
                                    {"strain", "strain [%]", 100, "{:.2f}"},
                                    {"strain_99", "p99 [%]", 100, "{:.1f}"},
                                    {"kinetic", "kinetic [J]", 1, "{:.3g}"},
                                    {"pairs_mean", "pairs", 1, "{:.1f}"},
                                    {"body_pairs_mean", "pairs with bodies", 1, "{:.1f}"},
                                    {"pairs_end", "at end", 1, "{:.0f}"},
                                    {"depth", "depth [mm]", 1000, "{:.2f}"},
                                    {"jitter", "jitter [mm]", 1000, "{:.2f}"},
                                    {"high_share", "high share", 1, "{:.3f}"},
                                    {"collision_percent", "collision_percent", 1, "{:.2f}"},
                                    {"collision_free_frames", "collision_free", 1, "{:.0f}"},
                                    {"hood_total", "hood_losses [J]", 1, "{:.3g}"},
                                    {"grad_norm", "grad_norm [N]", 1, "{:.2g}"},
                                    {"static_share", "static_share", 1, "{:.0f}"},
                                    {"proposal_share", "proposals", 1, "{:.2f}"},
                                    {"ms_guard", "guard [ms]", 1, "{:.2f}"},
                                    {"ms_graph", "graph [ms]", 1, "{:.1f}"},
                                    {"ms_network", "network [ms]", 1, "{:.1f}"},
                                    {"ms_solve", "solve [ms]", 1, "{:.1f}"},
                                    {"ms_broad_phase", "search [ms]", 1, "{:.1f}"},
                                    {"ms_ccd", "ccd [ms]", 1, "{:.1f}"},
                                    {"ms_response", "response [ms]", 1, "{:.1f}"},
                                    {"ms_audit", "audit [ms]", 1, "{:.1f}"},
                                    {"ms_body", "body [ms]", 1, "{:.1f}"}};

std::string cell(double value, const char* format) {
  return "<td>" + (std::isfinite(value) ? fmt::format(fmt::runtime(format), value) : std::string()) + "</td>";
}

bool is_there(const CompareRow& row) { return std::isfinite(row.ms); }

// Points are numbered as the rows of the table below the plot.
template <class Error>
std::string numbered_plot(const std::string& title, const std::vector<const CompareRow*>& rows, double floor,
                          const Error& error) {
  std::vector<ComparedPoint> points;
  for (const CompareRow* row : rows) points.push_back({row, std::to_string(points.size() + 1), error(*row)});
  return page_figure(plot_svg(error_plot(title, "RMS [mm]", floor, points)));
}

// Only columns that some row has.
std::string rows_table(const std::vector<const CompareRow*>& rows, bool references) {
  std::vector<const PageColumn*> columns;
  for (const PageColumn& column : page_columns)
    if (std::ranges::any_of(rows, [&](const CompareRow* row) { return row->measures.contains(column.name); }))
      columns.push_back(&column);
  std::string html = "<div class='wide'><table><tr><th></th><th>ms a frame</th>";
  if (references) html += "<th>temporal end [mm]</th><th>ranked</th><th>front</th>";
  for (const PageColumn* column : columns) {
    const std::string meaning = meaning_of(column->name);
    html += fmt::format("<th title='{}'>{}</th>", html_text(meaning.empty() ? column->name : meaning), column->title);
  }
  html += "<th class='left'>trouble</th></tr>";
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const CompareRow& row = *rows[k];
    html += fmt::format("<tr class='{}'><td>{} {}</td>",
                        row.front             ? "front"
                        : row.trouble.empty() ? ""
                                              : "trouble",
                        k + 1, html_text(row.setting));
    if (!is_there(row) && !std::isfinite(row.temporal)) {
      html += fmt::format("<td class='left' colspan='{}'>{}</td></tr>", columns.size() + (references ? 5 : 2),
                          html_text(row.trouble));
      continue;
    }
    html += cell(row.ms, "{:.1f}");
    if (references)
      html += cell(1000 * row.temporal, "{:.3g}") +
              fmt::format("<td>{}</td><td>{}</td>", row.ranked ? "yes" : "", row.front ? "yes" : "");
    for (const PageColumn* column : columns) html += cell(column->factor * row.measure(column->name), column->format);
    html += "<td class='left'>" + html_text(row.trouble) + "</td></tr>";
  }
  return html + "</table></div>\n";
}

double phases_of(const CompareRow& row, std::initializer_list<const char*> names) {
  double sum = 0;
  for (const char* name : names)
    if (row.measures.contains(name)) sum += row.measure(name);
  return sum;
}

// What a proposal of each network costs beside what it may save: the solve and the contact of the first conventional
// row's frame.
std::string break_even(const std::vector<const CompareRow*>& rows) {
  const auto parent =
      std::ranges::find_if(rows, [](const CompareRow* row) { return phases_of(*row, {"ms_solve"}) > 0; });
  if (parent == rows.end()) return "";
  const double solve = phases_of(**parent, {"ms_solve"});
  const double contact = phases_of(**parent, {"ms_broad_phase", "ms_ccd", "ms_response"});
  std::string html;
  for (const CompareRow* row : rows) {
    const double graph = phases_of(*row, {"ms_graph"}), network = phases_of(*row, {"ms_network"});
    if (network == 0 || !row->trouble.empty() || phases_of(*row, {"ms_solve"}) > 0) continue;
    html += fmt::format("<li>{}: graph {:.1f} and network {:.1f} ms against solve {:.1f} and contact {:.1f} ms of {}. ",
                        html_text(row->setting), graph, network, solve, contact, html_text((*parent)->setting));
    const double share = (graph + network) / (solve + contact);
    html += share < 1 ? fmt::format("Proposals that need neither pay if more than {:.0f} % of them are kept.</li>",
                                    100 * share)
                      : "Proposals cannot pay here, even if all of them are kept.</li>";
  }
  return html.empty() ? html : "<p>Break-even:</p><ul>" + html + "</ul>\n";
}

std::string scene_section(const CompareFloor& floor, const CompareResult& result) {
  std::vector<const CompareRow*> rows;
  for (const CompareRow& row : result.rows)
    if (row.scene == floor.scene) rows.push_back(&row);
  std::string html = fmt::format("<h2>{}</h2><p class='note'>{} vertices, {} frames", html_text(floor.scene),
                                 floor.vertices, floor.frames);
  if (floor.states > 0)
    html += fmt::format(
        "; {} common states, {} frames from each, in which the reference moves {:.3g} mm. Floor {:.3g} mm: the larger "
        "of dt/8 against dt/16 ({:.3g}) and of two jittered references ({:.3g}); what lies below is not ranked",
        floor.states, floor.horizon, 1000 * floor.motion, 1000 * floor.floor(), 1000 * floor.steps,
        1000 * floor.jittered);
  html += ".</p>\n";
  if (floor.states > 0) {
    html += numbered_plot(fmt::format("Distance to the temporal reference after {} frames", floor.horizon), rows,
                          1000 * floor.floor(), [](const CompareRow& r) { return 1000 * r.temporal; });
    html += numbered_plot("Distance to the algebraic reference after one frame", rows, 0,
                          [](const CompareRow& r) { return 1000 * r.measure("algebraic_1"); });
  }
  html += rows_table(rows, floor.states > 0) + break_even(rows);
  if (std::filesystem::path view = result.views / (floor.scene + ".html");
      !result.views.empty() && std::filesystem::exists(view))
    html += fmt::format("<p><a href='views/{}.html'>{} side by side</a></p>\n", url_text(floor.scene),
                        html_text(floor.scene));
  return html;
}

// The frames 0, 1, 2 and so on.
std::vector<double> by_frame(std::size_t count) {
  std::vector<double> frames(count);
  std::iota(frames.begin(), frames.end(), 0.0);
  return frames;
}

std::string evaluation_section(const Evaluation& e) {
  std::string html = "<h2>Evaluation</h2><pre>" + html_text(evaluation_text(e)) + "</pre>\n";
  Plot left{fmt::format("Part of the first pairs that is left, mean over {} tangled starts", e.tangled), {"frame"}};
  for (const EvaluatedRow& row : e.rows)
    if (!row.left.empty()) left.curves.push_back({row.row, by_frame(row.left.size()), row.left});
  Plot pairs{"Pairs by frame, " + e.shown, {"frame"}, {"pairs", PlotScale::counts}};
  for (const auto& [row, counts] : e.by_frame)
    pairs.curves.push_back({row, by_frame(counts.size()), std::vector<double>(counts.begin(), counts.end())});
  html += page_figure(plot_svg(left)) + page_figure(plot_svg(pairs));
  html += "<table><tr><th>frames a second</th>";
  for (std::size_t k = 0; k < e.outfits.size(); ++k)
    html += fmt::format("<th>{} ({} nodes)</th>", html_text(e.outfits[k]), e.vertices[k]);
  html += "</tr>";
  for (const auto& [row, of_outfits] : e.speeds) {
    html += "<tr><td>" + html_text(row) + "</td>";
    for (const std::string& outfit : e.outfits) {
      const auto found = std::ranges::find(of_outfits, outfit, [](const auto& pair) { return pair.first; });
      html += cell(found == of_outfits.end() ? unknown : found->second, "{:.1f}");
    }
    html += "</tr>";
  }
  return html + "</table>\n";
}

std::string repulsion_section(const Comparison& comparison, const CompareResult& result) {
  if (comparison.drapes.empty()) return "";
  std::string html = "<h2>Repulsive layer</h2><pre>" + html_text(result.repulsion) + "</pre>\n";
  for (const ComparedDrapes& one : comparison.drapes)
    for (const auto& [file, about] : {std::pair{one.name, "ways to handle collisions (figures 1, 4, 10 to 13)"},
                                      std::pair{one.name + "_scales", "fixed and predicted scales (figure 5)"}})
      if (std::filesystem::exists(result.views / (file + ".html")))
        html += fmt::format("<p><a href='views/{}.html'>{}</a>: {}</p>\n", url_text(file), html_text(file), about);
  return html + result.repulsion_figures;
}

std::string settings_section(const Comparison& comparison) {
  std::string html =
      "<h2>Settings</h2><table><tr><th>row</th><th class='left'>stepper</th><th class='left'>weights</th>"
      "<th class='left'>set</th></tr>";
  for (const CompareSetting& setting : comparison.settings)
    html += fmt::format("<tr><td>{}</td><td class='left'>{}</td><td class='left'>{}</td><td class='left'>{}</td></tr>",
                        html_text(setting.name), html_text(setting.stepper), html_text(setting.weights.filename()),
                        html_text(joined(setting.overrides)));
  return html + "</table>\n";
}

// Rows that a scene could not run, and those that it could not finish, once each.
std::string trouble_section(const CompareResult& result) {
  std::set<std::string> lines;
  for (const CompareRow& row : result.rows)
    if (!row.trouble.empty())
      lines.insert(row.setting + ": " + (is_there(row) ? row.scene + ": " : std::string()) + row.trouble);
  if (lines.empty()) return "";
  std::string html = "<h2>What was left out, and what failed</h2><ul>";
  for (const std::string& line : lines) html += "<li>" + html_text(line) + "</li>";
  return html + "</ul>\n";
}

}  // namespace

std::string compare_page(const Comparison& comparison, const CompareResult& result) {
  std::string html = fmt::format(
      "<!doctype html><html lang='en'><meta charset='utf-8'><title>selvedge compare: {0}</title><style>{1}</style>"
      "<h1>selvedge compare: {0}</h1><p class='note'>{2}. Median wall time a frame, one scene at a time, with graph, "
      "contact and audit. Red dots and the line: the efficient front, of clean rows of which none is faster and not "
      "worse by more than the floor. Open circles: with intersecting pairs or something passed through, on no front. "
      "Crosses: failed. A hybrid row counts where at least 30 % of its frames were made of proposals, and is otherwise "
      "on "
      "no front. Learned rows are shown the scene's material, and hood_losses, E - E* and the residual judge "
      "all rows by the energies that HOOD minimises; docs/comparison.md says how to read this.</p>\n",
      html_text(comparison.file.filename()), page_style,
      result.finished ? "Finished" : "Stopped before its end; the same command goes on");
  if (!comparison.evaluation.baseline.empty())
    html += evaluation_section(evaluated(comparison, result.floors, result.rows));
  html += repulsion_section(comparison, result);
  for (const CompareFloor& floor : result.floors) html += scene_section(floor, result);
  html += trouble_section(result) + settings_section(comparison);
  html += "<h2>Machine and build</h2><pre>" + html_text(info_text()) + "</pre></html>\n";
  return html;
}

}  // namespace selvedge
