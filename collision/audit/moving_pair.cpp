#include "collision/audit/moving_pair.hpp"

#include <algorithm>
#include <vector>

namespace selvedge {
namespace {

// A bound of the rounding error of m . p - m . q. Coordinates are differences, wrong by u = 2^-53 of themselves, and m
// . p rounds five times: less than 7 u max |m_k| reach for a point, with `reach` the largest sum of coordinates, and 14
// u for both sides. This is 45 u, with room for the error of halving the time. Underflow adds less than 1e-300.
double slack_of(const Vec3& m, double reach) { return 5e-15 * m.cwiseAbs().maxCoeff() * reach + 1e-300; }

// The most that two vertices come nearer along m where each coordinate is off by up to `room`.
double nearer_by(const Vec3& m, double room) { return room > 0 ? 2 * (1 + 1e-14) * m.cwiseAbs().sum() * room : 0; }

template <std::size_t Count>
double reach_of(const std::array<Vec3, Count>& points) {
  double reach = 0;
  for (const Vec3& p : points) reach = std::max(reach, p.cwiseAbs().sum());
  return reach;
}

template <int Count>
double reach_of(const MovingPoints<Count>& p) {
  return std::max(reach_of(p.start), reach_of(p.end));
}

struct Range {
  double lo, hi;
};

template <std::size_t Count>
Range range_of(const Vec3& m, const std::array<Vec3, Count>& points, std::size_t begin, std::size_t end) {
  Range range{m.dot(points[begin]), 0};
  range.hi = range.lo;
  for (std::size_t i = begin + 1; i < end; ++i) {
    const double at = m.dot(points[i]);
    range.lo = std::min(range.lo, at);
    range.hi = std::max(range.hi, at);
  }
  return range;
}

// Which of the two is lower by more than the slack; 0 if neither is known to be.
int order(const Range& a, const Range& b, double slack) {
  return b.lo - a.hi > slack ? 1 : a.lo - b.hi > slack ? -1 : 0;
}

bool separates(const Vec3& m, const MovingPoints<3>& a, const MovingPoints<3>& b, double reach, double room) {
  const double slack = slack_of(m, reach) + nearer_by(m, room);
  const int before = order(range_of(m, a.start, 0, 3), range_of(m, b.start, 0, 3), slack);
  return before != 0 && before == order(range_of(m, a.end, 0, 3), range_of(m, b.end, 0, 3), slack);
}

// Does the direction m separate the points [0, split) from [split, 4) all the time?
bool separates(const Vec3& m, const MovingPoints<4>& p, int split, double reach) {
  const double slack = slack_of(m, reach);
  const int before = order(range_of(m, p.start, 0, split), range_of(m, p.start, split, 4), slack);
  return before != 0 && before == order(range_of(m, p.end, 0, split), range_of(m, p.end, split, 4), slack);
}

Vec3 across(const Vec3& edge, const Vec3& to) {
  const double length2 = edge.squaredNorm();
  return length2 > 0 ? Vec3(to - edge * (edge.dot(to) / length2)) : to;
}

// Tries the normal of the face, and the directions from its edges and corners to the vertex, at the middle of the
// interval. The direction between the closest points is one of these.
bool some_direction_separates_face(const MovingPoints<4>& p, double reach) {
  const std::array<Vec3, 4> x{p.middle(0), p.middle(1), p.middle(2), p.middle(3)};
  if (separates((x[2] - x[1]).cross(x[3] - x[1]), p, 1, reach)) return true;
  for (int k = 0; k < 3; ++k) {
    const Vec3 &from = x[1 + k], edge = x[1 + (k + 1) % 3] - from;
    if (separates(across(edge, x[0] - from), p, 1, reach) || separates(x[0] - from, p, 1, reach)) return true;
  }
  return false;
}

// Tries the normal of both edges, and the directions from an end to the other edge or its ends.
bool some_direction_separates_edges(const MovingPoints<4>& p, double reach) {
  const std::array<Vec3, 4> x{p.middle(0), p.middle(1), p.middle(2), p.middle(3)};
  const Vec3 a = x[1] - x[0], b = x[3] - x[2];
  if (separates(a.cross(b), p, 2, reach)) return true;
  for (int k = 0; k < 2; ++k)
    if (separates(across(a, x[2 + k] - x[0]), p, 2, reach) || separates(across(b, x[k] - x[2]), p, 2, reach))
      return true;
  for (int i = 0; i < 2; ++i)
    for (int j = 2; j < 4; ++j)
      if (separates(x[j] - x[i], p, 2, reach)) return true;
  return false;
}

std::array<MovingPoints<4>, 2> halves(const MovingPoints<4>& p) {
  std::array<MovingPoints<4>, 2> parts;
  for (int i = 0; i < 4; ++i) {
    parts[0].start[i] = p.start[i];
    parts[1].end[i] = p.end[i];
    parts[0].end[i] = parts[1].start[i] = p.middle(i);
  }
  return parts;
}

// The first part of the motion after so many halvings of the time.
MovingPoints<4> beginning_of(const MovingPoints<4>& whole, int halvings) {
  MovingPoints<4> first = whole;
  for (int k = 0; k < halvings; ++k)
    for (int i = 0; i < 4; ++i) first.end[i] = first.middle(i);
  return first;
}

// Depth first and early parts first. A pair that touches at the start is found at once.
template <class Separated>
Proof proof_for(const MovingPoints<4>& whole, int max_halvings, int most, Separated&& separated) {
  // Every halving rounds the coordinates once more, 2 u for both sides.
  const double reach = reach_of(whole) * (1 + 0.05 * max_halvings);
  if (separated(whole, reach)) return Proof::apart;
  if (!separated(beginning_of(whole, max_halvings), reach)) return Proof::meets;
  struct Part {
    MovingPoints<4> points;
    int halvings;
  };
  std::vector<Part> stack{{whole, 0}};
  for (int parts = 0; !stack.empty(); ++parts) {
    const Part part = stack.back();
    stack.pop_back();
    if (separated(part.points, reach)) continue;
    if (part.halvings == max_halvings) return Proof::meets;
    if (parts >= most) return Proof::open;
    const auto [early, late] = halves(part.points);
    stack.push_back({late, part.halvings + 1});
    stack.push_back({early, part.halvings + 1});
  }
  return Proof::apart;
}

bool is_edge_on(const Vec3& m, const MovingPoints<2>& a, const MovingPoints<2>& b, double reach, double room) {
  const double slack = slack_of(m, reach) + nearer_by(m, room);
  const auto below = [&](const std::array<Vec3, 2>& p) { return range_of(m, p, 0, 2).hi < -slack; };
  const auto above = [&](const std::array<Vec3, 2>& p) { return range_of(m, p, 0, 2).lo > slack; };
  return below(a.start) && above(b.start) && below(a.end) && above(b.end);
}

}  // namespace

bool stay_apart(const MovingPoints<3>& a, const MovingPoints<3>& b, double room) {
  const double reach = std::max(reach_of(a), reach_of(b));
  const std::array<Vec3, 3> p{a.middle(0), a.middle(1), a.middle(2)}, q{b.middle(0), b.middle(1), b.middle(2)};
  const Vec3 normal_a = (p[1] - p[0]).cross(p[2] - p[0]);
  if (separates(normal_a, a, b, reach, room)) return true;
  const Vec3 normal_b = (q[1] - q[0]).cross(q[2] - q[0]);
  if (separates(normal_b, a, b, reach, room)) return true;
  for (int k = 0; k < 3; ++k)
    if (separates((p[(k + 1) % 3] - p[k]).cross(normal_a), a, b, reach, room) ||
        separates((q[(k + 1) % 3] - q[k]).cross(normal_b), a, b, reach, room))
      return true;
  return false;
}

bool stay_apart_beside(const MovingPoints<2>& a, const MovingPoints<2>& b, double room) {
  const double reach = std::max(reach_of(a), reach_of(b));
  const Vec3 toward_a = a.middle(0) + a.middle(1), toward_b = b.middle(0) + b.middle(1);
  if (is_edge_on(toward_b - toward_a, a, b, reach, room)) return true;
  const double length_a = toward_a.norm(), length_b = toward_b.norm();
  return is_edge_on(toward_b * length_a - toward_a * length_b, a, b, reach, room);
}

// Along a perpendicular of the edge, a is in front of s and t, and b behind them. Tilted along the edge the direction
// separates s and t too: one way for the edges s a and t b, the other way for t a and s b.
bool stay_apart_at_edge(const MovingPoints<4>& p) {
  const double reach = reach_of(p);
  const Vec3 edge = p.middle(1) - p.middle(0), from = p.middle(2), to = p.middle(3);
  const Vec3 perpendicular = across(edge, to - from);
  const Vec3 lean = 0.25 * (perpendicular.norm() / edge.norm()) * edge;
  const auto in_order = [&](const Vec3& m, int first, int second) {
    const double slack = slack_of(m, reach);
    const auto ordered = [&](const std::array<Vec3, 4>& x) {
      const double begin = m.dot(x[first]), end = m.dot(x[second]);
      return begin - m.dot(x[2]) > slack && end - begin > slack && m.dot(x[3]) - end > slack;
    };
    return ordered(p.start) && ordered(p.end);
  };
  return in_order(perpendicular + lean, 0, 1) && in_order(perpendicular - lean, 1, 0);
}

Proof proof_for_vertex_and_face(const MovingPoints<4>& p, int max_halvings, int parts) {
  return proof_for(p, max_halvings, parts, some_direction_separates_face);
}

Proof proof_for_edges(const MovingPoints<4>& p, int max_halvings, int parts) {
  return proof_for(p, max_halvings, parts, some_direction_separates_edges);
}

}  // namespace selvedge
