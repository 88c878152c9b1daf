#include <fmt/format.h>

#include "pipeline/exports/export_formats.hpp"
#include "pipeline/formats/mesh_io.hpp"
#include "pipeline/host/write_file.hpp"

namespace selvedge {

std::filesystem::path ExportRequest::file(const std::string& name) const {
  make_folder(out);
  return out / name;
}

std::filesystem::path ExportRequest::one_file() const { return file(trajectory.stem().string() + "." + format); }

std::vector<std::filesystem::path> export_meshes(const AnimatedSurfaces& run, const ExportRequest& request) {
  const auto write = request.format == "ply" ? write_ply : write_obj;
  std::vector<std::filesystem::path> written;
  for (int i = 0; i < run.frame_count; ++i) {
    const std::vector<PointsF> x = run.frame(i);
    for (std::size_t s = 0; s < x.size(); ++s) {
      written.push_back(request.file(fmt::format("{}_{:05}.{}", run.surfaces[s].name, i, request.format)));
      write(written.back(), x[s].cast<double>(), run.surfaces[s].triangles);
    }
  }
  return written;
}

}  // namespace selvedge
