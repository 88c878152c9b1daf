#pragma once

#include <array>
#include <vector>

#include "collision/contour/segments.hpp"

namespace selvedge {

enum class ContourEnd {
  none,      // the contour is closed
  boundary,  // at a boundary edge of one of its sheets
  vertex,    // at a loop vertex, which both of its triangles have
  branch     // at an edge of more than two triangles
};

// A contour lies on two sheets, or twice on one: the curve that it is on one of them.
struct ContourSide {
  int sheet = 0, component = 0;  // as in Surface::component
  std::vector<int> triangles;    // one a segment of the contour
  std::vector<int> edges;        // that the curve crosses, in order, as often as it does
  bool cuts = false;             // the curve parts the component in two of different size
  std::vector<int> inside;       // the vertices of the smaller one, sorted; empty where it is inside a triangle
  bool nested = false;           // it lies inside another contour of this component
};

// Segments joined at their crossings. Coordinates of its points: point_of, or the vertex itself.
struct Contour {
  std::vector<int> segments;            // in order
  std::vector<char> swapped;            // of each segment: its second triangle lies on side 0
  std::vector<int> points;              // ends of the segments in order (as Segment::end); closed: as many as segments
  std::vector<char> point_side;         // of each crossing among the points: the side that its edge lies on
  std::array<ContourEnd, 2> ends{};     // of the first and the last point
  std::array<int, 2> end_side{-1, -1};  // the side that has the boundary edge
  bool closed = false;
  bool one_trace = false;  // closed, but the sides change places on the way round: both are one curve
  double length = 0;       // [m]
  std::array<ContourSide, 2> sides;
};

}  // namespace selvedge
