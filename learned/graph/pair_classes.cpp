#include "learned/graph/pair_classes.hpp"

#include <algorithm>
#include <span>

#include "collision/contour/find_contours.hpp"

namespace selvedge {
namespace {

// A curve is one side of a contour; its number is 2 * contour + side. A vertex has the curves that cross its edges or
// enclose it. A face has those whose edges pierce it, and those whose other side encloses one of its vertices.
struct CurvesRound {
  std::vector<std::vector<int>> of_vertex, of_face;  // numbers, ascending, with repeats
  std::vector<char> enclosed;                        // one flag per vertex
  std::vector<char> encloses;                        // one flag per curve

  explicit CurvesRound(const Surface& surface, std::size_t contours)
      : of_vertex(static_cast<std::size_t>(surface.vertex_count)),
        of_face(static_cast<std::size_t>(surface.triangles.rows())),
        enclosed(static_cast<std::size_t>(surface.vertex_count), 0),
        encloses(2 * contours, 0) {}
};

void add_crossings(const Surface& surface, const Segments& segments, const Contour& contour, int number,
                   CurvesRound& curves) {
  for (std::size_t i = 0; i < contour.points.size(); ++i) {
    if (contour.points[i] < 0 || contour.sides[contour.point_side[i]].nested) continue;
    const Crossing& crossing = segments.crossings[static_cast<std::size_t>(contour.points[i])];
    const int curve = 2 * number + contour.point_side[i];
    for (int k = 0; k < 2; ++k) curves.of_vertex[surface.edges(crossing.edge, k)].push_back(curve);
    curves.of_face[crossing.face].push_back(curve);
  }
}

void add_enclosed(const Surface& surface, const Contour& contour, int number, CurvesRound& curves) {
  for (int side = 0; side < 2; ++side) {
    if (contour.sides[side].nested) continue;
    const int own = 2 * number + side, other = 2 * number + 1 - side;
    for (const int v : contour.sides[side].inside) {
      curves.encloses[own] = 1;
      curves.enclosed[v] = 1;
      curves.of_vertex[v].push_back(own);
      if (contour.sides[1 - side].nested) continue;
      for (const int face : surface.triangles_of(v)) curves.of_face[face].push_back(other);
    }
  }
}

CurvesRound curves_round(const Surface& surface, const Segments& segments, const std::vector<Contour>& contours) {
  CurvesRound curves(surface, contours.size());
  for (int c = 0; c < static_cast<int>(contours.size()); ++c) {
    add_crossings(surface, segments, contours[c], c, curves);
    add_enclosed(surface, contours[c], c, curves);
  }
  return curves;
}

bool have_common(const std::vector<int>& a, const std::vector<int>& b) {
  return std::ranges::any_of(a, [&](int curve) { return std::ranges::find(b, curve) != b.end(); });
}

bool attracts(const CurvesRound& curves, int vertex) {
  const std::vector<int>& on = curves.of_vertex[vertex];
  return curves.enclosed[vertex] ||
         (!on.empty() && std::ranges::none_of(on, [&](int curve) { return curves.encloses[curve] != 0; }));
}

void classify_by_vertex(const std::vector<ClothPair>& pairs, const CurvesRound& curves, PairClasses& classes) {
  for (const ClothPair& pair : pairs) {
    if (curves.enclosed[pair.vertex] && !have_common(curves.of_vertex[pair.vertex], curves.of_face[pair.face]))
      ++classes.without_contour;
    else
      (attracts(curves, pair.vertex) ? classes.attraction : classes.repulsion).push_back(pair);
  }
}

void classify_by_all(const std::vector<ClothPair>& pairs, const Surface& surface, const std::vector<char>& unrepelled,
                     PairClasses& classes) {
  for (const ClothPair& pair : pairs) {
    bool attraction = unrepelled[pair.vertex];
    for (int k = 0; k < 3; ++k) attraction |= unrepelled[surface.triangles(pair.face, k)] != 0;
    (attraction ? classes.attraction : classes.repulsion).push_back(pair);
  }
}

}  // namespace

PairClasses classify_pairs(const std::vector<ClothPair>& pairs, const SheetView& cloth, const Segments& segments,
                           const std::vector<Contour>& contours, ContourRule rule) {
  PairClasses classes;
  classes.contours = static_cast<int>(contours.size());
  if (contours.empty() || rule == ContourRule::all_repel) {
    classes.repulsion = pairs;
    return classes;
  }
  const CurvesRound curves = curves_round(*cloth.surface, segments, contours);
  classes.enclosed_vertices = static_cast<int>(std::ranges::count(curves.enclosed, 1));
  for (const Contour& contour : contours)
    for (const ContourSide& side : contour.sides) classes.nested += side.nested ? 1 : 0;
  if (rule == ContourRule::vertex)
    classify_by_vertex(pairs, curves, classes);
  else
    classify_by_all(pairs, *cloth.surface, unrepelled_vertices(std::span(&cloth, 1), contours), classes);
  return classes;
}

}  // namespace selvedge
