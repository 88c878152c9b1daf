#pragma once

#include <filesystem>
#include <string>
#include <vector>

// A skeleton and weights as MakeHuman stores them, JSON: .mhskel and .mhw.
namespace selvedge {

struct RigBone {
  std::string name;
  int parent = -1;        // among the bones; -1: hangs on none
  std::vector<int> head;  // vertices of the base mesh whose middle is where the bone begins
};

// Bones of a skeleton in the order of their names. Read are bones/NAME/{parent, head} and joints/HEAD. Throws Error
// with the file and what is wrong: the line for text that is not JSON, otherwise the place in it, for what is missing
// or of a wrong kind, parents that are no bones, and bones in a circle.
std::vector<RigBone> read_rig_bones(const std::filesystem::path&);

struct RigWeight {
  int bone = 0, vertex = 0;  // vertex of the base mesh
  double weight = 0;         // 0 to 1
};

// Read is weights/BONE: [[vertex, weight], ...]. Throws Error likewise, for bones that the skeleton lacks and for
// weights out of range.
std::vector<RigWeight> read_rig_weights(const std::filesystem::path&, const std::vector<RigBone>&);

}  // namespace selvedge
