#include "pipeline/weights/torch_tensor.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "pipeline/weights/pickle_check.hpp"

namespace selvedge {
namespace {

constexpr std::size_t most_dimensions = 8;
constexpr std::int64_t largest_storage = (std::int64_t{1} << 31) - 1;  // of one storage

template <class T>
const T* item(const Pickle& pickle, const PickleTuple& tuple, std::size_t k) {
  return std::get_if<T>(&pickle.values[tuple.items[k]]);
}

bool is_number_key(const std::string& key) {
  return !key.empty() && key.size() <= 20 && std::ranges::all_of(key, [](char c) { return c >= '0' && c <= '9'; });
}

std::vector<std::int64_t> extents(const Pickle& pickle, const PickleTuple& tuple, const char* noun,
                                  const std::string& where) {
  if (tuple.items.size() > most_dimensions)
    refuse_pickle(fmt::format("has a tensor of {} dimensions; {} are the most", tuple.items.size(), most_dimensions),
                  where);
  std::vector<std::int64_t> numbers;
  for (std::size_t k = 0; k < tuple.items.size(); ++k) {
    const auto* number = item<std::int64_t>(pickle, tuple, k);
    if (!number) refuse_pickle(fmt::format("has a tensor whose {} is no integer", noun), where);
    if (*number < 0 || *number > largest_storage)
      refuse_pickle(fmt::format("has a tensor with a {} of {}", noun, *number), where);
    numbers.push_back(*number);
  }
  return numbers;
}

}  // namespace

TorchStorage torch_storage(const Pickle& pickle, const PickleTuple& id, const std::string& where) {
  if (id.items.size() != 5) refuse_pickle(fmt::format("has a persistent id of {} parts", id.items.size()), where);
  const auto* word = item<std::string>(pickle, id, 0);
  const auto* type = item<PickleGlobal>(pickle, id, 1);
  const auto* key = item<std::string>(pickle, id, 2);
  const auto* location = item<std::string>(pickle, id, 3);
  const auto* count = item<std::int64_t>(pickle, id, 4);
  if (!word || *word != "storage" || !type || !key || !location || !count)
    refuse_pickle("has a persistent id that names no storage", where);
  if (*type != PickleGlobal::float_storage && *type != PickleGlobal::long_storage)
    refuse_pickle("has a storage of a type that holds no numbers", where);
  if (!is_number_key(*key)) refuse_pickle("has a storage under the key " + shown(*key), where);
  if (*count < 0 || *count > largest_storage) refuse_pickle(fmt::format("has a storage of {} numbers", *count), where);
  return {*type == PickleGlobal::float_storage ? TorchNumber::float32 : TorchNumber::int64, *key, *count};
}

TorchTensor torch_tensor(const Pickle& pickle, const PickleTuple& arguments, const std::string& where) {
  if (arguments.items.size() != 6)
    refuse_pickle(fmt::format("makes a tensor of {} arguments", arguments.items.size()), where);
  const auto* storage = item<TorchStorage>(pickle, arguments, 0);
  const auto* offset = item<std::int64_t>(pickle, arguments, 1);
  const auto* shape = item<PickleTuple>(pickle, arguments, 2);
  const auto* stride = item<PickleTuple>(pickle, arguments, 3);
  const auto* hooks = item<PickleDict>(pickle, arguments, 5);
  if (!storage || !offset || !shape || !stride || !item<bool>(pickle, arguments, 4) || !hooks)
    refuse_pickle("makes a tensor of arguments of the wrong types", where);
  if (!hooks->entries.empty()) refuse_pickle("has a tensor with hooks", where);
  TorchTensor tensor{*storage, *offset, 1, extents(pickle, *shape, "size", where),
                     extents(pickle, *stride, "stride", where)};
  if (tensor.shape.size() != tensor.stride.size())
    refuse_pickle(fmt::format("has a tensor of {} sizes and {} strides", tensor.shape.size(), tensor.stride.size()),
                  where);
  const std::int64_t there = storage->count;
  const auto outside = [&] {
    refuse_pickle(fmt::format("has a tensor of shape [{}] that does not lie inside its storage of {} numbers",
                              fmt::join(tensor.shape, ", "), there),
                  where);
  };
  if (*offset < 0 || *offset > there) outside();
  const bool empty = std::ranges::find(tensor.shape, 0) != tensor.shape.end();
  tensor.elements = empty ? 0 : 1;
  std::int64_t last = *offset;
  for (std::size_t k = 0; k < tensor.shape.size() && !empty; ++k) {
    // Before this, both are below 2^31, and so are the factors: nothing overflows.
    tensor.elements *= tensor.shape[k];
    last += (tensor.shape[k] - 1) * tensor.stride[k];
    if (tensor.elements > there || last >= there) outside();
  }
  if (!empty && last >= there) outside();  // a tensor without dimensions has one number
  return tensor;
}

}  // namespace selvedge
