#include "pipeline/tools/export.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include "collision/geometry/error.hpp"
#include "pipeline/formats/mesh_io.hpp"
#include "pipeline/formats/trajectory_hdf5.hpp"
#include "pipeline/formats/xdmf.hpp"
#include "pipeline/host/write_file.hpp"

namespace selvedge {
namespace {

using Paths = std::vector<std::filesystem::path>;

// The cloth (index -1) or one obstacle of a trajectory.
struct Part {
  std::string name;
  int obstacle = -1;
  const Triangles* triangles = nullptr;
  int vertex_count = 0;
  const PointsF& of(const Frame& frame) const { return obstacle < 0 ? frame.x : frame.obstacles[obstacle]; }
};

std::string file_name(const std::string& name) {
  std::string safe = name;
  for (char& c : safe)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-' && c != '_') c = '_';
  return safe;
}

std::vector<Part> parts_of(const TrajectoryInfo& info, bool with_obstacles) {
  std::vector<Part> parts{{"cloth", -1, &info.triangles, static_cast<int>(info.rest.rows())}};
  for (std::size_t k = 0; with_obstacles && k < info.obstacles.size(); ++k)
    parts.push_back({fmt::format("obstacle_{}_{}", k, file_name(info.obstacles[k].name)), static_cast<int>(k),
                     &info.obstacles[k].triangles, info.obstacles[k].vertex_count});
  return parts;
}

void export_meshes(const TrajectoryReader& reader, const std::vector<Part>& parts, const ExportRequest& request,
                   Paths& written) {
  const auto write = request.format == "ply" ? write_ply : write_obj;
  for (int i = 0; i < reader.frame_count(); ++i) {
    const Frame frame = reader.frame(i);
    for (const Part& part : parts) {
      written.push_back(request.out / fmt::format("{}_{:05}.{}", part.name, i, request.format));
      write(written.back(), part.of(frame).cast<double>(), *part.triangles);
    }
  }
}

template <class Value>
void append(std::string& bytes, Value value) {
  static_assert(std::endian::native == std::endian::little, "PC2 is little-endian");
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

// Point cache 2: "POINTCACHE2\0", version, points, first frame, frames a sample, samples, then x y z floats.
std::string pc2_header(int points, int samples) {
  std::string bytes("POINTCACHE2\0", 12);
  append<std::int32_t>(bytes, 1);
  append<std::int32_t>(bytes, points);
  append<float>(bytes, 0);
  append<float>(bytes, 1);
  append<std::int32_t>(bytes, samples);
  return bytes;
}

void export_pc2(const TrajectoryReader& reader, const std::vector<Part>& parts, const ExportRequest& request,
                Paths& written) {
  for (const Part& part : parts) {
    std::string bytes = pc2_header(part.vertex_count, reader.frame_count());
    for (int i = 0; i < reader.frame_count(); ++i) {
      const Frame frame = reader.frame(i);
      const PointsF& x = part.of(frame);
      bytes.append(reinterpret_cast<const char*>(x.data()), static_cast<std::size_t>(x.size()) * sizeof(float));
      if (i > 0) continue;
      written.push_back(request.out / (part.name + ".obj"));
      write_obj(written.back(), x.cast<double>(), *part.triangles);
    }
    written.push_back(request.out / (part.name + ".pc2"));
    write_file(written.back(), bytes);
  }
}

}  // namespace

std::vector<std::filesystem::path> export_trajectory(const ExportRequest& request) {
  const TrajectoryReader reader(request.trajectory);
  Paths written;
  if (request.format == "xdmf") return {write_xdmf(request.trajectory)};
  make_folder(request.out);
  const std::vector<Part> parts = parts_of(reader.info(), request.obstacles);
  if (request.format == "obj" || request.format == "ply")
    export_meshes(reader, parts, request, written);
  else if (request.format == "pc2")
    export_pc2(reader, parts, request, written);
  else
    throw Error("unknown format `" + request.format + "`", "--format", "known: obj, ply, pc2, xdmf");
  return written;
}

}  // namespace selvedge
