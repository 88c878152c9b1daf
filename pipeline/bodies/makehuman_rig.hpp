#pragma once

#include <filesystem>
#include <string>
#include <vector>

// A skeleton and weights as MakeHuman stores them, JSON: .mhskel and .mhw.
namespace selvedge {

struct RigBone {
  std::string name;
  int parent = -1;        // index of a bone; -1: none
  std::vector<int> head;  // vertices of the base mesh: the bone begins at their mean
};

// Reads the bones of a skeleton, in the order of their names, from bones/NAME/{parent, head} and joints/HEAD. Throws
// Error with the file and the line for text that is not JSON; with the place in it for values that are missing or of a
// wrong kind, parents that are no bones, and cycles of bones.
std::vector<RigBone> read_rig_bones(const std::filesystem::path&);

struct RigWeight {
  int bone = 0, vertex = 0;  // vertex of the base mesh
  double weight = 0;         // 0 to 1
};

// Reads weights/BONE: [[vertex, weight], ...]. Throws Error likewise, also for bones that the skeleton lacks and for
// weights out of range.
std::vector<RigWeight> read_rig_weights(const std::filesystem::path&, const std::vector<RigBone>&);

}  // namespace selvedge
