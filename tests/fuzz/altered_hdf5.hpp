#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <hdf5.h>

namespace selvedge::fuzz {

// The datasets of a valid file, from which files with other ranks, extents, types and values are written.
class AlteredHdf5 {
 public:
  explicit AlteredHdf5(const std::filesystem::path& valid);

  // A file that is valid for HDF5, with an empty user block of the valid one's length. `bytes` select the changes;
  // none: no change.
  void write(const std::uint8_t* bytes, std::size_t size, const std::filesystem::path& path) const;

 private:
  struct Field {
    std::string name;
    hid_t type = -1;  // type in the file
    std::vector<hsize_t> shape;
    std::vector<char> values;
  };
  std::vector<std::string> groups_;
  std::vector<Field> fields_;
  hsize_t user_block_ = 0;  // [bytes] before the HDF5 part, as in the valid file
};

}  // namespace selvedge::fuzz
