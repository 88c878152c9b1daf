#include "collision/untangle/find_exemption.hpp"

#include "collision/contour/contour_regions.hpp"
#include "collision/contour/find_contours.hpp"
#include "collision/untangle/separation.hpp"
#include "collision/untangle/world_sheets.hpp"

namespace selvedge {
namespace {

void mark(std::vector<char>& marks, int size, int node) {
  if (marks.empty()) marks.assign(size, 0);
  marks[node] = 1;
}

}  // namespace

Exemption find_exemption(const ContactWorld& world, const Points& nodes) {
  const WorldSheets sheets(world, nodes);
  const int n = world.cloth->vertex_count;
  Exemption exemption;
  const auto marks_for = [&](int partner_sheet) -> std::vector<char>& {
    return partner_sheet == 0 ? exemption.self : exemption.body;
  };
  const Segments found = find_segments(sheets.views);
  for_each_meeting(world, found, [&](int triangle, int partner_sheet) {
    for (const int v : world.cloth->triangles.row(triangle)) mark(marks_for(partner_sheet), n, v);
  });
  if (exemption.tangled())
    for (const Region& region : enclosed_regions(sheets.views, found, find_contours(sheets.views, found)))
      if (region.sheet == 0 && (region.partner_sheet != 0 || world.self))
        for (const int v : region.vertices) mark(marks_for(region.partner_sheet), n, v);
  const std::vector<char> inside = inside_obstacles(sheets.views);
  for (int v = 0; v < n; ++v)
    if (inside[v]) mark(exemption.body, n, v);
  return exemption;
}

}  // namespace selvedge
