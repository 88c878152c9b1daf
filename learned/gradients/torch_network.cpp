#include "learned/gradients/torch_network.hpp"

#include <dlfcn.h>

#include <algorithm>
#include <numeric>

#include "collision/geometry/error.hpp"
#include "collision/geometry/floating_point.hpp"
#include "collision/geometry/shared_library.hpp"
#include "learned/gradients/embedding_gradients.hpp"
#include "learned/gradients/torch_interface.hpp"
#include "learned/network/graph_plan.hpp"

namespace selvedge {
namespace {

const TorchCalls& torch_calls(const std::filesystem::path& library) {
  const std::string cure = "install libtorch-dev and configure with -DSELVEDGE_TORCH=ON, or train without libtorch";
  const auto entry = reinterpret_cast<TorchEntry>(entry_of_library(library, torch_entry, "libtorch", cure));
  if (!entry || entry()->version != torch_interface_version)
    throw Error("the library is of another version of this program", library.string(), cure);
  return *entry();
}

// Sets the threads of Debian's OpenBLAS, which libtorch does not set. `name` becomes its description of itself.
void set_blas_threads(int threads, std::string& name) {
  void* blas = dlopen("libopenblas.so.0", RTLD_NOW | RTLD_NOLOAD);
  if (!blas) return;
  const auto set = reinterpret_cast<void (*)(int)>(dlsym(blas, "openblas_set_num_threads"));
  if (set && threads > 0) set(threads);
  const auto config = reinterpret_cast<const char* (*)()>(dlsym(blas, "openblas_get_config"));
  if (config) name = config();
  dlclose(blas);
}

// The arrays that libtorch knows.
std::vector<TorchArray> torch_arrays(const Architecture& a, NetworkWeights& weights) {
  std::vector<TorchArray> arrays;
  for (const WeightArray& array : weight_arrays(a, weights)) {
    if (!array.trained || array.name.starts_with("embeddings/")) continue;
    const bool matrix = array.name.ends_with("/weight");
    arrays.push_back({array.data, array.rows, matrix ? array.columns : 0});
  }
  return arrays;
}

// A graph as the library reads it. It points into the graph.
struct GraphView {
  std::vector<TorchEdgeSet> sets;
  std::vector<TorchSelection> selections;
  std::vector<std::vector<std::int64_t>> indices;
  TorchGraphView view;

  GraphView(const Architecture& a, const Graph& graph);
  GraphView(const GraphView&) = delete;
};

GraphView::GraphView(const Architecture& a, const Graph& graph) {
  check_graph(a, graph);
  const GraphPlan plan = plan_graph(a, graph, 1);
  for (std::size_t s = 0; s < graph.edge_sets.size(); ++s) {
    const EdgeSet& set = graph.edge_sets[s];
    sets.push_back({encoder_of(a, set.key), set.features.rows(), set.features.cols(), set.features.data(),
                    is_used(plan, s) ? 1 : 0});
  }
  std::vector<TorchSelection> kinds;  // one per selection of the plan
  for (const EdgeSelection& selection : plan.selections) {
    const auto set = static_cast<std::size_t>(selection.set);
    std::vector<std::int64_t> edge;
    for (const int e : selection.edge) edge.push_back(plan.order[set][static_cast<std::size_t>(e)]);
    std::sort(edge.begin(), edge.end());
    std::vector<std::int64_t> receiver, sender;
    for (const std::int64_t e : edge) {
      receiver.push_back(graph.edge_sets[set].receivers[static_cast<std::size_t>(e)]);
      sender.push_back(graph.edge_sets[set].senders[static_cast<std::size_t>(e)]);
    }
    const auto count = static_cast<std::int64_t>(edge.size());
    for (std::vector<std::int64_t>* list : {&edge, &receiver, &sender}) indices.push_back(std::move(*list));
    kinds.push_back({selection.set, count == sets[set].edges ? 1 : 0, count, indices[indices.size() - 3].data(),
                     indices[indices.size() - 2].data(), indices.back().data()});
  }
  for (const std::vector<int>& step : plan.steps)
    for (const int index : step)
      selections.push_back(index < 0 ? TorchSelection{} : kinds[static_cast<std::size_t>(index)]);
  view = {graph.nodes.rows(), graph.cloth_nodes, graph.nodes.data(), static_cast<int>(sets.size()),
          sets.data(),        selections.data()};
}

// Derivatives with respect to the features that hold learned embeddings: of the nodes, and of each set with labels.
struct FeatureGradients {
  FeatureRows nodes;
  std::vector<FeatureRows> sets;
  std::vector<TorchFeatureGradient> wanted;  // points to the members above

  FeatureGradients(const Architecture& a, const Graph& graph) : sets(graph.edge_sets.size()) {
    if (a.features.type_columns + a.features.level_columns > 0) want(-1, graph.nodes, nodes);
    for (std::size_t s = 0; s < sets.size(); ++s)
      if (!graph.edge_sets[s].labels.empty()) want(static_cast<int>(s), graph.edge_sets[s].features, sets[s]);
  }
  FeatureGradients(const FeatureGradients&) = delete;

 private:
  void want(int set, const FeatureRows& features, FeatureRows& gradient) {
    gradient.setZero(features.rows(), features.cols());
    wanted.push_back({set, {gradient.data(), gradient.rows(), gradient.cols()}});
  }
};

LatentRows latent_rows(const FeatureRows& rows) {
  LatentRows copy(static_cast<int>(rows.rows()), static_cast<int>(rows.cols()));
  for (Eigen::Index i = 0; i < rows.rows(); ++i)
    Eigen::Map<Eigen::RowVectorXf>(copy.row(static_cast<int>(i)), rows.cols()) = rows.row(i);
  return copy;
}

// These derivatives are by features, so the first layer is replaced by the identity.
void add_embedding_gradients(const Architecture& a, const Graph& graph, const FeatureTables& tables,
                             const FeatureGradients& features, FeatureTables& gradients) {
  const auto identity = [](const FeatureRows& rows) { return FeatureRows::Identity(rows.cols(), rows.cols()); };
  if (features.nodes.size() > 0)
    add_node_gradients(a, graph, identity(features.nodes), tables, latent_rows(features.nodes), gradients);
  for (std::size_t s = 0; s < features.sets.size(); ++s) {
    const FeatureRows& rows = features.sets[s];
    if (rows.size() == 0) continue;
    std::vector<int> order(static_cast<std::size_t>(rows.rows()));
    std::iota(order.begin(), order.end(), 0);
    add_label_gradients(a, graph.edge_sets[s], order, identity(rows), tables, latent_rows(rows), gradients);
  }
}

}  // namespace

struct TorchNetwork::Handle {
  Architecture architecture;
  const TorchCalls& calls;
  void* model = nullptr;
  TorchFacts facts;
  int cloth_nodes = -1;  // of the last forward run; -1: none

  ~Handle() {
    if (model) calls.discard(model);
  }
  void check(int failed, const TorchReport& report) const {
    restore_standard_arithmetic();
    if (failed != 0)
      throw Error(std::string("libtorch says: ") + report.error, "network `" + architecture.name + "`", "");
  }
  // `keep`: for a backward run.
  FeatureRows forward(const Graph& graph, bool keep) {
    const GraphView view(architecture, graph);
    FeatureRows output(graph.cloth_nodes, architecture.outputs);
    TorchReport report;
    check(calls.forward(model, &view.view, keep ? 1 : 0, output.data(), &report), report);
    cloth_nodes = keep ? graph.cloth_nodes : -1;
    return output;
  }
};

std::filesystem::path torch_library_path() { return library_beside_program("libselvedge_torch.so"); }

TorchNetwork::TorchNetwork(const Architecture& a, const NetworkWeights& weights, const std::string& device, int threads,
                           const std::filesystem::path& library) {
  check_architecture(a, "network");
  check_weights(a, weights, "network");
  if (device != "auto" && device != "cpu" && device != "cuda")
    throw Error("`" + device + "` is no device", "libtorch", "choose auto, cpu or cuda");
  handle_.reset(new Handle{a, torch_calls(library), nullptr, {}, -1});
  std::vector<int> inputs, keys;
  for (const EdgeEncoder& encoder : a.encoders) inputs.push_back(encoder.inputs);
  for (const MessageStep& step : a.steps) keys.push_back(static_cast<int>(step.edge_keys.size()));
  TorchShape shape;
  shape.width = a.width;
  shape.hidden_layers = a.hidden_layers;
  shape.layer_norm = a.layer_norm ? 1 : 0;
  shape.node_inputs = a.node_inputs;
  shape.outputs = a.outputs;
  shape.encoders = static_cast<int>(inputs.size());
  shape.encoder_inputs = inputs.data();
  shape.steps = static_cast<int>(keys.size());
  shape.step_keys = keys.data();
  NetworkWeights copy = weights;
  const std::vector<TorchArray> arrays = torch_arrays(a, copy);
  TorchReport report;
  handle_->model =
      handle_->calls.make(&shape, arrays.data(), static_cast<int>(arrays.size()), device.c_str(), threads, &report);
  handle_->check(handle_->model ? 0 : 1, report);
  handle_->facts = {report.library, report.device,     report.blas,
                    report.threads, report.gemm_flops, report.flushes_denormals != 0};
  set_blas_threads(threads, handle_->facts.blas);
}

TorchNetwork::~TorchNetwork() = default;
TorchNetwork::TorchNetwork(TorchNetwork&&) noexcept = default;

const TorchFacts& TorchNetwork::facts() const { return handle_->facts; }

void TorchNetwork::set_weights(const NetworkWeights& weights) {
  check_weights(handle_->architecture, weights, "network");
  NetworkWeights copy = weights;
  const std::vector<TorchArray> arrays = torch_arrays(handle_->architecture, copy);
  TorchReport report;
  handle_->check(handle_->calls.set_weights(handle_->model, arrays.data(), static_cast<int>(arrays.size()), &report),
                 report);
}

void TorchNetwork::get_weights(NetworkWeights& weights) const {
  check_weights(handle_->architecture, weights, "network");
  const std::vector<TorchArray> arrays = torch_arrays(handle_->architecture, weights);
  TorchReport report;
  handle_->check(handle_->calls.get_weights(handle_->model, arrays.data(), static_cast<int>(arrays.size()), &report),
                 report);
}

FeatureRows TorchNetwork::infer(const Graph& graph) { return handle_->forward(graph, false); }
FeatureRows TorchNetwork::run_forward(const Graph& graph) { return handle_->forward(graph, true); }

void TorchNetwork::run_backward(const Graph& graph, const FeatureTables& tables, const FeatureRows& d_output,
                                WeightGradients& gradients) {
  const Architecture& a = handle_->architecture;
  if (d_output.rows() != handle_->cloth_nodes || d_output.rows() != graph.cloth_nodes || d_output.cols() != a.outputs)
    throw Error("a derivative is needed for each output of each cloth node of the last forward run", "libtorch", "");
  check_weights(a, gradients, "gradients");
  const std::vector<TorchArray> arrays = torch_arrays(a, gradients);
  const FeatureGradients features(a, graph);
  TorchReport report;
  handle_->check(
      handle_->calls.backward(handle_->model, d_output.data(), arrays.data(), static_cast<int>(arrays.size()),
                              features.wanted.data(), static_cast<int>(features.wanted.size()), &report),
      report);
  add_embedding_gradients(a, graph, tables, features, gradients.tables);
}

FeatureRows TorchNetwork::train(const Graph& graph, const FeatureRows& d_output, double learning_rate) {
  if (d_output.rows() != graph.cloth_nodes || d_output.cols() != handle_->architecture.outputs)
    throw Error("a derivative is needed for each output of each cloth node", "libtorch", "");
  const GraphView view(handle_->architecture, graph);
  FeatureRows output(graph.cloth_nodes, handle_->architecture.outputs);
  TorchReport report;
  handle_->check(
      handle_->calls.train(handle_->model, &view.view, d_output.data(), learning_rate, output.data(), &report), report);
  handle_->cloth_nodes = -1;
  return output;
}

}  // namespace selvedge
