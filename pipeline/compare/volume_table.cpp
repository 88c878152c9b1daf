#include "pipeline/compare/volume_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <random>

namespace selvedge {
namespace {

using OfSequence = std::function<double(const VolumeSequence&)>;

double per_frame(const VolumeSequence& s, double sum) {
  return sum / std::max<double>(1, static_cast<double>(s.found.loss_by_frame.size()));
}

// The logarithm of how a sequence's loss stands to the baseline's; a thousandth of a joule is what both can have alike.
constexpr double least_loss = 1e-3;
std::vector<double> log_ratios(const std::vector<const VolumeSequence*>& rows, const std::vector<VolumeSequence>& all,
                               const std::string& baseline) {
  std::vector<double> logs;
  for (const VolumeSequence* row : rows) {
    const auto other = std::ranges::find_if(all, [&](const VolumeSequence& s) {
      return s.row == baseline && s.group == row->group && s.sequence == row->sequence;
    });
    if (other != all.end())
      logs.push_back(std::log((row->found.mean_net_loss() + least_loss) / (other->found.mean_net_loss() + least_loss)));
  }
  return logs;
}

std::vector<std::string> in_order(const std::vector<VolumeSequence>& all, std::string VolumeSequence::*member) {
  std::vector<std::string> names;
  for (const VolumeSequence& s : all)
    if (std::ranges::find(names, s.*member) == names.end()) names.push_back(s.*member);
  return names;
}

double middle_of(std::vector<double> values) {
  std::erase_if(values, [](double v) { return !std::isfinite(v); });
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::ranges::sort(values);
  return values[values.size() / 2];
}

}  // namespace

MeanInterval mean_interval(const std::vector<double>& values, int resamples, std::uint64_t seed) {
  MeanInterval result;
  const std::size_t count = values.size();
  if (count == 0) return result;
  result.mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(count);
  result.low = result.high = result.mean;
  if (count < 2) return result;
  std::mt19937_64 random(seed);
  std::vector<double> means;
  for (int r = 0; r < resamples; ++r) {
    double sum = 0;
    for (std::size_t k = 0; k < count; ++k) sum += values[random() % count];
    means.push_back(sum / static_cast<double>(count));
  }
  std::ranges::sort(means);
  const auto at = [&](double part) {
    return means[static_cast<std::size_t>(std::lround(part * static_cast<double>(means.size() - 1)))];
  };
  result.low = at(0.025);
  result.high = at(0.975);
  return result;
}

std::vector<VolumeSummary> volume_summaries(const std::vector<VolumeSequence>& all, const std::string& baseline,
                                            int resamples, std::uint64_t seed) {
  std::vector<VolumeSummary> summaries;
  for (const std::string& group : in_order(all, &VolumeSequence::group))
    for (const std::string& row : in_order(all, &VolumeSequence::row)) {
      std::vector<const VolumeSequence*> rows;
      for (const VolumeSequence& s : all)
        if (s.row == row && s.group == group) rows.push_back(&s);
      if (rows.empty()) continue;
      const auto over = [&](const OfSequence& value) {
        std::vector<double> values;
        for (const VolumeSequence* s : rows) values.push_back(value(*s));
        return mean_interval(values, resamples, seed);
      };
      VolumeSummary summary;
      summary.row = row;
      summary.group = group;
      summary.sequences = static_cast<int>(rows.size());
      std::vector<double> speeds;
      for (const VolumeSequence* s : rows) {
        summary.frames += static_cast<long>(s->found.loss_by_frame.size());
        speeds.push_back(s->frames_a_second);
      }
      summary.frames_a_second = middle_of(std::move(speeds));
      summary.loss = over([](const VolumeSequence& s) { return s.found.mean_net_loss(); });
      summary.loss_as_published = over([](const VolumeSequence& s) { return s.found.mean_loss(); });
      summary.above_tenth = over([](const VolumeSequence& s) { return s.found.share_above(0.1); });
      summary.above_hundredth = over([](const VolumeSequence& s) { return s.found.share_above(0.01); });
      summary.volume = over([](const VolumeSequence& s) {
        const std::vector<double>& volumes = s.found.volume_by_frame;
        return per_frame(s, std::accumulate(volumes.begin(), volumes.end(), 0.0));
      });
      const auto count = [&](long VolumeFindings::*member) {
        return over([member](const VolumeSequence& s) { return per_frame(s, static_cast<double>(s.found.*member)); });
      };
      summary.pairs = count(&VolumeFindings::pairs);
      summary.contours = count(&VolumeFindings::contours);
      summary.enclosed = count(&VolumeFindings::enclosed);
      summary.open = count(&VolumeFindings::open);
      summary.unassigned = over([](const VolumeSequence& s) {
        return per_frame(s, static_cast<double>(s.found.unassigned + s.found.not_orientable));
      });
      const MeanInterval logs = mean_interval(log_ratios(rows, all, baseline), resamples, seed);
      summary.ratio = {std::exp(logs.mean), std::exp(logs.low), std::exp(logs.high)};
      summaries.push_back(std::move(summary));
    }
  return summaries;
}

std::string volume_table(const std::vector<VolumeSummary>& summaries, const std::string& baseline) {
  std::string text, group;
  const auto interval = [](const MeanInterval& m, double unit) {
    return fmt::format("{:.3g} [{:.3g}, {:.3g}]", unit * m.mean, unit * m.low, unit * m.high);
  };
  for (const VolumeSummary& s : summaries) {
    if (s.group != group || text.empty()) {
      group = s.group;
      text += fmt::format(
          "{}{}: L_sc is 3e4 x sum of 6 |V|, of the frames that were made, less that of the fans at "
          "rest; as published: of all frames, whole; intervals of 95 % over sequences\n",
          text.empty() ? "" : "\n", group);
      text += fmt::format(
          "  {:<22} {:>4} {:>6} {:>24} {:>24} {:>22} {:>22} {:>22} {:>22} {:>22} {:>22} {:>20} {:>20} {:>20} {:>8}\n",
          "", "seq", "frames", "L_sc [mJ]", "as published [mJ]", "% above 0.1", "% above 0.01", "cm3", "pairs",
          "contours", "enclosed", "open", "unassigned", "L_sc over " + baseline, "frames/s");
    }
    text += fmt::format(
        "  {:<22} {:>4} {:>6} {:>24} {:>24} {:>22} {:>22} {:>22} {:>22} {:>22} {:>22} {:>20} {:>20} {:>20} {:>8.1f}\n",
        s.row, s.sequences, s.frames, interval(s.loss, 1e3), interval(s.loss_as_published, 1e3),
        interval(s.above_tenth, 100), interval(s.above_hundredth, 100), interval(s.volume, 1e6), interval(s.pairs, 1),
        interval(s.contours, 1), interval(s.enclosed, 1), interval(s.open, 1), interval(s.unassigned, 1),
        interval(s.ratio, 1), s.frames_a_second);
  }
  return text;
}

std::string volume_by_frame_csv(const std::vector<VolumeSequence>& all, const std::string& group) {
  const std::vector<std::string> rows = in_order(all, &VolumeSequence::row);
  std::string text = "frame";
  std::size_t frames = 0;
  for (const std::string& row : rows) text += "," + row;
  for (const VolumeSequence& s : all)
    if (s.group == group) frames = std::max(frames, s.found.loss_by_frame.size());
  text += "\n";
  for (std::size_t f = 0; f < frames; ++f) {
    text += fmt::format("{}", f);
    for (const std::string& row : rows) {
      double sum = 0;
      int count = 0;
      for (const VolumeSequence& s : all) {
        if (s.row != row || s.group != group || f >= s.found.loss_by_frame.size()) continue;
        sum += s.found.loss_by_frame[f];
        ++count;
      }
      text += count > 0 ? fmt::format(",{:.6g}", sum / count) : ",";
    }
    text += "\n";
  }
  return text;
}

}  // namespace selvedge
