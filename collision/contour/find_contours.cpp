#include "collision/contour/find_contours.hpp"

#include <algorithm>

#include "collision/contour/contour_regions.hpp"
#include "collision/contour/edge_parity.hpp"

namespace selvedge {
namespace {

struct Use {
  int segment, end;
};

// Which segments end at each crossing.
struct Joints {
  std::vector<std::vector<Use>> uses;  // of each crossing

  explicit Joints(const Segments& found) : uses(found.crossings.size()) {
    for (int i = 0; i < static_cast<int>(found.segments.size()); ++i)
      for (int end = 0; end < 2; ++end)
        if (found.segments[i].end[end] >= 0) uses[found.segments[i].end[end]].push_back({i, end});
  }
  bool goes_on(int point) const { return point >= 0 && uses[point].size() == 2; }
  Use next(int point, int segment) const {
    const std::vector<Use>& two = uses[point];
    return two[0].segment == segment ? two[1] : two[0];
  }
};

// Which of the segment's triangles is the face of the crossing?
int face_place(const Segment& segment, const Crossing& c) {
  return segment.sheet[0] == c.face_sheet && segment.triangle[0] == c.face ? 0 : 1;
}

ContourEnd end_kind(const Joints& joints, int point) {
  if (point < 0) return ContourEnd::vertex;
  return joints.uses[point].size() == 1 ? ContourEnd::boundary : ContourEnd::branch;
}

// Follows the segments from `start`, leaving it at its end `leave`, until the contour ends or comes back.
Contour walk(const Segments& found, const Joints& joints, Use start, std::vector<char>& taken) {
  Contour contour;
  contour.points.push_back(found.segments[start.segment].end[1 - start.end]);
  bool swapped = false;
  for (Use at = start;;) {
    const Segment& segment = found.segments[at.segment];
    taken[at.segment] = 1;
    contour.segments.push_back(at.segment);
    contour.swapped.push_back(swapped);
    const int point = segment.end[at.end];
    if (!joints.goes_on(point)) {
      contour.points.push_back(point);
      break;
    }
    const Use next = joints.next(point, at.segment);
    const Crossing& c = found.crossings[point];
    swapped ^= face_place(segment, c) != face_place(found.segments[next.segment], c);
    if (next.segment == start.segment) {
      contour.closed = true;
      contour.one_trace = swapped;
      break;
    }
    contour.points.push_back(point);
    at = {next.segment, 1 - next.end};
  }
  return contour;
}

// Side on which the edge of the crossing lies, seen from one of its segments.
int edge_side(const Contour& contour, std::size_t place, const Segments& found, int point) {
  const Segment& segment = found.segments[contour.segments[place]];
  return (1 - face_place(segment, found.crossings[point])) ^ contour.swapped[place];
}

void fill_sides(std::span<const SheetView> sheets, const Segments& found, Contour& contour) {
  for (std::size_t i = 0; i < contour.segments.size(); ++i) {
    const Segment& segment = found.segments[contour.segments[i]];
    for (int k = 0; k < 2; ++k) contour.sides[k ^ contour.swapped[i]].triangles.push_back(segment.triangle[k]);
    contour.length += (end_point(sheets, found, segment, 1) - end_point(sheets, found, segment, 0)).norm();
  }
  for (std::size_t i = 0; i < contour.points.size(); ++i) {
    const int point = contour.points[i];
    contour.point_side.push_back(0);
    if (point < 0) continue;
    const int side = edge_side(contour, std::min(i, contour.segments.size() - 1), found, point);
    contour.point_side.back() = static_cast<char>(side);
    contour.sides[side].edges.push_back(found.crossings[point].edge);
    if (contour.closed) continue;
    if (i == 0) contour.end_side[0] = side;
    if (i + 1 == contour.points.size()) contour.end_side[1] = side;
  }
  const Segment& first = found.segments[contour.segments.front()];
  for (int k = 0; k < 2; ++k) {
    ContourSide& side = contour.sides[k ^ contour.swapped.front()];
    side.sheet = first.sheet[k];
    const Surface& surface = *sheets[side.sheet].surface;
    side.component = surface.component[surface.triangles(first.triangle[k], 0)];
  }
}

bool same_component(const Contour& contour) {
  return contour.sides[0].sheet == contour.sides[1].sheet && contour.sides[0].component == contour.sides[1].component;
}

// Sets `cuts` of a side, and `inside`: the vertices that the curves cut off.
void judge_cut(const EdgeParity& parity, const std::vector<int>& sizes, ContourSide& side) {
  std::optional<std::vector<int>> part = parity.smaller_part(side.component, sizes[side.component]);
  side.cuts = part.has_value();
  if (part) side.inside = std::move(*part);
}

// sizes: numbers of vertices of the components of each sheet.
void judge_sides(std::span<const SheetView> sheets, std::span<const std::vector<int>> sizes, Contour& contour) {
  const bool loop = contour.ends[0] == ContourEnd::vertex || contour.ends[1] == ContourEnd::vertex;
  if (loop || contour.one_trace) {
    if (!ends_outside(contour, 0) || !ends_outside(contour, 1) || !same_component(contour)) return;
    EdgeParity parity(*sheets[contour.sides[0].sheet].surface);
    parity.add(contour, 0);
    parity.add(contour, 1);
    ContourSide &first = contour.sides[0], &second = contour.sides[1];
    judge_cut(parity, sizes[first.sheet], first);
    second.cuts = first.cuts;
    second.inside = first.inside;
    return;
  }
  for (int k = 0; k < 2; ++k) {
    ContourSide& side = contour.sides[k];
    if (!ends_outside(contour, k)) continue;
    EdgeParity parity(*sheets[side.sheet].surface);
    parity.add(contour, k);
    judge_cut(parity, sizes[side.sheet], side);
  }
}

bool contains(const std::vector<int>& sorted, int value) { return std::ranges::binary_search(sorted, value); }

// Does the curve of `inner` run among the vertices inside `outer`?
bool lies_inside(const Surface& surface, const ContourSide& inner, const ContourSide& outer) {
  if (!inner.inside.empty())
    return inner.inside.size() < outer.inside.size() &&
           std::includes(outer.inside.begin(), outer.inside.end(), inner.inside.begin(), inner.inside.end());
  for (int t : inner.triangles)
    for (int k = 0; k < 3; ++k)
      if (!contains(outer.inside, surface.triangles(t, k))) return false;
  return true;
}

// A side that cuts its component, listed at each vertex that it encloses.
struct Enclosure {
  int contour = 0;
  const ContourSide* side = nullptr;
};

void mark_nested(std::span<const SheetView> sheets, std::vector<Contour>& contours) {
  std::vector<std::vector<std::vector<Enclosure>>> round;  // enclosures of each vertex of each sheet
  for (const SheetView& sheet : sheets) round.emplace_back(sheet.surface->vertex_count);
  for (int c = 0; c < static_cast<int>(contours.size()); ++c)
    for (const ContourSide& side : contours[c].sides)
      if (side.cuts)
        for (const int v : side.inside) round[side.sheet][v].push_back({c, &side});
  for (int c = 0; c < static_cast<int>(contours.size()); ++c)
    for (ContourSide& side : contours[c].sides) {
      if (!side.cuts) continue;
      const Surface& surface = *sheets[side.sheet].surface;
      const int one = side.inside.empty() ? surface.triangles(side.triangles.front(), 0) : side.inside.front();
      const std::vector<Enclosure>& all = round[side.sheet][one];
      side.nested = std::ranges::any_of(
          all, [&](const Enclosure& outer) { return outer.contour != c && lies_inside(surface, side, *outer.side); });
    }
}

}  // namespace

std::vector<Contour> trace_contours(std::span<const SheetView> sheets, const Segments& found) {
  const Joints joints(found);
  const int count = static_cast<int>(found.segments.size());
  std::vector<char> taken(found.segments.size(), 0);
  std::vector<Contour> contours;
  for (int i = 0; i < count; ++i)
    for (int end = 0; end < 2 && !taken[i]; ++end) {
      if (joints.goes_on(found.segments[i].end[end])) continue;
      Contour contour = walk(found, joints, {i, 1 - end}, taken);
      contour.ends = {end_kind(joints, contour.points.front()), end_kind(joints, contour.points.back())};
      contours.push_back(std::move(contour));
    }
  for (int i = 0; i < count; ++i)
    if (!taken[i]) contours.push_back(walk(found, joints, {i, 1}, taken));
  for (Contour& contour : contours) fill_sides(sheets, found, contour);
  return contours;
}

std::vector<Contour> find_contours(std::span<const SheetView> sheets, const Segments& segments) {
  std::vector<Contour> contours = trace_contours(sheets, segments);
  std::vector<std::vector<int>> sizes;
  for (const SheetView& sheet : sheets) sizes.push_back(component_sizes(*sheet.surface));
  for (Contour& contour : contours) judge_sides(sheets, sizes, contour);
  mark_nested(sheets, contours);
  return contours;
}

std::vector<char> unrepelled_vertices(std::span<const SheetView> sheets, std::span<const Contour> contours) {
  const Surface& surface = *sheets[0].surface;
  std::vector<char> marked(surface.vertex_count, 0);
  for (const Contour& contour : contours)
    for (const ContourSide& side : contour.sides) {
      if (side.sheet != 0 || side.nested) continue;
      for (int v : side.inside) marked[v] = 1;
      if (side.cuts) continue;
      for (int t : side.triangles)
        for (int k = 0; k < 3; ++k) marked[surface.triangles(t, k)] = 1;
    }
  return marked;
}

}  // namespace selvedge
