#include "pipeline/scene/setup_selection.hpp"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

#include "collision/geometry/lists.hpp"

namespace selvedge {
namespace {

std::vector<int> in_box(const Config& box, const Points& x) {
  const Vec3 low = box["min"].vector(), high = box["max"].vector();
  if ((low.array() > high.array()).any()) box.fail("has a `min` above its `max`", "swap them");
  std::vector<int> found;
  for (int v = 0; v < x.rows(); ++v)
    if ((row(x, v).array() >= low.array()).all() && (row(x, v).array() <= high.array()).all()) found.push_back(v);
  if (found.empty()) {
    const Vec3 least = x.colwise().minCoeff(), most = x.colwise().maxCoeff();
    box.fail("holds no vertex of the cloth",
             fmt::format("the cloth spans [{:.4g}, {:.4g}, {:.4g}] to [{:.4g}, {:.4g}, {:.4g}] m", least.x(), least.y(),
                         least.z(), most.x(), most.y(), most.z()));
  }
  return found;
}

std::vector<int> in_groups(const Config& group, const Mesh& mesh) {
  std::vector<std::string> known;
  for (const auto& [name, vertices] : mesh.groups) known.push_back(name);
  std::vector<int> found;
  for (const std::string& word : group.words) {
    const auto match = std::find(known.begin(), known.end(), word);
    if (match == known.end())
      group.fail("names the unknown group `" + word + "`",
                 known.empty() ? "the cloth has no groups" : "groups: " + joined(known) + suggestion(word, known));
    const std::vector<int>& vertices = mesh.groups[static_cast<std::size_t>(match - known.begin())].second;
    found.insert(found.end(), vertices.begin(), vertices.end());
  }
  sort_once(found);
  return found;
}

std::vector<int> listed(const Config& list, const ClothPart& part) {
  const Eigen::Index count = vertices_as_read(part);
  std::vector<int> found;
  for (const double v : list.numbers) {
    if (v >= static_cast<double>(count))
      list.fail(fmt::format("names vertex {}, which does not exist", v), fmt::format("allowed: 0 to {}", count - 1));
    found.push_back(number_here(part, static_cast<int>(v)));
  }
  return found;
}

}  // namespace

Eigen::Index vertices_as_read(const ClothPart& part) {
  return part.sewn.empty() ? part.mesh.x.rows() : std::ssize(part.sewn);
}

int number_here(const ClothPart& part, int v) { return part.sewn.empty() ? v : part.sewn[static_cast<std::size_t>(v)]; }

std::vector<int> read_vertices(const Config& section, const ClothPart& part) {
  if (section["vertices"].given) return listed(section["vertices"], part);
  if (section["box"].given) return in_box(section["box"], part.mesh.x);
  if (section["group"].given) return in_groups(section["group"], part.mesh);
  std::vector<int> all(static_cast<std::size_t>(part.mesh.x.rows()));
  std::iota(all.begin(), all.end(), 0);
  return all;
}

std::vector<int> read_selection(const Config& section, const ClothPart& part) {
  std::vector<int> found = read_vertices(section, part);
  sort_once(found);
  return found;
}

std::string selection_text(const Config& section) {
  if (section["vertices"].given) return "of `vertices`";
  if (section["box"].given) return "of a box";
  if (section["group"].given) return "of group " + joined(section["group"].words);
  return "of all vertices";
}

}  // namespace selvedge
