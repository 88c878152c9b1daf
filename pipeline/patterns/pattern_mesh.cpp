#include "pipeline/patterns/pattern_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "collision/geometry/error.hpp"
#include "pipeline/patterns/flip_mesh.hpp"
#include "pipeline/patterns/planar_mesh.hpp"

namespace selvedge {
namespace {

using EdgeCounts = std::vector<std::vector<int>>;  // by panel and edge

EdgeCounts edge_counts(const Pattern& pattern, double edge) {
  EdgeCounts counts;
  for (const Panel& panel : pattern.panels) {
    counts.emplace_back();
    for (int e = 0; e < static_cast<int>(panel.edges.size()); ++e)
      counts.back().push_back(std::max(1, static_cast<int>(std::lround(edge_length(panel, e) / edge))));
  }
  for (const PatternSeam& seam : pattern.seams) {
    const auto count = [&](std::size_t k) -> int& { return counts[seam.sides[k].panel][seam.sides[k].edge]; };
    count(0) = count(1) = std::max(count(0), count(1));
  }
  return counts;
}

struct CutPanel {
  PlanarMesh mesh;
  std::vector<std::vector<int>> edge_vertices;  // by edge, from end to end
};

CutPanel cut_panel(const Panel& panel, const std::vector<int>& counts, double edge) {
  CutPanel cut;
  cut.edge_vertices.resize(panel.edges.size());
  std::vector<Vec2> outline;
  for (const int e : panel.loop) {
    const std::vector<Vec2> points = edge_points(panel, e, counts[e]);
    for (std::size_t i = 0; i < points.size(); ++i)
      cut.edge_vertices[e].push_back(static_cast<int>(outline.size() + i));
    outline.insert(outline.end(), points.begin(), points.end() - 1);
  }
  cut.edge_vertices[panel.loop.back()].back() = 0;
  const bool clockwise = twice_area(outline) < 0;  // seen from the front; then the right side is the back
  if (clockwise)
    for (Vec2& p : outline) p.x() = -p.x();
  try {
    cut.mesh = planar_mesh(outline, edge);
  } catch (const Error& error) {
    throw Error(error.problem(), "panel `" + panel.name + "`", error.cure());
  }
  if (clockwise)
    for (Vec2& p : cut.mesh.points) p.x() = -p.x();
  return cut;
}

// The rest shape of a triangle, seen from the panel's right side.
RestTriangle rest_of(const std::vector<Vec2>& points, const Triangles& triangles, Eigen::Index t) {
  RestTriangle rest;
  for (int k = 0; k < 3; ++k) rest.col(k) = points[triangles(t, k)];
  if (area(rest) < 0) rest.row(0) *= -1;
  return rest;
}

void append(const Panel& panel, int number, const CutPanel& cut, PatternMesh& all) {
  const Eigen::Index first = all.placed.rows(), first_triangle = all.triangles.rows(),
                     n = static_cast<Eigen::Index>(cut.mesh.points.size()), m = cut.mesh.triangles.rows();
  all.placed.conservativeResize(first + n, 3);
  for (Eigen::Index v = 0; v < n; ++v) {
    const Vec2& p = cut.mesh.points[v];
    all.placed.row(first + v) = (panel.rotation * Vec3(p.x(), p.y(), 0) + panel.translation).transpose();
  }
  all.triangles.conservativeResize(first_triangle + m, 3);
  all.triangles.bottomRows(m) = cut.mesh.triangles.array() + static_cast<int>(first);
  for (Eigen::Index t = 0; t < m; ++t) {
    all.rest.push_back(rest_of(cut.mesh.points, cut.mesh.triangles, t));
    const auto corner = [&](int k) { return Vec2(all.rest.back().col(k)); };
    all.least_angle = std::min(all.least_angle, smallest_angle(corner(0), corner(1), corner(2)));
  }
  all.panel.insert(all.panel.end(), static_cast<std::size_t>(n), number);
}

}  // namespace

PatternMesh pattern_mesh(const Pattern& pattern, double edge) {
  const EdgeCounts counts = edge_counts(pattern, edge);
  PatternMesh all;
  all.placed.resize(0, 3);
  all.triangles.resize(0, 3);
  all.least_angle = 4;
  std::vector<std::vector<std::vector<int>>> edge_vertices;
  std::map<std::string, std::set<int>> groups;
  for (std::size_t p = 0; p < pattern.panels.size(); ++p) {
    const Panel& panel = pattern.panels[p];
    CutPanel cut = cut_panel(panel, counts[p], edge);
    const int first = static_cast<int>(all.placed.rows());
    append(panel, static_cast<int>(p), cut, all);
    for (std::size_t e = 0; e < panel.edges.size(); ++e) {
      for (int& v : cut.edge_vertices[e]) v += first;
      if (const std::string& label = panel.edges[e].label; !label.empty())
        groups[label].insert(cut.edge_vertices[e].begin(), cut.edge_vertices[e].end());
    }
    for (int v = first; v < all.placed.rows(); ++v) {
      groups[panel.name].insert(v);
      if (!panel.label.empty()) groups[panel.label].insert(v);
    }
    edge_vertices.push_back(std::move(cut.edge_vertices));
  }
  for (std::size_t s = 0; s < pattern.seams.size(); ++s) {
    const auto side = [&](std::size_t k) {
      const PanelSide& at = pattern.seams[s].sides[k];
      return edge_vertices[at.panel][at.edge];
    };
    const std::vector<int> from = side(0);
    std::vector<int> to = side(1);
    if (!pattern.seams[s].right_to_wrong) std::ranges::reverse(to);
    for (std::size_t i = 0; i < from.size(); ++i)
      if (from[i] != to[i]) {
        all.sewn.push_back({from[i], to[i]});
        all.seam.push_back(static_cast<int>(s));
      }
  }
  for (const auto& [name, vertices] : groups)
    all.groups.emplace_back(name, std::vector<int>(vertices.begin(), vertices.end()));
  return all;
}

}  // namespace selvedge
