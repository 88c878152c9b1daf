#include "pipeline/run/summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "pipeline/formats/trajectory_row.hpp"
#include "pipeline/host/numbers_json.hpp"

namespace selvedge {
namespace {

const char* end_name(RunEnd end) {
  switch (end) {
    case RunEnd::running:
      return "running";
    case RunEnd::finished:
      return "finished";
    case RunEnd::interrupted:
      return "interrupted";
    case RunEnd::rejected:
      return "rejected";
  }
  return "";
}

std::vector<std::pair<const char*, double>> phases_in_milliseconds(const RunSummary& summary) {
  const double factor = summary.frame_seconds.empty() ? 0 : 1000.0 / static_cast<double>(summary.frame_seconds.size());
  const PhaseTimes& s = summary.seconds;
  const double all = std::accumulate(summary.frame_seconds.begin(), summary.frame_seconds.end(), 0.0);
  std::vector<std::pair<const char*, double>> phases{{"solve", factor * s.solve},
                                                     {"broad_phase", factor * s.broad_phase},
                                                     {"ccd", factor * s.ccd},
                                                     {"response", factor * s.response}};
  if (s.network > 0) phases.insert(phases.end(), {{"graph", factor * s.graph}, {"network", factor * s.network}});
  if (s.guard > 0) phases.push_back({"guard", factor * s.guard});
  phases.insert(phases.end(), {{"audit", factor * s.audit}, {"other", factor * std::max(0.0, all - s.total())}});
  return phases;
}

// The verdicts that there were, each with its frames.
std::vector<std::pair<std::string, int>> verdict_counts(const RunSummary& s) {
  std::vector<std::pair<std::string, int>> counts;
  for (std::size_t k = 0; k < s.verdicts.size(); ++k)
    if (s.verdicts[k] > 0) counts.emplace_back(verdict_names()[k], s.verdicts[k]);
  return counts;
}

void add_labels(const StepReport& report, int index, RunSummary& summary) {
  for (std::size_t k = 0; k < std::min(report.switched_off.size(), summary.switched_off.size()); ++k) {
    RunSummary::SwitchedOff& obstacle = summary.switched_off[k];
    if (report.switched_off[k] == 0) continue;
    if (obstacle.frames++ == 0) obstacle.first_frame = index;
    obstacle.most = std::max(obstacle.most, report.switched_off[k]);
  }
  if (report.reason == Reason::energy_gain && summary.energy_gains++ == 0) summary.first_gain_frame = index;
  summary.pushed_out += report.collision.pushed_out;
  summary.untangling += report.untangling;
  summary.out_of_newton += report.out_of_newton;
  summary.out_of_untangling += report.out_of_untangling;
  summary.out_of_response += report.out_of_response;
  summary.out_of_proofs += report.out_of_proofs;
  summary.max_unsolved = std::max(summary.max_unsolved, report.unsolved);
}

nlohmann::ordered_json switched_off_json(const RunSummary& s) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const RunSummary::SwitchedOff& one : s.switched_off)
    if (one.frames > 0)
      all.push_back({{"obstacle", one.obstacle},
                     {"most_triangles", one.most},
                     {"frames", one.frames},
                     {"first_frame", one.first_frame}});
  return all;
}

// What contact left alone and what budgets ended, a label and a sentence each.
std::vector<std::pair<const char*, std::string>> label_lines(const RunSummary& s) {
  std::vector<std::pair<const char*, std::string>> lines;
  for (const RunSummary::SwitchedOff& one : s.switched_off)
    if (one.frames > 0)
      lines.emplace_back("switched off",
                         fmt::format("up to {} triangles of `{}`, in {} frame{}, first in {}: it crosses itself there, "
                                     "and cloth that its parts catch is let through",
                                     one.most, one.obstacle, one.frames, one.frames == 1 ? "" : "s", one.first_frame));
  if (s.pushed_out > 0)
    lines.emplace_back("pushed out", fmt::format("{} vertices over all frames, by the repulsive layer", s.pushed_out));
  if (s.out_of_newton > 0)
    lines.emplace_back("out of Newton", fmt::format("{} frames: later solves were rough, {:.2g} m off at most",
                                                    s.out_of_newton, s.max_unsolved));
  if (s.out_of_untangling > 0)
    lines.emplace_back("out of untangling",
                       fmt::format("{} frames: what was tangled still waited for the next", s.out_of_untangling));
  if (s.out_of_response > 0)
    lines.emplace_back("out of response", fmt::format("{} frames: later motion was shortened", s.out_of_response));
  if (s.out_of_proofs > 0)
    lines.emplace_back("out of proofs", fmt::format("{} frames: the audit of their motion is not whole, and what it "
                                                    "gave up counts as passed through",
                                                    s.out_of_proofs));
  return lines;
}

}  // namespace

void add_frame(RunSummary& summary, int index, const Frame& frame) {
  const StepReport& report = frame.report;
  const CollisionReport& collision = report.collision;
  if (index > 0) {
    if (report.status == StepStatus::accepted) ++summary.frames;
    summary.frame_seconds.push_back(frame.seconds);
    summary.seconds += report.seconds;
    if (report.verdict != Verdict::none) {
      summary.verdicts.resize(verdict_names().size());
      ++summary.verdicts[static_cast<std::size_t>(report.verdict)];
    }
  }
  summary.substeps += report.substeps;
  summary.iterations += report.iterations;
  summary.linear_iterations += report.linear_iterations;
  summary.counts += report.counts;
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
  if (index == 0) summary.cut_out_at_start = collision.cut_out;
  summary.cut_out_at_end = collision.cut_out;
  if (collision.cut_out > 0) summary.last_cut_frame = index;
  summary.max_contacts = std::max(summary.max_contacts, collision.contacts);
  summary.impulses += collision.impulses;
  summary.zones += collision.zones;
  summary.halved_substeps += collision.halved_substeps;
  summary.shortened += collision.shortened;
  summary.held_vertices += collision.held_vertices;
  summary.passed_through += collision.passed_through;
  summary.jumped += collision.jumped;
  if (collision.jumped > 0 && summary.first_jump_frame < 0) summary.first_jump_frame = index;
  add_labels(report, index, summary);
  summary.worst_pairs_wanted = std::max(summary.worst_pairs_wanted, collision.pairs_wanted);
  summary.max_depth_wanted = std::max(summary.max_depth_wanted, collision.depth_wanted);
  summary.max_obstacle_lag = std::max(summary.max_obstacle_lag, collision.obstacle_lag);
  summary.max_residual = std::max(summary.max_residual, report.residual);
  summary.min_contact_gap = std::min(summary.min_contact_gap, collision.min_gap);
}

double held_fraction(const RunSummary& summary) {
  const double vertex_steps = static_cast<double>(summary.vertices) * summary.substeps;
  return vertex_steps > 0 ? static_cast<double>(summary.held_vertices) / vertex_steps : 0;
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
         summary.passed_through == 0 && summary.jumped == 0 && summary.cut_out_at_end == 0 && summary.slid_off.empty();
}

std::string summary_json(const RunSummary& s) {
  nlohmann::ordered_json phases, left_out = nlohmann::ordered_json::array(),
                                 verdicts = nlohmann::ordered_json::object();
  for (const auto& [name, milliseconds] : phases_in_milliseconds(s)) phases[name] = milliseconds;
  for (const auto& [name, frames] : verdict_counts(s)) verdicts[name] = frames;
  for (const PlanLine& line : s.left_out) left_out.push_back({{"feature", line.feature}, {"why", line.why}});
  nlohmann::ordered_json slid_off = nlohmann::ordered_json::array();
  for (const WornWatch& one : s.slid_off)
    slid_off.push_back({{"garment", one.garment}, {"body", one.body}, {"frame", one.left_in}});
  const nlohmann::ordered_json json = {
      {"program_version", s.program_version},
      {"scene", s.scene},
      {"stepper", s.stepper},
      {"prepared", s.prepared},
      {"vertices", s.vertices},
      {"triangles", s.triangles},
      {"end", end_name(s.end)},
      {"reason", s.reason},
      {"clean", is_clean(s)},
      {"frames_wanted", s.frames_wanted},
      {"frames", s.frames},
      {"ms_per_frame", {{"mean", mean_milliseconds(s)}, {"median", median_milliseconds(s)}, {"by_phase", phases}}},
      {"peak_memory_bytes", s.peak_memory},
      {"substeps", s.substeps},
      {"iterations", s.iterations},
      {"linear_iterations", s.linear_iterations},
      {"solves", s.counts.solves},
      {"coarse_builds", s.counts.coarse_builds},
      {"searches", s.counts.searches},
      {"candidates", s.counts.candidates},
      {"audits", s.counts.audits},
      {"verdicts", verdicts},
      {"max_residual", number_or_null(s.max_residual)},
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
      {"cut_out_triangles", s.cut_out_at_start},
      {"cut_out_triangles_at_end", s.cut_out_at_end},
      {"cut_out_last_frame", s.last_cut_frame},
      {"max_contacts", s.max_contacts},
      {"impulses", s.impulses},
      {"zones", s.zones},
      {"halved_substeps", s.halved_substeps},
      {"shortened_zones", s.shortened},
      {"held_fraction", held_fraction(s)},
      {"passed_through", s.passed_through},
      {"jumped", s.jumped},
      {"jumped_first_frame", s.first_jump_frame},
      {"energy_gains", s.energy_gains},
      {"energy_gains_first_frame", s.first_gain_frame},
      {"min_contact_gap", number_or_null(s.min_contact_gap)},
      {"max_obstacle_lag", s.max_obstacle_lag},
      {"intersecting_pairs_wanted", s.worst_pairs_wanted},
      {"max_depth_wanted", s.max_depth_wanted},
      {"switched_off", switched_off_json(s)},
      {"pushed_out", s.pushed_out},
      {"untangling_passes", s.untangling},
      {"out_of_newton_frames", s.out_of_newton},
      {"out_of_untangling_frames", s.out_of_untangling},
      {"out_of_response_frames", s.out_of_response},
      {"out_of_proofs_frames", s.out_of_proofs},
      {"max_unsolved", number_or_null(s.max_unsolved)},
      {"left_out", left_out},
      {"warnings", s.warnings}};
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

std::string summary_text(const RunSummary& s) {
  std::string phases, out;
  for (const auto& [name, milliseconds] : phases_in_milliseconds(s))
    if (milliseconds >= 0.05) phases += fmt::format("{}{} {:.1f}", phases.empty() ? "" : ", ", name, milliseconds);
  for (const PlanLine& line : s.left_out) out += (out.empty() ? "" : ", ") + line.feature;

  std::string text;
  const auto add = [&](const char* label, const std::string& value) {
    text += fmt::format("{:<20}{}\n", label, value);
  };
  const std::string end = s.end == RunEnd::finished ? "" : fmt::format(", {} {}", end_name(s.end), s.reason);
  if (!s.prepared.empty()) add("start", s.prepared);
  add("frames", fmt::format("{} of {}{}", s.frames, s.frames_wanted, end));
  add("cloth", fmt::format("{} vertices, {} triangles", s.vertices, s.triangles));
  add("time a frame", fmt::format("{:.1f} ms (median {:.1f})", mean_milliseconds(s), median_milliseconds(s)));
  if (!phases.empty()) add("  by phase [ms]", phases);
  std::string verdicts;
  for (const auto& [name, frames] : verdict_counts(s))
    verdicts += fmt::format("{}{} {}", verdicts.empty() ? "" : ", ", name, frames);
  if (!verdicts.empty()) add("proposals", verdicts);
  if (s.peak_memory > 0) add("peak memory", fmt::format("{:.0f} MB", static_cast<double>(s.peak_memory) / 1e6));
  add("worst stretch", fmt::format("{:.3f} in frame {}", s.max_stretch, s.max_stretch_frame));
  add("intersecting pairs",
      s.pairs == 0 ? "0 in every frame"
                   : fmt::format("{} in frame {} ({} over all frames)", s.worst_pairs, s.worst_frame, s.pairs));
  if (s.cut_out_at_start > 0)
    add("cut out",
        s.cut_out_at_end > 0
            ? fmt::format("{} triangles at the start, {} at the end: no pair is counted of them", s.cut_out_at_start,
                          s.cut_out_at_end)
            : fmt::format("{} triangles at the start, none after frame {}", s.cut_out_at_start, s.last_cut_frame));
  if (!s.self_audited) add("self", "not audited");
  if (s.vertex_pairs > 0) add("cross at a vertex", fmt::format("{} pairs over all frames", s.vertex_pairs));
  if (s.worst_inside > 0) add("inside obstacles", fmt::format("{} vertices in the worst frame", s.worst_inside));
  for (const WornWatch& one : s.slid_off) add("slid off", slid_off_text(one));
  if (s.nonfinite > 0) add("not finite", fmt::format("{} vertices over all frames", s.nonfinite));
  if (s.max_contacts > 0 || s.impulses > 0 || s.zones > 0)  // a network looks for none
    add("contacts", fmt::format("{} at most; {} impulses, {} zones", s.max_contacts, s.impulses, s.zones));
  if (s.halved_substeps > 0) add("substeps halved", std::to_string(s.halved_substeps));
  if (s.held_vertices > 0)
    add("held back", fmt::format("{:.2g} % of all vertices and substeps", 100 * held_fraction(s)));
  if (s.passed_through > 0) add("passed through", fmt::format("{} pairs over all frames", s.passed_through));
  if (s.jumped > 0)
    add("jumped",
        fmt::format("{} obstacles, first in frame {}: too fast for a sweep, so what they passed is not known; "
                    "give more frames a second or substeps",
                    s.jumped, s.first_jump_frame));
  if (s.energy_gains > 0)
    add("energy from nowhere", fmt::format("in {} frames, first in frame {}: more than pins, obstacles and wind gave",
                                           s.energy_gains, s.first_gain_frame));
  if (s.max_obstacle_lag > 0)
    add("obstacles lag", fmt::format("{:.2g} m at most; where they were wanted {} pairs and {:.2g} m deep at worst",
                                     s.max_obstacle_lag, s.worst_pairs_wanted, s.max_depth_wanted));
  for (const auto& [label, sentence] : label_lines(s)) add(label, sentence);
  add("left out", out.empty() ? "nothing" : out);
  for (const std::string& warning : s.warnings) add("warning", warning);
  return text;
}

}  // namespace selvedge
