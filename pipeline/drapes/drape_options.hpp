#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/config/options.hpp"

namespace selvedge {

// Drapes at rest of one garment on the mannequin, in poses, shapes and styles that are drawn at random. They go along
// paths: one shape and one style each, and pose after pose, each drape from the last one.
struct DrapeOptions {
  std::string name;                // of the set; empty: the file's
  std::string garment = "tshirt";  // by code
  double edge = 0.025;             // of its triangles [m]
  std::uint64_t seed = 1;
  int poses = 10;               // of a path
  int training = 15, test = 4;  // paths
  // Poses along procedural clips in place of drawn ones: every one of `shapes` bodies in every clip is a path.
  std::vector<std::string> clips, test_clips;
  int shapes = 5;
  double pose_range = 1;        // of the ranges of the joints' angles
  double shape_spread = 0.7;    // standard deviation of the shape's coefficients
  double style_spread = 1;      // of the styles' ranges; 0: all alike
  double fps = 30;              // of the simulation
  int move_frames = 16;         // from pose to pose
  int settle_frames = 14;       // before a drape is looked at
  int most_settle_frames = 60;  // before it counts as not at rest
  double rest_speed = 0.03;     // of the fastest hundredth of the vertices, below which it is at rest [m/s]
  double friction = 0.1;        // with the body; little, so that a drape tells little of its path
  double damping = 6;           // of the mass [1/s]
  double thickness = 0.003;     // that cloth keeps from the body [m]
};

// The table of a data file; a file read (throws Error, also for an unknown garment); and the options as YAML.
const Options<DrapeOptions>& drape_options();
DrapeOptions read_drape_options(const std::filesystem::path&, const std::vector<std::string>& overrides = {});
std::string drape_yaml(const DrapeOptions&);
std::string drape_reference();  // its section as Markdown

}  // namespace selvedge
