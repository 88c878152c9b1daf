#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <map>

#include "pipeline/shapes/generate.hpp"

namespace selvedge {
namespace {

// The T on squared paper: columns from the left cuff to the right one, rows from the hem to the shoulders.
struct PanelGrid {
  int sleeve, body, cuff, rows, neck;  // columns of a sleeve and of the body, rows of a sleeve and of all, neck columns

  int columns() const { return body + 2 * sleeve; }
  bool in_body(int i) const { return i >= sleeve && i < sleeve + body; }
  bool has_square(int i, int j) const {
    return i >= 0 && i < columns() && j >= 0 && j < rows && (in_body(i) || j >= rows - cuff);
  }
  bool has_corner(int i, int j) const {
    return has_square(i, j) || has_square(i - 1, j) || has_square(i, j - 1) || has_square(i - 1, j - 1);
  }
  bool at_hem(int i, int j) const { return j == 0 && i > sleeve && i < sleeve + body; }
  bool at_cuff(int i, int j) const { return (i == 0 || i == columns()) && j > rows - cuff && j < rows; }
  bool at_neck(int i, int j) const { return j == rows && std::abs(2 * i - columns()) < neck; }
  bool at_seam(int i, int j) const {
    if (at_hem(i, j) || at_cuff(i, j) || at_neck(i, j)) return false;
    return !(has_square(i, j) && has_square(i - 1, j) && has_square(i, j - 1) && has_square(i - 1, j - 1));
  }
};

PanelGrid grid_of(const TshirtShape& shape) {
  const auto squares = [&](double length, int least) {
    return std::max(least, static_cast<int>(std::lround(length / shape.edge)));
  };
  PanelGrid grid{squares(shape.sleeve_length, 1), squares(shape.width, 4), squares(shape.sleeve_width, 3),
                 squares(shape.length, 5), squares(shape.neck, 2)};
  grid.cuff = std::min(grid.cuff, grid.rows - 1);
  grid.neck = std::min(grid.neck, grid.body - 2);
  return grid;
}

// Squares to the nearest seam.
double seam_distance(const PanelGrid& grid, int i, int j) {
  double least = std::numeric_limits<double>::infinity();
  for (int p = 0; p <= grid.columns(); ++p)
    for (int q = 0; q <= grid.rows; ++q)
      if (grid.has_corner(p, q) && grid.at_seam(p, q)) least = std::min(least, std::hypot(i - p, j - q));
  return least;
}

}  // namespace

Mesh make_tshirt(const TshirtShape& shape) {
  assert(shape.edge > 0 && shape.depth > 0);
  constexpr double slope = 0.35;  // of front and back beside a seam
  const PanelGrid grid = grid_of(shape);
  std::map<std::array<int, 3>, int> index;  // column, row and side of a corner; seams have side 0
  std::vector<Vec3> x;
  std::map<std::string, std::vector<int>> groups;
  for (int j = 0; j <= grid.rows; ++j)
    for (int i = 0; i <= grid.columns(); ++i) {
      if (!grid.has_corner(i, j)) continue;
      const bool seam = grid.at_seam(i, j);
      const double rise = seam ? 0 : std::min(shape.depth / 2, slope * shape.edge * seam_distance(grid, i, j));
      for (const int side : {1, -1}) {
        const auto [entry, fresh] = index.emplace(std::array{i, j, seam ? 0 : side}, static_cast<int>(x.size()));
        if (!fresh) continue;
        x.emplace_back(shape.edge * (i - 0.5 * grid.columns()), shape.edge * (j - 0.5 * grid.rows), side * rise);
        groups[seam ? "seams" : side > 0 ? "front" : "back"].push_back(entry->second);
        if (grid.at_hem(i, j)) groups["hem"].push_back(entry->second);
        if (grid.at_cuff(i, j)) groups["cuffs"].push_back(entry->second);
        if (grid.at_neck(i, j)) groups["neck"].push_back(entry->second);
      }
    }
  std::vector<std::array<int, 3>> triangles;
  for (const int side : {1, -1})
    for (int j = 0; j < grid.rows; ++j)
      for (int i = 0; i < grid.columns(); ++i) {
        if (!grid.has_square(i, j)) continue;
        const auto at = [&](int p, int q) { return index.at({p, q, grid.at_seam(p, q) ? 0 : side}); };
        const int a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
        add_quad(triangles, a, b, c, d, (i + j) % 2 == 0);
        if (side > 0) continue;
        for (auto triangle = triangles.end() - 2; triangle != triangles.end(); ++triangle)
          std::swap((*triangle)[1], (*triangle)[2]);
      }
  Mesh mesh;
  mesh.x = to_points(x);
  mesh.triangles = to_triangles(triangles);
  mesh.groups.assign(groups.begin(), groups.end());
  return mesh;
}

}  // namespace selvedge
