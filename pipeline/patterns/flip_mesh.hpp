#pragma once

#include <array>
#include <vector>

#include "collision/geometry/points.hpp"

namespace selvedge {

// Edge k runs from corner k to corner k + 1; `beyond` is the triangle on its other side, -1 at the outline.
struct FlipTriangle {
  std::array<int, 3> corner{}, beyond{-1, -1, -1};
};

// The smallest angle of a triangle [rad].
double smallest_angle(const Vec2& a, const Vec2& b, const Vec2& c);

// A triangulation of a simple polygon that changes by flips of edges. The first `fixed` points are the polygon's.
struct FlipMesh {
  std::vector<Vec2> points;
  std::vector<FlipTriangle> triangles;
  int fixed = 0;
  bool may_make_chords = true;  // edges inside that join two points of the outline

  // corners: triangles of the polygon, without inner points.
  FlipMesh(const std::vector<Vec2>& outline, const std::vector<std::array<int, 3>>& corners);

  bool is_sound() const;         // every triangle is counter-clockwise
  int sign(int triangle) const;  // of its area, exact

  // Flips edges until each is locally Delaunay (Lawson 1977).
  void make_delaunay();

  // Inserts a point into its triangle, then flips edges. Does nothing if the point is outside or on an edge.
  void insert(const Vec2&);

  bool is_chord(int triangle, int k) const;            // an edge inside that joins two points of the outline
  double angle_if_flipped(int triangle, int k) const;  // smallest angle of the two triangles [rad]; 0: not possible
  void flip(int triangle, int k);                      // must be possible
  void cut(int triangle, int k);                       // splits the edge, and both of its triangles, at the middle

  std::vector<std::vector<int>> triangles_round_vertices() const;

 private:
  int find(const Vec2&) const;
  int edge_to(int triangle, int other) const;  // the edge of a triangle that it shares with another
  void rejoin(int triangle, int k);            // updates the neighbour across edge k
  bool wants_flip(int triangle, int k) const;
  void settle(std::vector<int> fan);
  mutable int last_ = 0;
};

}  // namespace selvedge
