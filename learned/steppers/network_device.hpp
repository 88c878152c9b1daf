#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "learned/network/engine_kernels.hpp"

namespace selvedge {

struct Architecture;
struct NetworkWeights;
class TorchNetwork;

// The device that computes a network, in a roll-out or in training.
enum class NetworkDevice {
  cpu,       // the program's own kernels
  libtorch,  // libtorch on the CPU: the code that a GPU runs, for machines without one
  cuda,      // libtorch on the first CUDA device
  automatic  // cuda where libtorch's part is beside the program and finds a device, else cpu
};

// Numbers that the program's kernels multiply in a roll-out. They add up in 32 bits, and training always has 32.
enum class NetworkNumbers {
  float32,
  int16,     // integers of 16 bits, with a scale for each row, by the processor's own instruction (AVX-512 VNNI)
  automatic  // int16 where the processor has it, else float32
};

// The names of the numbers in scene files.
std::vector<std::pair<std::string, NetworkNumbers>> network_numbers();

// The kernels that multiply such numbers on this machine. Throws Error where it cannot.
InstructionSet kernels_of(NetworkNumbers);

// The names of the devices in scene and training files.
std::vector<std::pair<std::string, NetworkDevice>> network_devices();

// The network by libtorch if `device` selects it; null: the kernels run. Throws Error where libtorch's part is not
// beside the program or lacks the device.
std::unique_ptr<TorchNetwork> torch_network_for(NetworkDevice device, const Architecture&, const NetworkWeights&);

// Whether libtorch is used, as a sentence for `selvedge plan`.
std::string device_sentence(NetworkDevice);

}  // namespace selvedge
