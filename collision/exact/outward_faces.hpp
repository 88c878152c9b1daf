#pragma once

#include <span>
#include <vector>

#include "collision/geometry/surface.hpp"

namespace selvedge {

// A part of a surface that hangs together along edges, vertices at one place taken as one (welded_surface.hpp).
struct Shell {
  int triangles = 0;
  int vertex = 0;           // one of its own
  int open_edges = 0;       // of one triangle
  int branching_edges = 0;  // of more than two
  bool orientable = true;
  double opening = 0;   // area of flat fans over its holes, by its own area
  bool over = false;    // most of it faced the wrong way and was turned
  int odd = 0;          // triangles that faced the other way than most: all face alike now
  bool cavity = false;  // it faces inwards as it should: it bounds a hole in the shell round it

  bool closed() const { return open_edges == 0 && branching_edges == 0 && orientable; }
  // Its holes are small beside it: what it holds is meant to be inside.
  bool nearly_closed() const {
    return open_edges > 0 && branching_edges == 0 && orientable && opening < largest_opening;
  }
  static constexpr double largest_opening = 0.15;  // a bowl has 0.5, an open box 0.2, a body without head 0.02
};

struct OutwardFaces {
  Triangles triangles;  // as given, in their order; those that were turned have their last two corners exchanged
  std::vector<Shell> shells;
  bool turned() const;  // any of them
};

// Turns triangles so that closed shells face outwards, each by its own volume in the first frame [m]; a nearly closed
// one as if flat fans closed its holes. Within a shell all face alike. A shell that lies within another one in all
// frames, and faces the other way than that as given, bounds a cavity: it faces inwards where the one round it faces
// outwards. What is wide open, branches, has one side only or no volume stays as it is. A triangle that lies on one
// that faces as it does goes with that one. `places`: of each vertex the lowest one at its place (same_places.hpp).
// Positions must be finite.
OutwardFaces face_outward(const Triangles&, std::span<const Points> frames, const std::vector<int>& places);

}  // namespace selvedge
