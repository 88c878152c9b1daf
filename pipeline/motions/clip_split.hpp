#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace selvedge {

// A procedural clip and what it is for. What is for validation is never trained on.
struct ClipEntry {
  std::string name;
  int frames = 0;
  bool validation = false;
};

// configs/clips.yaml. Throws Error with file and line, also for names that no procedural clip has or that come twice.
std::vector<ClipEntry> read_clip_split(const std::filesystem::path&);

}  // namespace selvedge
