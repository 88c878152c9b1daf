#include <yaml-cpp/yaml.h>

#include "collision/geometry/error.hpp"
#include "pipeline/host/read_file.hpp"
#include "pipeline/suites/work_keys.hpp"

namespace selvedge {

WorkKeys work_keys(const std::filesystem::path& file) {
  WorkKeys keys;
  try {
    const YAML::Node root = YAML::Load(read_text_file(file, "file of cells"));
    if (!root.IsMap()) throw Error("is not a list of `key: value`", file.string(), "docs/cells.md says what it may be");
    for (const auto& pair : root) keys.names.insert(pair.first.Scalar());
    if (const YAML::Node cells = root["cells"]; cells && cells.IsScalar()) keys.cells = cells.Scalar();
  } catch (const YAML::Exception& e) {
    throw Error("cannot be read: " + e.msg, file.string(), "write `key: value`, as docs/cells.md shows");
  }
  return keys;
}

}  // namespace selvedge
