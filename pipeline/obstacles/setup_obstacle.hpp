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
  std::function<Points(double time)> at;            // positions wanted at a time [s]
  std::function<BodyFrame(double time)> body = {};  // empty: it is no body
  std::optional<double> ends = {};                  // when its file's motion does [s]; empty: there is none
};

// The name given, or that of its place in the list.
std::string obstacle_name(const Config& section, std::size_t index);

// An obstacle that is no skinned body (setup_body.hpp). `folder` is the scene file's; warnings are added.
ObstaclePart read_obstacle(const Config& section, std::size_t index, const std::filesystem::path& folder,
                           std::vector<std::string>& warnings);

// Vertex positions of a body that changes shape, the same faces in all frames.
struct Sequence {
  std::vector<Points> frames;
  Triangles triangles;
  SampleTimes times;  // of the frames
};
Points sequence_at(const Sequence&, double time);  // linear between frames, held at both ends

// A `sequence` section; throws Error naming the file whose faces differ from the first one's. What files do not say of
// their times, and numbers that are missing among them, are warned of.
Sequence read_sequence(const Config& section, const std::filesystem::path& folder, std::vector<std::string>& warnings);

// A `trajectory` section: a cloth or an obstacle of an earlier run. Frames of rejected steps are left out.
Sequence read_recorded(const Config& section, const std::filesystem::path& folder, std::vector<std::string>& warnings);

}  // namespace selvedge
