#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "collision/geometry/error.hpp"
#include "pipeline/formats/mesh_io.hpp"
#include "pipeline/formats/read_point_cache.hpp"
#include "pipeline/formats/seam_places.hpp"
#include "pipeline/hdf5/trajectory_hdf5.hpp"
#include "pipeline/obstacles/numbered_files.hpp"
#include "pipeline/obstacles/setup_motion.hpp"
#include "pipeline/obstacles/setup_obstacle.hpp"
#include "pipeline/obstacles/setup_paths.hpp"
#include "pipeline/shapes/outward_mesh.hpp"
#include "pipeline/shapes/own_crossings.hpp"

namespace selvedge {
namespace {

// The rate from the scene, or else from the files; if both lack it, a warning says what is assumed.
double rate_of(const Config& section, double own, std::size_t count, std::vector<std::string>& warnings) {
  const Config& fps = section["fps"];
  if (!fps.given && own > 0) return own;
  if (!fps.given && count > 1)
    warnings.push_back(
        fmt::format("{}: its files do not say their rate; {:g} frames a second are assumed, which "
                    "`fps` changes",
                    section.where, fps.number()));
  return fps.number();
}

// Sets the begin from the scene, or warns where the files begin.
void set_begin(const Config& section, SampleTimes& times, std::vector<std::string>& warnings) {
  if (section["start"].given)
    begin_at(section["start"].number(), times);
  else
    warn_of_begin(section.where + ": the sequence", "`start: 0 s` lets it begin at once", times, warnings);
}

// The times of a cache's samples. A rate in the scene replaces the file's.
SampleTimes cache_times(const Config& section, const PointCache& cache, std::vector<std::string>& warnings) {
  const double rate = rate_of(section, cache.fps, cache.at.size(), warnings);
  SampleTimes times{cache.at, rate};
  const double differs = std::abs(rate / cache.fps - 1);  // infinite for a file without a rate
  if (section["fps"].given && cache.fps > 0 && differs > 1e-3) {
    times = steady(cache.at.size(), rate);
    warnings.push_back(fmt::format("{}: `fps` is {:g}, and the times of the file, {:.4g} s in {} frames, are not used",
                                   section.where, rate, (cache.at.back() - cache.at.front()) / cache.fps,
                                   cache.at.size()));
  }
  set_begin(section, times, warnings);
  return times;
}

std::string other_faces_text(const Mesh& mesh, const Mesh& first) {
  const std::string of_first = "the first mesh of the sequence";
  if (mesh.x.rows() == first.x.rows() && mesh.triangles.rows() == first.triangles.rows())
    return "has as many faces as " + of_first + ", in another order or of other vertices";
  return fmt::format("has other faces than {} ({} vertices and {} triangles, the first has {} and {})", of_first,
                     mesh.x.rows(), mesh.triangles.rows(), first.x.rows(), first.triangles.rows());
}

// The name of a sequence of files for messages.
std::string sequence_name(const Config& section) {
  return section["pattern"].given ? section["pattern"].text() : section["files"].words.front();
}

// The positions of a point cache on the faces of a mesh.
Sequence cached_sequence(const Config& section, const std::filesystem::path& folder,
                         std::vector<std::string>& warnings) {
  const Config& name = section["cache"];
  if (!section["mesh"].given) name.fail("is given without a mesh", "give the faces: mesh: FILE.obj");
  Mesh mesh = read_mesh(existing_path(section["mesh"], folder));
  PointCache cache = read_point_cache(existing_path(name, folder));
  if (cache.frames.front().rows() != mesh.x.rows())
    name.fail(fmt::format("has {} vertices, its mesh has {}", cache.frames.front().rows(), mesh.x.rows()),
              "give the mesh that it was made of");
  warnings.insert(warnings.end(), mesh.warnings.begin(), mesh.warnings.end());
  const double unit = read_unit(section["unit"]);
  for (Points& x : cache.frames) x *= unit;
  const std::vector<int> places = seam_places(cache.frames, mesh.triangles);
  turn_outward(section["mesh"].text(), mesh.groups, cache.frames, places, mesh.triangles, warnings);
  warn_of_crossings(section["mesh"].text(), own_crossings(mesh.groups, cache.frames[0], mesh.triangles, places),
                    warnings);
  SampleTimes times = cache_times(section, cache, warnings);
  return {std::move(cache.frames), mesh.triangles, std::move(times)};
}

// The files of a sequence and their times: numbers of a pattern are frames, counted from the first one.
std::vector<std::filesystem::path> sequence_files(const Config& section, const std::filesystem::path& folder,
                                                  SampleTimes& times, std::vector<std::string>& warnings) {
  std::vector<std::filesystem::path> files;
  for (const std::string& name : section["files"].words) files.push_back(existing_path(section["files"], name, folder));
  times.at = steady(files.size(), 1).at;
  if (section["pattern"].given)
    for (const NumberedFile& one : numbered_files(section, folder, warnings)) {
      files.push_back(one.file);
      times.at.push_back(one.number - section["first"].integer());
    }
  times.fps = rate_of(section, 0, files.size(), warnings);
  set_begin(section, times, warnings);
  return files;
}

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

Points sequence_at(const Sequence& sequence, double time) {
  const auto [k, s] = place_of(sequence.times, time);
  if (s == 0) return sequence.frames[k];
  return (1 - s) * sequence.frames[k] + s * sequence.frames[k + 1];
}

Sequence read_sequence(const Config& section, const std::filesystem::path& folder, std::vector<std::string>& warnings) {
  if (section["mesh"].given && !section["cache"].given)
    section["mesh"].fail("is given without a point cache", "give cache: FILE.pc2, .pc16 or .mdd, or leave it out");
  if (section["cache"].given) return cached_sequence(section, folder, warnings);
  Sequence sequence;
  const double unit = read_unit(section["unit"]);
  Mesh first;
  for (const std::filesystem::path& file : sequence_files(section, folder, sequence.times, warnings)) {
    const Mesh mesh = read_mesh(file);
    if (sequence.frames.empty()) {
      first = mesh;
      sequence.triangles = mesh.triangles;
      warnings.insert(warnings.end(), mesh.warnings.begin(), mesh.warnings.end());
    } else if (!same_faces(mesh, first)) {
      throw Error(other_faces_text(mesh, first), file.string(),
                  "an obstacle keeps its faces while it moves; used by " + section.where);
    }
    sequence.frames.push_back(unit * mesh.x);
  }
  const std::string name = sequence_name(section);
  const std::vector<int> places = seam_places(sequence.frames, sequence.triangles);
  turn_outward(name, first.groups, sequence.frames, places, sequence.triangles, warnings);
  warn_of_crossings(name, own_crossings(first.groups, sequence.frames[0], sequence.triangles, places), warnings);
  return sequence;
}

Sequence read_recorded(const Config& section, const std::filesystem::path& folder, std::vector<std::string>& warnings) {
  const std::filesystem::path file = existing_path(section["file"], folder);
  const TrajectoryReader reader(file);
  const RecordedPart part = recorded_part(section, reader.info());
  const double unit = read_unit(section["unit"]), fps = reader.info().fps;
  Sequence sequence{{}, part.triangles, {{}, fps}};
  for (int f = 0; f < reader.frame_count(); ++f) {
    const Frame frame = reader.frame(f);
    const double at = frame.time * fps, whole = std::round(at);
    std::vector<double>& all = sequence.times.at;
    all.push_back(std::abs(at - whole) < 1e-6 ? whole : at);
    if (const std::size_t n = all.size(); n > 1 && !(all[n - 1] > all[n - 2])) {
      if (frame.report.status != StepStatus::rejected)
        throw Error(fmt::format("has frame {} at {} s, no later than the one before", f, frame.time), file.string(),
                    "the file is damaged; write it again; used by " + section.where);
      all.pop_back();  // it has the positions of the frame before
      continue;
    }
    const PointsF& x = part.obstacle >= 0 ? frame.obstacles[part.obstacle] : frame.x;
    sequence.frames.push_back(unit * x.middleRows(part.first_vertex, part.vertex_count).cast<double>());
  }
  if (sequence.frames.empty()) throw Error("has no frames", file.string(), "used by " + section.where);
  set_begin(section, sequence.times, warnings);
  return sequence;
}

}  // namespace selvedge
