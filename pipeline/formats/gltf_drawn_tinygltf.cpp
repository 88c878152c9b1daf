#include "pipeline/formats/gltf_drawn_tinygltf.hpp"

#include <tiny_gltf.h>

#include <algorithm>

namespace selvedge {
namespace {

bool is_hidden(const tinygltf::Node& node) {
  const auto extension = node.extensions.find("KHR_node_visibility");
  if (extension == node.extensions.end() || !extension->second.Has("visible")) return false;
  const tinygltf::Value& visible = extension->second.Get("visible");
  return visible.IsBool() && !visible.Get<bool>();
}

bool is_root(const tinygltf::Model& model, int node) {
  return std::ranges::count(model.scenes[static_cast<std::size_t>(model.defaultScene)].nodes, node) > 0;
}

}  // namespace

GltfDrawn drawn_nodes(const tinygltf::Model& model) {
  const std::vector<tinygltf::Node>& nodes = model.nodes;
  std::vector<int> parent(nodes.size(), -1);
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (const int child : nodes[i].children) parent[static_cast<std::size_t>(child)] = static_cast<int>(i);
  std::vector<char> joint(nodes.size(), 0);
  for (const tinygltf::Skin& skin : model.skins)
    for (const int node : skin.joints)
      if (node >= 0 && node < std::ssize(nodes)) joint[static_cast<std::size_t>(node)] = 1;
  const bool scened = model.defaultScene >= 0 && model.defaultScene < std::ssize(model.scenes);
  GltfDrawn all{std::vector<char>(nodes.size(), 1), std::vector<char>(nodes.size(), 0)};
  bool skinned = false;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    bool on_joint = false, rooted = !scened;
    for (int at = static_cast<int>(i); at >= 0; at = parent[static_cast<std::size_t>(at)]) {
      const auto node = static_cast<std::size_t>(at);
      if (is_hidden(nodes[node])) all.drawn[i] = 0;
      on_joint = on_joint || joint[node];
      rooted = rooted || is_root(model, at);
    }
    if (!rooted) all.drawn[i] = 0;
    skinned = skinned || (all.drawn[i] && nodes[i].mesh >= 0 && nodes[i].skin >= 0);
    all.rigid[i] = all.drawn[i] && nodes[i].mesh >= 0 && nodes[i].skin < 0 && on_joint;
  }
  if (!skinned) all.drawn.assign(nodes.size(), 1);
  return all;
}

}  // namespace selvedge
