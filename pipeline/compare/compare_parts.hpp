#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/compare/compare_reference.hpp"

namespace selvedge {

// One timed run of a setting on a scene.
struct CompareRun {
  std::string trouble;          // empty: came to its end
  std::vector<double> seconds;  // a frame
  long substeps = 0, newton = 0, linear = 0, passed_through = 0;
  int pairs = -1;                          // worst frame
  double lost = 0;                         // energy [J]
  std::uint64_t end = 0;                   // hash of the last positions
  std::map<std::string, double> measures;  // of RunMeasures
  std::map<std::string, double> phases;    // median milliseconds a frame
  std::vector<int> pairs_by_frame;         // of cloth, the start's first
};

// The parts of a comparison as they are kept, each with its key. Absent where the text is none or has another key.
std::string part_json(const CompareFloor&, const std::string& key);
std::string part_json(const CompareErrors&, const std::string& key);
std::string part_json(const CompareRun&, const std::string& key);
std::optional<CompareFloor> read_floor(const std::string& json, const std::string& key);
std::optional<CompareErrors> read_errors(const std::string& json, const std::string& key);
std::optional<CompareRun> read_run(const std::string& json, const std::string& key);

}  // namespace selvedge
