#pragma once

#include <vector>

namespace tinygltf {
class Model;
}

namespace selvedge {

// What a glTF file shows, of each of its nodes; their tree must have been checked.
struct GltfDrawn {
  std::vector<char> drawn;  // in the file's own scene, and neither hidden (KHR_node_visibility) nor below such a node
  std::vector<char> rigid;  // drawn, with a mesh that has no skin and hangs on a joint of one
};

// Where the file names no scene, or shows no mesh with a skin, all nodes are drawn.
GltfDrawn drawn_nodes(const tinygltf::Model&);

}  // namespace selvedge
