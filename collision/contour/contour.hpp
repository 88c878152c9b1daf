#pragma once

#include <array>
#include <vector>

#include "collision/contour/segments.hpp"

namespace selvedge {

enum class ContourEnd {
  none,      // the contour is closed
  boundary,  // at a boundary edge of one of its sheets
  vertex,    // at a loop vertex: the two triangles that cross share it
  branch     // at an edge of more than two triangles
};

// A contour lies on two sheets, or twice on one. This is its curve on one of them.
struct ContourSide {
  int sheet = 0, component = 0;  // as in Surface::component
  std::vector<int> triangles;    // one a segment of the contour
  std::vector<int> edges;        // that the curve crosses, in order, repeated where it crosses one again
  bool cuts = false;             // the curve cuts the component into two parts of different size
  std::vector<int> inside;       // the vertices of the smaller part, sorted; empty if it lies inside a triangle
  bool nested = false;           // the curve lies inside another contour of this component
};

// Segments joined at their crossings. The position of a point is point_of(crossing), or that of the vertex.
struct Contour {
  std::vector<int> segments;            // in order
  std::vector<char> swapped;            // of each segment: its second triangle lies on side 0
  std::vector<int> points;              // ends of the segments in order (as Segment::end); closed: as many as segments
  std::vector<char> point_side;         // of each crossing among the points: the side that its edge lies on
  std::array<ContourEnd, 2> ends{};     // of the first and the last point
  std::array<int, 2> end_side{-1, -1};  // the side that has the boundary edge
  bool closed = false;
  bool one_trace = false;  // closed, but the sides change places on the way round, so that both are one curve
  double length = 0;       // [m]
  std::array<ContourSide, 2> sides;
};

}  // namespace selvedge
