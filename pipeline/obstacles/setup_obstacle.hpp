#pragma once

#include <filesystem>
#include <functional>
#include <optional>

#include "physics/scene/scene.hpp"
#include "physics/scene/stepper.hpp"
#include "pipeline/config/config.hpp"
#include "pipeline/shapes/sample_times.hpp"

namespace selvedge {

struct ObstaclePart {
  Obstacle obstacle;
  std::function<Points(double time)> at;            // wanted positions at a time [s]
  std::function<BodyFrame(double time)> body = {};  // empty: not a body
  std::optional<double> ends = {};                  // end of its file's motion [s]; absent: no motion
};

// The name in the section, or one made of its index.
std::string obstacle_name(const Config& section, std::size_t index);

// Reads an obstacle that is not a skinned body (setup_body.hpp). `folder` is the scene file's. Adds warnings.
ObstaclePart read_obstacle(const Config& section, std::size_t index, const std::filesystem::path& folder,
                           std::vector<std::string>& warnings);

// Vertex positions of a deforming mesh with the same faces in all frames.
struct Sequence {
  std::vector<Points> frames;
  Triangles triangles;
  SampleTimes times;  // of the frames
};
Points sequence_at(const Sequence&, double time);  // linear between frames, held at both ends

// Reads a `sequence` section. Throws Error, naming the file, if its faces differ from the first one's. Warns of missing
// times and missing numbers of files.
Sequence read_sequence(const Config& section, const std::filesystem::path& folder, std::vector<std::string>& warnings);

// Reads a `trajectory` section: a cloth or an obstacle of an earlier run. Leaves out frames of rejected steps.
Sequence read_recorded(const Config& section, const std::filesystem::path& folder, std::vector<std::string>& warnings);

}  // namespace selvedge
