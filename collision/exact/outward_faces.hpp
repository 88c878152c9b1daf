#pragma once

#include <span>
#include <vector>

#include "collision/geometry/surface.hpp"

namespace selvedge {

// A part of a surface that edges connect. Vertices at one place count as one (welded_surface.hpp).
struct Shell {
  int triangles = 0;
  int vertex = 0;           // any of its vertices
  int open_edges = 0;       // of one triangle
  int branching_edges = 0;  // of more than two
  bool orientable = true;
  double opening = 0;   // area of flat fans over its holes, divided by its own area
  bool over = false;    // most of its triangles faced the wrong way and were turned
  int odd = 0;          // triangles that faced the other way than most, before all were turned alike
  bool cavity = false;  // it faces inwards as it should: it bounds a hole in the shell round it

  bool closed() const { return open_edges == 0 && branching_edges == 0 && orientable; }
  // Its holes are small, so that it is meant to have an inside.
  bool nearly_closed() const {
    return open_edges > 0 && branching_edges == 0 && orientable && opening < largest_opening;
  }
  static constexpr double largest_opening = 0.15;  // a bowl has 0.5, an open box 0.2, a body without head 0.02
};

struct OutwardFaces {
  Triangles triangles;  // as given, in their order; those that were turned have their last two corners exchanged
  std::vector<Shell> shells;
  bool turned() const;  // any triangle was turned
};

// Turns triangles so that closed shells face outwards, by the sign of each shell's volume in the first frame [m]. A
// nearly closed shell is judged as if flat fans closed its holes. Within a shell all face alike. A shell that lies
// within another one in all frames, and as given faces the other way, bounds a cavity: it faces inwards where the outer
// one faces outwards. Shells that are wide open, branch, have one side only or no volume stay as they are. Of two
// triangles at one place that face alike the second is turned as the first. `places`: of each vertex the lowest one at
// its place (same_places.hpp). Positions must be finite.
OutwardFaces face_outward(const Triangles&, std::span<const Points> frames, const std::vector<int>& places);

}  // namespace selvedge
