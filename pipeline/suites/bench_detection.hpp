#pragma once

#include <optional>
#include <string>
#include <vector>

#include "collision/geometry/surface.hpp"

namespace selvedge {

// Discrete detection of one cloth with itself, once it has moved: boxes, refit, search and exact tests.
struct DetectionTiming {
  std::string shape;
  int triangles = 0, pairs = 0;
  double ours = 0;            // median [s]
  std::optional<double> fcl;  // the same question to FCL, where the build has it [s]
  int other_pairs = 0;        // found by one of the two alone
};

// Shapes of n x n squares: `drape`, a sheet over a ball with hanging folds; `pile`, eight layers 4 mm apart with a
// crease between each two; `crossing`, the same with waves in which the layers pass through each other.
struct DetectionShape {
  std::string name;
  Triangles triangles;
  Points x;
};
std::vector<DetectionShape> detection_shapes(int n);

// Times each shape at each size; with FCL where the build has it.
std::vector<DetectionTiming> time_detection(const std::vector<int>& sizes = {100, 200});

// For people.
std::string detection_table(const std::vector<DetectionTiming>&);

}  // namespace selvedge
