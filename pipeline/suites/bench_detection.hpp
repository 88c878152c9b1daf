#pragma once

#include <optional>
#include <string>
#include <vector>

namespace selvedge {

// Discrete detection of one cloth with itself, once it has moved: boxes, refit, search and exact tests.
struct DetectionTiming {
  std::string shape;
  int triangles = 0, pairs = 0;
  double ours = 0;            // median [s]
  std::optional<double> fcl;  // the same question to FCL, where the build has it [s]
  int other_pairs = 0;        // found by one of the two alone
};

// Times three shapes (drape, pile, crossing) of 20,000 and 80,000 triangles each; with FCL where the build has it.
std::vector<DetectionTiming> time_detection();

// For people.
std::string detection_table(const std::vector<DetectionTiming>&);

}  // namespace selvedge
