#pragma once

#include <array>
#include <span>
#include <vector>

#include "collision/geometry/surface.hpp"

namespace selvedge {

struct Bvh;

// A surface at its present positions.
struct SheetView {
  const Surface* surface = nullptr;
  const Points* x = nullptr;
  const Bvh* tree = nullptr;                 // of its triangles' boxes at x, if the caller has one: saves building it
  const std::vector<char>* quiet = nullptr;  // by node of that tree: 1 if nothing below crosses itself (quiet.hpp)
};

// Where an edge of one surface passes through a face of another or of its own. `sheet` numbers the surfaces of a query.
struct Crossing {
  int edge_sheet = 0, edge = 0, face_sheet = 0, face = 0;
  double s = 0;                  // on the edge: (1 - s) lower vertex + s higher vertex, in [0, 1]
  std::array<double, 3> weight;  // of the face's corners, >= 0, sum 1
  bool operator==(const Crossing& c) const {
    return edge_sheet == c.edge_sheet && edge == c.edge && face_sheet == c.face_sheet && face == c.face;
  }
};

// The line along which two triangles cross. Each end is the index of a crossing. If the triangles share a vertex, the
// first end is the bitwise complement of that vertex.
struct Segment {
  std::array<int, 2> sheet;     // the second is the higher
  std::array<int, 2> triangle;  // within one surface the first is the lower
  std::array<int, 2> end;
  bool at_vertex() const { return end[0] < 0; }
};

// All intersections, as if every vertex had been moved by an infinitesimal amount (symbolic_orientation.hpp, ranks in
// the order of sheets and vertices): two triangles have no segment or one, a crossing belongs to one segment for every
// triangle at its edge, and so segments join end to end. Signs are exact. s and the weights are quotients of
// floating-point determinants, with the relative error of these; where these vanish they are clamped to their ranges.
struct Segments {
  std::vector<Crossing> crossings;  // sorted by sheets, edge and face
  std::vector<Segment> segments;    // sorted by sheets and triangles
  // Pairs without a common vertex that touch or overlap in a plane, but do not cross after the infinitesimal motion.
  // Closed triangles meet (triangles_meet) exactly if they have a segment or are listed here.
  std::vector<std::array<int, 3>> touching;  // triangle of sheet 0, sheet, triangle of that sheet; sorted
};

// Intersections of sheets[0] with itself and with each of the others. Vertices must be finite. Throws TooManyPairs
// (pair_budget.hpp).
Segments find_segments(std::span<const SheetView> sheets);

Vec3 point_of(std::span<const SheetView> sheets, const Crossing&);  // on its edge
// The position of a segment's end 0 or 1.
Vec3 end_point(std::span<const SheetView> sheets, const Segments&, const Segment&, int end);
// The number of pairs of triangles that share no vertex and cross or touch, as an audit counts them.
int intersecting_pairs(const Segments&);

}  // namespace selvedge
