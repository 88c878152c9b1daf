#include "collision/crossing_triangles.hpp"

#include "collision/inside.hpp"
#include "collision/world_sheets.hpp"

namespace selvedge {

std::vector<char> crossing_triangles(const ContactWorld& world, const Points& nodes) {
  const WorldSheets sheets(world, nodes);
  std::vector<char> crosses(static_cast<std::size_t>(world.cloth->triangles.rows()), 0);
  const Segments found = find_segments(sheets.views);
  for (const Segment& segment : found.segments)
    if (segment.sheet[1] != 0 || world.self)
      for (int side = 0; side < 2; ++side)
        if (segment.sheet[side] == 0) crosses[segment.triangle[side]] = 1;
  for (const auto& [triangle, sheet, other] : found.touching) {
    if (sheet == 0 && !world.self) continue;
    crosses[triangle] = 1;
    if (sheet == 0) crosses[other] = 1;
  }
  for (std::size_t k = 0; k < world.obstacles.size(); ++k) {
    if (!is_closed(*world.obstacles[k])) continue;
    const std::vector<char> is_inside = inside(*world.obstacles[k], sheets.positions[k + 1], sheets.positions[0]);
    for (int v = 0; v < world.cloth->vertex_count; ++v)
      if (is_inside[v])
        for (const int t : world.cloth->triangles_of(v)) crosses[t] = 1;
  }
  return crosses;
}

}  // namespace selvedge
