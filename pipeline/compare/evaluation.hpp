#pragma once

#include <string>
#include <vector>

#include "pipeline/compare/compare_result.hpp"
#include "pipeline/compare/comparison.hpp"

namespace selvedge {

// A row's pairs over the baseline's on the same sequences: the geometric mean of (pairs + 1) / (baseline's pairs + 1),
// where pairs are means over frames, with the interval of 95 % by a bootstrap over sequences.
struct PairedRatio {
  std::string row, baseline;
  int sequences = 0;  // that both have
  double ratio = unknown, low = unknown, high = unknown;
  // Fewer than 6 sequences cannot show 95 %: five fair coins all fall on one side once in 16 throws.
  bool apart() const { return sequences >= 6 && (low > 1 || high < 1); }
};

// Percentiles 2.5 and 97.5 of the resampled means; the same numbers for the same seed.
PairedRatio paired_ratio(const std::vector<double>& pairs, const std::vector<double>& baseline, int resamples,
                         std::uint64_t seed = 1);

// A row over sequences. `left` is the mean over tangled sequences of pairs over the first frame's, by frame.
struct EvaluatedRow {
  std::string row;
  std::string trouble;  // why it was left out
  int sequences = 0, failed = 0;
  // Means over frames and sequences, in the order of Evaluation::outfits.
  std::vector<double> pairs_of_outfit, strain_of_outfit, strain_99_of_outfit;
  double pairs = unknown, body_pairs = unknown;              // over all: of cloth, and of cloth with bodies
  double at_0 = unknown, at_50 = unknown, at_150 = unknown;  // pairs in these frames, of tangled sequences
  std::vector<double> left;
  double frames_a_second = unknown;  // median
  double strain = unknown, strain_99 = unknown, depth = unknown, kinetic_ratio = unknown, jitter_ratio = unknown;
};

struct Evaluation {
  std::string baseline;
  std::vector<std::string> outfits;
  std::vector<int> vertices;  // of them
  int tangled = 0;            // of the sequences, with pairs where they start
  std::string machine;        // that has timed most of them: speeds are of these alone
  int timed_elsewhere = 0;    // sequences that other machines have timed
  std::vector<EvaluatedRow> rows;
  std::vector<PairedRatio> ratios;                                                          // of every two rows
  std::vector<std::pair<std::string, std::vector<std::pair<std::string, double>>>> speeds;  // of a row: outfit, fps
  std::string shown;  // the sequence whose pairs are shown by frame
  std::vector<std::pair<std::string, std::vector<int>>> by_frame;
};

// The machine that has timed most scenes: times of others are not to be compared with its.
std::string machine_of_most(const std::vector<CompareRow>&);

// The evaluation of the finished rows, for people and as JSON. A row without a result keeps its trouble.
Evaluation evaluated(const Comparison&, const std::vector<CompareFloor>&, const std::vector<CompareRow>&);
std::string evaluation_text(const Evaluation&);
std::string evaluation_json(const Evaluation&);

}  // namespace selvedge
