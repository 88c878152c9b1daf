#include "pipeline/tools/export.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include "collision/geometry/error.hpp"
#include "pipeline/formats/trajectory_hdf5.hpp"

namespace selvedge {
namespace {

std::string file_name(const std::string& name) {
  std::string safe = name;
  for (char& c : safe)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-' && c != '_') c = '_';
  return safe;
}

// The colours of the page (pipeline/view/palette.js) in linear form; there they are sRGB.
Eigen::Vector3d colour_of(int cloth) {
  constexpr std::array<std::array<int, 3>, 5> colours = {
      {{0x4a, 0x7f, 0xb5}, {0xc9, 0x8a, 0x5a}, {0x5d, 0x9c, 0x84}, {0x8d, 0x76, 0xb3}, {0xb9, 0xbd, 0xc2}}};
  const auto& srgb = cloth < 0 ? colours.back() : colours[static_cast<std::size_t>(cloth % 4)];
  Eigen::Vector3d linear;
  for (int k = 0; k < 3; ++k) {
    const double c = srgb[static_cast<std::size_t>(k)] / 255.0;
    linear[k] = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  }
  return linear;
}

// Whether no triangle joins vertices of two cloths, as seams do.
bool cloths_are_apart(const TrajectoryInfo& info) {
  for (std::size_t c = 0; c + 1 < info.cloth_first_triangle.size(); ++c) {
    const int first = info.cloth_first_triangle[c], count = info.cloth_first_triangle[c + 1] - first;
    if (count == 0) return false;
    const auto own = info.triangles.middleRows(first, count);
    if (own.minCoeff() < info.cloth_first_vertex[c] || own.maxCoeff() >= info.cloth_first_vertex[c + 1]) return false;
  }
  return !info.cloth_names.empty();
}

// The surfaces of a run: one per cloth, or one of all cloths; then the obstacles. `frame` reads positions once per
// call.
class ExportedRun {
 public:
  ExportedRun(const ExportRequest& request, bool each_cloth) : request_(request), reader_(request.trajectory) {
    const TrajectoryInfo& info = reader_.info();
    if (reader_.frame_count() < 1)
      throw Error("the run has no full frame", request.trajectory.string(), "wait for its first frame");
    run_.fps = info.fps;
    run_.frame_count = reader_.frame_count();
    if (each_cloth && cloths_are_apart(info))
      for (std::size_t c = 0; c < info.cloth_names.size(); ++c)
        add_cloth(info.cloth_names[c], info.cloth_first_vertex[c], info.cloth_first_vertex[c + 1],
                  info.triangles.middleRows(info.cloth_first_triangle[c],
                                            info.cloth_first_triangle[c + 1] - info.cloth_first_triangle[c]));
    else
      add_cloth("cloth", 0, static_cast<int>(info.rest.rows()), info.triangles);
    for (std::size_t k = 0; request.obstacles && k < info.obstacles.size(); ++k) {
      const TrajectoryInfo::Body& body = info.obstacles[k];
      run_.surfaces.push_back({fmt::format("obstacle_{}_{}", k, file_name(body.name)), body.triangles,
                               body.vertex_count, false, body.moving, colour_of(-1)});
    }
    run_.frame = [this](int index) { return positions(index); };
  }
  ExportedRun(const ExportedRun&) = delete;
  ExportedRun& operator=(const ExportedRun&) = delete;
  // `reads` is the number of frames that will be read, for the progress.
  const AnimatedSurfaces& read_so_often(int reads) {
    all_ = reads;
    return run_;
  }
  int surfaces() const { return static_cast<int>(run_.surfaces.size()); }
  int frames() const { return run_.frame_count; }

 private:
  void add_cloth(const std::string& name, int first, int end, const Triangles& triangles) {
    const int number = static_cast<int>(firsts_.size());
    firsts_.push_back(first);
    run_.surfaces.push_back({name, triangles.array() - first, end - first, true, true, colour_of(number)});
  }
  std::vector<PointsF> positions(int index) {
    const Frame frame = reader_.frame(index);
    std::vector<PointsF> all;
    for (std::size_t c = 0; c < firsts_.size(); ++c)
      all.push_back(frame.x.middleRows(firsts_[c], run_.surfaces[c].vertex_count));
    if (request_.obstacles) all.insert(all.end(), frame.obstacles.begin(), frame.obstacles.end());
    if (request_.progress) request_.progress(++done_, all_);
    return all;
  }

  const ExportRequest& request_;
  TrajectoryReader reader_;
  AnimatedSurfaces run_;
  std::vector<int> firsts_;
  int done_ = 0, all_ = 0;
};

}  // namespace

std::vector<std::filesystem::path> export_trajectory(const ExportRequest& request) {
  const auto format = std::ranges::find(export_formats, request.format, &ExportFormat::name);
  if (format == std::end(export_formats))
    throw Error("unknown format `" + request.format + "`", "--format", "known: " + export_format_list());
  ExportRequest of_file = request;
  of_file.trajectory = trajectory_file(request.trajectory);
  ExportedRun run(of_file, format->each_cloth);
  return format->write(run.read_so_often(format->reads(run.surfaces(), run.frames())), of_file);
}

std::string export_format_list() {
  std::string list;
  for (const ExportFormat& format : export_formats)
    list += fmt::format("{}{} ({})", list.empty() ? "" : ", ", format.name, format.about);
  return list;
}

}  // namespace selvedge
