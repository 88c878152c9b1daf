#include "pipeline/shapes/outward_mesh.hpp"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "collision/exact/outward_faces.hpp"
#include "collision/geometry/counted.hpp"
#include "collision/geometry/same_places.hpp"

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
  const auto tell = [&](int count, const std::string& what) {
    if (count > 0) warnings.push_back(mesh + ": " + of_shells(count, found.shells) + " " + what);
  };
  tell(found.over, "faced inwards and was turned outwards, " + counted(found.over_triangles, "triangle"));
  tell(found.mixed, fmt::format("had triangles that faced the other way than the rest, {} were turned", found.odd));
  tell(found.cavities, "faces inwards inside of another: taken for a cavity, where cloth is outside");
  tell(found.open,
       fmt::format("is open ({} with one triangle): cloth that gets inside is not known to be there and is not pushed "
                   "out; close its holes if it is to be solid",
                   counted(found.open_edges, "edge")));
  tell(found.branching,
       fmt::format("has {} with more than two triangles, so that nothing is inside of it; part what touches there",
                   counted(found.branching_edges, "edge")));
  tell(found.one_sided, "has one side only, so that nothing is inside of it");
}

}  // namespace

void turn_outward(const std::string& name, const NamedVertices& groups, std::span<const Points> frames,
                  const std::vector<int>& places, Triangles& triangles, std::vector<std::string>& warnings) {
  OutwardFaces outward = face_outward(triangles, frames, places);
  triangles = std::move(outward.triangles);
  std::vector<int> group_of(static_cast<std::size_t>(frames.empty() ? 0 : frames[0].rows()), -1);
  for (std::size_t g = groups.size(); g-- > 0;)  // the first group with a vertex counts
    for (const int v : groups[g].second) group_of[v] = static_cast<int>(g);
  std::map<int, Findings> by_group;
  for (const Shell& shell : outward.shells) add(shell, by_group[group_of[shell.vertex]]);
  for (const auto& [group, found] : by_group)
    say(group < 0 ? name : fmt::format("{}, mesh `{}`", name, groups[group].first), found, warnings);
}

void turn_outward(const std::string& name, Mesh& mesh, std::vector<std::string>& warnings) {
  turn_outward(name, mesh.groups, {&mesh.x, 1}, same_places(mesh.x), mesh.triangles, warnings);
}

}  // namespace selvedge
