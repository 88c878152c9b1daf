#include "pipeline/training/training_tables.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "pipeline/host/csv_columns.hpp"

namespace selvedge {

void StepWindow::add(const StepRecord& record) {
  terms_.resize(loss_rows().size());
  for (const SampleRecord& sample : record.samples) {
    if (!sample.bad.empty()) {
      ++bad_;
      continue;
    }
    double gradients = 0;
    for (const LossTerm& term : sample.terms) gradients += term.gradient_norm;
    for (const LossTerm& term : sample.terms) {
      Term& sum = terms_[static_cast<std::size_t>(term.row - loss_rows().data())];
      sum.value += term.value;
      sum.gradient += gradients > 0 ? term.gradient_norm / gradients : 0;
    }
    ++count_;
    sum_ += sample.sum;
    norm_ += record.adam.norm;
    scale_ += record.adam.scale;
    rate_ = record.adam.learning_rate;
  }
}

std::vector<double> StepWindow::sums() const {
  std::vector<double> all{static_cast<double>(count_), static_cast<double>(bad_), sum_, norm_, scale_};
  for (std::size_t k = 0; k < loss_rows().size(); ++k) {
    const Term term = k < terms_.size() ? terms_[k] : Term{};
    all.insert(all.end(), {term.value, term.gradient});
  }
  return all;
}

void StepWindow::add(std::span<const double> sums, double learning_rate) {
  rate_ = learning_rate;
  terms_.resize(loss_rows().size());
  count_ += static_cast<int>(sums[0]);
  bad_ += static_cast<int>(sums[1]);
  sum_ += sums[2];
  norm_ += sums[3];
  scale_ += sums[4];
  for (std::size_t k = 0; k < terms_.size(); ++k) {
    terms_[k].value += sums[5 + 2 * k];
    terms_[k].gradient += sums[6 + 2 * k];
  }
}

std::string steps_header() {
  std::string line =
      "step,progress,seconds,learning_rate,samples,bad,lost,sum,gradient_norm,clip_scale,"
      "targets_per_second";
  for (const LossRow& row : loss_rows()) line += fmt::format(",{0},{0}_share", row.name);
  return line + "\n";
}

std::string with_columns_of_now(const std::string& steps_csv) {
  std::string all = steps_header();
  if (steps_csv.starts_with(all)) return steps_csv;
  const CsvColumns had(steps_csv), now(all);
  for (std::size_t i = 0; i < had["step"].size(); ++i) {
    std::string line;
    for (const std::string& name : now.names)
      line += fmt::format(",{:.10g}", had[name].size() > i ? had[name][i] : 0.0);
    all += line.substr(1) + "\n";
  }
  return all;
}

std::string StepWindow::take_line(const Trainer& trainer, const TrainingCounts& counts, double seconds) {
  const double n = std::max(count_, 1);
  std::string line = fmt::format("{},{:.4f},{:.1f},{:.4g},{},{},{},{:.6g},{:.4g},{:.4g},{:.4g}", counts.step,
                                 progress_of(trainer), seconds, rate_, count_, bad_, counts.lost, sum_ / n, norm_ / n,
                                 scale_ / n, trainer.teacher ? trainer.teacher->tally().rate() : 0);
  terms_.resize(loss_rows().size());
  for (const Term& term : terms_) line += fmt::format(",{:.6g},{:.4f}", term.value / n, term.gradient / n);
  const double mean = mean_sum();
  *this = {};
  last_mean_ = mean;
  return line + "\n";
}

std::string measures_header() {
  return "step,seconds,worn_closed,worn_excess,worn_log_excess,worn_rms,minimised_closed,minimised_excess,"
         "minimised_log_excess,minimised_rms,finite,frames,energy,strain,strain_99,strain_most,deep,deepest,kinetic,"
         "jitter,pairs,pairs_at_end,volume,taught_distance\n";
}

std::string measure_line(const TrainingMeasure& m, double seconds) {
  const auto gap = [](const GapMeasure& g) {
    return fmt::format("{:.4f},{:.6g},{:.3f},{:.5g}", g.closed, g.excess, g.log_excess, g.rms);
  };
  const RollMeasure& r = m.roll;
  return fmt::format(
      "{},{:.1f},{},{},{:d},{},{:.6g},{:.5f},{:.5f},{:.4f},{:.5f},{:.5f},{:.6g},{:.6g},{:.2f},{},{:.4g},{:.4g}\n",
      m.step, seconds, gap(m.skinned), gap(m.minimised), r.finite, r.frames, r.energy, r.strain, r.strain_99,
      r.strain_most, r.deep, r.deepest, r.kinetic, r.jitter, r.pairs, r.pairs_at_end, 1e6 * r.volume, m.taught);
}

}  // namespace selvedge
