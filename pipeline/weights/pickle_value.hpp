#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace selvedge {

// The index of a value in a Pickle. Values refer to each other by it, so that reading and freeing need no recursion.
using PickleIndex = std::uint32_t;

enum class TorchNumber { float32, int64 };

// Numbers stored together in an archive under `key`. Tensors are views of them.
struct TorchStorage {
  TorchNumber number = TorchNumber::float32;
  std::string key;
  std::int64_t count = 0;
};

// Element (i, j, ..) is number offset + i stride[0] + j stride[1] + .. of the storage. All elements lie inside the
// storage, which has at least as many numbers.
struct TorchTensor {
  TorchStorage storage;
  std::int64_t offset = 0, elements = 0;
  std::vector<std::int64_t> shape, stride;
};

struct PickleNone {};
struct PickleList {
  std::vector<PickleIndex> items;
};
struct PickleTuple {
  std::vector<PickleIndex> items;
};
struct PickleDict {
  std::vector<std::pair<PickleIndex, PickleIndex>> entries;  // in the order of the file; keys are text or integers
};

// The globals that a file may call. A finished Pickle has none of them, and no bare storage.
enum class PickleGlobal { ordered_dict, float_storage, long_storage, rebuild_tensor };

using PickleValue = std::variant<PickleNone, bool, std::int64_t, double, std::string, PickleList, PickleTuple,
                                 PickleDict, TorchTensor, TorchStorage, PickleGlobal>;

struct Pickle {
  std::vector<PickleValue> values;
  PickleIndex root = 0;
};

// Text of a file for a message: short, printable, on one line.
std::string shown(std::string_view);

}  // namespace selvedge
