#include "collision/exact/triangle_pair.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

#include "collision/exact/orientation.hpp"

namespace selvedge {
namespace {

using TriangleCorners = std::array<Vec3, 3>;
using Sides = std::array<int, 3>;

Sides sides(const TriangleCorners& plane, const TriangleCorners& of) {
  Sides side;
  for (int k = 0; k < 3; ++k) side[k] = orient3d(plane[0], plane[1], plane[2], of[k]);
  return side;
}

bool on_one_side(const Sides& s) { return s[0] != 0 && s[0] == s[1] && s[0] == s[2]; }
bool in_plane(const Sides& s) { return s[0] == 0 && s[1] == 0 && s[2] == 0; }

// A triangle that crosses the other's plane. The apex is alone on its side; `next` and `last` follow it in the
// triangle's order of corners. `above`: the apex is on the positive side.
struct Wedge {
  const Vec3 *apex, *next, *last;
  bool above;
};

Wedge wedge(const TriangleCorners& t, const Sides& side) {
  for (int k = 0;; ++k) {
    assert(k < 3);  // the sides are not all the same
    const int next = (k + 1) % 3, last = (k + 2) % 3;
    const bool above = side[k] > std::max(side[next], side[last]);
    if (above || side[k] < std::min(side[next], side[last])) return {&t[k], &t[next], &t[last], above};
  }
}

// Each triangle cuts the line of the two planes in an interval between its edges from the apex. Let each apex be above
// the other's plane, and the line directed along the cross product of the normals. Then the first triangle's interval
// begins at its edge to `last` and ends at its edge to `next`, and the second's the other way round. They overlap if
// each begins before the other ends.
bool intervals_overlap(Wedge a, Wedge b) {
  if (!a.above) std::swap(b.next, b.last);  // turns b's plane over
  if (!b.above) std::swap(a.next, a.last);
  return orient3d(*a.apex, *a.last, *b.apex, *b.last) >= 0 && orient3d(*a.apex, *a.next, *b.apex, *b.next) <= 0;
}

// For a degenerate triangle that crosses the plane of a proper one: does its line go through the face, seen along the
// line?
bool segment_meets(const TriangleCorners& segment, const Sides& side, const TriangleCorners& face) {
  const auto [low, high] = std::minmax_element(side.begin(), side.end());
  const Vec3 &p = segment[low - side.begin()], &q = segment[high - side.begin()];
  const auto [least, most] = std::minmax(
      {orient3d(p, q, face[0], face[1]), orient3d(p, q, face[1], face[2]), orient3d(p, q, face[2], face[0])});
  return least >= 0 || most <= 0;
}

int area_sign(const TriangleCorners& t, int axis) { return orient2d(t[0], t[1], t[2], axis); }

// Seen along the axis: is all of b strictly beyond an edge of a?
bool edge_parts(const TriangleCorners& a, int area_a, const TriangleCorners& b, int axis) {
  for (int k = 0; k < 3; ++k) {
    const Vec3 &p = a[k], &q = a[(k + 1) % 3];
    const int side = orient2d(p, q, b[0], axis);
    if (side != 0 && side != area_a && side == orient2d(p, q, b[1], axis) && side == orient2d(p, q, b[2], axis))
      return true;
  }
  return false;
}

bool boxes_meet(const TriangleCorners& a, const TriangleCorners& b) {
  for (int k = 0; k < 3; ++k) {
    const auto [a_lo, a_hi] = std::minmax({a[0][k], a[1][k], a[2][k]});
    const auto [b_lo, b_hi] = std::minmax({b[0][k], b[1][k], b[2][k]});
    if (a_lo > b_hi || b_lo > a_hi) return false;
  }
  return true;
}

bool edges_are_skew(const TriangleCorners& a, const TriangleCorners& b) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (orient3d(a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3]) != 0) return true;
  return false;
}

// For triangles in one plane, or two degenerate ones. Convex polygons in a plane that are apart are on different sides
// of the line of some edge or, if all is on one line, in separate boxes. An axis along which one of the triangles has
// an area shows their plane. Two segments that are apart are apart in one of the three views; two that meet do so in
// each.
bool flat_meet(const TriangleCorners& a, const TriangleCorners& b) {
  if (!boxes_meet(a, b)) return false;
  for (int axis = 0; axis < 3; ++axis) {
    const int area_a = area_sign(a, axis), area_b = area_sign(b, axis);
    if (edge_parts(a, area_a, b, axis) || edge_parts(b, area_b, a, axis)) return false;
    if (area_a != 0 || area_b != 0) return true;
  }
  return !edges_are_skew(a, b);
}

}  // namespace

bool triangles_meet(const TriangleCorners& a, const TriangleCorners& b) {
  const Sides side_b = sides(a, b);
  if (on_one_side(side_b)) return false;
  const Sides side_a = sides(b, a);
  if (on_one_side(side_a)) return false;
  const bool flat_a = in_plane(side_a), flat_b = in_plane(side_b);
  if (flat_a && flat_b) return flat_meet(a, b);
  // If a's plane cuts b but b's does not cut a, then b is degenerate, or the other way round.
  if (flat_a) return segment_meets(b, side_b, a);
  if (flat_b) return segment_meets(a, side_a, b);
  return intervals_overlap(wedge(a, side_a), wedge(b, side_b));
}

}  // namespace selvedge
