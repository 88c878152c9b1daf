#include "learned/graph/feature_options.hpp"

namespace selvedge {

FeatureOptions hood_features() { return {}; }

FeatureOptions hood_cvpr_features() {
  FeatureOptions options;
  options.cloth_velocity = ClothVelocity::difference;
  options.body_velocity = BodyVelocity::next;
  options.next_body_first = true;
  return options;
}

FeatureOptions fine_features() {
  FeatureOptions options = hood_cvpr_features();
  options.level_columns = 0;
  options.coarse_levels = 0;
  options.coarse_sets.clear();
  return options;
}

FeatureOptions contourcraft_features() {
  FeatureOptions options;
  options.highest_level = 4;
  options.log_mass = false;
  options.time = TimeFeature::is_init;
  options.body_velocity = BodyVelocity::next;
  options.pinned = PinnedForm::moved_for_mesh_edges;
  options.mesh_order = MeshOrder::smaller_sends;
  options.rest = RestFeature::length;
  options.coarse_levels = 4;
  options.coarse_sets = {0, 1, 2, 3};
  options.shared_mesh_statistics = false;
  options.body_key = "body_edge";
  options.body_partner = BodyPartner::nearest_face;
  options.body_edge_velocity = true;
  options.cloth_edges = true;
  return options;
}

FeatureOptions senc_features() {
  FeatureOptions options = hood_features();
  options.acceleration_inputs = true;
  options.space_edges = true;
  return options;
}

FeatureOptions contourcraft_paper_features() {
  FeatureOptions options = contourcraft_features();
  options.highest_level = 2;
  options.coarse_levels = 2;
  options.coarse_sets = {0, 1};
  options.contours = ContourRule::all_vertices;
  return options;
}

namespace {

constexpr int materials = 3;

// A time column is the last normalised one, or the first after them.
FeatureWidths with_time(const FeatureOptions& options, int normalised, int behind) {
  const bool dt = options.time == TimeFeature::timestep;
  return {normalised + 1 + behind, normalised + (dt ? 1 : 0)};
}

}  // namespace

int objective_columns(const FeatureOptions& options) {
  return (options.body_inputs ? 14 : 0) + (options.force_inputs ? 3 : 0) + (options.pass_inputs ? 3 : 0) +
         (options.guess_inputs ? 15 : 0) + (options.acceleration_inputs ? 3 : 0);
}

bool sees_accelerations(const FeatureOptions& options) { return options.acceleration_inputs || options.guess_inputs; }

EmbeddingColumns embedding_columns(const FeatureOptions& options) {
  return {3, 3 + options.type_columns, options.time == TimeFeature::timestep ? 13 : 12};
}

FeatureWidths node_widths(const FeatureOptions& options) {
  const int flags = int{options.pinned_flag} + int{options.body_inputs} + int{options.pass_inputs};
  return with_time(options, 3 + options.type_columns + options.level_columns + 3 + 1 + objective_columns(options),
                   materials + flags);
}

FeatureWidths mesh_edge_widths(const FeatureOptions& options) {
  const int columns = 4 + (options.rest == RestFeature::vector ? 4 : 1) + (options.strain_inputs ? 2 : 0);
  return options.edge_context ? with_time(options, columns, materials) : FeatureWidths{columns, columns};
}

FeatureWidths body_edge_widths(const FeatureOptions& options) {
  return with_time(options, options.body_edge_velocity ? 12 : 8, 0);
}

FeatureWidths cloth_edge_widths(const FeatureOptions& options) {
  return with_time(options, 12 + options.label_columns, materials);
}

std::vector<std::string> edge_set_keys(const FeatureOptions& options) {
  std::vector<std::string> keys{"mesh_edge"};
  for (const int level : options.coarse_sets) keys.push_back("coarse_edge" + std::to_string(level));
  if (!options.body_key.empty()) keys.push_back(options.body_key);
  if (options.cloth_edges) {
    keys.push_back("repulsion_edge");
    keys.push_back("attraction_edge");
  }
  if (options.space_edges) keys.push_back("space_edge");
  return keys;
}

}  // namespace selvedge
