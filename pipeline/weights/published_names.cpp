#include "pipeline/weights/published_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <sstream>

namespace selvedge {
namespace {

const std::string learned_prefix = "model._learned_model.";

bool any_begins(const std::vector<std::string>& tensors, const std::string& beginning) {
  return std::ranges::any_of(tensors, [&](const std::string& name) { return name.starts_with(beginning); });
}

std::vector<std::string> parts_between_slashes(const std::string& path) {
  std::istringstream rest(path);
  std::vector<std::string> parts;
  for (std::string part; std::getline(rest, part, '/');) parts.push_back(part);
  return parts;
}

bool is_fine(const Architecture& a) { return a.name.starts_with("fine"); }

// Published models group their steps: HOOD has three per level, ContourCraft all in one.
std::string step_prefix(const Architecture& a, int step) {
  if (is_fine(a)) return fmt::format("processor_steps.{}.", step);
  if (a.name == "hood_cvpr") return fmt::format("processor_steps{}.{}.", step / 3 + 1, step % 3);
  if (a.name == "hood") return fmt::format("levels.{}.{}.", step / 3, step % 3);
  return fmt::format("levels.0.{}.", step);
}

std::string edge_network(const Architecture& a, const std::string& key) {
  return is_fine(a) ? key + "_processor" : "edge_processor_dict." + key;
}

std::string node_network(const Architecture& a) { return is_fine(a) ? "node_processor" : "node_processor_dict.node"; }

// layer1/weight is layers.2.weight, because activations between the layers are counted. A perceptron with a layer norm
// is a pair of both.
std::string inside_perceptron(const std::string& group, const std::string& field, bool pair) {
  if (group == "norm") return field == "scale" ? ".1.weight" : ".1.bias";
  return fmt::format("{}.layers.{}.{}", pair ? ".0" : "", 2 * std::atoi(group.c_str() + 5), field);
}

}  // namespace

std::string published_kind(const std::vector<std::string>& tensors) {
  if (!any_begins(tensors, learned_prefix)) return "";
  if (any_begins(tensors, "model.edgetype_embedding.")) return "contourcraft";
  if (any_begins(tensors, learned_prefix + "levels.")) return "hood";
  if (any_begins(tensors, learned_prefix + "processor_steps1.")) return "hood_cvpr";
  if (!any_begins(tensors, learned_prefix + "processor_steps.")) return "";
  return fine_steps(tensors) == 48 ? "fine48" : "fine15";
}

int fine_steps(const std::vector<std::string>& tensors) {
  int steps = 0;
  while (steps <= 64 && any_begins(tensors, fmt::format("{}processor_steps.{}.", learned_prefix, steps))) ++steps;
  return steps;
}

std::string published_name(const Architecture& a, const std::string& name) {
  const std::vector<std::string> parts = parts_between_slashes(name);
  const std::string &group = parts[parts.size() - 2], &field = parts.back();
  if (parts[0] == "embeddings") {
    if (field == "node_type") return "model.nodetype_embedding.weight";
    return field == "edge_type" ? "model.edgetype_embedding.weight" : "model.vertexlevel_embedding.weight";
  }
  if (parts[0] == "node_encoder" || parts[0] == "decoder")
    return learned_prefix + parts[0] + inside_perceptron(group, field, parts[0] == "node_encoder");
  if (parts[0] == "encoders")
    return learned_prefix + "edgeset_encoders." + parts[1] + inside_perceptron(group, field, true);
  const std::string network = parts[2] == "edges" ? edge_network(a, parts[3]) : node_network(a);
  return learned_prefix + step_prefix(a, std::atoi(parts[1].c_str())) + network + inside_perceptron(group, field, true);
}

PublishedSums published_sums(const std::string& set) {
  const std::string prefix = "model._" + set + "_normalizer._";
  return {prefix + "acc_count", prefix + "num_accumulations", prefix + "acc_sum", prefix + "acc_sum_squared"};
}

}  // namespace selvedge
