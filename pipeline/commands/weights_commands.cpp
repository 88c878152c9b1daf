#include "pipeline/commands/weights_commands.hpp"

#include <iostream>
#include <utility>

#include "learned/network/weights_hdf5.hpp"
#include "pipeline/host/version.hpp"
#include "pipeline/weights/import_weights.hpp"
#include "pipeline/weights/weights_info.hpp"
#include "pipeline/weights/weights_parity.hpp"

namespace selvedge {
namespace {

void print_weights(const WeightFile& file, bool json) {
  const WeightsInfo info = weights_info(file);
  (json ? std::cerr : std::cout) << weights_info_text(info);
  if (json) std::cout << weights_info_json(info);
}

}  // namespace

int weights_import_command(const WeightsImportArguments& arguments, bool json) {
  ImportedWeights imported = read_published_weights(arguments.checkpoint);
  const WeightFile file{imported.architecture, std::move(imported.weights), "", origin_of(imported),
                        std::string(program_version())};
  write_weight_file(arguments.out, file);
  print_weights(file, json);
  return 0;
}

int weights_info_command(const WeightsInfoArguments& arguments, bool json) {
  print_weights(read_weight_file(arguments.file), json);
  return 0;
}

int weights_halve_command(const WeightsHalveArguments& arguments, bool json) {
  write_weight_file(arguments.out, read_weight_file(arguments.file), WeightStorage::half);
  print_weights(read_weight_file(arguments.out), json);
  return 0;
}

int weights_parity_command(const WeightsParityArguments& arguments, bool json) {
  const bool is_checkpoint = arguments.file.extension() == ".pth";
  ImportedWeights network;
  if (is_checkpoint) {
    network = read_published_weights(arguments.file);
  } else {
    WeightFile file = read_weight_file(arguments.file);
    network.architecture = std::move(file.architecture);
    network.weights = std::move(file.weights);
  }
  const ParityReport report =
      weights_parity(network.architecture, network.weights, read_parity_dump(arguments.dump, network.architecture),
                     is_checkpoint ? &network.sums : nullptr);
  (json ? std::cerr : std::cout) << parity_text(report);
  if (json) std::cout << parity_json(report);
  return is_clean(report) ? 0 : 1;
}

}  // namespace selvedge
