#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "learned/repulsion/plain_network.hpp"

namespace selvedge {

// The checkpoint of a training stage, and its result at the end.
struct StagePart {
  std::string name;
  PlainNetwork network;
  PlainAdam adam;
};
struct StageFile {
  std::string config;  // configuration of the run
  long step = 0;
  double seconds = 0;
  std::uint64_t random = 0;  // state of the random stream
  std::string csv;           // lines of the table so far
  std::vector<StagePart> parts;
  std::map<std::string, std::vector<double>> numbers;  // further numbers by name

  const StagePart* find(const std::string& name) const;
};

// Writes a new file and renames it. Both throw Error, also for a file with bad content.
void write_stage_file(const std::filesystem::path&, const StageFile&);
StageFile read_stage_file(const std::filesystem::path&);

}  // namespace selvedge
