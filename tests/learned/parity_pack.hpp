#pragma once

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <vector>

#include "learned/graph/make_graph.hpp"
#include "pipeline/formats/npz.hpp"
#include "tests/source_root.hpp"

// Results of the authors' code (shared/data/parity/README.md), as scenes and states of ours.
namespace selvedge::parity {

inline std::filesystem::path folder() {
  const char* set = std::getenv("SELVEDGE_DATA");
  return (set && *set ? std::filesystem::path(set) : source_root() / ".." / "shared" / "data") / "parity";
}

// Prints a warning if the pack is absent.
inline bool is_here() {
  if (std::filesystem::exists(folder() / "README.md")) return true;
  WARN("skipped: no parity pack in " << folder());
  return false;
}

inline Npz open(const std::string& name) { return Npz(folder() / (name + ".npz")); }

inline std::vector<int> integers(const Npz& npz, const std::string& name) {
  const auto values = npz.integers(name).values;
  return {values.begin(), values.end()};
}

inline FeatureRows rows(const Npz& npz, const std::string& name) {
  const NpyArray<double> array = npz.numbers(name);
  REQUIRE(array.shape.size() == 2);
  const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> map(
      array.values.data(), array.shape[0], array.shape[1]);
  return map.cast<float>();
}

inline Points points(const Npz& npz, const std::string& name) {
  const NpyArray<double> array = npz.numbers(name);
  return Eigen::Map<const Points>(array.values.data(), array.shape[0], 3);
}

inline Surface surface(const Npz& npz, const std::string& name, int vertices) {
  const std::vector<int> faces = integers(npz, name);
  return make_surface(vertices,
                      Eigen::Map<const Triangles>(faces.data(), static_cast<Eigen::Index>(faces.size() / 3), 3));
}

// The pairs in an index array of two rows.
inline std::vector<std::pair<int, int>> index_pairs(const Npz& npz, const std::string& name) {
  const std::vector<int> flat = integers(npz, name);
  const std::size_t count = flat.size() / 2;
  std::vector<std::pair<int, int>> pairs;
  for (std::size_t i = 0; i < count; ++i) pairs.emplace_back(flat[i], flat[count + i]);
  return pairs;
}

struct Case {
  std::string name;
  Npz npz;
  FeatureOptions options;
  GraphScene scene;
  GraphState state;
  std::vector<int> centres;  // centres of the authors' coarse edges
};

inline FeatureRows material_inputs(const Npz& npz, Eigen::Index vertices) {
  FeatureRows materials(vertices, 3);
  int column = 0;
  for (const char* name : {"bending_coeff_input", "lame_mu_input", "lame_lambda_input"})
    materials.col(column++).setConstant(static_cast<float>(npz.numbers(name).values[0]));
  return materials;
}

inline void load_body(Case& c) {
  if (!c.npz.has("body_pos")) {
    c.state.body = c.state.body_previous = c.state.body_target = Points(0, 3);
    c.scene.body = make_surface(0, Triangles(0, 3));
    return;
  }
  c.state.body = points(c.npz, "body_pos");
  c.state.body_previous = points(c.npz, "body_prev_pos");
  c.state.body_target = points(c.npz, "body_target_pos");
  c.scene.body = surface(c.npz, "body_faces", static_cast<int>(c.state.body.rows()));
  c.scene.body_types = integers(c.npz, "body_vertex_type");
}

// `name` is the name of a step file.
inline Case load(const std::string& name) {
  Case c{name, open(name), name.starts_with("hood") ? hood_features() : contourcraft_features(), {}, {}, {}};
  c.state.x = points(c.npz, "cloth_pos");
  c.state.previous = points(c.npz, "cloth_prev_pos");
  c.state.target = points(c.npz, "cloth_target_pos");
  c.state.velocity = points(c.npz, "cloth_velocity");
  c.state.timestep = c.npz.numbers("timestep").values[0];
  c.state.is_init = c.npz.has("is_init") && c.npz.numbers("is_init").values[0] != 0;
  c.state.no_cloth_edges = name == "ccraft_fold_init";
  c.scene.cloth = surface(c.npz, "cloth_faces", static_cast<int>(c.state.x.rows()));
  c.scene.rest = points(c.npz, "cloth_rest_pos");
  c.scene.mass = c.npz.numbers("cloth_mass").values;
  c.scene.types = integers(c.npz, "cloth_vertex_type");
  c.scene.materials = material_inputs(c.npz, c.state.x.rows());
  load_body(c);
  if (c.npz.has("center")) c.centres = integers(c.npz, "center");
  if (c.npz.has("centers")) {
    c.centres = integers(c.npz, "centers");
    const std::vector<int> offsets = integers(c.npz, "garment_offsets");
    for (std::size_t i = 0; i < c.centres.size(); ++i) c.centres[i] += offsets[i];
  }
  return c;
}

inline const std::vector<std::string> hood_steps{"hood_step0", "hood_step1", "hood_step2", "hood_step_nobody_nopin",
                                                 "hood_step_training"};
inline const std::vector<std::string> contourcraft_steps{"ccraft_fold_init",     "ccraft_fold_nobody",
                                                         "ccraft_fold_step0",    "ccraft_fold_step1",
                                                         "ccraft_fold_training", "ccraft_two_step0"};
inline std::vector<std::string> all_steps() {
  std::vector<std::string> all = hood_steps;
  all.insert(all.end(), contourcraft_steps.begin(), contourcraft_steps.end());
  return all;
}

// The largest difference in the columns [first, first + count); infinite for arrays of different shapes.
inline double difference(const FeatureRows& a, const FeatureRows& b, Eigen::Index first, Eigen::Index count) {
  if (a.rows() != b.rows() || a.cols() < first + count || b.cols() < first + count) return INFINITY;
  if (a.rows() == 0 || count == 0) return 0;
  const auto of = [&](const FeatureRows& m) { return m.middleCols(first, count).cast<double>(); };
  const Eigen::MatrixXd apart = (of(a) - of(b)).cwiseAbs();
  return apart.allFinite() ? apart.maxCoeff() : INFINITY;
}

inline double difference(const FeatureRows& a, const FeatureRows& b) {
  return a.cols() == b.cols() ? difference(a, b, 0, a.cols()) : INFINITY;
}

// The rows of `ours` in the order of `theirs`, matched by keys. Fails unless both have the same keys, equally often.
template <class Key>
FeatureRows in_their_order(const std::vector<Key>& ours, const FeatureRows& our_rows, const std::vector<Key>& theirs) {
  std::multimap<Key, int> places;
  for (std::size_t i = 0; i < ours.size(); ++i) places.emplace(ours[i], static_cast<int>(i));
  REQUIRE(ours.size() == theirs.size());
  REQUIRE(our_rows.rows() == static_cast<Eigen::Index>(ours.size()));
  FeatureRows result(our_rows.rows(), our_rows.cols());
  for (std::size_t i = 0; i < theirs.size(); ++i) {
    const auto at = places.find(theirs[i]);
    REQUIRE(at != places.end());
    result.row(static_cast<Eigen::Index>(i)) = our_rows.row(at->second);
    places.erase(at);
  }
  return result;
}

inline std::vector<std::pair<int, int>> directed(const EdgeSet& set) {
  std::vector<std::pair<int, int>> edges;
  for (std::size_t e = 0; e < set.senders.size(); ++e) edges.emplace_back(set.senders[e], set.receivers[e]);
  return edges;
}

inline const EdgeSet& edge_set(const Graph& graph, const std::string& key) {
  const auto at = std::ranges::find(graph.edge_sets, key, &EdgeSet::key);
  REQUIRE(at != graph.edge_sets.end());
  return *at;
}

}  // namespace selvedge::parity
