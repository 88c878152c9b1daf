#include "pipeline/tools/export.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "collision/geometry/error.hpp"
#include "pipeline/hdf5/trajectory_hdf5.hpp"
#include "pipeline/tools/animated_run.hpp"

namespace selvedge {

std::vector<std::filesystem::path> export_trajectory(const ExportRequest& request) {
  const auto format = std::ranges::find(export_formats, request.format, &ExportFormat::name);
  if (format == std::end(export_formats))
    throw Error("unknown format `" + request.format + "`", "--format", "known: " + export_format_list());
  ExportRequest of_file = request;
  of_file.trajectory = trajectory_file(request.trajectory);
  const AnimatedRun run = animated_run(of_file);
  *run.reads = format->reads(run.surfaces);
  return format->write(run.surfaces, of_file);
}

std::string export_format_list() {
  std::string list;
  for (const ExportFormat& format : export_formats)
    list += fmt::format("{}{} ({})", list.empty() ? "" : ", ", format.name, format.about);
  return list;
}

}  // namespace selvedge
