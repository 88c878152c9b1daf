#include "pipeline/shapes/own_crossings.hpp"

#include <algorithm>
#include <map>
#include <optional>

#include <fmt/format.h>

#include "collision/geometry/counted.hpp"
#include "collision/geometry/pair_budget.hpp"
#include "collision/geometry/welded_surface.hpp"
#include "collision/search/intersections.hpp"
#include "pipeline/formats/seam_places.hpp"

namespace selvedge {

int OwnCrossings::pairs() const {
  int sum = 0;
  for (const Between& one : between) sum += one.pairs;
  return sum;
}

OwnCrossings own_crossings(const NamedVertices& meshes, const Points& x, const Triangles& triangles,
                           const std::vector<int>& places) {
  const Surface surface = make_surface(static_cast<int>(x.rows()), triangles);
  const std::optional<WeldedSurface> welded = welded_surface(surface, places);
  const Surface& whole = welded ? welded->surface : surface;
  std::vector<int> mesh_of(static_cast<std::size_t>(x.rows()), -1);
  for (std::size_t m = meshes.size(); m-- > 0;)  // the first mesh with a vertex counts
    for (const int v : meshes[m].second) mesh_of[v] = static_cast<int>(m);
  const auto mesh = [&](int triangle) { return mesh_of[whole.triangles(triangle, 0)]; };
  OwnCrossings found;
  IntersectionCache cache;
  try {
    std::map<std::pair<int, int>, int> count;
    for (const auto& [a, b] : intersecting_pairs(whole, x, cache)) ++count[std::minmax(mesh(a), mesh(b))];
    const auto name = [&](int m) { return m < 0 ? std::string() : meshes[m].first; };
    for (const auto& [both, pairs] : count) found.between.push_back({name(both.first), name(both.second), pairs});
  } catch (const TooManyPairs&) {
    found.too_many = true;
  }
  return found;
}

std::string crossings_text(const OwnCrossings& found) {
  if (found.too_many) return "more pairs of triangles than are counted";
  if (found.between.empty()) return "";
  std::string text = counted(found.pairs(), "pair") + " of triangles";
  std::string parts;
  for (const OwnCrossings::Between& one : found.between) {
    if (one.a.empty() && one.b.empty()) continue;
    const auto named = [](const std::string& name) { return name.empty() ? "the rest" : "`" + name + "`"; };
    parts += (parts.empty() ? "" : ", ") + named(one.a) + (one.a == one.b ? "" : " with " + named(one.b)) +
             fmt::format(" {}", one.pairs);
  }
  return parts.empty() ? text : text + " (" + parts + ")";
}

void warn_of_crossings(const std::string& name, const OwnCrossings& found, std::vector<std::string>& warnings) {
  if (const std::string text = crossings_text(found); !text.empty())
    warnings.push_back(name + ": crosses itself in " + text +
                       "; its outside stays closed, but cloth that its parts catch as they move into each other is let "
                       "through there");
}

void warn_of_crossings(const std::string& name, const Mesh& mesh, std::vector<std::string>& warnings) {
  warn_of_crossings(name, own_crossings(mesh.groups, mesh.x, mesh.triangles, seam_places({&mesh.x, 1}, mesh.triangles)),
                    warnings);
}

}  // namespace selvedge
