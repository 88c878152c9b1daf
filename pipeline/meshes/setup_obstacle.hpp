#pragma once

#include <filesystem>
#include <functional>

#include "physics/scene/scene.hpp"
#include "physics/scene/stepper.hpp"
#include "pipeline/config/config.hpp"

namespace selvedge {

struct ObstaclePart {
  Obstacle obstacle;
  std::function<Points(double time)> at;            // positions wanted at a time [s]
  std::function<BodyFrame(double time)> body = {};  // empty: it is no body
};

// The name given, or that of its place in the list.
std::string obstacle_name(const Config& section, std::size_t index);

// An obstacle that is no skinned body (setup_body.hpp). `folder` is the scene file's; warnings are added.
ObstaclePart read_obstacle(const Config& section, std::size_t index, const std::filesystem::path& folder,
                           std::vector<std::string>& warnings);

// Vertex positions of a body that changes shape: frames at a steady rate, the same faces in all.
struct Sequence {
  std::vector<Points> frames;
  Triangles triangles;
  double fps = 30;
};
Points sequence_at(const Sequence&, double time);  // linear between frames, held at both ends

// A `sequence` section; throws Error naming the file whose faces differ from the first one's.
Sequence read_sequence(const Config& section, const std::filesystem::path& folder, std::vector<std::string>& warnings);

// A `trajectory` section: a cloth or an obstacle of an earlier run.
Sequence read_recorded(const Config& section, const std::filesystem::path& folder);

}  // namespace selvedge
