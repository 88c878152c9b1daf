#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "learned/gradients/training_network.hpp"

namespace selvedge {

// Where the shared library with libtorch is looked for: beside the running program.
std::filesystem::path torch_library_path();

// Found out at start-up.
struct TorchFacts {
  std::string version, device, blas;
  int threads = 0;
  double gemm_flops = 0;           // a second
  bool flushes_denormals = false;  // after loading; standard arithmetic is restored by then
};

// The same network, computed by libtorch: what the kernels are compared with, and what runs on a GPU where there is
// one. It has the textbook form, but for first layers split per node. All sums have a fixed order, on a GPU too.
class TorchNetwork {
 public:
  // `device`: auto, cpu or cuda. `threads`: 0 leaves libtorch's. Throws Error where there is no library at `library`,
  // where it is of another version, or where the device is not there. It is never unloaded.
  TorchNetwork(const Architecture&, const NetworkWeights&, const std::string& device, int threads,
               const std::filesystem::path& library = torch_library_path());
  ~TorchNetwork();
  TorchNetwork(TorchNetwork&&) noexcept;

  const TorchFacts& facts() const;
  void set_weights(const NetworkWeights&);
  void get_weights(NetworkWeights&) const;  // all but embeddings and statistics, which stay

  FeatureRows infer(const Graph&);
  // As run_forward, run_backward of training_network.hpp; several backward runs may follow a forward one. `tables` are
  // those that the graph's features were normalised with.
  FeatureRows run_forward(const Graph&);
  void run_backward(const Graph&, const FeatureTables& tables, const FeatureRows& d_output, WeightGradients&);
  // Forward, backward and a step of libtorch's own Adam; the output before the step. Embeddings stay.
  FeatureRows train(const Graph&, const FeatureRows& d_output, double learning_rate);

 private:
  struct Handle;
  std::unique_ptr<Handle> handle_;
};

}  // namespace selvedge
