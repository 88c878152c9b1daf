#include "pipeline/weights/torch_archive.hpp"

#include <fmt/format.h>

#include <bit>
#include <cstring>

#include "collision/geometry/error.hpp"
#include "pipeline/weights/pickle_check.hpp"

namespace selvedge {
namespace {

static_assert(std::endian::native == std::endian::little, "storages are read as they lie in the file");

// The folder inside of the archive, which torch names after the saved file.
std::string archive_stem(const std::vector<std::string>& names, const std::string& where) {
  constexpr std::string_view pickle = "/data.pkl";
  std::vector<std::string> stems;
  for (const std::string& name : names)
    if (name.ends_with(pickle)) stems.push_back(name.substr(0, name.size() - pickle.size()));
  if (stems.size() != 1)
    refuse_pickle(fmt::format("has {} entries named data.pkl instead of one", stems.size()), where);
  return stems.front();
}

// Calls `take` with each element and its position in the storage, the last index fastest.
template <class Take>
void for_each_element(const TorchTensor& tensor, const Take& take) {
  std::vector<std::int64_t> index(tensor.shape.size(), 0);
  std::int64_t at = tensor.offset;
  for (std::int64_t element = 0; element < tensor.elements; ++element) {
    take(element, at);
    for (std::size_t k = tensor.shape.size(); k-- > 0;) {
      at += tensor.stride[k];
      if (++index[k] < tensor.shape[k]) break;
      at -= tensor.stride[k] * tensor.shape[k];
      index[k] = 0;
    }
  }
}

}  // namespace

TorchArchive::TorchArchive(const std::filesystem::path& path)
    : path_(path), archive_(path), stem_(archive_stem(archive_.names(), path.string())) {
  const std::string order = stem_ + "/byteorder";
  if (archive_.has(order) && archive_.bytes(order) != "little")
    refuse_pickle("was saved by a machine of another byte order", path.string());
  pickle_ = read_pickle(archive_.bytes(stem_ + "/data.pkl"), path.string() + ": data.pkl");
}

std::vector<float> TorchArchive::floats(const TorchTensor& tensor, const std::string& name) {
  const std::string where = path_.string() + ": " + name;
  if (tensor.storage.number != TorchNumber::float32) refuse_pickle("holds integers, not float32", where);
  const std::string bytes = archive_.bytes(stem_ + "/data/" + tensor.storage.key);
  if (bytes.size() != sizeof(float) * static_cast<std::size_t>(tensor.storage.count))
    refuse_pickle(fmt::format("has {} bytes in its storage {} instead of {} numbers", bytes.size(), tensor.storage.key,
                              tensor.storage.count),
                  where);
  std::vector<float> numbers(static_cast<std::size_t>(tensor.elements));
  for_each_element(tensor, [&](std::int64_t element, std::int64_t at) {
    std::memcpy(&numbers[static_cast<std::size_t>(element)],
                bytes.data() + sizeof(float) * static_cast<std::size_t>(at), sizeof(float));
  });
  return numbers;
}

}  // namespace selvedge
