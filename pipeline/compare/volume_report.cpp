#include "pipeline/compare/volume_report.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "pipeline/host/csv_columns.hpp"
#include "pipeline/host/write_file.hpp"
#include "pipeline/plots/plot.hpp"

namespace selvedge {
namespace {

// All columns of a table by frame [mJ].
std::string volume_plot(const std::string& group, const std::string& csv) {
  const CsvColumns table(csv);
  Plot plot{"L_sc by frame, mean over sequences: " + group, {"frame"}, {"mJ", PlotScale::counts}};
  for (const std::string& name : table.names) {
    if (name == "frame") continue;
    std::vector<double> energies = table[name];
    for (double& energy : energies) energy *= 1e3;
    plot.curves.push_back({name, table["frame"], std::move(energies)});
  }
  return plot_svg(plot);
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
    write_file(folder / fmt::format("volume_{}.svg", group), volume_plot(group, csv));
  }
  return table;
}

}  // namespace selvedge
