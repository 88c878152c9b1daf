#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "pipeline/tools/check_volume.hpp"

namespace selvedge {

// What a row (a network, a solver) left of self-penetration in one sequence. Its group is what tables are split by,
// such as the garment. Sequences of one name are the same motion for every row.
struct VolumeSequence {
  std::string row, group, sequence;
  VolumeFindings found;
  double frames_a_second = std::numeric_limits<double>::quiet_NaN();
};

// A mean over sequences with its interval of 95 % by a bootstrap over them; of one sequence there is none.
struct MeanInterval {
  double mean = 0, low = 0, high = 0;
};
MeanInterval mean_interval(const std::vector<double>& values, int resamples, std::uint64_t seed);

// The means of a row in a group. All frames of a sequence count alike, and so do all sequences.
struct VolumeSummary {
  std::string row, group;
  int sequences = 0;
  long frames = 0;
  MeanInterval loss, above_tenth, above_hundredth;           // net L_sc [J], parts of the frames above 0.1 and 0.01
  MeanInterval loss_as_published;                            // with the start and the fans [J]
  MeanInterval volume;                                       // a frame [m^3]
  MeanInterval pairs, contours, enclosed, open, unassigned;  // a frame; what is not orientable counts as unassigned
  MeanInterval ratio;  // to the baseline: geometric mean of (net L_sc + 1e-3) / (its + 1e-3) over common sequences
  double frames_a_second = 0;
};

// Rows in the order in which they first come, each with its groups. The ratio is 1 where the baseline is the row itself
// or not there. The same numbers every time.
std::vector<VolumeSummary> volume_summaries(const std::vector<VolumeSequence>&, const std::string& baseline,
                                            int resamples = 10000, std::uint64_t seed = 1);

// Tables 1 and 4 of Liao et al. 2024, a group after another.
std::string volume_table(const std::vector<VolumeSummary>&, const std::string& baseline);

// L_sc by frame as published, means over the sequences of a row and group; a line a frame, a column a row.
std::string volume_by_frame_csv(const std::vector<VolumeSequence>&, const std::string& group);

}  // namespace selvedge
