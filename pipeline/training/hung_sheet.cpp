#include "pipeline/training/hung_sheet.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace selvedge {

HungSheet hung_sheet(double edge) {
  constexpr double side = 0.5;  // [m]
  const int cells = std::max(2, static_cast<int>(std::lround(side / edge))), columns = cells + 1;
  HungSheet sheet;
  sheet.rest.resize(columns * columns, 3);
  sheet.triangles.resize(2 * cells * cells, 3);
  for (int i = 0; i < columns; ++i)
    for (int j = 0; j < columns; ++j)
      sheet.rest.row(i * columns + j) << side * j / cells - side / 2, -side * i / cells, 0;
  int t = 0;
  for (int i = 0; i < cells; ++i)
    for (int j = 0; j < cells; ++j) {
      const int a = i * columns + j, b = a + 1, c = a + columns, d = c + 1;
      // Diagonals alternate from cell to cell, so that the cloth has no preferred direction.
      if ((i + j) % 2 == 0) {
        sheet.triangles.row(t++) << a, c, d;
        sheet.triangles.row(t++) << a, d, b;
      } else {
        sheet.triangles.row(t++) << a, c, b;
        sheet.triangles.row(t++) << b, c, d;
      }
    }
  for (int j = 0; j < columns; ++j) sheet.pins.push_back(j);
  return sheet;
}

Points folded(const Points& flat, RandomStream& random) {
  const double side = random.heads(0.5) ? 1 : -1, front = random.heads(0.5) ? 1 : -1;
  const double size = 0.14 + 0.1 * random.uniform(), lift = 0.004 + 0.008 * random.uniform();
  const double turn = std::numbers::pi + 0.15 + 0.2 * random.uniform(), skew = 0.35 * (2 * random.uniform() - 1);
  const Vec3 corner(side * flat.col(0).maxCoeff(), flat.col(1).minCoeff(), 0);
  const Vec3 inward = Vec3(-side * std::cos(std::numbers::pi / 4 + skew), std::sin(std::numbers::pi / 4 + skew), 0);
  Points x = flat;
  for (Eigen::Index v = 0; v < x.rows(); ++v) {
    const Vec3 p = x.row(v).transpose();
    const double beyond = size - (p - corner).dot(inward);  // distance beyond the line, towards the corner
    if (beyond <= 0) continue;
    // First half a circle of radius `lift`, then straight on, tilted towards the sheet.
    const double arc = std::numbers::pi * lift;
    Vec3 at = p + beyond * inward;  // on the line
    if (beyond < arc)
      at += -std::sin(beyond / lift) * lift * inward + Vec3(0, 0, front * lift * (1 - std::cos(beyond / lift)));
    else
      at +=
          -std::cos(turn) * (beyond - arc) * inward + Vec3(0, 0, front * (2 * lift + std::sin(turn) * (beyond - arc)));
    x.row(v) = at.transpose();
  }
  return x;
}

}  // namespace selvedge
