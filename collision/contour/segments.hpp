#pragma once

#include <array>
#include <span>
#include <utility>
#include <vector>

#include "collision/geometry/surface.hpp"

namespace selvedge {

struct Bvh;

// A surface where it is now.
struct SheetView {
  const Surface* surface = nullptr;
  const Points* x = nullptr;
  const Bvh* tree = nullptr;  // of its triangles' boxes there, if whoever asks has one: saves building it
  const std::vector<char>* quiet = nullptr;  // by node of that tree: nothing below crosses itself (quiet.hpp)
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

// What two triangles have in common. Each end is a crossing (its index) or, for triangles that share one vertex and
// cross, the bitwise complement of that vertex; then it is the first.
struct Segment {
  std::array<int, 2> sheet;     // the second is the higher
  std::array<int, 2> triangle;  // within one surface the first is the lower
  std::array<int, 2> end;
  bool at_vertex() const { return end[0] < 0; }
};

// All intersections, as if every vertex had been moved by an infinitesimal amount (symbolic_orientation.hpp, ranks in
// the order of sheets and vertices): two triangles have no segment or one, a crossing belongs to one segment for every
// triangle at its edge, and so segments join end to end. Signs are exact; s and the weights are floating, good to the
// relative error of the determinants that they are quotients of, and clamped to their ranges where these vanish.
struct Segments {
  std::vector<Crossing> crossings;  // sorted by sheets, edge and face
  std::vector<Segment> segments;    // sorted by sheets and triangles
  // Pairs without a common vertex that touch or overlap in a plane without crossing, as a rule of the infinitesimal
  // motion: closed triangles meet (triangles_meet) exactly if they have a segment or are listed here.
  std::vector<std::array<int, 3>> touching;  // triangle of sheet 0, sheet, triangle of that sheet; sorted
};

// sheets[0] against itself and against each of the others. Vertices must be finite. Throws TooManyPairs
// (pair_budget.hpp).
Segments find_segments(std::span<const SheetView> sheets);

Vec3 point_of(std::span<const SheetView> sheets, const Crossing&);  // on the edge
// Of a segment's end.
Vec3 end_point(std::span<const SheetView> sheets, const Segments&, const Segment&, int end);
// Number of segments between triangles that share no vertex, the touching ones included: what an audit counts.
int intersecting_pairs(const Segments&);

}  // namespace selvedge
