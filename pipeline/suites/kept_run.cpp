#include "pipeline/suites/kept_run.hpp"

#include <ostream>

#include "pipeline/view/view.hpp"

namespace selvedge {

void keep_or_remove(const std::filesystem::path& run_folder, bool keep, std::ostream* log) {
  if (!keep) {
    std::filesystem::remove_all(run_folder);
    return;
  }
  if (const auto trouble = write_page(run_folder); trouble && log) *log << "no page: " << *trouble << "\n";
}

}  // namespace selvedge
