#include <CLI/CLI.hpp>
#include <memory>
#include <utility>

#include "collision/geometry/error.hpp"
#include "learned/network/weights_hdf5.hpp"
#include "pipeline/commands/command_output.hpp"
#include "pipeline/commands/commands.hpp"
#include "pipeline/host/version.hpp"
#include "pipeline/weights/import_weights.hpp"
#include "pipeline/weights/weights_info.hpp"
#include "pipeline/weights/weights_parity.hpp"

namespace selvedge {
namespace {

struct TwoFiles {
  std::filesystem::path from, other;  // other: what is written, or compared with
};

void refuse_same(const TwoFiles& files) {
  std::error_code ignored;
  if (std::filesystem::equivalent(files.from, files.other, ignored))
    throw Error("is the file that is read", "--out " + files.other.string(), "give the new file another name");
}

int print_weights(const WeightFile& file, bool json) {
  const WeightsInfo info = weights_info(file);
  return end_command(json, weights_info_text(info), weights_info_json(info), true);
}

}  // namespace

RunCommand weights_import_command(CLI::App& command) {
  const auto files = std::make_shared<TwoFiles>();
  command.add_option("checkpoint", files->from, "checkpoint that the authors of HOOD or ContourCraft published (.pth)")
      ->required();
  command.add_option("--out", files->other, "file for the weights (.h5)")->required();
  return [files](bool json) {
    refuse_same(*files);
    ImportedWeights imported = read_published_weights(files->from);
    const WeightFile file{imported.architecture, std::move(imported.weights), "", origin_of(imported),
                          std::string(program_version())};
    write_weight_file(files->other, file);
    return print_weights(file, json);
  };
}

RunCommand weights_info_command(CLI::App& command) {
  const auto file = std::make_shared<std::filesystem::path>();
  command.add_option("file", *file, "weight file (.h5)")->required();
  return [file](bool json) { return print_weights(read_weight_file(*file), json); };
}

RunCommand weights_halve_command(CLI::App& command) {
  const auto files = std::make_shared<TwoFiles>();
  command.add_option("file", files->from, "weight file (.h5)")->required();
  command.add_option("--out", files->other, "file for the weights in 16-bit floats (.h5)")->required();
  return [files](bool json) {
    refuse_same(*files);
    write_weight_file(files->other, read_weight_file(files->from), WeightStorage::half);
    return print_weights(read_weight_file(files->other), json);
  };
}

RunCommand weights_parity_command(CLI::App& command) {
  const auto files = std::make_shared<TwoFiles>();
  command.add_option("file", files->from, "weight file (.h5) or published checkpoint (.pth)")->required();
  command.add_option("dump", files->other, "recording of a step by the authors' code (.npz)")->required();
  return [files](bool json) {
    const bool is_checkpoint = files->from.extension() == ".pth";
    ImportedWeights network;
    if (is_checkpoint) {
      network = read_published_weights(files->from);
    } else {
      WeightFile file = read_weight_file(files->from);
      network.architecture = std::move(file.architecture);
      network.weights = std::move(file.weights);
    }
    const ParityReport report =
        weights_parity(network.architecture, network.weights, read_parity_dump(files->other, network.architecture),
                       is_checkpoint ? &network.sums : nullptr);
    return end_command(json, parity_text(report), parity_json(report), is_clean(report));
  };
}

}  // namespace selvedge
