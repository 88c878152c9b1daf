#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pipeline/compare/evaluation.hpp"
#include "pipeline/host/numbers_json.hpp"

namespace selvedge {
namespace {

std::string shown(double value, const char* format = "{:.1f}") {
  return std::isfinite(value) ? fmt::format(fmt::runtime(format), value) : "-";
}

// Of the column of names: all are whole, so that the others stand below each other.
std::size_t name_width(const Evaluation& e) {
  std::size_t width = 18;
  for (const EvaluatedRow& row : e.rows) width = std::max(width, row.row.size());
  return width;
}

std::string ratio_text(const PairedRatio& r, std::size_t width) {
  return fmt::format("  {:<{}} over {:<{}} {:>7} [{}, {}] of {} sequences{}\n", r.row, width, r.baseline, width,
                     shown(r.ratio, "{:.3g}"), shown(r.low, "{:.3g}"), shown(r.high, "{:.3g}"), r.sequences,
                     r.apart() ? ", apart" : "");
}

// Strains tell of garments that a network has never seen; the outfits of the validation split are of such.
std::string strain_by_outfit(const Evaluation& e) {
  const std::size_t width = name_width(e);
  std::string text = "principal strain by outfit, mean % (99th percentile %)\n  " + std::string(width, ' ');
  for (const std::string& outfit : e.outfits) text += fmt::format(" {:>14}", outfit);
  text += "\n";
  for (const EvaluatedRow& row : e.rows) {
    if (row.sequences == 0) continue;
    text += fmt::format("  {:<{}}", row.row, width);
    for (std::size_t k = 0; k < e.outfits.size(); ++k)
      text += fmt::format(" {:>14}", fmt::format("{} ({})", shown(100 * row.strain_of_outfit[k], "{:.2f}"),
                                                 shown(100 * row.strain_99_of_outfit[k])));
    text += "\n";
  }
  return text;
}

}  // namespace

std::string evaluation_text(const Evaluation& e) {
  const std::size_t width = name_width(e);
  std::string text =
      "evaluation: intersecting pairs of cloth, mean over frames and sequences; `body`: those of cloth with bodies\n "
      " " +
      std::string(width, ' ');
  for (std::size_t k = 0; k < e.outfits.size(); ++k)
    text += fmt::format(" {:>14}", fmt::format("{} ({})", e.outfits[k], e.vertices[k]));
  text +=
      fmt::format(" {:>10} {:>10} {:>9} {:>8} {:>8} {:>8}\n", "all", "body", "sequences", "at 0", "at 50", "at 150");
  for (const EvaluatedRow& row : e.rows) {
    text += fmt::format("  {:<{}}", row.row, width);
    if (row.sequences == 0) {
      text += " " + row.trouble + "\n";
      continue;
    }
    for (const double pairs : row.pairs_of_outfit) text += fmt::format(" {:>14}", shown(pairs));
    text += fmt::format(" {:>10} {:>10} {:>9} {:>8} {:>8} {:>8}{}\n", shown(row.pairs), shown(row.body_pairs),
                        row.sequences, shown(row.at_0), shown(row.at_50), shown(row.at_150),
                        row.failed > 0 ? fmt::format("  {} ended early", row.failed) : "");
  }
  text += fmt::format("  \"at\" are means over the {} sequences that start tangled\n", e.tangled);
  text += "ratios of (pairs + 1), geometric means with intervals of 95 % over sequences\n";
  for (const PairedRatio& ratio : e.ratios) text += ratio_text(ratio, width);
  text += fmt::format("what keeps stiff or frozen cloth from looking good; kinetic energy and jitter over {}'s\n",
                      e.baseline);
  text += fmt::format("  {} {:>8} {:>8} {:>10} {:>8} {:>8} {:>10}\n", std::string(width, ' '), "strain %", "p99 %",
                      "depth mm", "kinetic", "jitter", "frames/s");
  for (const EvaluatedRow& row : e.rows)
    if (row.sequences > 0)
      text += fmt::format("  {:<{}} {:>8} {:>8} {:>10} {:>8} {:>8} {:>10}\n", row.row, width,
                          shown(100 * row.strain, "{:.2f}"), shown(100 * row.strain_99, "{:.1f}"),
                          shown(1000 * row.depth, "{:.2f}"), shown(row.kinetic_ratio, "{:.2f}"),
                          shown(row.jitter_ratio, "{:.2f}"), shown(row.frames_a_second));
  if (e.timed_elsewhere > 0)
    text += fmt::format("  frames/s are of {}; times of {} sequences, which other machines have made, are left out\n",
                        e.machine, e.timed_elsewhere);
  return text + strain_by_outfit(e) + "\n";
}

std::string evaluation_json(const Evaluation& e) {
  Json rows = Json::array(), ratios = Json::array(), outfits = Json::array(), by_frame = Json::object(),
       speeds = Json::object();
  for (std::size_t k = 0; k < e.outfits.size(); ++k)
    outfits.push_back({{"name", e.outfits[k]}, {"vertices", e.vertices[k]}});
  for (const EvaluatedRow& row : e.rows) {
    Json of_outfits = Json::array(), strains = Json::array(), left = Json::array();
    for (const double pairs : row.pairs_of_outfit) of_outfits.push_back(number_or_null(pairs));
    for (std::size_t k = 0; k < e.outfits.size(); ++k)
      strains.push_back({{"mean", number_or_null(row.strain_of_outfit[k])},
                         {"percentile_99", number_or_null(row.strain_99_of_outfit[k])}});
    for (const double part : row.left) left.push_back(number_or_null(part));
    rows.push_back({{"row", row.row},
                    {"trouble", row.trouble},
                    {"sequences", row.sequences},
                    {"ended_early", row.failed},
                    {"pairs", number_or_null(row.pairs)},
                    {"body_pairs", number_or_null(row.body_pairs)},
                    {"pairs_of_outfit", of_outfits},
                    {"strain_of_outfit", strains},
                    {"pairs_at_0", number_or_null(row.at_0)},
                    {"pairs_at_50", number_or_null(row.at_50)},
                    {"pairs_at_150", number_or_null(row.at_150)},
                    {"left", left},
                    {"frames_a_second", number_or_null(row.frames_a_second)},
                    {"strain", number_or_null(row.strain)},
                    {"strain_99", number_or_null(row.strain_99)},
                    {"depth", number_or_null(row.depth)},
                    {"kinetic_ratio", number_or_null(row.kinetic_ratio)},
                    {"jitter_ratio", number_or_null(row.jitter_ratio)}});
  }
  for (const PairedRatio& r : e.ratios)
    ratios.push_back({{"row", r.row},
                      {"over", r.baseline},
                      {"sequences", r.sequences},
                      {"ratio", number_or_null(r.ratio)},
                      {"low", number_or_null(r.low)},
                      {"high", number_or_null(r.high)},
                      {"apart", r.apart()}});
  for (const auto& [row, pairs] : e.by_frame) by_frame[row] = pairs;
  for (const auto& [row, of_outfits] : e.speeds)
    for (const auto& [outfit, fps] : of_outfits) speeds[row][outfit] = fps;
  const Json json = {{"baseline", e.baseline}, {"outfits", outfits},
                     {"tangled", e.tangled},   {"rows", rows},
                     {"ratios", ratios},       {"shown", e.shown},
                     {"by_frame", by_frame},   {"frames_a_second", speeds},
                     {"machine", e.machine},   {"timed_elsewhere", e.timed_elsewhere}};
  return json_text(json);
}

}  // namespace selvedge
