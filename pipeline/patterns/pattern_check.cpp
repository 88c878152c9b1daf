#include "pipeline/patterns/pattern_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "collision/exact/orientation.hpp"
#include "collision/geometry/error.hpp"

namespace selvedge {
namespace {

constexpr double least_length = 1e-6;  // of an edge [m]
constexpr double most_way = 1000;      // of a point from its panel's origin, and of a panel from the body's [m]
constexpr double most_radius = 1e6;    // [m]
constexpr int checked_pieces = 24;     // pieces of a curved edge, for finding crossings

// Throws Error for places so far away that lengths and angles lose all precision, and for places that are not finite.
void check_places(const Panel& panel, const std::string& file) {
  const std::string cure = "check the numbers, and `units_in_meter`";
  if (!(panel.translation.cwiseAbs().maxCoeff() <= most_way))
    throw Error(fmt::format("is more than {} m from the body", most_way), file + ": panel `" + panel.name + "`", cure);
  const auto is_far = [](const Vec2& p) { return !(p.cwiseAbs().maxCoeff() <= most_way); };
  for (int e = 0; e < static_cast<int>(panel.edges.size()); ++e) {
    const PanelEdge& edge = panel.edges[e];
    bool far = std::ranges::any_of(edge.controls, is_far) || !(std::abs(edge.radius) <= most_radius);
    for (const int v : edge.ends) far = far || is_far(panel.corners[v]);
    if (far) throw Error(fmt::format("reaches farther than {} m", most_way), file + ": " + edge_name(panel, e), cure);
  }
}

void check_edge(const Panel& panel, int e, const std::string& file) {
  const PanelEdge& edge = panel.edges[e];
  const std::string where = file + ": " + edge_name(panel, e);
  const double chord = (panel.corners[edge.ends[1]] - panel.corners[edge.ends[0]]).norm();
  if (chord < least_length)
    throw Error("has no length", where, "leave the edge out, or give its ends different places");
  if (edge.form == EdgeForm::circle && 2 * edge.radius < chord * (1 - 1e-6))
    throw Error(fmt::format("is an arc of radius {:.4g} m, and its ends are {:.4g} m apart", edge.radius, chord), where,
                "give a radius of half that distance or more");
}

// All edges in the order round the panel.
std::vector<int> closed_loop(const Panel& panel, const std::string& file) {
  std::map<int, int> from;
  for (int e = 0; e < static_cast<int>(panel.edges.size()); ++e)
    if (!from.emplace(panel.edges[e].ends[0], e).second)
      throw Error("starts at a vertex at which another edge starts", file + ": " + edge_name(panel, e),
                  "let the edges of a panel follow each other once round");
  std::vector<int> loop;
  int e = 0;
  do {
    loop.push_back(e);
    const auto next = from.find(panel.edges[e].ends[1]);
    const std::string cure = "let the edges of a panel follow each other once round";
    if (next == from.end())
      throw Error("ends where no edge starts: the loop is open", file + ": " + edge_name(panel, e), cure);
    if (next->second != 0 && std::ranges::find(loop, next->second) != loop.end())
      throw Error(fmt::format("runs back to edge {}: the loop is open", next->second),
                  file + ": " + edge_name(panel, e), cure);
    e = next->second;
  } while (e != 0);
  if (loop.size() < panel.edges.size()) {
    int left = 0;
    while (std::ranges::find(loop, left) != loop.end()) ++left;
    throw Error("is no part of the loop that begins with edge 0", file + ": " + edge_name(panel, left),
                "give each loop a panel of its own; holes are not supported");
  }
  return loop;
}

bool cross(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  for (int k = 0; k < 2; ++k)
    if (std::max(a[k], b[k]) < std::min(c[k], d[k]) || std::max(c[k], d[k]) < std::min(a[k], b[k])) return false;
  return orient2d(a, b, c) * orient2d(a, b, d) <= 0 && orient2d(c, d, a) * orient2d(c, d, b) <= 0;
}

void check_crossings(const Panel& panel, const std::string& file) {
  std::vector<Vec2> outline;
  std::vector<int> edge;
  for (const int e : panel.loop) {
    const int pieces = panel.edges[e].form == EdgeForm::straight ? 1 : checked_pieces;
    const std::vector<Vec2> points = edge_points(panel, e, pieces);
    outline.insert(outline.end(), points.begin(), points.end() - 1);
    edge.insert(edge.end(), static_cast<std::size_t>(pieces), e);
  }
  const std::size_t n = outline.size();
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 2; j < n; ++j) {
      if (i == 0 && j + 1 == n) continue;
      if (!cross(outline[i], outline[i + 1], outline[j], outline[(j + 1) % n])) continue;
      throw Error(edge[i] == edge[j] ? "crosses itself" : fmt::format("crosses edge {} of the panel", edge[j]),
                  file + ": " + edge_name(panel, edge[i]), "draw the panel so that its outline is simple");
    }
}

void check_seams(const Pattern& pattern, const std::string& file) {
  std::map<std::pair<int, int>, std::size_t> sewn;
  for (std::size_t s = 0; s < pattern.seams.size(); ++s)
    for (const PanelSide& side : pattern.seams[s].sides)
      if (const auto [other, is_new] = sewn.emplace(std::pair(side.panel, side.edge), s); !is_new)
        throw Error(fmt::format("is sewn by stitch {} and by stitch {}", other->second, s),
                    file + ": " + edge_name(pattern.panels[side.panel], side.edge), "sew an edge once");
}

}  // namespace

void check_pattern(Pattern& pattern, const std::string& file) {
  for (Panel& panel : pattern.panels) {
    check_places(panel, file);
    for (int e = 0; e < static_cast<int>(panel.edges.size()); ++e) check_edge(panel, e, file);
    panel.loop = closed_loop(panel, file);
    check_crossings(panel, file);
  }
  check_seams(pattern, file);
}

}  // namespace selvedge
