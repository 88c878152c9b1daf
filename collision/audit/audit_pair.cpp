#include "collision/audit/audit_pair.hpp"

#include <algorithm>

#include "collision/exact/orientation.hpp"

namespace selvedge {
namespace {

Vec2 without(const Vec3& p, int axis) { return {p[(axis + 1) % 3], p[(axis + 2) % 3]}; }

// An axis that is not in the plane of the three points, so that projecting along it loses nothing; -1 if the points are
// on a line.
int visible_axis(const Vec3& a, const Vec3& b, const Vec3& c) {
  for (int axis = 0; axis < 3; ++axis)
    if (orient2d(a, b, c, axis) != 0) return axis;
  return -1;
}

bool in_box(const Vec2& p, const Vec2& a, const Vec2& b) {
  return (p.array() >= a.array().min(b.array())).all() && (p.array() <= a.array().max(b.array())).all();
}

bool segments_meet_2d(const Vec2& p, const Vec2& q, const Vec2& a, const Vec2& b) {
  const int pa = orient2d(p, q, a), pb = orient2d(p, q, b), ap = orient2d(a, b, p), aq = orient2d(a, b, q);
  if ((pa == 0 && in_box(a, p, q)) || (pb == 0 && in_box(b, p, q))) return true;
  if ((ap == 0 && in_box(p, a, b)) || (aq == 0 && in_box(q, a, b))) return true;
  return pa * pb < 0 && ap * aq < 0;
}

bool in_triangle_2d(const Vec2& p, const Vec2& a, const Vec2& b, const Vec2& c) {
  const auto [least, most] = std::minmax({orient2d(a, b, p), orient2d(b, c, p), orient2d(c, a, p)});
  return least >= 0 || most <= 0;
}

bool segments_meet(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b) {
  if (orient3d(p, q, a, b) != 0) return false;
  for (const auto& [u, v, w] : {std::array{&p, &q, &a}, {&p, &q, &b}, {&a, &b, &p}, {&a, &b, &q}}) {
    const int axis = visible_axis(*u, *v, *w);
    if (axis >= 0) return segments_meet_2d(without(p, axis), without(q, axis), without(a, axis), without(b, axis));
  }
  // All points are on one line, along which every coordinate is monotone.
  return (p.array().min(q.array()) <= a.array().max(b.array())).all() &&
         (a.array().min(b.array()) <= p.array().max(q.array())).all();
}

// Do segment and triangle meet, if they are in one plane or the triangle is degenerate?
bool segment_meets_flat(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
  const int axis = visible_axis(a, b, c);
  if (axis < 0) return segments_meet(p, q, a, b) || segments_meet(p, q, b, c) || segments_meet(p, q, c, a);
  const Vec2 p2 = without(p, axis), q2 = without(q, axis);
  const Vec2 a2 = without(a, axis), b2 = without(b, axis), c2 = without(c, axis);
  return in_triangle_2d(p2, a2, b2, c2) || segments_meet_2d(p2, q2, a2, b2) || segments_meet_2d(p2, q2, b2, c2) ||
         segments_meet_2d(p2, q2, c2, a2);
}

// side_p, side_q: orient3d(a, b, c, p) and (a, b, c, q).
bool segment_meets_triangle(const Vec3& p, const Vec3& q, int side_p, int side_q, const Vec3& a, const Vec3& b,
                            const Vec3& c) {
  if (side_p * side_q > 0) return false;
  if (side_p == 0 && side_q == 0) return segment_meets_flat(p, q, a, b, c);
  const int ab = orient3d(p, q, a, b), bc = orient3d(p, q, b, c);
  if (ab * bc < 0) return false;
  const int ca = orient3d(p, q, c, a);
  return ab * ca >= 0 && bc * ca >= 0;
}

bool segment_meets_triangle(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
  return segment_meets_triangle(p, q, orient3d(a, b, c, p), orient3d(a, b, c, q), a, b, c);
}

using Corners = std::array<const Vec3*, 3>;

std::array<int, 3> sides(const Corners& plane, const Corners& of) {
  return {orient3d(*plane[0], *plane[1], *plane[2], *of[0]), orient3d(*plane[0], *plane[1], *plane[2], *of[1]),
          orient3d(*plane[0], *plane[1], *plane[2], *of[2])};
}

bool on_one_side(const std::array<int, 3>& side) { return side[0] != 0 && side[0] == side[1] && side[0] == side[2]; }

bool an_edge_meets(const Corners& edges_of, const std::array<int, 3>& side, const Corners& triangle) {
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3;
    if (segment_meets_triangle(*edges_of[k], *edges_of[next], side[k], side[next], *triangle[0], *triangle[1],
                               *triangle[2]))
      return true;
  }
  return false;
}

// Do the segments from s to a and from s to b share more than s?
bool rays_overlap(const Vec3& s, const Vec3& a, const Vec3& b) {
  if (visible_axis(s, a, b) >= 0) return false;
  for (int k = 0; k < 3; ++k)
    if (a[k] != s[k]) return b[k] != s[k] && (a[k] > s[k]) == (b[k] > s[k]);
  return false;
}

// Does the segment from s to a share more than s with a proper triangle s, b1, b2? If so, the last point that it shares
// is a or lies on the side opposite s.
bool ray_meets_triangle(const Vec3& s, const Vec3& a, const Vec3& b1, const Vec3& b2) {
  return a != s && (segment_meets_triangle(a, a, s, b1, b2) || segments_meet(s, a, b1, b2));
}

}  // namespace

bool triangles_intersect(const Vec3& a0, const Vec3& a1, const Vec3& a2, const Vec3& b0, const Vec3& b1,
                         const Vec3& b2) {
  const Corners a{&a0, &a1, &a2}, b{&b0, &b1, &b2};
  const std::array<int, 3> side_b = sides(a, b);
  if (on_one_side(side_b)) return false;
  const std::array<int, 3> side_a = sides(b, a);
  if (on_one_side(side_a)) return false;
  // Triangles that meet do so on an edge of one of them.
  return an_edge_meets(b, side_b, a) || an_edge_meets(a, side_a, b);
}

bool triangles_cross_at_vertex(const Vec3& s, const Vec3& a1, const Vec3& a2, const Vec3& b1, const Vec3& b2) {
  const int side_b1 = orient3d(s, a1, a2, b1), side_b2 = orient3d(s, a1, a2, b2);
  if (side_b1 * side_b2 > 0) return false;
  const int side_a1 = orient3d(s, b1, b2, a1), side_a2 = orient3d(s, b1, b2, a2);
  if (side_a1 * side_a2 > 0) return false;
  const bool flat_a = visible_axis(s, a1, a2) < 0, flat_b = visible_axis(s, b1, b2) < 0;
  if (flat_a && flat_b)
    return rays_overlap(s, a1, b1) || rays_overlap(s, a1, b2) || rays_overlap(s, a2, b1) || rays_overlap(s, a2, b2);
  if (flat_a) return ray_meets_triangle(s, a1, b1, b2) || ray_meets_triangle(s, a2, b1, b2);
  if (flat_b) return ray_meets_triangle(s, b1, a1, a2) || ray_meets_triangle(s, b2, a1, a2);
  // Their common part is star-shaped round s, so that its far end lies on a side opposite s, of one of them.
  return segment_meets_triangle(a1, a2, side_a1, side_a2, s, b1, b2) ||
         segment_meets_triangle(b1, b2, side_b1, side_b2, s, a1, a2);
}

}  // namespace selvedge
