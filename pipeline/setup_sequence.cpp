#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "collision/error.hpp"
#include "pipeline/mesh_io.hpp"
#include "pipeline/setup_motion.hpp"
#include "pipeline/setup_obstacle.hpp"
#include "pipeline/setup_paths.hpp"

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
  Sequence sequence;
  sequence.fps = section["fps"].number();
  const double unit = read_unit(section["unit"]);
  for (const std::filesystem::path& file : sequence_files(section, folder)) {
    const Mesh mesh = read_mesh(file);
    if (sequence.frames.empty()) {
      sequence.triangles = mesh.triangles;
      warnings.insert(warnings.end(), mesh.warnings.begin(), mesh.warnings.end());
    } else if (mesh.x.rows() != sequence.frames[0].rows() || mesh.triangles != sequence.triangles) {
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

}  // namespace selvedge
