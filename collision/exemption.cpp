#include "collision/exemption.hpp"

#include <algorithm>

#include "collision/buried.hpp"
#include "collision/contour_regions.hpp"
#include "collision/separation.hpp"
#include "collision/world_sheets.hpp"

namespace selvedge {
namespace {

void mark(std::vector<char>& marks, int size, int node) {
  if (marks.empty()) marks.assign(size, 0);
  marks[node] = 1;
}

void mark_triangle(std::vector<char>& marks, int size, const Surface& surface, int triangle, int first = 0) {
  for (int k = 0; k < 3; ++k) mark(marks, size, first + surface.triangles(triangle, k));
}

}  // namespace

int Exemption::cloth_vertices() const {
  int count = 0;
  for (std::size_t v = 0; v < std::max(self.size(), body.size()); ++v)
    count += (!self.empty() && self[v]) || (!body.empty() && body[v]);
  return count;
}

bool Exemption::leaves_alone(const ContactWorld& world, const std::array<int, 4>& nodes) const {
  bool self_alone = false, body_alone = false, all_cloth = true, all_off = !off.empty();
  for (const int node : nodes) {
    if (!world.is_cloth(node)) {
      all_cloth = false;
      all_off = all_off && off[node];
      continue;
    }
    self_alone = self_alone || (!self.empty() && self[node]);
    body_alone = body_alone || (!body.empty() && body[node]);
  }
  return all_cloth ? self_alone : body_alone || all_off;
}

std::vector<char> either(std::vector<char> a, const std::vector<char>& b) {
  if (a.empty()) return b;
  for (std::size_t v = 0; v < b.size(); ++v) a[v] = a[v] || b[v];
  return a;
}

Exemption find_exemption(const ContactWorld& world, const Points& nodes) {
  const WorldSheets sheets(world, nodes);
  const int n = world.cloth->vertex_count;
  Exemption exemption;
  const auto marks_for = [&](int partner_sheet) -> std::vector<char>& {
    return partner_sheet == 0 ? exemption.self : exemption.body;
  };
  const Segments found = find_segments(sheets.views);
  for_each_meeting(world, found, [&](int triangle, int partner_sheet) {
    mark_triangle(marks_for(partner_sheet), n, *world.cloth, triangle);
  });
  if (exemption.cloth())
    for (const Region& region : enclosed_regions(sheets.views, find_contours(sheets.views, found)))
      if (region.sheet == 0 && (region.partner_sheet != 0 || world.self))
        for (const int v : region.vertices) mark(marks_for(region.partner_sheet), n, v);
  const std::vector<char> inside = inside_obstacles(sheets.views);
  for (int v = 0; v < n; ++v)
    if (inside[v]) mark(exemption.body, n, v);
  return exemption;
}

void switch_off(const ContactWorld& world, int obstacle, const Points& nodes, Exemption& exemption) {
  const Surface& body = *world.obstacles[obstacle];
  const int first = world.first_node[obstacle];
  const Points x = nodes.middleRows(first, body.vertex_count);
  const std::vector<SheetView> view{{&body, &x}};
  const Segments found = find_segments(view);
  if (found.segments.empty()) return;
  const std::vector<char> crossed = buried_vertices(body, x, found);
  // The margin: every triangle at a crossed vertex.
  for (int t = 0; t < body.triangles.rows(); ++t) {
    const auto corners = body.triangles.row(t);
    if (crossed[corners(0)] || crossed[corners(1)] || crossed[corners(2)])
      mark_triangle(exemption.off, world.node_count, body, t, first);
  }
}

}  // namespace selvedge
