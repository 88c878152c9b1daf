#include "pipeline/shapes/outward_mesh.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "collision/exact/outward_faces.hpp"
#include "collision/geometry/counted.hpp"
#include "collision/geometry/disjoint_sets.hpp"
#include "collision/geometry/welded_surface.hpp"
#include "pipeline/formats/seam_places.hpp"

namespace selvedge {
namespace {

// Findings about the shells of one mesh.
struct Findings {
  int shells = 0, triangles = 0;
  int over = 0, over_triangles = 0;  // shells that were turned whole
  int mixed = 0, odd = 0;            // shells of mixed orientation, triangles of the smaller part
  int cavities = 0;
  int open = 0, open_edges = 0;
  int branching = 0, branching_edges = 0;
  int one_sided = 0;
};

void add(const Shell& shell, Findings& mesh) {
  ++mesh.shells;
  mesh.triangles += shell.triangles;
  mesh.over += shell.over;
  mesh.over_triangles += shell.over ? shell.triangles : 0;
  const bool faced = shell.closed() || shell.nearly_closed();
  mesh.mixed += faced && shell.odd > 0;
  mesh.odd += faced ? shell.odd : 0;
  mesh.cavities += shell.cavity;
  mesh.open += shell.nearly_closed();
  mesh.open_edges += shell.nearly_closed() ? shell.open_edges : 0;
  mesh.branching += shell.open_edges == 0 && shell.branching_edges > 0;
  mesh.branching_edges += shell.open_edges == 0 ? shell.branching_edges : 0;
  mesh.one_sided += shell.open_edges + shell.branching_edges == 0 && !shell.orientable;
}

std::string of_shells(int count, int all) {
  return all == 1 ? "the surface" : fmt::format("{} of its {} shells", count, all);
}

void say(const std::string& mesh, const Findings& found, std::vector<std::string>& warnings) {
  const auto tell = [&](int count, const std::string& one, const std::string& many, const std::string& what) {
    if (count > 0)
      warnings.push_back(mesh + ": " + of_shells(count, found.shells) + " " + by_number(count, one, many) + " " + what);
  };
  tell(found.over, "faced inwards and was", "faced inwards and were",
       "turned outwards, " + counted(found.over_triangles, "triangle"));
  tell(found.mixed, "had", "had",
       fmt::format("triangles that faced the other way than the rest, {} were turned", found.odd));
  tell(found.cavities, "faces", "face", "inwards inside of another: taken for a cavity, where cloth is outside");
  tell(found.open, "is", "are",
       fmt::format("open ({} with one triangle): cloth that gets inside is not known to be there and is not pushed "
                   "out; close its holes if it is to be solid",
                   counted(found.open_edges, "edge")));
  tell(found.branching, "has", "have",
       fmt::format("{} with more than two triangles, so that nothing is inside of it; part what touches there",
                   counted(found.branching_edges, "edge")));
  tell(found.one_sided, "has", "have", "one side only, so that nothing is inside of it");
}

// A triangle by the places of its corners, and whether their order is an odd permutation of the ascending one.
struct PlacedTriangle {
  std::array<int, 3> places;
  bool odd;
  int number;
  auto operator<=>(const PlacedTriangle&) const = default;
};

std::vector<PlacedTriangle> placed_triangles(const Triangles& triangles, const std::vector<int>& places) {
  std::vector<PlacedTriangle> placed;
  for (int t = 0; t < static_cast<int>(triangles.rows()); ++t)
    if (std::optional<std::array<int, 3>> at = placed_corners(triangles, t, places)) {  // the lowest comes first
      const bool odd = (*at)[1] > (*at)[2];
      if (odd) std::swap((*at)[1], (*at)[2]);
      placed.push_back({*at, odd, t});
    }
  std::ranges::sort(placed);
  return placed;
}

// The triangles that are to stay, ascending. A connected piece of a surface is two-sided if all of its triangles lie on
// one that faces the other way: of those that lie on each other the first one then stays.
std::vector<int> without_backs(const Triangles& triangles, const std::vector<int>& places) {
  const std::vector<PlacedTriangle> placed = placed_triangles(triangles, places);
  std::vector<std::pair<std::size_t, std::size_t>> alike;  // ranges of triangles at the same places
  for (std::size_t begin = 0, end = 0; begin < placed.size(); begin = end) {
    while (end < placed.size() && placed[end].places == placed[begin].places) ++end;
    alike.emplace_back(begin, end);
  }
  DisjointSets pieces(static_cast<int>(places.size()));
  for (const PlacedTriangle& one : placed)
    for (const int k : {1, 2}) pieces.join(one.places[0], one.places[k]);
  std::vector<char> two_sided(places.size(), 1), stays(static_cast<std::size_t>(triangles.rows()), 1);
  for (const auto& [begin, end] : alike)
    if (placed[begin].odd == placed[end - 1].odd) two_sided[pieces.root(placed[begin].places[0])] = 0;
  for (const auto& [begin, end] : alike) {
    if (!two_sided[pieces.root(placed[begin].places[0])]) continue;
    int first = placed[begin].number;
    for (std::size_t i = begin; i < end; ++i) {
      stays[placed[i].number] = 0;
      first = std::min(first, placed[i].number);
    }
    stays[first] = 1;
  }
  std::vector<int> kept;
  for (std::size_t t = 0; t < stays.size(); ++t)
    if (stays[t]) kept.push_back(static_cast<int>(t));
  return kept;
}

void leave_out_backs(const std::string& name, const std::vector<int>& places, Triangles& triangles,
                     std::vector<std::string>& warnings) {
  const std::vector<int> kept = without_backs(triangles, places);
  const auto backs = static_cast<int>(triangles.rows() - std::ssize(kept));
  if (backs == 0) return;
  triangles = Triangles(triangles(kept, Eigen::all));
  warnings.push_back(fmt::format(
      "{}: the surface is two-sided; {} on another and face{} the other way, and {} left out", name,
      counted(backs, "triangle lies", "triangles lie"), by_number(backs, "s", ""), by_number(backs, "is", "are")));
}

}  // namespace

bool turn_outward(const std::string& name, const NamedVertices& groups, std::span<const Points> frames,
                  const std::vector<int>& places, Triangles& triangles, std::vector<std::string>& warnings) {
  leave_out_backs(name, places, triangles, warnings);
  OutwardFaces outward = face_outward(triangles, frames, places);
  triangles = std::move(outward.triangles);
  std::vector<int> group_of(static_cast<std::size_t>(frames.empty() ? 0 : frames[0].rows()), -1);
  for (std::size_t g = groups.size(); g-- > 0;)  // the first group with a vertex counts
    for (const int v : groups[g].second) group_of[v] = static_cast<int>(g);
  std::map<int, Findings> by_group;
  for (const Shell& shell : outward.shells) add(shell, by_group[group_of[shell.vertex]]);
  for (const auto& [group, found] : by_group)
    say(group < 0 ? name : fmt::format("{}, mesh `{}`", name, groups[group].first), found, warnings);
  return std::ranges::any_of(outward.shells, [](const Shell& s) { return s.closed() || s.nearly_closed(); });
}

void turn_outward(const std::string& name, Mesh& mesh, std::vector<std::string>& warnings) {
  turn_outward(name, mesh.groups, {&mesh.x, 1}, seam_places({&mesh.x, 1}, mesh.triangles), mesh.triangles, warnings);
}

}  // namespace selvedge
