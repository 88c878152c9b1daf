#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/formats/zip_archive.hpp"
#include "pipeline/weights/pickle.hpp"

namespace selvedge {

// A file of torch.save (torch 1.6 or newer): a ZIP archive with one pickle of plain values and one entry per storage.
// The pickle is read at once, and a tensor's numbers on request. An entry has at most 256 MiB, and all reads of one
// object together 1 GiB. Compressed entries are refused, so that no entry is larger than the file. Throws Error for
// everything that pickle.hpp and zip_archive.hpp refuse.
class TorchArchive {
 public:
  explicit TorchArchive(const std::filesystem::path&);

  const std::filesystem::path& path() const { return path_; }
  const Pickle& pickle() const { return pickle_; }
  const PickleValue& root() const { return pickle_.values[pickle_.root]; }

  // The tensor's numbers, the last index fastest. `name` is for messages. Throws Error for a tensor of integers, and
  // for a storage that is missing or of another size than the pickle says.
  std::vector<float> floats(const TorchTensor&, const std::string& name);

 private:
  std::string bytes(const std::string& name);  // of the entry in the archive's folder

  std::filesystem::path path_;
  ZipArchive archive_;
  std::string stem_;
  std::uint64_t read_ = 0;
  Pickle pickle_;
};

}  // namespace selvedge
