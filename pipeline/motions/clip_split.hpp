#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace selvedge {

// A procedural clip and its use. Clips for validation are never trained on.
struct ClipEntry {
  std::string name;
  int frames = 0;
  bool validation = false;
};

// configs/clips.yaml. Throws Error with file and line, also for names that no procedural clip has and for repeated
// names.
std::vector<ClipEntry> read_clip_split(const std::filesystem::path&);

}  // namespace selvedge
