#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "learned/repulsion/plain_adam.hpp"

namespace selvedge {

// All that one stage of a training goes on from, and what it has made when it has ended.
struct StagePart {
  std::string name;
  PlainNetwork network;
  PlainAdam adam;
};
struct StageFile {
  std::string config;  // of the run
  long step = 0;
  double seconds = 0;
  std::uint64_t random = 0;  // state of the stream
  std::string csv;           // lines of the table so far
  std::vector<StagePart> parts;
  std::map<std::string, std::vector<double>> numbers;  // further ones, by name

  const StagePart* find(const std::string& name) const;
};

// Written beside and renamed. Both throw Error; what is read is checked.
void write_stage_file(const std::filesystem::path&, const StageFile&);
StageFile read_stage_file(const std::filesystem::path&);

}  // namespace selvedge
