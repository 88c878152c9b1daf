#pragma once

#include <filesystem>
#include <functional>

#include "physics/scene.hpp"
#include "pipeline/config.hpp"

namespace selvedge {

struct ObstaclePart {
  Obstacle obstacle;
  std::function<Points(double time)> at;  // positions wanted at a time [s]
};

// `folder` is the scene file's; warnings are added.
ObstaclePart read_obstacle(const Config& section, const std::string& default_name, const std::filesystem::path& folder,
                           std::vector<std::string>& warnings);

// An obstacle with a `body` section: a skinned body in the poses of its clip. Without a name.
ObstaclePart read_performer(const Config& section, const std::filesystem::path& folder);

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
