#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/formats/npy.hpp"
#include "pipeline/formats/zip_archive.hpp"

namespace selvedge {

// An .npz file as numpy.savez and numpy.savez_compressed write it: arrays by name. Only the requested arrays are read,
// so that other content, even pickled objects, does not matter.
class Npz {
 public:
  explicit Npz(const std::filesystem::path&);  // throws Error for a file that cannot be opened or is no .npz

  bool has(const std::string& name) const;
  std::vector<std::string> names() const;  // in the order of the file
  NpyPlace place(const std::string& name) const;

  // See npy.hpp. They throw Error, naming the file and the array, also if it is missing or damaged.
  NpyArray<double> numbers(const std::string& name) const;
  NpyArray<std::int64_t> integers(const std::string& name) const;
  NpyArray<std::string> texts(const std::string& name) const;

 private:
  std::string bytes(const std::string& name) const;

  std::filesystem::path path_;
  ZipArchive archive_;
};

}  // namespace selvedge
