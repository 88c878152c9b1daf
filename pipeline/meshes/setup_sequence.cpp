#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "collision/geometry/error.hpp"
#include "pipeline/formats/mesh_io.hpp"
#include "pipeline/formats/read_point_cache.hpp"
#include "pipeline/formats/trajectory_hdf5.hpp"
#include "pipeline/meshes/setup_motion.hpp"
#include "pipeline/meshes/setup_obstacle.hpp"
#include "pipeline/meshes/setup_paths.hpp"

namespace selvedge {
namespace {

// The number put in place of %d or %0Nd.
std::string numbered(const Config& pattern, int number) {
  const std::string& text = pattern.text();
  const std::size_t begin = text.find('%');
  std::size_t end = begin == std::string::npos ? begin : begin + 1;
  std::size_t width = 0;
  while (end < text.size() && std::isdigit(static_cast<unsigned char>(text[end])))
    width = std::min<std::size_t>(10 * width + static_cast<std::size_t>(text[end++] - '0'), 20);
  if (begin == std::string::npos || end >= text.size() || text[end] != 'd' || text.find('%', end) != std::string::npos)
    pattern.fail("is `" + text + "`", "write one %d or %04d where the number goes");
  std::string digits = std::to_string(number);
  if (digits.size() < width) digits.insert(0, width - digits.size(), text[begin + 1] == '0' ? '0' : ' ');
  return text.substr(0, begin) + digits + text.substr(end + 1);
}

std::vector<std::filesystem::path> sequence_files(const Config& section, const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const std::string& name : section["files"].words) files.push_back(existing_path(section["files"], name, folder));
  if (!section["pattern"].given) return files;
  const Config &pattern = section["pattern"], &count = section["count"];
  for (int number = section["first"].integer(); !count.given || files.size() < count.number(); ++number) {
    const std::string name = numbered(pattern, number);
    std::error_code ignored;
    const bool exists = std::filesystem::exists(expanded_path(pattern, name, folder), ignored);
    if (!exists && !count.given && !files.empty()) return files;
    files.push_back(existing_path(pattern, name, folder));
  }
  return files;
}

// The positions of a point cache on the faces of a mesh.
Sequence cached_sequence(const Config& section, const std::filesystem::path& folder,
                         std::vector<std::string>& warnings) {
  const Config& name = section["cache"];
  if (!section["mesh"].given) name.fail("is given without a mesh", "give the faces: mesh: FILE.obj");
  const Mesh mesh = read_mesh(existing_path(section["mesh"], folder));
  PointCache cache = read_point_cache(existing_path(name, folder));
  if (cache.frames.front().rows() != mesh.x.rows())
    name.fail(fmt::format("has {} vertices, its mesh has {}", cache.frames.front().rows(), mesh.x.rows()),
              "give the mesh that it was made of");
  warnings.insert(warnings.end(), mesh.warnings.begin(), mesh.warnings.end());
  const double unit = read_unit(section["unit"]), own = section["fps"].given ? 0 : cache.fps;
  for (Points& x : cache.frames) x *= unit;
  return {std::move(cache.frames), mesh.triangles, own > 0 ? own : section["fps"].number()};
}

}  // namespace

Points sequence_at(const Sequence& sequence, double time) {
  const double last = static_cast<double>(sequence.frames.size() - 1);
  const double at = std::clamp(time * sequence.fps, 0.0, last);
  const auto k = static_cast<std::size_t>(std::floor(at));
  const double s = at - std::floor(at);
  if (s == 0) return sequence.frames[k];
  return (1 - s) * sequence.frames[k] + s * sequence.frames[k + 1];
}

Sequence read_sequence(const Config& section, const std::filesystem::path& folder, std::vector<std::string>& warnings) {
  if (section["mesh"].given && !section["cache"].given)
    section["mesh"].fail("is given without a point cache", "give cache: FILE.pc2, .pc16 or .mdd, or leave it out");
  if (section["cache"].given) return cached_sequence(section, folder, warnings);
  Sequence sequence;
  sequence.fps = section["fps"].number();
  const double unit = read_unit(section["unit"]);
  Mesh first;
  for (const std::filesystem::path& file : sequence_files(section, folder)) {
    const Mesh mesh = read_mesh(file);
    if (sequence.frames.empty()) {
      first = mesh;
      sequence.triangles = mesh.triangles;
      warnings.insert(warnings.end(), mesh.warnings.begin(), mesh.warnings.end());
    } else if (!same_faces(mesh, first)) {
      throw Error(
          fmt::format("has other faces than the first mesh of the sequence ({} vertices and {} triangles, the "
                      "first has {} and {})",
                      mesh.x.rows(), mesh.triangles.rows(), sequence.frames[0].rows(), sequence.triangles.rows()),
          file.string(), "an obstacle keeps its faces while it moves; used by " + section.where);
    }
    sequence.frames.push_back(unit * mesh.x);
  }
  return sequence;
}

namespace {

// A cloth or an obstacle of a run: the obstacle's number, or the cloth's range of vertices and triangles.
struct RecordedPart {
  int obstacle = -1;
  int first_vertex = 0, vertex_count = 0;
  Triangles triangles;
};

RecordedPart recorded_part(const Config& section, const TrajectoryInfo& info) {
  std::vector<std::string> names;
  for (const TrajectoryInfo::Body& body : info.obstacles) names.push_back(body.name);
  names.insert(names.end(), info.cloth_names.begin(), info.cloth_names.end());
  const Config& part = section["part"];
  const bool alone = info.obstacles.size() == 1 || names.size() == 1;
  if (!part.given && !alone) section.fail("does not say which part of the run it is", "add part: " + joined(names));
  const std::string name = part.given ? part.text() : names.front();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    part.fail("names the unknown part `" + name + "`", "parts: " + joined(names) + suggestion(name, names));
  const auto index = static_cast<std::size_t>(found - names.begin());
  if (index < info.obstacles.size())
    return {static_cast<int>(index), 0, info.obstacles[index].vertex_count, info.obstacles[index].triangles};
  const std::size_t c = index - info.obstacles.size();
  const int v = info.cloth_first_vertex[c], t = info.cloth_first_triangle[c];
  return {-1, v, info.cloth_first_vertex[c + 1] - v,
          info.triangles.middleRows(t, info.cloth_first_triangle[c + 1] - t).array() - v};
}

}  // namespace

Sequence read_recorded(const Config& section, const std::filesystem::path& folder) {
  const std::filesystem::path file = existing_path(section["file"], folder);
  const TrajectoryReader reader(file);
  const RecordedPart part = recorded_part(section, reader.info());
  if (reader.frame_count() == 0) throw Error("has no frames", file.string(), "used by " + section.where);
  const double unit = read_unit(section["unit"]);
  Sequence sequence{{}, part.triangles, reader.info().fps};
  for (int f = 0; f < reader.frame_count(); ++f) {
    const Frame frame = reader.frame(f);
    const PointsF& x = part.obstacle >= 0 ? frame.obstacles[static_cast<std::size_t>(part.obstacle)] : frame.x;
    sequence.frames.push_back(unit * x.middleRows(part.first_vertex, part.vertex_count).cast<double>());
  }
  return sequence;
}

}  // namespace selvedge
