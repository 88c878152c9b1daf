#include "pipeline/view/view.hpp"

#include <memory>

#include "collision/geometry/error.hpp"
#include "pipeline/host/write_file.hpp"

namespace selvedge {
namespace {

std::string run_name(const std::filesystem::path& file) {
  const std::string stem = file.stem().string();
  const std::filesystem::path folder = std::filesystem::absolute(file).parent_path().filename();
  return stem == "run" && !folder.empty() ? folder.string() : stem;
}

}  // namespace

ViewRun open_view_run(const std::filesystem::path& path) {
  const std::filesystem::path file = trajectory_file(path);
  const auto reader = std::make_shared<TrajectoryReader>(file);
  return {run_name(file), reader->info(), reader->frame_count(), [reader](int index) { return reader->frame(index); }};
}

void write_view(const std::vector<std::filesystem::path>& runs, const std::filesystem::path& html,
                const ViewOptions& options) {
  std::vector<ViewRun> opened;
  for (const auto& run : runs) opened.push_back(open_view_run(run));
  write_view_page(opened, html, options);
}

void write_view_page(const std::vector<ViewRun>& runs, const std::filesystem::path& html, const ViewOptions& options) {
  write_file(html, view_page(runs, options));
}

std::optional<std::string> write_page(const std::filesystem::path& folder) {
  try {
    write_view({folder / "run.h5"}, folder / "view.html");
    return {};
  } catch (const Error& error) {
    return error.what();
  }
}

}  // namespace selvedge
