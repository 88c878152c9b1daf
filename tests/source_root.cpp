#include "tests/source_root.hpp"

namespace selvedge {

const std::filesystem::path& source_root() {
  static const std::filesystem::path root = SELVEDGE_SOURCE_DIR;
  return root;
}

}  // namespace selvedge
