#include "pipeline/run/run_folder.hpp"

#include "pipeline/host/write_file.hpp"

namespace selvedge {

void remove_results(const std::filesystem::path& folder) {
  remove_made_of_frames(folder);
  for (const char* name : {"checkpoint.h5", "run.h5"}) remove_file(folder / name);
}

void remove_made_of_frames(const std::filesystem::path& folder) {
  for (const char* name : {"summary.json", "run.xdmf", "view.html"}) remove_file(folder / name);
}

}  // namespace selvedge
