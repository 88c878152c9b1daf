#pragma once

#include <array>

#include "collision/geometry/points.hpp"

namespace selvedge {

// For the audit of motion: points at the beginning and end of a straight motion, relative to one node of the pair, so
// that rounding depends on the size of the pair and not on its distance from the origin.
template <int Count>
struct MovingPoints {
  std::array<Vec3, Count> start, end;

  Vec3 middle(int i) const { return 0.5 * (start[i] + end[i]); }
};

// The functions that return bool are proofs: true only if the two sides stay apart from beginning to end in exact
// arithmetic, and also where each coordinate of a vertex is off by up to `room` [m]. False says nothing.

// Triangles without a common vertex: some direction of their faces separates them all the time.
bool stay_apart(const MovingPoints<3>& a, const MovingPoints<3>& b, double room = 0);

// Triangles s, a0, a1 and s, b0, b1 with the common vertex s as origin: they share no more than s at any time.
bool stay_apart_beside(const MovingPoints<2>& a, const MovingPoints<2>& b, double room = 0);

// Triangles s, t, a and s, t, b with the common edge p = s, t and then a, b: the vertex and the edges of one that the
// other does not share stay apart from it.
bool stay_apart_at_edge(const MovingPoints<4>& p);

// What is known of a moving pair. apart: it stays apart. meets: it comes so near that rounding, or the shortest part of
// time, cannot tell it from meeting. open: the allowed parts of time did not decide.
enum class Proof { apart, meets, open };

// Vertex p[0] and face p[1], p[2], p[3], or edges p[0] p[1] and p[2] p[3]; time is halved at most `max_halvings` times
// and cut into `parts`.
Proof proof_for_vertex_and_face(const MovingPoints<4>& p, int max_halvings, int parts);
Proof proof_for_edges(const MovingPoints<4>& p, int max_halvings, int parts);

}  // namespace selvedge
