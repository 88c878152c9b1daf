#pragma once

#include <string>
#include <vector>

#include "learned/graph/feature_options.hpp"
#include "learned/graph/graph.hpp"

namespace selvedge {

// Limits of a network. Files and options that exceed them are refused.
inline constexpr int most_latents = 4096;
inline constexpr int most_message_steps = 1024;

// A network that turns the features of edges into latents. Several kinds of edges may share one.
struct EdgeEncoder {
  std::string name;  // name in the published checkpoints: mesh, world, body, coarse0..
  int inputs = 0;
};

struct EdgeKind {
  std::string key;
  int encoder = 0;     // index into Architecture::encoders
  int normalised = 0;  // the first columns of the features
  bool operator==(const EdgeKind&) const = default;
};

// Edges of this key take part in a step only if each cloth end of theirs has an edge in one of the sets `near`.
struct EdgeFilter {
  std::string key;
  std::vector<std::string> near;
  bool operator==(const EdgeFilter&) const = default;
};

// One step of message passing with its own weights. The sums enter the node network in the order of `edge_keys`, which
// is alphabetical (row 3 of the parity README). Latents of edges that a filter drops stay unchanged. An edge must pass
// every filter of its key (row 5).
struct MessageStep {
  std::vector<std::string> edge_keys;
  std::vector<EdgeFilter> filters;
  bool operator==(const MessageStep&) const = default;
};

// Rows and columns of a learned embedding; none where rows are zero.
struct TableSize {
  int rows = 0, columns = 0;
};

// Columns of each set of statistics; zero where a model lacks it. Kinds of edges name their set by key. The published
// HOOD calls edges to the body and their statistics `world_edge`.
struct StatisticsSizes {
  int node = 0, mesh_edge = 0, coarse_edge = 0, world_edge = 0, body_edge = 0, output = 3, space_edge = 0;
};

// How a roll-out starts and how a frame is integrated.
enum class Integration {
  relaxation_frame,  // HOOD: frame 0 takes 1/3 s and is pushed out of the body (row 18)
  start_flag,        // ContourCraft: a flag among the features says that a sample starts (is_init)
};

// A network as a value: inputs, message passing and outputs. Its weights are separate (NetworkWeights).
struct Architecture {
  std::string name;
  int width = 128;         // width of every latent
  int hidden_layers = 2;   // of every perceptron, each as wide as a latent
  bool layer_norm = true;  // on the output of every perceptron but the decoder
  int node_inputs = 0;
  FeatureOptions features;  // description of the inputs
  std::vector<EdgeEncoder> encoders;
  std::vector<EdgeKind> edge_kinds;
  std::vector<MessageStep> steps;
  int outputs = 3;
  TableSize node_type, vertex_level, edge_type;
  StatisticsSizes statistics;
  Integration integration = Integration::relaxation_frame;
  int passes = 1;  // runs of the network per frame with the same weights
};

// hood, hood_cvpr, fine15, fine48, contourcraft, contourcraft_paper, senc, small, small_contour, small_senc,
// small_senc_layers, student, tiny (`preset_names`). Sizes: docs/learned.md. The last six are ours. `small` has no
// contact of cloth with cloth, `small_senc` has SENC's inputs, `small_senc_layers` adds the edges of `small_contour`,
// `student` adds its output to the carried guess, and `tiny` is for tests. Throws Error at any other name.
Architecture architecture_preset(const std::string& name);
std::vector<std::string> preset_names();

// Throws Error, which names `where`, unless the network can be built: counts within bounds (width at most 4096, at most
// 1024 steps, ...), every key known, keys of a step in alphabetical order, encoders in range.
void check_architecture(const Architecture&, const std::string& where);

// Trainable numbers: weights, biases, layer norms, embeddings. Statistics are not counted.
long long parameter_count(const Architecture&);

// Index of the kind with this key, or -1.
int edge_kind(const Architecture&, const std::string& key);
// Index of its encoder. There must be such a kind.
int encoder_of(const Architecture&, const std::string& key);

}  // namespace selvedge
