// The shared library: the only file that sees libtorch.
#include <torch/torch.h>
#include <xmmintrin.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "learned/torch/graph_torch.hpp"

namespace selvedge {
namespace {

using torch::Tensor;

void put_text(char* to, std::size_t size, const std::string& text) { std::snprintf(to, size, "%s", text.c_str()); }

// Runs `work` and turns an exception into a message.
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

// Weights of one perceptron: weight and bias of each layer, then scale and shift if it has a norm.
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
  Tensor flat;                     // all weights, one after the other
  std::vector<Tensor> parameters;  // views of it, in the order of the arrays
  TorchPerceptron node_encoder, decoder;
  std::vector<TorchPerceptron> encoders;
  std::vector<TorchStep> steps;
  std::unique_ptr<torch::optim::Adam> adam;
  Tensor output;     // of the last forward run with `keep`
  TorchGraph graph;  // of the same run
};

// Gives the parameters in their order.
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

std::int64_t size_of(const TorchArray& array) { return array.rows * std::max<std::int64_t>(1, array.columns); }

Tensor flat_weights(const TorchArray* arrays, int count, const torch::Device& device) {
  std::vector<float> values;
  for (int i = 0; i < count; ++i) values.insert(values.end(), arrays[i].data, arrays[i].data + size_of(arrays[i]));
  return torch::from_blob(values.data(), {static_cast<std::int64_t>(values.size())}).clone().to(device);
}

void make_parameters(TorchModel& model, const TorchArray* arrays, int count) {
  model.flat = flat_weights(arrays, count, model.device);
  std::int64_t at = 0;
  for (int i = 0; i < count; ++i) {
    const TorchArray& array = arrays[i];
    const Tensor view = model.flat.narrow(0, at, size_of(array));
    model.parameters.push_back((array.columns == 0 ? view : view.view({array.rows, array.columns})).requires_grad_());
    at += size_of(array);
  }
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

// The layers after the first, whose results are `x`, then the layer norm.
Tensor behind_first(const TorchPerceptron& p, Tensor x) {
  for (std::size_t layer = 1; layer < p.weight.size(); ++layer)
    x = torch::addmm(p.bias[layer], torch::relu(x), p.weight[layer].t());
  return p.scale.defined() ? torch::layer_norm(x, {x.size(1)}, p.scale, p.shift, 1e-5) : x;
}

Tensor evaluate(const TorchPerceptron& p, const Tensor& x) {
  return behind_first(p, torch::addmm(p.bias[0], x, p.weight[0].t()));
}

TorchGraph tensors_of(const TorchModel& model, const TorchGraphView& view) {
  std::size_t keys = 0;
  for (const TorchStep& step : model.steps) keys += step.edges.size();
  return tensors_of(view, model.node_encoder.weight[0].size(1), keys, model.device);
}

// Sums rows of edges per node in the order of the edges: the same bits each time, unlike index_add on a GPU.
Tensor summed(const Tensor& rows, const Tensor& count, const Tensor& edge) {
  return at::segment_reduce(rows.index_select(0, edge), "sum", count, {}, {}, 0, /*unsafe=*/true, 0.0);
}

// Rows of nodes at the ends of edges. Its derivative is `summed`.
struct AtEnds : torch::autograd::Function<AtEnds> {
  static Tensor forward(torch::autograd::AutogradContext* context, const Tensor& rows, const TorchEnds& ends) {
    context->save_for_backward({ends.count, ends.edge});
    return rows.index_select(0, ends.node);
  }
  static torch::autograd::tensor_list backward(torch::autograd::AutogradContext* context,
                                               const torch::autograd::tensor_list& gradient) {
    const auto saved = context->get_saved_variables();
    return {summed(gradient[0], saved[0], saved[1]), Tensor()};
  }
};

// `summed` with the derivative `AtEnds`.
struct SumAtEnds : torch::autograd::Function<SumAtEnds> {
  static Tensor forward(torch::autograd::AutogradContext* context, const Tensor& rows, const TorchEnds& ends) {
    context->save_for_backward({ends.node});
    return summed(rows, ends.count, ends.edge);
  }
  static torch::autograd::tensor_list backward(torch::autograd::AutogradContext* context,
                                               const torch::autograd::tensor_list& gradient) {
    return {gradient[0].index_select(0, context->get_saved_variables()[0]), Tensor()};
  }
};

// New values of the edges of a selection. The first layer multiplies each node once.
Tensor edge_values(const TorchModel& model, const TorchPerceptron& p, const Tensor& nodes, const Tensor& latents,
                   const TorchEdges& edges) {
  const std::int64_t w = model.width;
  const Tensor& weight = p.weight[0];
  const Tensor to_receiver = torch::addmm(p.bias[0], nodes, weight.slice(1, 0, w).t());
  const Tensor to_sender = nodes.matmul(weight.slice(1, w, 2 * w).t());
  const Tensor ends = AtEnds::apply(to_receiver, edges.receivers) + AtEnds::apply(to_sender, edges.senders);
  return behind_first(p, torch::addmm(ends, latents, weight.slice(1, 2 * w, 3 * w).t()));
}

Tensor run(const TorchModel& model, const TorchGraphView& view, const TorchGraph& graph) {
  Tensor nodes = evaluate(model.node_encoder, graph.nodes);
  std::vector<Tensor> edges(graph.features.size());
  for (std::size_t s = 0; s < edges.size(); ++s)
    if (view.edge_sets[s].used != 0)
      edges[s] = evaluate(model.encoders[static_cast<std::size_t>(view.edge_sets[s].encoder)], graph.features[s]);
  std::size_t at = 0;
  for (const TorchStep& step : model.steps) {
    std::vector<Tensor> inputs{nodes};
    for (std::size_t k = 0; k < step.edges.size(); ++k, ++at) {
      const TorchSelection& selection = view.selections[at];
      if (selection.set < 0) {
        inputs.push_back(torch::zeros_like(nodes));
        continue;
      }
      const TorchEdges& chosen = graph.selections[at];
      Tensor& latents = edges[static_cast<std::size_t>(selection.set)];
      const bool all = !chosen.taken.defined();
      const Tensor values =
          edge_values(model, step.edges[k], nodes, all ? latents : latents.index_select(0, chosen.taken), chosen);
      inputs.push_back(SumAtEnds::apply(values, chosen.receivers));
      latents = all ? latents + values : latents.index_add(0, chosen.taken, values);
    }
    nodes = nodes + evaluate(step.node, torch::cat(inputs, 1));
  }
  return evaluate(model.decoder, nodes.slice(0, 0, view.cloth_nodes));
}

// The name of the library that multiplies matrices, from libtorch's description of its build.
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
    make_parameters(*model, arrays, count);
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
    model.flat.copy_(flat_weights(arrays, count, model.device));
  });
}

void copy_out(const Tensor& tensor, float* to) {
  const Tensor values = tensor.detach().to(torch::kCPU).contiguous();
  std::copy_n(values.data_ptr<float>(), values.numel(), to);
}

int get_weights(void* handle, const TorchArray* arrays, int count, TorchReport* report) {
  return guarded(report, [&] {
    const Tensor values = static_cast<TorchModel*>(handle)->flat.to(torch::kCPU);
    const float* from = values.data_ptr<float>();
    for (int i = 0; i < count; from += size_of(arrays[i]), ++i) std::copy_n(from, size_of(arrays[i]), arrays[i].data);
  });
}

int forward(void* handle, const TorchGraphView* view, int keep, float* output, TorchReport* report) {
  return guarded(report, [&] {
    TorchModel& model = *static_cast<TorchModel*>(handle);
    const torch::AutoGradMode mode(keep != 0);
    TorchGraph graph = tensors_of(model, *view);
    if (keep != 0) {
      graph.nodes.requires_grad_();
      for (Tensor& features : graph.features) features.requires_grad_();
    }
    const Tensor made = run(model, *view, graph);
    copy_out(made, output);
    model.output = keep != 0 ? made : Tensor();
    model.graph = keep != 0 ? std::move(graph) : TorchGraph();
  });
}

Tensor derivative_of(const TorchModel& model, const float* d_output) {
  return torch::from_blob(const_cast<float*>(d_output), model.output.sizes()).clone().to(model.device);
}

void add_to(const TorchArray& array, const float* values) {
  for (std::int64_t k = 0; k < size_of(array); ++k) array.data[k] += values[k];
}

// Derivatives of tensors that do not affect the output are zero. All come back in one copy.
int backward(void* handle, const float* d_output, const TorchArray* gradients, int count,
             const TorchFeatureGradient* features, int feature_count, TorchReport* report) {
  return guarded(report, [&] {
    TorchModel& model = *static_cast<TorchModel*>(handle);
    if (!model.output.defined()) throw std::runtime_error("going backward needs a forward run that was kept");
    std::vector<Tensor> inputs(model.parameters.begin(), model.parameters.begin() + count);
    std::vector<TorchArray> arrays(gradients, gradients + count);
    for (int k = 0; k < feature_count; ++k) {
      const int set = features[k].set;
      inputs.push_back(set < 0 ? model.graph.nodes : model.graph.features.at(static_cast<std::size_t>(set)));
      arrays.push_back(features[k].array);
    }
    std::vector<Tensor> results = torch::autograd::grad({model.output}, inputs, {derivative_of(model, d_output)},
                                                        /*retain_graph=*/true, /*create_graph=*/false,
                                                        /*allow_unused=*/true);
    for (std::size_t i = 0; i < results.size(); ++i)
      results[i] =
          results[i].defined() ? results[i].reshape({-1}) : torch::zeros({inputs[i].numel()}, model.flat.options());
    const Tensor values = torch::cat(results).to(torch::kCPU);
    const float* from = values.data_ptr<float>();
    for (const TorchArray& array : arrays) {
      add_to(array, from);
      from += size_of(array);
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
    model.output = run(model, *view, tensors_of(model, *view));
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
