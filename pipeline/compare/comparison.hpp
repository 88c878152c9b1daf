#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/scene/kinds.hpp"

namespace selvedge {

struct CompareScene {
  std::string name;
  std::filesystem::path file;
  std::vector<std::string> overrides;  // key=value
  int states = 4;                      // common states, spread over the run
  int horizon = 6;                     // frames from each of them
};

struct CompareSetting {
  std::string name;
  std::vector<std::string> overrides;
};

// A comparison file, read.
struct Comparison {
  std::filesystem::path file;
  std::vector<CompareScene> scenes;
  std::vector<CompareSetting> settings;
  std::vector<std::string> reference;  // overrides of the temporal reference, beside its time step
  Kinds kinds = known_kinds();         // of steppers
  int repeats = 3;
  double jitter = 1e-3;  // of the common states for the floor, in mean edge lengths
};

// Throws Error with file, line and key. short_form: with the file's own `short_form` and that of every scene.
Comparison read_comparison(const std::filesystem::path&, bool short_form);

}  // namespace selvedge
