#include "pipeline/compare/evaluation.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "pipeline/run/summary.hpp"
#include "pipeline/training/random_stream.hpp"

namespace selvedge {
namespace {

using Rows = std::vector<const CompareRow*>;

Rows rows_of(const std::vector<CompareRow>& all, const std::string& setting) {
  Rows found;
  for (const CompareRow& row : all)
    if (row.setting == setting && !row.pairs_by_frame.empty()) found.push_back(&row);
  return found;
}

// Over the rows where it is known.
template <class Value>
double mean_over(const Rows& rows, const Value& value) {
  double sum = 0;
  int count = 0;
  for (const CompareRow* row : rows)
    if (const double v = value(*row); std::isfinite(v)) {
      sum += v;
      ++count;
    }
  return count > 0 ? sum / count : unknown;
}

double mean_measure(const Rows& rows, const std::string& name) {
  return mean_over(rows, [&](const CompareRow& row) { return row.measure(name); });
}

bool finished(const CompareRow& row) { return row.measure("finished") == 1; }

// The same scene's row of another setting; null where it has none.
const CompareRow* partner(const Rows& rows, const std::string& scene) {
  const auto found = std::ranges::find(rows, scene, [](const CompareRow* row) { return row->scene; });
  return found == rows.end() ? nullptr : *found;
}

double ratio_to(const Rows& rows, const Rows& baseline, const std::string& measure) {
  double logs = 0;
  int count = 0;
  for (const CompareRow* row : rows) {
    const CompareRow* other = partner(baseline, row->scene);
    const double ratio = other ? row->measure(measure) / other->measure(measure) : unknown;
    if (!(ratio > 0) || !std::isfinite(ratio)) continue;
    logs += std::log(ratio);
    ++count;
  }
  return count > 0 ? std::exp(logs / count) : unknown;
}

bool starts_tangled(const CompareRow& row) { return row.tangled && row.pairs_by_frame.front() > 0; }

// A run that ended early counts as it was.
double pairs_at(const CompareRow& row, std::size_t frame) {
  return frame < row.pairs_by_frame.size() ? row.pairs_by_frame[frame] : unknown;
}

void describe_tangled(const Rows& rows, int frames, EvaluatedRow& row) {
  Rows tangled;
  for (const CompareRow* one : rows)
    if (starts_tangled(*one)) tangled.push_back(one);
  const auto at = [&](std::size_t frame) {
    return mean_over(tangled, [&](const CompareRow& one) { return pairs_at(one, frame); });
  };
  row.at_0 = at(0);
  row.at_50 = at(50);
  row.at_150 = at(150);
  for (int f = 0; f <= frames; ++f) {
    const double left = mean_over(tangled, [&](const CompareRow& one) {
      return pairs_at(one, static_cast<std::size_t>(f)) / one.pairs_by_frame.front();
    });
    if (!std::isfinite(left)) break;
    row.left.push_back(left);
  }
}

using ScenesOfMachine = std::map<std::string, std::set<std::string>>;

ScenesOfMachine scenes_of_machines(const std::vector<CompareRow>& rows) {
  ScenesOfMachine scenes;
  for (const CompareRow& row : rows) scenes[row.machine].insert(row.scene);
  return scenes;
}

EvaluatedRow described(const Comparison& comparison, const Evaluation& evaluation, const std::vector<CompareRow>& all,
                       const std::string& setting) {
  EvaluatedRow row;
  row.row = setting;
  const Rows rows = rows_of(all, setting), baseline = rows_of(all, comparison.evaluation.baseline);
  for (const CompareRow& one : all)
    if (one.setting == setting && one.pairs_by_frame.empty() && row.trouble.empty()) row.trouble = one.trouble;
  row.sequences = static_cast<int>(rows.size());
  row.failed = static_cast<int>(std::ranges::count_if(rows, [](const CompareRow* r) { return !finished(*r); }));
  for (const std::string& outfit : evaluation.outfits) {
    Rows of_outfit;
    for (const CompareRow* one : rows)
      if (one->outfit == outfit) of_outfit.push_back(one);
    row.pairs_of_outfit.push_back(mean_measure(of_outfit, "pairs_mean"));
    row.strain_of_outfit.push_back(mean_measure(of_outfit, "strain"));
    row.strain_99_of_outfit.push_back(mean_measure(of_outfit, "strain_99"));
  }
  row.pairs = mean_measure(rows, "pairs_mean");
  row.body_pairs = mean_measure(rows, "body_pairs_mean");
  describe_tangled(rows, comparison.evaluation.left_frames, row);
  std::vector<double> ms;
  for (const CompareRow* one : rows)
    if (one->machine == evaluation.machine) ms.push_back(one->ms);
  if (!ms.empty()) row.frames_a_second = 1000 / median(ms);
  row.strain = mean_measure(rows, "strain");
  row.strain_99 = mean_measure(rows, "strain_99");
  row.depth = mean_measure(rows, "depth");
  row.kinetic_ratio = ratio_to(rows, baseline, "kinetic");
  row.jitter_ratio = ratio_to(rows, baseline, "jitter");
  return row;
}

// Of the sequences that both have.
PairedRatio ratio_of(const std::vector<CompareRow>& all, const std::string& row, const std::string& baseline,
                     int resamples) {
  const Rows mine = rows_of(all, row), theirs = rows_of(all, baseline);
  std::vector<double> a, b;
  for (const CompareRow* one : mine)
    if (const CompareRow* other = partner(theirs, one->scene)) {
      a.push_back(one->measure("pairs_mean"));
      b.push_back(other->measure("pairs_mean"));
    }
  PairedRatio ratio = paired_ratio(a, b, resamples);
  ratio.row = row;
  ratio.baseline = baseline;
  return ratio;
}

}  // namespace

std::string machine_of_most(const std::vector<CompareRow>& rows) {
  const ScenesOfMachine scenes = scenes_of_machines(rows);
  const auto count = [](const auto& one) { return one.second.size(); };
  return scenes.empty() ? std::string() : std::ranges::max_element(scenes, {}, count)->first;
}

PairedRatio paired_ratio(const std::vector<double>& pairs, const std::vector<double>& baseline, int resamples,
                         std::uint64_t seed) {
  std::vector<double> logs;
  for (std::size_t k = 0; k < pairs.size(); ++k)
    if (const double log = std::log((pairs[k] + 1) / (baseline[k] + 1)); std::isfinite(log)) logs.push_back(log);
  PairedRatio result;
  result.sequences = static_cast<int>(logs.size());
  if (logs.empty()) return result;
  const auto count = static_cast<int>(logs.size());
  double sum = 0;
  for (const double log : logs) sum += log;
  result.ratio = std::exp(sum / count);
  if (count < 2) return result;  // one sequence says nothing of the others
  RandomStream random = stream_of(seed, static_cast<std::uint64_t>(count));
  std::vector<double> means;
  for (int r = 0; r < resamples; ++r) {
    double total = 0;
    for (int k = 0; k < count; ++k) total += logs[static_cast<std::size_t>(random.below(count))];
    means.push_back(total / count);
  }
  std::ranges::sort(means);
  const auto at = [&](double part) {
    return std::exp(means[static_cast<std::size_t>(std::lround(part * static_cast<double>(means.size() - 1)))]);
  };
  result.low = at(0.025);
  result.high = at(0.975);
  return result;
}

Evaluation evaluated(const Comparison& comparison, const std::vector<CompareFloor>& floors,
                     const std::vector<CompareRow>& rows) {
  Evaluation evaluation;
  evaluation.baseline = comparison.evaluation.baseline;
  for (const CompareRow& row : rows) {
    if (std::ranges::find(evaluation.outfits, row.outfit) != evaluation.outfits.end()) continue;
    evaluation.outfits.push_back(row.outfit);
    const auto floor = std::ranges::find(floors, row.scene, &CompareFloor::scene);
    evaluation.vertices.push_back(floor == floors.end() ? 0 : floor->vertices);
  }
  evaluation.machine = machine_of_most(rows);
  for (const auto& [machine, timed] : scenes_of_machines(rows))
    if (machine != evaluation.machine) evaluation.timed_elsewhere += static_cast<int>(timed.size());
  int most = -1;
  for (const CompareRow& row : rows) {
    if (row.setting != evaluation.baseline || row.pairs_by_frame.empty()) continue;
    if (starts_tangled(row)) ++evaluation.tangled;
    if (row.pairs_by_frame.front() <= most) continue;
    most = row.pairs_by_frame.front();
    evaluation.shown = row.scene;
  }
  for (const CompareSetting& setting : comparison.settings) {
    evaluation.rows.push_back(described(comparison, evaluation, rows, setting.name));
    std::vector<std::pair<std::string, double>> speeds;
    for (const std::string& outfit : evaluation.outfits) {
      std::vector<double> ms;
      for (const CompareRow* row : rows_of(rows, setting.name))
        if (row->outfit == outfit && row->machine == evaluation.machine) ms.push_back(row->ms);
      if (!ms.empty()) speeds.emplace_back(outfit, 1000 / median(ms));
    }
    if (!speeds.empty()) evaluation.speeds.emplace_back(setting.name, speeds);
    if (const CompareRow* row = partner(rows_of(rows, setting.name), evaluation.shown))
      evaluation.by_frame.emplace_back(setting.name, row->pairs_by_frame);
  }
  for (std::size_t a = 0; a < evaluation.rows.size(); ++a)
    for (std::size_t b = a + 1; b < evaluation.rows.size(); ++b)
      if (evaluation.rows[a].sequences > 0 && evaluation.rows[b].sequences > 0)
        evaluation.ratios.push_back(
            ratio_of(rows, evaluation.rows[a].row, evaluation.rows[b].row, comparison.evaluation.resamples));
  return evaluation;
}

}  // namespace selvedge
