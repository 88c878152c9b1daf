#include "collision/untangle/let_through.hpp"

#include <algorithm>

#include "collision/contour/find_contours.hpp"

namespace selvedge {

void drop_let_through(std::span<const SheetView> sheets, const std::vector<char>& let_through, Segments& found) {
  if (let_through.empty()) return;
  const auto goes_through = [&](int t) {
    const auto corners = sheets[0].surface->triangles.row(t);
    return std::any_of(corners.begin(), corners.end(), [&](int v) { return let_through[v] != 0; });
  };
  std::vector<char> dropped(found.segments.size(), 0);
  for (const Contour& contour : trace_contours(sheets, found)) {
    if (contour.sides[0].sheet == contour.sides[1].sheet) continue;
    const std::vector<int>& on_cloth = contour.sides[contour.sides[0].sheet == 0 ? 0 : 1].triangles;
    if (std::any_of(on_cloth.begin(), on_cloth.end(), goes_through))
      for (const int s : contour.segments) dropped[s] = 1;
  }
  std::vector<Segment> kept;
  for (std::size_t s = 0; s < found.segments.size(); ++s)
    if (!dropped[s]) kept.push_back(found.segments[s]);
  found.segments = std::move(kept);
  std::erase_if(found.touching, [&](const std::array<int, 3>& pair) { return pair[1] != 0 && goes_through(pair[0]); });
}

void drop_let_through(const std::vector<char>& let_through, std::vector<Separation>& separations) {
  if (let_through.empty()) return;
  std::erase_if(separations, [&](const Separation& s) {
    bool marked = false;
    for (int i = 0; i < s.count; ++i) marked = marked || let_through[s.vertex[i]];
    return marked && is_against_obstacle(s);
  });
}

}  // namespace selvedge
