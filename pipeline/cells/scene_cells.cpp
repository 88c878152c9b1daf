#include "pipeline/cells/scene_cells.hpp"

#include <fmt/format.h>

#include "collision/geometry/error.hpp"
#include "pipeline/obstacles/setup_body.hpp"
#include "pipeline/run/run_inputs_yaml.hpp"

namespace selvedge {

std::vector<std::filesystem::path> needs_of(const Setup& setup) {
  std::vector<std::filesystem::path> needs{setup.file};
  const std::filesystem::path folder = input_folder(setup);
  for (const InputFile& file : input_files(setup)) needs.push_back((folder / file.name).lexically_normal());
  return needs;
}

std::string inputs_key(const Setup& setup) { return fmt::format("{:016x}", hash_anywhere(setup)); }

void keep_tissue(const Setup& setup, std::ostream* log) {
  try {
    write_tissue(setup.bodies);
  } catch (const Error& error) {
    if (log) *log << "warning: soft tissue is not kept: " << error.what() << "\n";
  }
}

}  // namespace selvedge
