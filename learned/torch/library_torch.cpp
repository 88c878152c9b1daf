// The shared library: the only file that sees libtorch.
#include <torch/torch.h>
#include <xmmintrin.h>

#include <chrono>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "learned/gradients/torch_interface.hpp"

namespace selvedge {
namespace {

using torch::Tensor;

void put_text(char* to, std::size_t size, const std::string& text) { std::snprintf(to, size, "%s", text.c_str()); }

// Runs `work`; what it throws becomes a sentence.
template <class Work>
int guarded(TorchReport* report, Work&& work) {
  try {
    work();
    return 0;
  } catch (const std::exception& error) {
    put_text(report->error, sizeof report->error, error.what());
    return 1;
  }
}

// Weights of one perceptron: weight and bias of each layer, then scale and shift or nothing.
struct TorchPerceptron {
  std::vector<Tensor> weight, bias;
  Tensor scale, shift;
};

struct TorchStep {
  std::vector<TorchPerceptron> edges;
  TorchPerceptron node;
};

struct TorchModel {
  torch::Device device = torch::kCPU;
  std::int64_t width = 0;
  std::vector<Tensor> parameters;  // in the order of the arrays
  TorchPerceptron node_encoder, decoder;
  std::vector<TorchPerceptron> encoders;
  std::vector<TorchStep> steps;
  std::unique_ptr<torch::optim::Adam> adam;
  Tensor output;  // of the last forward run that was to be kept
};

// Hands out the parameters in their order.
struct ParameterReader {
  const TorchModel& model;
  std::size_t next = 0;

  const Tensor& take() { return model.parameters.at(next++); }
  TorchPerceptron perceptron(int hidden_layers, bool norm) {
    TorchPerceptron p;
    for (int layer = 0; layer <= hidden_layers; ++layer) {
      p.weight.push_back(take());
      p.bias.push_back(take());
    }
    if (norm) {
      p.scale = take();
      p.shift = take();
    }
    return p;
  }
};

Tensor copied(const TorchArray& array, const torch::Device& device) {
  const std::vector<std::int64_t> shape =
      array.columns == 0 ? std::vector<std::int64_t>{array.rows} : std::vector<std::int64_t>{array.rows, array.columns};
  return torch::from_blob(array.data, shape).clone().to(device);
}

void build(TorchModel& model, const TorchShape& shape) {
  ParameterReader reader{model};
  const bool norm = shape.layer_norm != 0;
  model.width = shape.width;
  model.node_encoder = reader.perceptron(shape.hidden_layers, norm);
  for (int i = 0; i < shape.encoders; ++i) model.encoders.push_back(reader.perceptron(shape.hidden_layers, norm));
  for (int s = 0; s < shape.steps; ++s) {
    TorchStep& step = model.steps.emplace_back();
    for (int k = 0; k < shape.step_keys[s]; ++k) step.edges.push_back(reader.perceptron(shape.hidden_layers, norm));
    step.node = reader.perceptron(shape.hidden_layers, norm);
  }
  model.decoder = reader.perceptron(shape.hidden_layers, false);
  if (reader.next != model.parameters.size()) throw std::runtime_error("the arrays are not those of the architecture");
}

// The layers behind the first, whose results are `x`, then the layer norm.
Tensor behind_first(const TorchPerceptron& p, Tensor x) {
  for (std::size_t layer = 1; layer < p.weight.size(); ++layer)
    x = torch::addmm(p.bias[layer], torch::relu(x), p.weight[layer].t());
  return p.scale.defined() ? torch::layer_norm(x, {x.size(1)}, p.scale, p.shift, 1e-5) : x;
}

Tensor evaluate(const TorchPerceptron& p, const Tensor& x) {
  return behind_first(p, torch::addmm(p.bias[0], x, p.weight[0].t()));
}

// A graph as tensors.
struct TorchGraph {
  Tensor nodes;
  std::vector<Tensor> features;  // of each set
  struct Ends {
    Tensor edge, receiver, sender;
  };
  std::vector<Ends> selections;
};

Tensor index_tensor(const std::int64_t* values, std::int64_t count, const torch::Device& device) {
  return torch::from_blob(const_cast<std::int64_t*>(values), {count}, torch::kInt64).clone().to(device);
}

TorchGraph tensors_of(const TorchModel& model, const TorchGraphView& view) {
  TorchGraph graph;
  const auto rows = [&](const float* values, std::int64_t count, std::int64_t columns) {
    return torch::from_blob(const_cast<float*>(values), {count, columns}).clone().to(model.device);
  };
  graph.nodes = rows(view.node_features, view.nodes, model.node_encoder.weight[0].size(1));
  for (int s = 0; s < view.sets; ++s)
    graph.features.push_back(rows(view.edge_sets[s].features, view.edge_sets[s].edges, view.edge_sets[s].inputs));
  std::size_t count = 0;
  for (const TorchStep& step : model.steps) count += step.edges.size();
  for (std::size_t i = 0; i < count; ++i) {
    const TorchSelection& selection = view.selections[i];
    TorchGraph::Ends ends;
    if (selection.set >= 0) {
      if (selection.all == 0) ends.edge = index_tensor(selection.edge, selection.edges, model.device);
      ends.receiver = index_tensor(selection.receiver, selection.edges, model.device);
      ends.sender = index_tensor(selection.sender, selection.edges, model.device);
    }
    graph.selections.push_back(std::move(ends));
  }
  return graph;
}

// New values of the edges of a selection. The first layer's products with the nodes are made once a node.
Tensor edge_values(const TorchModel& model, const TorchPerceptron& p, const Tensor& nodes, const Tensor& edges,
                   const TorchGraph::Ends& ends) {
  const std::int64_t w = model.width;
  const Tensor& weight = p.weight[0];
  const Tensor to_receiver = nodes.matmul(weight.slice(1, 0, w).t());
  const Tensor to_sender = nodes.matmul(weight.slice(1, w, 2 * w).t());
  const Tensor ends_part = to_receiver.index_select(0, ends.receiver) + to_sender.index_select(0, ends.sender);
  return behind_first(p, torch::addmm(p.bias[0], edges, weight.slice(1, 2 * w, 3 * w).t()) + ends_part);
}

Tensor run(const TorchModel& model, const TorchGraphView& view) {
  const TorchGraph graph = tensors_of(model, view);
  Tensor nodes = evaluate(model.node_encoder, graph.nodes);
  std::vector<Tensor> edges(graph.features.size());
  for (std::size_t s = 0; s < edges.size(); ++s)
    if (view.edge_sets[s].used != 0)
      edges[s] = evaluate(model.encoders[static_cast<std::size_t>(view.edge_sets[s].encoder)], graph.features[s]);
  std::size_t at = 0;
  for (const TorchStep& step : model.steps) {
    std::vector<Tensor> inputs{nodes};
    for (std::size_t k = 0; k < step.edges.size(); ++k, ++at) {
      Tensor sums = torch::zeros({view.nodes, model.width}, nodes.options());
      const TorchSelection& selection = view.selections[at];
      if (selection.set >= 0) {
        const TorchGraph::Ends& ends = graph.selections[at];
        Tensor& latents = edges[static_cast<std::size_t>(selection.set)];
        const Tensor taken = selection.all != 0 ? latents : latents.index_select(0, ends.edge);
        const Tensor values = edge_values(model, step.edges[k], nodes, taken, ends);
        sums = sums.index_add(0, ends.receiver, values);
        latents = selection.all != 0 ? latents + values : latents.index_add(0, ends.edge, values);
      }
      inputs.push_back(sums);
    }
    nodes = nodes + evaluate(step.node, torch::cat(inputs, 1));
  }
  return evaluate(model.decoder, nodes.slice(0, 0, view.cloth_nodes));
}

// What the library multiplies matrices with, from the text that describes how it was built.
std::string blas_name() {
  const std::string text = at::show_config();
  const std::size_t at = text.find("BLAS_INFO=");
  return at == std::string::npos ? "unknown" : text.substr(at + 10, text.find_first_of(",\n", at) - at - 10);
}

double gemm_speed(const torch::Device& device) {
  const Tensor a = torch::rand({512, 512}, device), b = torch::rand({512, 512}, device);
  double best = 1e9;
  for (int round = 0; round < 4; ++round) {
    const auto begin = std::chrono::steady_clock::now();
    (void)a.matmul(b)[0][0].item<float>();
    best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  return 2.0 * 512 * 512 * 512 / best;
}

void describe(const TorchModel& model, TorchReport& report) {
  put_text(report.device, sizeof report.device, model.device.str());
  put_text(report.library, sizeof report.library, TORCH_VERSION);
  put_text(report.blas, sizeof report.blas, blas_name());
  report.threads = at::get_num_threads();
  report.gemm_flops = gemm_speed(model.device);
  report.flushes_denormals = (_mm_getcsr() & 0x8040u) != 0 ? 1 : 0;
}

void* make(const TorchShape* shape, const TorchArray* arrays, int count, const char* device, int threads,
           TorchReport* report) {
  auto model = std::make_unique<TorchModel>();
  const int failed = guarded(report, [&] {
    const std::string wanted = device;
    if (wanted == "cuda" && !torch::cuda::is_available()) throw std::runtime_error("this libtorch has no CUDA device");
    model->device = wanted != "cpu" && torch::cuda::is_available() ? torch::Device(torch::kCUDA, 0) : torch::kCPU;
    if (threads > 0) at::set_num_threads(threads);
    for (int i = 0; i < count; ++i) model->parameters.push_back(copied(arrays[i], model->device).requires_grad_(true));
    build(*model, *shape);
    describe(*model, *report);
  });
  return failed != 0 ? nullptr : model.release();
}

void discard(void* model) { delete static_cast<TorchModel*>(model); }

int set_weights(void* handle, const TorchArray* arrays, int count, TorchReport* report) {
  return guarded(report, [&] {
    TorchModel& model = *static_cast<TorchModel*>(handle);
    const torch::NoGradGuard guard;
    for (int i = 0; i < count; ++i)
      model.parameters.at(static_cast<std::size_t>(i)).copy_(copied(arrays[i], model.device));
  });
}

void copy_out(const Tensor& tensor, float* to) {
  const Tensor values = tensor.detach().to(torch::kCPU).contiguous();
  std::copy_n(values.data_ptr<float>(), values.numel(), to);
}

int get_weights(void* handle, const TorchArray* arrays, int count, TorchReport* report) {
  return guarded(report, [&] {
    TorchModel& model = *static_cast<TorchModel*>(handle);
    for (int i = 0; i < count; ++i) copy_out(model.parameters.at(static_cast<std::size_t>(i)), arrays[i].data);
  });
}

int forward(void* handle, const TorchGraphView* view, int keep, float* output, TorchReport* report) {
  return guarded(report, [&] {
    TorchModel& model = *static_cast<TorchModel*>(handle);
    const torch::AutoGradMode mode(keep != 0);
    model.output = run(model, *view);
    copy_out(model.output, output);
    if (keep == 0) model.output = Tensor();
  });
}

Tensor derivative_of(const TorchModel& model, const float* d_output) {
  return torch::from_blob(const_cast<float*>(d_output), model.output.sizes()).clone().to(model.device);
}

int backward(void* handle, const float* d_output, const TorchArray* gradients, int count, TorchReport* report) {
  return guarded(report, [&] {
    TorchModel& model = *static_cast<TorchModel*>(handle);
    if (!model.output.defined()) throw std::runtime_error("going backward needs a forward run that was kept");
    for (Tensor& parameter : model.parameters) parameter.mutable_grad() = Tensor();
    model.output.backward(derivative_of(model, d_output), /*retain_graph=*/true);
    for (int i = 0; i < count; ++i) {
      const Tensor& gradient = model.parameters.at(static_cast<std::size_t>(i)).grad();
      if (!gradient.defined()) continue;
      const Tensor values = gradient.to(torch::kCPU).contiguous();
      for (std::int64_t k = 0; k < values.numel(); ++k) gradients[i].data[k] += values.data_ptr<float>()[k];
    }
  });
}

int train(void* handle, const TorchGraphView* view, const float* d_output, double learning_rate, float* output,
          TorchReport* report) {
  return guarded(report, [&] {
    TorchModel& model = *static_cast<TorchModel*>(handle);
    if (!model.adam) model.adam = std::make_unique<torch::optim::Adam>(model.parameters, learning_rate);
    static_cast<torch::optim::AdamOptions&>(model.adam->param_groups()[0].options()).lr(learning_rate);
    model.adam->zero_grad();
    model.output = run(model, *view);
    copy_out(model.output, output);
    model.output.backward(derivative_of(model, d_output));
    model.adam->step();
    model.output = Tensor();
  });
}

constexpr TorchCalls calls{torch_interface_version, make, discard, set_weights, get_weights, forward, backward, train};

}  // namespace
}  // namespace selvedge

extern "C" __attribute__((visibility("default"))) const selvedge::TorchCalls* selvedge_torch_calls() {
  return &selvedge::calls;
}
