#include "pipeline/cells/scene_cells.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "collision/geometry/error.hpp"
#include "pipeline/obstacles/setup_body.hpp"
#include "pipeline/obstacles/setup_paths.hpp"
#include "pipeline/run/run_inputs_yaml.hpp"

namespace selvedge {

namespace fs = std::filesystem;

std::vector<fs::path> config_files_near(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code absent;  // a folder that is not there has none
  for (const fs::path& place : config_folders(folder.empty() ? "." : folder)) {
    if (fs::equivalent(place, config_folder(), absent)) continue;
    if (fs::is_regular_file(place / "outfits.yaml", absent)) files.push_back(place / "outfits.yaml");
    for (const fs::directory_entry& entry : fs::directory_iterator(place / "materials", absent))
      if (entry.path().extension() == ".yaml") files.push_back(entry.path());
  }
  for (fs::path& file : files) file = file.lexically_normal();
  std::ranges::sort(files);
  return files;
}

std::vector<fs::path> needs_of(const Setup& setup) {
  std::vector<fs::path> needs{setup.file};
  const fs::path folder = input_folder(setup);
  for (const InputFile& file : input_files(setup)) needs.push_back((folder / file.name).lexically_normal());
  for (const fs::path& file : config_files_near(folder)) needs.push_back(file);
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
