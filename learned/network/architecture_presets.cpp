#include "collision/geometry/error.hpp"
#include "learned/network/architecture.hpp"

namespace selvedge {
namespace {

void add_edges(Architecture& a, const std::string& encoder, int inputs, int normalised,
               const std::vector<std::string>& keys) {
  for (const std::string& key : keys) a.edge_kinds.push_back({key, static_cast<int>(a.encoders.size()), normalised});
  a.encoders.push_back({encoder, inputs});
}

void add_steps(Architecture& a, int count, const MessageStep& step) { a.steps.insert(a.steps.end(), count, step); }

// Three steps each on: mesh and c0, c0 and c1, c1 alone, and back. `down1` and `down2` say near which edges those to
// the body are kept on the way down.
void add_hierarchy(Architecture& a, const EdgeFilter& down1, const EdgeFilter& down2) {
  const MessageStep fine{{"coarse_edge0", "mesh_edge", "world_edge"}, {}};
  const MessageStep middle{{"coarse_edge0", "coarse_edge1", "world_edge"}, {down1}};
  const MessageStep coarse{{"coarse_edge1", "world_edge"}, {down1, down2}};
  for (const MessageStep& step : {fine, middle, coarse, middle, fine}) add_steps(a, 3, step);
}

// HOOD (Grigorev et al. 2023), models/postcvpr.py. coarse_edge2 is encoded and never used (row 5).
Architecture hood() {
  Architecture a;
  a.name = "hood";
  a.node_inputs = 24;
  add_edges(a, "mesh", 12, 9, {"mesh_edge"});
  add_edges(a, "world", 9, 9, {"world_edge"});
  for (const std::string level : {"0", "1", "2"}) add_edges(a, "coarse" + level, 12, 9, {"coarse_edge" + level});
  add_hierarchy(a, {"world_edge", {"coarse_edge0", "coarse_edge1"}}, {"world_edge", {"coarse_edge1"}});
  a.node_type = {9, 9};
  a.vertex_level = {4, 4};
  a.statistics = {.node = 21, .mesh_edge = 9, .world_edge = 9};  // coarse edges share those of the mesh
  a.features = hood_features();
  return a;
}

// models/cvpr.py: one encoder for all coarse edges, and going down looks at one level only.
Architecture hood_cvpr() {
  Architecture a = hood();
  a.name = "hood_cvpr";
  a.features = hood_cvpr_features();
  a.encoders.clear();
  a.edge_kinds.clear();
  a.steps.clear();
  add_edges(a, "mesh", 12, 9, {"mesh_edge"});
  add_edges(a, "world", 9, 9, {"world_edge"});
  add_edges(a, "coarse", 12, 9, {"coarse_edge0", "coarse_edge1", "coarse_edge2"});
  add_hierarchy(a, {"world_edge", {"coarse_edge0"}}, {"world_edge", {"coarse_edge1"}});
  return a;
}

// models/baselines.py: no coarse level, so no embedding of levels either.
Architecture fine(const std::string& name, int steps) {
  Architecture a;
  a.name = name;
  a.node_inputs = 20;
  add_edges(a, "mesh", 12, 9, {"mesh_edge"});
  add_edges(a, "world", 9, 9, {"world_edge"});
  add_steps(a, steps, {{"mesh_edge", "world_edge"}, {}});
  a.node_type = {9, 9};
  a.features = fine_features();
  a.statistics = {.node = 17, .mesh_edge = 9, .world_edge = 9};
  return a;
}

// ContourCraft (Grigorev et al. 2024) with the coarse levels `encoded`, of which every step uses `used`.
Architecture contour(const std::string& name, const FeatureOptions& features, const std::vector<std::string>& encoded,
                     const std::vector<std::string>& used) {
  Architecture a;
  a.name = name;
  a.node_inputs = 24;
  add_edges(a, "mesh", 9, 5, {"mesh_edge"});
  add_edges(a, "repulsion", 20, 16, {"repulsion_edge"});
  add_edges(a, "attraction", 20, 16, {"attraction_edge"});
  add_edges(a, "body", 13, 12, {"body_edge"});
  for (const std::string& level : encoded) add_edges(a, "coarse" + level, 9, 5, {"coarse_edge" + level});
  MessageStep step{{"attraction_edge", "body_edge"}, {}};
  for (const std::string& level : used) step.edge_keys.push_back("coarse_edge" + level);
  step.edge_keys.insert(step.edge_keys.end(), {"mesh_edge", "repulsion_edge"});
  add_steps(a, 15, step);
  a.node_type = {4, 9};
  a.vertex_level = {static_cast<int>(encoded.size()) + 1, 4};
  a.edge_type = {4, 4};
  a.statistics = {.node = 20, .mesh_edge = 5, .coarse_edge = 5, .world_edge = 16, .body_edge = 12};
  a.features = features;
  a.integration = Integration::start_flag;
  return a;
}

// Ours, for two cores (reference/training.md, "Recommended small preset"). Node inputs: velocity 3, pinned 1, normal 3,
// time step 1, log mass 1 | bending, mu, lambda 3; nearest body face: normal 3, offset now 3 and next 3, signed
// distance at x and at x + v 2, its motion 3, near 1; the objective's preconditioned gradient 3; move so far 3, pass 1.
// Edge inputs: x_s - x_t 3, norm, rest length, strain at x and at x + v. `features` says only how its levels are built
// so far: what it reads beside them comes with training.
Architecture small_preset() {
  Architecture a;
  a.name = "small";
  a.width = 64;
  a.hidden_layers = 1;
  a.node_inputs = 34;
  add_edges(a, "mesh", 7, 7, {"mesh_edge"});
  for (const std::string level : {"0", "1"}) add_edges(a, "coarse" + level, 7, 7, {"coarse_edge" + level});
  add_steps(a, 6, {{"coarse_edge0", "coarse_edge1", "mesh_edge"}, {}});
  a.statistics = {.node = 34, .mesh_edge = 7, .coarse_edge = 7};
  a.features.coarse_levels = 2;
  a.features.coarse_sets = {0, 1};
  a.features.body_key.clear();
  a.passes = 2;
  return a;
}

}  // namespace

std::vector<std::string> preset_names() {
  return {"hood", "hood_cvpr", "fine15", "fine48", "contourcraft", "contourcraft_paper", "small"};
}

Architecture architecture_preset(const std::string& name) {
  if (name == "hood") return hood();
  if (name == "hood_cvpr") return hood_cvpr();
  if (name == "fine15") return fine(name, 15);
  if (name == "fine48") return fine(name, 48);
  // The released code uses the fourth level only; the paper speaks of two levels (reference/learned.md, 1.6).
  if (name == "contourcraft") return contour(name, contourcraft_features(), {"0", "1", "2", "3"}, {"3"});
  if (name == "contourcraft_paper") return contour(name, contourcraft_paper_features(), {"0", "1"}, {"0", "1"});
  if (name == "small") return small_preset();
  std::string known;
  for (const std::string& preset : preset_names()) known += (known.empty() ? "" : ", ") + preset;
  throw Error("no network of this name", name, "choose one of " + known);
}

}  // namespace selvedge
