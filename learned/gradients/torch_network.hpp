#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "learned/gradients/training_network.hpp"

namespace selvedge {

// The path of the shared library with libtorch: beside the running program.
std::filesystem::path torch_library_path();

// Facts that are found at start-up.
struct TorchFacts {
  std::string version, device, blas;
  int threads = 0;
  double gemm_flops = 0;           // [1/s]
  bool flushes_denormals = false;  // after loading; standard arithmetic is restored by then
};

// The same network, computed by libtorch. Tests compare the kernels with it, and it runs on a GPU where there is one.
// Its layers have the textbook form, except that first layers are split per node. All sums have a fixed order, on a GPU
// too.
class TorchNetwork {
 public:
  // `device`: auto, cpu or cuda. `threads`: 0 keeps libtorch's number. Throws Error where there is no library at
  // `library`, where it is of another version, or where the device is missing. The library is never unloaded.
  TorchNetwork(const Architecture&, const NetworkWeights&, const std::string& device, int threads,
               const std::filesystem::path& library = torch_library_path());
  ~TorchNetwork();
  TorchNetwork(TorchNetwork&&) noexcept;

  const TorchFacts& facts() const;
  void set_weights(const NetworkWeights&);
  void get_weights(NetworkWeights&) const;  // leaves embeddings and statistics unchanged

  FeatureRows infer(const Graph&);
  // They work as run_forward and run_backward of training_network.hpp. Several backward runs may follow a forward one.
  // `tables` are those that normalised the graph's features.
  FeatureRows run_forward(const Graph&);
  void run_backward(const Graph&, const FeatureTables& tables, const FeatureRows& d_output, WeightGradients&);
  // Runs forward, backward and one step of libtorch's Adam. Returns the output before the step. Embeddings stay.
  FeatureRows train(const Graph&, const FeatureRows& d_output, double learning_rate);

 private:
  struct Handle;
  std::unique_ptr<Handle> handle_;
};

}  // namespace selvedge
