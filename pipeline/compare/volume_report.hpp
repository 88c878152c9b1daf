#pragma once

#include <filesystem>

#include "pipeline/compare/volume_table.hpp"

namespace selvedge {

// A stored run of a row. Its sequence is the motion that it shares with other rows.
struct KeptRun {
  std::string row, group, sequence;
  std::filesystem::path trajectory;
  double frames_a_second = 0;
};

// What the rows leave of self-penetration, all by one measure on the stored runs: volume.txt, and for each group
// volume_GROUP.csv and .svg with L_sc by frame. Returns the table. Takes some milliseconds a frame.
std::string write_volume_report(const std::vector<KeptRun>&, const std::string& baseline,
                                const std::filesystem::path& folder);

}  // namespace selvedge
