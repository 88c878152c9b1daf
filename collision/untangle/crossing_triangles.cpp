#include "collision/untangle/crossing_triangles.hpp"

#include "collision/untangle/separation.hpp"
#include "collision/untangle/world_sheets.hpp"

namespace selvedge {

std::vector<char> crossing_triangles(const ContactWorld& world, const Points& nodes) {
  const WorldSheets sheets(world, nodes);
  std::vector<char> crosses(static_cast<std::size_t>(world.cloth->triangles.rows()), 0);
  for_each_meeting(world, find_segments(sheets.views), [&](int triangle, int) { crosses[triangle] = 1; });
  const std::vector<char> inside = inside_obstacles(sheets.views);
  for (int v = 0; v < world.cloth->vertex_count; ++v)
    if (inside[v])
      for (const int t : world.cloth->triangles_of(v)) crosses[t] = 1;
  return crosses;
}

}  // namespace selvedge
