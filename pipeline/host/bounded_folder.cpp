#include "pipeline/host/bounded_folder.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace selvedge {

void keep_within(const std::filesystem::path& folder, std::uintmax_t most) {
  std::vector<std::pair<std::filesystem::file_time_type, std::filesystem::path>> files;
  std::uintmax_t bytes = 0;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    if (!entry.is_regular_file(ignored)) continue;
    bytes += entry.file_size(ignored);
    files.emplace_back(entry.last_write_time(ignored), entry.path());
  }
  std::ranges::sort(files);
  for (std::size_t k = 0; k < files.size() && bytes > most; ++k) {
    bytes -= std::filesystem::file_size(files[k].second, ignored);
    std::filesystem::remove(files[k].second, ignored);
  }
}

void mark_used(const std::filesystem::path& file) {
  std::error_code ignored;
  std::filesystem::last_write_time(file, std::filesystem::file_time_type::clock::now(), ignored);
}

}  // namespace selvedge
