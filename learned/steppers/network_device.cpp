#include "learned/steppers/network_device.hpp"

#include "collision/geometry/error.hpp"
#include "learned/gradients/torch_network.hpp"

namespace selvedge {

std::vector<std::pair<std::string, NetworkDevice>> network_devices() {
  return {{"cpu", NetworkDevice::cpu},
          {"libtorch", NetworkDevice::libtorch},
          {"cuda", NetworkDevice::cuda},
          {"auto", NetworkDevice::automatic}};
}

std::vector<std::pair<std::string, NetworkNumbers>> network_numbers() {
  return {{"float32", NetworkNumbers::float32}, {"int16", NetworkNumbers::int16}, {"auto", NetworkNumbers::automatic}};
}

InstructionSet kernels_of(NetworkNumbers numbers) {
  const bool has = is_supported(InstructionSet::vnni);
  if (numbers == NetworkNumbers::int16 && !has)
    throw Error("this processor does not add up products of 16-bit integers (AVX-512 VNNI)",
                "run.learned.numbers: int16", "give `auto` or `float32`");
  return numbers == NetworkNumbers::float32 || !has ? best_instruction_set() : InstructionSet::vnni;
}

namespace {

// Throws Error that names the key and a cure for machines without such a device.
std::unique_ptr<TorchNetwork> on_libtorch(const char* device, const Architecture& architecture,
                                          const NetworkWeights& weights) {
  try {
    return std::make_unique<TorchNetwork>(architecture, weights, device, 0);
  } catch (const Error& error) {
    const std::string cure = "give `cpu` or `auto`, which run where there is no GPU";
    throw Error(
        "the network cannot run there: " + error.problem() + " (" + error.where() + ")",
        std::string("`device` of the network (--device, run.learned.device, or device of a training file), on ") +
            (std::string(device) == "cpu" ? "libtorch" : device),
        error.cure().empty() ? cure : cure + "; or " + error.cure());
  }
}

}  // namespace

std::unique_ptr<TorchNetwork> torch_network_for(NetworkDevice device, const Architecture& architecture,
                                                const NetworkWeights& weights) {
  if (device == NetworkDevice::cpu) return nullptr;
  const bool choose = device == NetworkDevice::automatic;
  if (choose && !std::filesystem::exists(torch_library_path())) return nullptr;
  const char* name = choose ? "auto" : device == NetworkDevice::cuda ? "cuda" : "cpu";
  auto network = on_libtorch(name, architecture, weights);
  if (choose && network->facts().device == "cpu") return nullptr;
  return network;
}

std::string device_sentence(NetworkDevice device) {
  switch (device) {
    case NetworkDevice::cpu:
      return "the program's own kernels run the network";
    case NetworkDevice::libtorch:
      return "on the CPU, as run.learned.device asks";
    case NetworkDevice::cuda:
      return "on a GPU, as run.learned.device asks";
    case NetworkDevice::automatic:
      break;
  }
  return "where it finds a GPU, as run.learned.device asks; else the program's own kernels";
}

}  // namespace selvedge
