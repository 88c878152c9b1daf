#include "pipeline/weights/import_weights.hpp"

#include <fmt/format.h>

#include <cstring>
#include <map>

#include "collision/geometry/error.hpp"
#include "pipeline/weights/published_names.hpp"

namespace selvedge {
namespace {

constexpr long long most_parameters = 64'000'000;  // 256 MB; the largest published network has 12 million

const char* const published_cure =
    "take the file as the authors published it, or as their own code saves it; docs/weights.md lists the kinds";

// The tensors of a state dictionary by name. Tensors that were taken are erased, so that extra ones are found.
class StateDict {
 public:
  StateDict(TorchArchive& archive, const PickleDict& dict) : archive_(archive), where_(archive.path().string()) {
    const Pickle& pickle = archive.pickle();
    for (const auto& [key, value] : dict.entries) {
      const auto* name = std::get_if<std::string>(&pickle.values[key]);
      if (!name) throw Error("has a tensor without a name", where_ + ": training_module", published_cure);
      const auto* tensor = std::get_if<TorchTensor>(&pickle.values[value]);
      if (!tensor) throw Error("is no tensor", where_ + ": " + shown(*name), published_cure);
      tensors_.emplace(*name, tensor);
      names_.push_back(*name);
    }
  }

  const std::vector<std::string>& names() const { return names_; }

  // Extent of a dimension of a tensor. Throws Error if the tensor is missing.
  std::int64_t extent(const std::string& name, std::size_t dimension) const {
    const TorchTensor& tensor = at(name);
    if (dimension >= tensor.shape.size())
      throw Error(fmt::format("has {} dimensions", tensor.shape.size()), where_ + ": " + name, published_cure);
    return tensor.shape[dimension];
  }

  std::vector<float> take(const std::string& name, const std::vector<std::int64_t>& shape) {
    const TorchTensor& tensor = at(name);
    if (tensor.shape != shape)
      throw Error(
          fmt::format("has the shape [{}] instead of [{}]", fmt::join(tensor.shape, ", "), fmt::join(shape, ", ")),
          where_ + ": " + name, published_cure);
    std::vector<float> numbers = archive_.floats(tensor, name);
    numbers_read_ += static_cast<long long>(numbers.size());
    tensors_.erase(name);
    return numbers;
  }

  // Throws Error if a tensor is left.
  long long finish(const std::string& kind) const {
    for (const std::string& name : names_)
      if (tensors_.contains(name))
        throw Error(
            fmt::format("has no place in a network of kind {}; {} such tensors are in the file", kind, tensors_.size()),
            where_ + ": " + shown(name), published_cure);
    return numbers_read_;
  }

 private:
  const TorchTensor& at(const std::string& name) const {
    const auto found = tensors_.find(name);
    if (found == tensors_.end()) throw Error("is missing", where_ + ": " + name, published_cure);
    return *found->second;
  }

  TorchArchive& archive_;
  std::string where_;
  std::map<std::string, const TorchTensor*> tensors_;
  std::vector<std::string> names_;
  long long numbers_read_ = 0;
};

std::vector<std::string> top_keys(const TorchArchive& archive) {
  std::vector<std::string> keys;
  if (const auto* dict = std::get_if<PickleDict>(&archive.root()))
    for (const auto& [key, value] : dict->entries)
      if (const auto* name = std::get_if<std::string>(&archive.pickle().values[key])) keys.push_back(shown(*name));
  return keys;
}

const PickleDict& training_module(const TorchArchive& archive) {
  const PickleValue* const module = find(archive.pickle(), archive.root(), "training_module");
  if (const auto* dict = module ? std::get_if<PickleDict>(module) : nullptr) return *dict;
  throw Error(fmt::format("has no dictionary training_module; at its top are: {}", fmt::join(top_keys(archive), ", ")),
              archive.path().string(), published_cure);
}

// The network, by the names of the tensors and the width of the decoder.
Architecture architecture_of(const StateDict& tensors, const std::string& where) {
  const std::string kind = published_kind(tensors.names());
  if (kind.empty())
    throw Error(fmt::format("holds no network of HOOD or ContourCraft: none of its {} tensors is named as theirs",
                            tensors.names().size()),
                where, published_cure);
  if (kind.starts_with("fine") && kind != fmt::format("fine{}", fine_steps(tensors.names())))
    throw Error(fmt::format("has {} processor_steps; fine15 has 15 and fine48 has 48", fine_steps(tensors.names())),
                where, published_cure);
  Architecture architecture = architecture_preset(kind);
  const std::string decoder = published_name(architecture, "decoder/layer0/weight");
  const std::int64_t width = tensors.extent(decoder, 0);
  if (width < 1 || width > 4096)
    throw Error(fmt::format("makes the network {} wide; 1 to 4096 are possible", width), where + ": " + decoder,
                published_cure);
  architecture.width = static_cast<int>(width);
  if (parameter_count(architecture) > most_parameters)
    throw Error(fmt::format("asks for {} parameters; {} are the most", parameter_count(architecture), most_parameters),
                where, published_cure);
  return architecture;
}

void take_statistics(StateDict& tensors, const std::string& set, int columns, Accumulators& sums,
                     Statistics& statistics) {
  if (columns == 0) return;
  const PublishedSums names = published_sums(set);
  sums.rows = tensors.take(names.rows, {1})[0];
  sums.updates = tensors.take(names.updates, {1})[0];
  sums.sum = tensors.take(names.sum, {1, columns});
  sums.sum_squared = tensors.take(names.sum_squared, {1, columns});
  statistics = statistics_of(sums);
}

void take_weights(StateDict& tensors, const Architecture& architecture, NetworkWeights& weights) {
  for (const WeightArray& array : weight_arrays(architecture, weights)) {
    if (!array.trained) continue;
    std::vector<std::int64_t> shape{array.rows};
    const bool is_vector = array.name.ends_with("/bias") || array.name.find("/norm/") != std::string::npos;
    if (!is_vector) shape.push_back(array.columns);
    const std::vector<float> numbers = tensors.take(published_name(architecture, array.name), shape);
    std::memcpy(array.data, numbers.data(), sizeof(float) * numbers.size());
  }
}

}  // namespace

ImportedWeights read_published_weights(const std::filesystem::path& path) {
  TorchArchive archive(path);
  StateDict tensors(archive, training_module(archive));
  ImportedWeights imported;
  imported.architecture = architecture_of(tensors, path.string());
  imported.weights = blank_weights(imported.architecture);
  take_weights(tensors, imported.architecture, imported.weights);
  const auto take = [&tensors](const std::string& set, int columns, Accumulators& sums, Statistics& statistics) {
    take_statistics(tensors, set, columns, sums, statistics);
  };
  visit_statistics(take, imported.architecture.statistics, imported.sums, imported.weights.tables);
  imported.numbers = tensors.finish(imported.architecture.name);
  imported.file = shown(path.filename().string());
  imported.bytes = std::filesystem::file_size(path);
  imported.parts = top_keys(archive);
  return imported;
}

std::vector<std::pair<std::string, std::string>> origin_of(const ImportedWeights& imported) {
  return {{"imported from", imported.file},
          {"its bytes", std::to_string(imported.bytes)},
          {"its parts", fmt::format("{}", fmt::join(imported.parts, ", "))},
          {"numbers read", std::to_string(imported.numbers)}};
}

}  // namespace selvedge
