#include "pipeline/weights/torch_archive.hpp"

#include <fmt/format.h>

#include <bit>
#include <cstring>

#include "collision/geometry/error.hpp"
#include "pipeline/weights/pickle_check.hpp"

namespace selvedge {
namespace {

static_assert(std::endian::native == std::endian::little, "storages are read as they lie in the file");

constexpr std::int64_t largest_entry = std::int64_t{256} << 20;
constexpr std::uint64_t most_read = std::uint64_t{1} << 30;

const ZipForm torch_form{
    "weights",
    "is it a file of torch.save, and whole? Load and save older ones (before torch 1.6) again with a newer",
    "save the weights with torch.save, which neither compresses nor encrypts",
    false,
    largest_entry,
    false};

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
    : path_(path), archive_(path, torch_form), stem_(archive_stem(archive_.names(), path.string())) {
  if (archive_.has(stem_ + "/byteorder") && bytes("byteorder") != "little")
    refuse_pickle("was saved by a machine of another byte order", path.string());
  pickle_ = read_pickle(bytes("data.pkl"), path.string() + ": data.pkl");
}

std::string TorchArchive::bytes(const std::string& name) {
  std::string content = archive_.bytes(stem_ + "/" + name, path_.string() + ": " + shown(name));
  read_ += content.size();
  if (read_ > most_read)
    refuse_pickle(fmt::format("holds more than the {} bytes that are read at most", most_read), path_.string());
  return content;
}

std::vector<float> TorchArchive::floats(const TorchTensor& tensor, const std::string& name) {
  const std::string where = path_.string() + ": " + name;
  if (tensor.storage.number != TorchNumber::float32) refuse_pickle("holds integers, not float32", where);
  const std::string stored = bytes("data/" + tensor.storage.key);
  if (stored.size() != sizeof(float) * static_cast<std::size_t>(tensor.storage.count))
    refuse_pickle(fmt::format("has {} bytes in its storage {} instead of {} numbers", stored.size(), tensor.storage.key,
                              tensor.storage.count),
                  where);
  std::vector<float> numbers(static_cast<std::size_t>(tensor.elements));
  for_each_element(tensor, [&](std::int64_t element, std::int64_t at) {
    std::memcpy(&numbers[static_cast<std::size_t>(element)],
                stored.data() + sizeof(float) * static_cast<std::size_t>(at), sizeof(float));
  });
  return numbers;
}

}  // namespace selvedge
