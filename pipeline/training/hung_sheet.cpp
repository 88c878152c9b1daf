#include "pipeline/training/hung_sheet.hpp"

#include <algorithm>
#include <cmath>

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

}  // namespace selvedge
