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

// Adds three steps each on: mesh and c0, c0 and c1, c1 alone, and back. `down1` and `down2` select the edges to the
// body on the way down.
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

// models/cvpr.py: one encoder for all coarse edges. A filter on the way down looks at one level only.
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

// SENC (Liao et al. 2024): HOOD with accelerations by forces without contact among the node features, and with edges in
// space, which take part wherever mesh edges or those of the step's coarse levels do.
Architecture senc() {
  Architecture a = hood();
  a.name = "senc";
  a.node_inputs = 27;
  a.features = senc_features();
  add_edges(a, "space", 12, 9, {"space_edge"});
  for (MessageStep& step : a.steps) {
    EdgeFilter near{"space_edge", {}};
    for (const std::string& key : step.edge_keys)
      if (key.starts_with("coarse_edge")) near.near.push_back(key);
    step.edge_keys.insert(step.edge_keys.end() - 1, "space_edge");
    if (!step.filters.empty()) step.filters.push_back(near);
  }
  a.statistics = {.node = 24, .mesh_edge = 9, .world_edge = 9, .space_edge = 9};
  return a;
}

// ContourCraft (Grigorev et al. 2024). It encodes the coarse levels `encoded`, and every step uses `used`.
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

// The inputs of our small networks (docs/learned.md). Nodes: velocity 3, normal 3, time step 1, log mass 1, nearest
// body face 14, the objective's preconditioned gradient 3, move so far 3 | bending, mu, lambda 3, pinned 1, near the
// body 1, pass 1. Edges: x_s - x_r 3, norm, rest length, strain at x and at the guess.
FeatureOptions own_features() {
  FeatureOptions options;
  options.type_columns = options.level_columns = 0;
  options.pinned_flag = options.body_inputs = options.force_inputs = options.pass_inputs = true;
  options.strain_inputs = true;
  options.edge_context = false;
  options.rest = RestFeature::length;
  options.coarse_levels = 2;
  options.coarse_sets = {0, 1};
  options.shared_mesh_statistics = false;
  options.coarse_form = CoarseForm::discs;
  options.body_key.clear();
  options.body_partner = BodyPartner::nearest_face;
  options.label_columns = 0;
  options.future_pinned = false;
  return options;
}

// The inputs with more. `contact` adds vertex-face edges of cloth with cloth. `forces` adds SENC's inputs:
// accelerations by forces without contact, and edges in space.
FeatureOptions own_features(bool contact, bool forces) {
  FeatureOptions options = own_features();
  options.cloth_edges = contact;
  options.acceleration_inputs = options.space_edges = forces;
  return options;
}

// Our networks for two cores.
Architecture own(const std::string& name, int width, int steps, const FeatureOptions& features) {
  const bool contact = features.cloth_edges, forces = features.space_edges;
  Architecture a;
  a.name = name;
  a.width = width;
  a.hidden_layers = 1;
  a.features = features;
  a.node_inputs = node_widths(a.features).all;
  const FeatureWidths mesh = mesh_edge_widths(a.features), cloth = cloth_edge_widths(a.features);
  add_edges(a, "mesh", mesh.all, mesh.normalised, {"mesh_edge"});
  for (const std::string level : {"0", "1"})
    add_edges(a, "coarse" + level, mesh.all, mesh.normalised, {"coarse_edge" + level});
  if (contact)
    for (const std::string kind : {"repulsion", "attraction"})
      add_edges(a, kind, cloth.all, cloth.normalised, {kind + "_edge"});
  if (forces) add_edges(a, "space", mesh.all, mesh.normalised, {"space_edge"});
  MessageStep step{{"coarse_edge0", "coarse_edge1", "mesh_edge"}, {}};
  if (contact) step.edge_keys = {"attraction_edge", "coarse_edge0", "coarse_edge1", "mesh_edge", "repulsion_edge"};
  if (forces) step.edge_keys.push_back("space_edge");
  add_steps(a, steps, step);
  a.statistics = {.node = node_widths(a.features).normalised,
                  .mesh_edge = mesh.normalised,
                  .coarse_edge = mesh.normalised,
                  .world_edge = contact ? cloth.normalised : 0,
                  .space_edge = forces ? mesh.normalised : 0};
  a.passes = 2;
  return a;
}

// For a frame on two cores: one pass beside the carried guess. In place of the objective's force it sees the guess and
// what is left of the solver's forces there, for which nothing is searched but the nearest faces of the body.
Architecture student() {
  FeatureOptions features = own_features();
  features.base = OutputBase::carried;
  features.force_inputs = features.pass_inputs = false;
  features.guess_inputs = true;
  Architecture a = own("student", 32, 4, features);
  a.integration = Integration::start_flag;  // no settling frame
  a.passes = 1;
  return a;
}

}  // namespace

std::vector<std::string> preset_names() {
  return {"hood", "hood_cvpr", "fine15",        "fine48",     "contourcraft",      "contourcraft_paper",
          "senc", "small",     "small_contour", "small_senc", "small_senc_layers", "student",
          "tiny"};
}

Architecture architecture_preset(const std::string& name) {
  if (name == "hood") return hood();
  if (name == "hood_cvpr") return hood_cvpr();
  if (name == "fine15") return fine(name, 15);
  if (name == "fine48") return fine(name, 48);
  // The released code uses the fourth level only; the paper speaks of two levels (Grigorev et al. 2024).
  if (name == "contourcraft") return contour(name, contourcraft_features(), {"0", "1", "2", "3"}, {"3"});
  if (name == "contourcraft_paper") return contour(name, contourcraft_paper_features(), {"0", "1"}, {"0", "1"});
  if (name == "senc") return senc();
  if (name == "small" || name == "small_contour") return own(name, 64, 6, own_features(name == "small_contour", false));
  if (name == "small_senc" || name == "small_senc_layers")
    return own(name, 64, 6, own_features(name == "small_senc_layers", true));
  if (name == "tiny") return own(name, 32, 3, own_features(true, false));
  if (name == "student") return student();
  std::string known;
  for (const std::string& preset : preset_names()) known += (known.empty() ? "" : ", ") + preset;
  throw Error("no network of this name", name, "choose one of " + known);
}

}  // namespace selvedge
