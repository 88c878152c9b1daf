#include <fmt/format.h>

#include <cmath>

#include "pipeline/host/numbers_json.hpp"
#include "pipeline/host/version.hpp"
#include "pipeline/suites/bench.hpp"

namespace selvedge {
namespace {

struct Column {
  const char* name;   // in the CSV file
  const char* title;  // in the table
  int digits;         // 0: whole numbers
  double (*value)(const BenchMember&);
};

double a_frame(const BenchMember& member, double sum) {
  const auto frames = static_cast<double>(member.summary.frame_seconds.size());
  return frames > 0 ? sum / frames : 0;
}

const FieldTotal& total(const BenchMember& member, std::string_view field) {
  return total_of(member.summary.fields, field);
}

double per_frame(const BenchMember& member, double seconds) { return 1000 * a_frame(member, seconds); }

const std::vector<Column>& columns() {
  using M = const BenchMember&;
  static const std::vector<Column> all{
      {"frames", "frames", 0, [](M m) { return double(m.summary.frames); }},
      {"ms_median", "median ms", 1, [](M m) { return median_milliseconds(m.summary); }},
      {"ms_mean", "mean ms", 1, [](M m) { return mean_milliseconds(m.summary); }},
      {"ms_solve", "solve", 1, [](M m) { return per_frame(m, m.summary.seconds.solve); }},
      {"ms_broad_phase", "broad", 1, [](M m) { return per_frame(m, m.summary.seconds.broad_phase); }},
      {"ms_ccd", "ccd", 1, [](M m) { return per_frame(m, m.summary.seconds.ccd); }},
      {"ms_response", "response", 1, [](M m) { return per_frame(m, m.summary.seconds.response); }},
      {"ms_audit", "audit", 1, [](M m) { return per_frame(m, m.summary.seconds.audit); }},
      {"ms_body", "body", 1, [](M m) { return per_frame(m, m.summary.seconds.body); }},
      {"ms_worst", "worst ms", 1, [](M m) { return worst_milliseconds(m.summary); }},
      {"iterations", "Newton", 1, [](M m) { return a_frame(m, total(m, "iterations").sum); }},
      {"linear_iterations", "V-cycles", 1, [](M m) { return a_frame(m, total(m, "linear_iterations").sum); }},
      {"solves", "solves", 1, [](M m) { return a_frame(m, total(m, "solves").sum); }},
      {"coarse_builds", "builds", 1, [](M m) { return a_frame(m, total(m, "coarse_builds").sum); }},
      {"searches", "searches", 1, [](M m) { return a_frame(m, total(m, "searches").sum); }},
      {"candidates", "candidates", 0, [](M m) { return a_frame(m, total(m, "candidates").sum); }},
      {"audits", "audits", 1, [](M m) { return a_frame(m, total(m, "audits").sum); }},
      {"peak_mb", "peak MB", 1, [](M m) { return double(m.summary.peak_memory) / 1e6; }},
      {"max_contacts", "contacts", 0, [](M m) { return total(m, "contacts").largest; }},
      {"impulses", "impulses", 0, [](M m) { return total(m, "impulses").sum; }},
      {"intersecting_pairs", "pairs", 0, [](M m) { return double(m.summary.worst_pairs); }},
      {"pairs_wanted", "wanted", 0, [](M m) { return total(m, "pairs_wanted").largest; }},
      {"depth_wanted", "depth", 4, [](M m) { return total(m, "depth_wanted").largest; }},
      {"inside_vertices", "inside", 0, [](M m) { return double(m.summary.worst_inside); }},
      {"nonfinite", "nonfinite", 0, [](M m) { return double(m.summary.nonfinite); }},
      {"max_stretch", "stretch", 3, [](M m) { return m.summary.max_stretch; }},
      {"algebraic_error", "alg. error", 6,
       [](M m) { return m.algebraic ? m.algebraic->error : std::numeric_limits<double>::quiet_NaN(); }},
      {"energy_decay", "decay", 3, [](M m) { return m.decay.value_or(std::numeric_limits<double>::quiet_NaN()); }}};
  return all;
}

std::string rounded_number(double value, int digits) {
  return std::isnan(value) ? "" : fmt::format("{:.{}f}", value, digits);
}

Json detection_json(const std::vector<DetectionTiming>& timings) {
  Json list = Json::array();
  for (const DetectionTiming& t : timings) {
    Json entry = {{"shape", t.shape}, {"triangles", t.triangles}, {"pairs", t.pairs}, {"ms", 1e3 * t.ours}};
    entry["fcl_ms"] = t.fcl ? Json(1e3 * *t.fcl) : Json(nullptr);
    if (t.fcl) entry["pairs_found_by_one_alone"] = t.other_pairs;
    list.push_back(entry);
  }
  return list;
}

Json engine_json(const EngineTimings& timings) {
  const PeakMeasurement& peak = timings.peak;
  Json rows = Json::array();
  for (const EngineTiming& row : timings.rows)
    rows.push_back({{"network", row.network},
                    {"width", row.width},
                    {"steps", row.steps},
                    {"nodes", row.run.nodes},
                    {"edges", row.run.edges},
                    {"operations", row.run.operations},
                    {"ms", 1e3 * row.run.seconds},
                    {"busy_ms", 1e3 * row.run.busy_seconds},
                    {"share_of_peak", share_of_peak(timings, row)},
                    {"busy_share_of_peak", busy_share_of_peak(timings, row)},
                    {"bytes", row.run.bytes},
                    {"runs_a_frame", row.passes}});
  return {{"instruction_set", name_of(peak.set)},
          {"threads", peak.threads},
          {"floats_in_a_vector", peak.lanes},
          {"clock_hz", peak.clock},
          {"peak_flops", peak.flops},
          {"busy_peak_flops", peak.flops_busy},
          {"share_of_ports", peak.share_of_ports},
          {"void", is_void(peak)},
          {"rows", rows}};
}

Json training_json(const std::vector<TrainingTiming>& timings) {
  Json list = Json::array();
  for (const TrainingTiming& t : timings) {
    Json row = {{"network", t.network},
                {"nodes", t.nodes},
                {"edges", t.edges},
                {"threads", t.threads},
                {"forward_ms", 1e3 * t.forward.wall},
                {"step_ms", 1e3 * t.fused.wall},
                {"busy_step_ms", 1e3 * t.fused.busy}};
    if (t.with_torch) {
      row["libtorch_step_ms"] = 1e3 * t.torch.wall;
      row["libtorch_busy_step_ms"] = 1e3 * t.torch.busy;
      row["libtorch"] = t.facts.version;
      row["blas"] = t.facts.blas;
      row["outputs_apart"] = t.apart;
    }
    list.push_back(std::move(row));
  }
  return list;
}

}  // namespace

std::string bench_json(const BenchResult& result) {
  Json list = Json::array();
  for (const BenchMember& member : result.members) {
    Json entry = {{"scene", member.scene}, {"size", member.size}};
    for (const Column& column : columns()) {
      const double value = column.value(member);
      if (std::isnan(value))
        entry[column.name] = nullptr;
      else if (column.digits == 0)
        entry[column.name] = std::llround(value);
      else
        entry[column.name] = value;
    }
    if (member.algebraic) entry["algebraic_reference_converged"] = member.algebraic->reference_converged;
    entry["run"] = parse_json(summary_json(member.summary));
    list.push_back(entry);
  }
  Json json = {{"program_version", program_version()}, {"detection", detection_json(result.detection)}};
  if (result.engine) json["engine"] = engine_json(*result.engine);
  if (!result.training.empty()) json["training"] = training_json(result.training);
  json["members"] = list;
  return json_text(json);
}

std::string bench_csv(const std::vector<BenchMember>& members) {
  std::string text = "scene,size";
  for (const Column& column : columns()) text += std::string(",") + column.name;
  text += "\n";
  for (const BenchMember& member : members) {
    text += fmt::format("{},{}", member.scene, member.size);
    for (const Column& column : columns())
      text += fmt::format(",{}", rounded_number(column.value(member), column.digits > 0 ? column.digits + 3 : 0));
    text += "\n";
  }
  return text;
}

std::string bench_table(const BenchResult& result) {
  std::string text;
  if (!result.members.empty()) {
    text = fmt::format("{:<6} {:>4}", "scene", "N");
    for (const Column& column : columns()) text += fmt::format(" {:>10}", column.title);
    text += "\n";
  }
  for (const BenchMember& member : result.members) {
    text += fmt::format("{:<6} {:>4}", member.scene, member.size);
    for (const Column& column : columns())
      text += fmt::format(" {:>10}", rounded_number(column.value(member), column.digits));
    text += "\n";
  }
  const auto add = [&text](const std::string& table) {
    if (!text.empty()) text += '\n';
    text += table;
  };
  if (!result.detection.empty()) add(detection_table(result.detection));
  if (result.engine) add(engine_table(*result.engine));
  if (!result.training.empty()) add(training_table(result.training));
  return text;
}

}  // namespace selvedge
