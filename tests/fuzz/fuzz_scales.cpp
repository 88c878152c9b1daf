#include <cstdlib>

#include "pipeline/hdf5/neighbour_scale_hdf5.hpp"
#include "tests/fuzz/valid_hdf5.hpp"

using namespace selvedge;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto write = [](const std::filesystem::path& path) {
    write_neighbour_scale(path, make_neighbour_scale({5, 0.002, 0.03, ScaleRange::at_least_zero}, 9));
  };
  return fuzz::with_altered_file(data, size, write, [](const std::filesystem::path& path) {
    const NeighbourScale scale = read_neighbour_scale(path);
    const FeatureRows inputs = FeatureRows::Ones(1, scale.first.inputs());
    if (evaluate(scale.first, inputs).cols() != scale.first.outputs()) std::abort();
  });
}
