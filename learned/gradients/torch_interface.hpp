#pragma once

#include <cstdint>

// The interface between the program and the shared library with libtorch: plain structs, and one C function that
// returns a table of calls. No exception crosses it: calls return 0, or another number and a message in the report.
namespace selvedge {

constexpr int torch_interface_version = 2;

// An architecture as numbers, in the order of its weights (weight_arrays).
struct TorchShape {
  int width = 0, hidden_layers = 0, layer_norm = 0, node_inputs = 0, outputs = 0;
  int encoders = 0;
  const int* encoder_inputs = nullptr;  // one per encoder
  int steps = 0;
  const int* step_keys = nullptr;  // number of keys of each step
};

struct TorchArray {
  float* data = nullptr;
  std::int64_t rows = 0, columns = 0;  // columns: 0 for a vector
};

struct TorchEdgeSet {
  int encoder = 0;
  std::int64_t edges = 0, inputs = 0;
  const float* features = nullptr;
  int used = 0;  // by any step
};

// Edges of one key in one step.
struct TorchSelection {
  int set = -1;  // -1: none
  int all = 0;   // 1: every edge of the set, in order
  std::int64_t edges = 0;
  const std::int64_t *edge = nullptr, *receiver = nullptr, *sender = nullptr;  // receiver, sender: nodes
};

struct TorchGraphView {
  std::int64_t nodes = 0, cloth_nodes = 0;
  const float* node_features = nullptr;
  int sets = 0;
  const TorchEdgeSet* edge_sets = nullptr;
  const TorchSelection* selections = nullptr;  // all keys of step 0, of step 1, ..
};

struct TorchReport {
  char error[512] = {};
  char device[32] = {};   // cpu or cuda:0
  char library[32] = {};  // version of libtorch
  char blas[32] = {};     // name of the library that multiplies matrices
  int threads = 0;        // threads of libtorch
  double gemm_flops = 0;  // rate of a product of 512 x 512 matrices [1/s]
  int flushes_denormals = 0;
};

// An array to which derivatives by features are added: by those of the nodes or of a set's edges.
struct TorchFeatureGradient {
  int set = -1;  // -1: nodes
  TorchArray array;
};

struct TorchCalls {
  int version;
  // Arrays are all trained ones except embeddings, in the order of weight_arrays. `device` is auto, cpu or cuda.
  // Returns null where it fails; the report says why.
  void* (*make)(const TorchShape*, const TorchArray*, int count, const char* device, int threads, TorchReport*);
  void (*discard)(void*);
  int (*set_weights)(void*, const TorchArray*, int count, TorchReport*);
  int (*get_weights)(void*, const TorchArray*, int count, TorchReport*);
  // `output`: cloth_nodes x outputs. If `keep` is not 0, the call keeps what backward needs.
  int (*forward)(void*, const TorchGraphView*, int keep, float* output, TorchReport*);
  // Adds to the gradients of the arrays of `make`, and to those of features.
  int (*backward)(void*, const float* d_output, const TorchArray* gradients, int count, const TorchFeatureGradient*,
                  int feature_count, TorchReport*);
  // Runs forward, backward from d_output, and one step of libtorch's Adam with this rate.
  int (*train)(void*, const TorchGraphView*, const float* d_output, double learning_rate, float* output, TorchReport*);
};

constexpr const char* torch_entry = "selvedge_torch_calls";
using TorchEntry = const TorchCalls* (*)();

}  // namespace selvedge
