#include <cstdlib>

#include "learned/network/weight_seal.hpp"
#include "learned/network/weights_hdf5.hpp"
#include "tests/fuzz/valid_hdf5.hpp"

using namespace selvedge;

namespace {

// Two steps of width 4: small, and with every kind of array.
WeightFile small_network() {
  Architecture a = architecture_preset("contourcraft");
  a.width = 4;
  a.steps.resize(2);
  return {a, random_weights(a, 3), "iterations: 7\n", {{"source", "fuzz"}}, "0.1.0"};
}

}  // namespace

// What is read has the architecture's shapes. Altered files are sealed, as a forger would; damaged ones are not.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto write = [](const std::filesystem::path& path) { write_weight_file(path, small_network()); };
  return fuzz::with_altered_file(data, size, write, [](const std::filesystem::path& path) {
    if (std::getenv("SELVEDGE_FUZZ_DAMAGE") == nullptr) write_seal(path);
    const WeightFile file = read_weight_file(path);
    check_weights(file.architecture, file.weights, path.string());
  });
}
