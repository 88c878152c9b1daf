#include "pipeline/run/summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>

#include "collision/geometry/counted.hpp"
#include "pipeline/host/bytes_of.hpp"
#include "pipeline/host/kept_rows.hpp"
#include "pipeline/host/label_lines.hpp"
#include "pipeline/host/numbers_json.hpp"

namespace selvedge {
namespace {

const char* end_name(RunEnd end) {
  constexpr std::array names{"running", "finished", "interrupted", "rejected"};  // in the order of RunEnd
  return names.at(static_cast<std::size_t>(end));
}

std::vector<std::pair<std::string, double>> phases_in_milliseconds(const RunSummary& summary) {
  const double factor = summary.frame_seconds.empty() ? 0 : 1000.0 / static_cast<double>(summary.frame_seconds.size());
  const PhaseTimes& s = summary.seconds;
  const double all = std::accumulate(summary.frame_seconds.begin(), summary.frame_seconds.end(), 0.0);
  std::vector<std::pair<std::string, double>> phases;
  for (const BoundField<PhaseTimes>& phase : phase_fields()) {
    const double seconds = number_of(phase.get(s), {});
    const bool only_where_there = phase.in_summary.at(0).over == Over::milliseconds_where_there;
    if (seconds > 0 || !only_where_there) phases.emplace_back(phase.name, factor * seconds);
  }
  phases.emplace_back("other", factor * std::max(0.0, all - s.total()));
  return phases;
}

// The verdicts that occurred, each with its number of frames.
std::string verdicts_text(const RunSummary& s) {
  std::string text;
  const std::vector<int>& frames = total_of(s.fields, "verdict").by_word;
  for (std::size_t k = 0; k < frames.size(); ++k)
    if (frames[k] > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", verdict_names()[k], frames[k]);
  return text;
}

void add_labels(const StepReport& report, int index, RunSummary& summary) {
  for (std::size_t k = 0; k < std::min(report.switched_off.size(), summary.switched_off.size()); ++k) {
    RunSummary::SwitchedOff& obstacle = summary.switched_off[k];
    if (report.switched_off[k] == 0) continue;
    if (obstacle.frames++ == 0) obstacle.first_frame = index;
    obstacle.most = std::max(obstacle.most, report.switched_off[k]);
  }
}

Json switched_off_json(const RunSummary& s) {
  Json all = Json::array();
  for (const RunSummary::SwitchedOff& one : s.switched_off)
    if (one.frames > 0)
      all.push_back({{"obstacle", one.obstacle},
                     {"most_triangles", one.most},
                     {"frames", one.frames},
                     {"first_frame", one.first_frame}});
  return all;
}

std::string vertices_text(long n) { return counted(n, "vertex", "vertices"); }

// Adds lines about cloth that contact left alone, and budgets that ran out.
void add_doubtful(const RunSummary& s, LabelLines& add) {
  for (const RunSummary::SwitchedOff& one : s.switched_off)
    if (one.frames > 0)
      add("switched off",
          fmt::format(
              "up to {} of `{}`, in {}, first in {}: it crosses itself there, and cloth that its parts catch is "
              "let through",
              counted(one.most, "triangle"), one.obstacle, counted(one.frames, "frame"), one.first_frame));
  if (const auto pushed = static_cast<long>(total_of(s.fields, "pushed_out").sum); pushed > 0)
    add("pushed out", vertices_text(pushed) + " over all frames, by the repulsive layer or the settling of a network");
  const auto in_frames = [&](std::string_view field, const std::string& name, const std::string& what) {
    if (const int frames = total_of(s.fields, field).frames; frames > 0) add(name, counted(frames, "frame") + what);
  };
  // Not every stepper bounds how far its solves are off.
  const double unsolved = total_of(s.fields, "unsolved").largest;
  const std::string off = unsolved > 0 ? fmt::format("{:.2g} m off at most", unsolved) : "";
  in_frames("not_converged", "not converged", off.empty() ? "" : ": " + off);
  in_frames("out_of_newton", "out of Newton", ": later solves were rough" + (off.empty() ? "" : ", " + off));
  in_frames("out_of_untangling", "out of untangling", ": what was tangled still waited for the next");
  in_frames("out_of_response", "out of response", ": later motion was shortened");
  in_frames("out_of_proofs", "out of proofs",
            ": the audit of their motion is not whole, and what it gave up counts as passed through");
}

Json total_json(const BoundField<StepReport>& field, const FieldTotal& total, const InSummary& one,
                const RunSummary& s) {
  if (one.over == Over::by_obstacle) return switched_off_json(s);
  if (one.over == Over::by_word) {
    Json words = Json::object();
    for (std::size_t k = 0; k < total.by_word.size(); ++k)
      if (total.by_word[k] > 0) words[field.words[k]] = total.by_word[k];
    return words;
  }
  const double value = value_of(total, one.over);
  const bool counted = one.over == Over::frames || one.over == Over::first_frame || one.over == Over::last_frame;
  if (counted || field.type != ColumnType::real) return static_cast<std::int64_t>(value);
  return number_or_null(value);
}

// Adds the totals that the table of fields (report_fields.cpp) asks for.
void put_totals(const RunSummary& s, Json& json) {
  for (std::size_t k = 0; k < report_fields().size(); ++k)
    for (const InSummary& one : report_fields()[k].in_summary)
      if (one.over != Over::milliseconds && one.over != Over::milliseconds_where_there)
        json[one.key] = total_json(report_fields()[k], s.fields[k], one, s);
}

}  // namespace

void add_frame(RunSummary& summary, int index, const Frame& frame) {
  const StepReport& report = frame.report;
  summary.positions_hash = hash_of(bytes_of(frame.x), index > 0 ? summary.positions_hash : hash_of(""));
  if (index > 0) {
    if (report.status == StepStatus::accepted) ++summary.frames;
    summary.frame_seconds.push_back(frame.seconds);
    summary.seconds += report.seconds;
  }
  add_report(summary.fields, index, report);
  add_labels(report, index, summary);
  if (frame.max_stretch > summary.max_stretch) {
    summary.max_stretch = frame.max_stretch;
    summary.max_stretch_frame = index;
  }
  summary.min_stretch = std::min(summary.min_stretch, frame.min_stretch);
  const int pairs = frame.self_pairs + frame.obstacle_pairs;
  summary.pairs += pairs;
  summary.vertex_pairs += frame.vertex_pairs;
  if (pairs > summary.worst_pairs) {
    summary.worst_pairs = pairs;
    summary.worst_frame = index;
  }
  summary.worst_inside = std::max(summary.worst_inside, frame.inside_vertices);
  summary.nonfinite += frame.nonfinite;
}

double held_fraction(const RunSummary& summary) {
  const double vertex_steps = static_cast<double>(summary.vertices) * total_of(summary.fields, "substeps").sum;
  return vertex_steps > 0 ? total_of(summary.fields, "held_vertices").sum / vertex_steps : 0;
}

double mean_milliseconds(const RunSummary& summary) {
  const std::vector<double>& all = summary.frame_seconds;
  return all.empty() ? 0 : 1000 * std::accumulate(all.begin(), all.end(), 0.0) / static_cast<double>(all.size());
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

double median_milliseconds(const RunSummary& summary) { return 1000 * median(summary.frame_seconds); }

double worst_milliseconds(const RunSummary& summary) {
  const std::vector<double>& all = summary.frame_seconds;
  return all.empty() ? 0 : 1000 * *std::ranges::max_element(all);
}

bool is_clean(const RunSummary& summary) {
  return summary.end == RunEnd::finished && summary.pairs == 0 && summary.worst_inside == 0 && summary.nonfinite == 0 &&
         total_of(summary.fields, "passed_through").sum == 0 && total_of(summary.fields, "jumped").sum == 0 &&
         total_of(summary.fields, "cut_out").at_end == 0 && summary.slid_off.empty() && all_came_true(summary.outcomes);
}

std::string summary_json(const RunSummary& s) {
  Json phases, left_out = Json::array();
  for (const auto& [name, milliseconds] : phases_in_milliseconds(s)) phases[name] = milliseconds;
  for (const PlanLine& line : s.left_out) left_out.push_back({{"feature", line.feature}, {"why", line.why}});
  Json slid_off = Json::array();
  for (const WornWatch& one : s.slid_off)
    slid_off.push_back({{"garment", one.garment}, {"body", one.body}, {"frame", one.left_in}});
  Json outcomes = Json::array();
  for (const OutcomeResult& one : s.outcomes)
    outcomes.push_back({{"name", one.name},
                        {"came_true", one.came_true},
                        {"value", one.frame < 0 ? Json(nullptr) : number_or_null(one.value)},
                        {"frame", one.frame}});
  Json json = {
      {"program_version", s.program_version},
      {"scene", s.scene},
      {"stepper", s.stepper},
      {"prepared", s.prepared},
      {"vertices", s.vertices},
      {"triangles", s.triangles},
      {"end", end_name(s.end)},
      {"reason", s.reason},
      {"clean", is_clean(s)},
      {"outcomes", outcomes},
      {"frames_wanted", s.frames_wanted},
      {"frames", s.frames},
      {"ms_per_frame", {{"mean", mean_milliseconds(s)}, {"median", median_milliseconds(s)}, {"by_phase", phases}}},
      {"peak_memory_bytes", s.peak_memory},
      {"max_stretch", number_or_null(s.max_stretch)},
      {"max_stretch_frame", s.max_stretch_frame},
      {"min_stretch", number_or_null(s.min_stretch)},
      {"self", s.self_audited ? "audited" : "not audited"},
      {"intersecting_pairs", s.worst_pairs},
      {"intersecting_pairs_worst_frame", s.worst_frame},
      {"intersecting_pairs_all_frames", s.pairs},
      {"vertex_sharing_pairs_all_frames", s.vertex_pairs},
      {"inside_vertices", s.worst_inside},
      {"nonfinite", s.nonfinite},
      {"slid_off", slid_off},
      {"held_fraction", held_fraction(s)}};
  put_totals(s, json);
  json["positions_hash"] = fmt::format("{:016x}", s.positions_hash);
  json["inputs_hash"] = fmt::format("{:016x}", s.inputs_hash);
  json["left_out"] = left_out;
  json["warnings"] = s.warnings;
  return json_text(json);
}

std::string summary_text(const RunSummary& s) {
  std::string phases, out;
  for (const auto& [name, milliseconds] : phases_in_milliseconds(s))
    if (milliseconds >= 0.05) phases += fmt::format("{}{} {:.1f}", phases.empty() ? "" : ", ", name, milliseconds);
  for (const PlanLine& line : s.left_out) out += (out.empty() ? "" : ", ") + line.feature;

  LabelLines add{20};
  const std::string end = s.end == RunEnd::finished ? "" : fmt::format(", {} {}", end_name(s.end), s.reason);
  if (!s.prepared.empty()) add("start", s.prepared);
  add("frames", fmt::format("{} of {}{}", s.frames, s.frames_wanted, end));
  add("cloth", vertices_text(s.vertices) + ", " + counted(s.triangles, "triangle"));
  add("time a frame", fmt::format("{:.1f} ms (median {:.1f})", mean_milliseconds(s), median_milliseconds(s)));
  if (!phases.empty()) add("  by phase [ms]", phases);
  if (const std::string verdicts = verdicts_text(s); !verdicts.empty()) add("proposals", verdicts);
  if (s.peak_memory > 0) add("peak memory", fmt::format("{:.0f} MB", static_cast<double>(s.peak_memory) / 1e6));
  add("worst stretch", fmt::format("{:.3f} in frame {}", s.max_stretch, s.max_stretch_frame));
  add("intersecting pairs",
      s.pairs == 0 ? "0 in every frame"
                   : fmt::format("{} in frame {} ({} over all frames)", s.worst_pairs, s.worst_frame, s.pairs));
  const FieldTotal& cut_out = total_of(s.fields, "cut_out");
  const auto cut_at_start = static_cast<long>(cut_out.at_start), cut_at_end = static_cast<long>(cut_out.at_end);
  if (cut_at_start > 0)
    add("cut out", counted(cut_at_start, "triangle") + " at the start, " +
                       (cut_at_end > 0 ? fmt::format("{} at the end: no pair is counted of them", cut_at_end)
                                       : fmt::format("none after frame {}", cut_out.last_frame)));
  if (!s.self_audited) add("self", "not audited");
  if (s.vertex_pairs > 0) add("cross at a vertex", counted(s.vertex_pairs, "pair") + " over all frames");
  if (s.worst_inside > 0) add("inside obstacles", vertices_text(s.worst_inside) + " in the worst frame");
  for (const WornWatch& one : s.slid_off) add("slid off", slid_off_text(one));
  if (s.nonfinite > 0) add("not finite", vertices_text(s.nonfinite) + " over all frames");
  const auto sum = [&](std::string_view field) { return static_cast<long>(total_of(s.fields, field).sum); };
  const auto largest = [&](std::string_view field) { return total_of(s.fields, field).largest; };
  const auto contacts = static_cast<long>(largest("contacts"));
  if (contacts > 0 || sum("impulses") > 0 || sum("zones") > 0)  // networks do not look for contacts
    add("contacts", fmt::format("{} at most; {}, {}", contacts, counted(sum("impulses"), "impulse"),
                                counted(sum("zones"), "zone")));
  if (sum("halved_substeps") > 0) add("substeps halved", std::to_string(sum("halved_substeps")));
  if (sum("held_vertices") > 0)
    add("held back", fmt::format("{:.2g} % of all vertices and substeps", 100 * held_fraction(s)));
  if (sum("passed_through") > 0) add("passed through", counted(sum("passed_through"), "pair") + " over all frames");
  if (sum("jumped") > 0)
    add("jumped", fmt::format("{}, first in frame {}: too fast for a sweep, so what was passed is not known; give more "
                              "frames a second or substeps",
                              counted(sum("jumped"), "obstacle"), total_of(s.fields, "jumped").first_frame));
  if (const FieldTotal& gains = total_of(s.fields, "energy_gain"); gains.frames > 0)
    add("energy from nowhere", fmt::format("in {}, first in frame {}: more than pins, obstacles and wind gave",
                                           counted(gains.frames, "frame"), gains.first_frame));
  if (largest("obstacle_lag") > 0)
    add("obstacles lag",
        fmt::format("{:.2g} m at most; where they were wanted {} and {:.2g} m deep at worst", largest("obstacle_lag"),
                    counted(static_cast<long>(largest("pairs_wanted")), "pair"), largest("depth_wanted")));
  add_doubtful(s, add);
  add("left out", out.empty() ? "nothing" : out);
  for (const std::string& warning : s.warnings) add("warning", warning);
  for (const std::string& line : s.outcome_lines) add(&line == &s.outcome_lines.front() ? "outcome" : "", line);
  return add.text;
}

}  // namespace selvedge
