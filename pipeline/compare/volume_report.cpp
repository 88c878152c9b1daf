#include "pipeline/compare/volume_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "pipeline/compare/svg_plots.hpp"
#include "pipeline/host/write_file.hpp"

namespace selvedge {
namespace {

// The columns of a table by frame behind the first.
std::vector<PlotCurve> volume_curves(const std::string& csv) {
  std::vector<PlotCurve> curves;
  std::istringstream lines(csv);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string word;
    std::getline(words, word, ',');
    const bool names = word == "frame";
    for (std::size_t k = 0; std::getline(words, word, ','); ++k)
      if (names)
        curves.push_back({word, {}});
      else if (!word.empty() && k < curves.size())
        curves[k].y.push_back(1e3 * std::stod(word));
  }
  return curves;
}

}  // namespace

std::string write_volume_report(const std::vector<KeptRun>& runs, const std::string& baseline,
                                const std::filesystem::path& folder) {
  std::vector<VolumeSequence> sequences;
  std::vector<std::string> groups;
  for (const KeptRun& run : runs) {
    sequences.push_back({run.row, run.group, run.sequence, volume_findings(run.trajectory), run.frames_a_second});
    if (std::ranges::find(groups, run.group) == groups.end()) groups.push_back(run.group);
  }
  const std::string table = volume_table(volume_summaries(sequences, baseline), baseline);
  write_file(folder / "volume.txt", table);
  for (const std::string& group : groups) {
    const std::string csv = volume_by_frame_csv(sequences, group);
    write_file(folder / fmt::format("volume_{}.csv", group), csv);
    write_file(folder / fmt::format("volume_{}.svg", group),
               curves_svg("L_sc by frame, mean over sequences [mJ]: " + group, "frame", volume_curves(csv), true));
  }
  return table;
}

}  // namespace selvedge
