#include <cstdlib>

#include "pipeline/drapes/stage_file_hdf5.hpp"
#include "tests/fuzz/valid_hdf5.hpp"

using namespace selvedge;

namespace {

StageFile small_stage() {
  StageFile stage;
  stage.config = "drape: {}\n";
  stage.csv = "1,2\n";
  stage.step = 12;
  stage.random = 7;
  PlainNetwork network = make_plain_network({3, {4, 2}, Bend::softplus, 100, 1, 2}, 1);
  PlainAdam adam;
  adam.steps = 5;
  adam.first.assign(static_cast<std::size_t>(parameter_count(network)), 0.1f);
  adam.second = adam.first;
  stage.parts = {{"first", network, adam}, {"end", network, {}}};
  stage.numbers = {{"mean", {1, 2, 3}}};
  return stage;
}

}  // namespace

// The networks of what is read can be evaluated.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto write = [](const std::filesystem::path& path) { write_stage_file(path, small_stage()); };
  return fuzz::with_altered_file(data, size, write, [](const std::filesystem::path& path) {
    for (const StagePart& part : read_stage_file(path).parts) {
      const FeatureRows inputs = FeatureRows::Ones(1, part.network.inputs());
      if (evaluate(part.network, inputs).cols() != part.network.outputs()) std::abort();
    }
  });
}
