#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/config/options.hpp"

namespace selvedge {

// Drapes at rest of one garment on the mannequin. Members are described where keys are bound to them:
// pipeline/drapes/drape_options.cpp.
struct DrapeOptions {
  std::string name;
  std::string garment = "tshirt";
  double edge = 0.025;
  std::uint64_t seed = 1;
  int poses = 10;
  int training = 15, test = 4;
  std::vector<std::string> clips, test_clips;
  int shapes = 5;
  double pose_range = 1, shape_spread = 0.7, style_spread = 1;
  double fps = 30;
  int move_frames = 16, settle_frames = 14, most_settle_frames = 60;
  double rest_speed = 0.03;
  double friction = 0.1;
  double damping = 6;
  double thickness = 0.003;
};

// The table of a data file; a file read (throws Error, also for an unknown garment); and the options as YAML.
const Options<DrapeOptions>& drape_options();
DrapeOptions read_drape_options(const std::filesystem::path&, const std::vector<std::string>& overrides = {});
std::string drape_yaml(const DrapeOptions&);
std::string drape_reference();  // its section as Markdown

}  // namespace selvedge
