#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <hdf5.h>

namespace selvedge::fuzz {

// The datasets of a valid file, to write files from in which some of them have other ranks, extents, types and values.
class AlteredHdf5 {
 public:
  explicit AlteredHdf5(const std::filesystem::path& valid);

  // A file that HDF5 itself has no objection to, with an empty user block of the valid one's length. `bytes` say what
  // is altered; none: nothing.
  void write(const std::uint8_t* bytes, std::size_t size, const std::filesystem::path& path) const;

 private:
  struct Field {
    std::string name;
    hid_t type = -1;  // in the file
    std::vector<hsize_t> shape;
    std::vector<char> values;
  };
  std::vector<std::string> groups_;
  std::vector<Field> fields_;
  hsize_t user_block_ = 0;  // [bytes] before the HDF5 part, as the valid file has them
};

}  // namespace selvedge::fuzz
