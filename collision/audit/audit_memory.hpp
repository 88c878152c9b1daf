#pragma once

#include <span>
#include <utility>
#include <vector>

#include "collision/audit/moving_body.hpp"

namespace selvedge {

// Where a motion ended, and which triangles were not proven to be apart there, with `reach` to spare in each
// coordinate; pairs that share an edge may be left out. So one search and its proofs serve the motion and the state at
// its end, rounded to float.
struct MotionEnd {
  std::vector<Points> x;                                    // cloth, then obstacles; empty: none is known
  double reach = 0;                                         // [m]
  bool self = true;                                         // pairs of the cloth with itself were looked for
  std::vector<std::pair<int, int>> self_pairs, body_pairs;  // as in AuditMemory
};

// Four times the most that rounding to float can move a coordinate at the end of these motions [m].
double reach_of_rounding(const MovingBody& cloth, std::span<const MovingBody> bodies);

// Is every coordinate within `reach` of where the motion ended? Then triangles that are not listed are apart.
bool is_at_end(const MotionEnd&, const MovingBody& cloth, std::span<const MovingBody> bodies, bool self);

// What the audit remembers of a scene, so that it need not prove pairs at rest again: which pairs of triangles were
// near each other at some reference positions, and how far apart they were proven to be. Two triangles stay apart, on
// any path, while the largest displacements of their vertices from the reference sum to less than their gap. This is a
// cache: the result of an audit is the same with it and without, in any of its states.
struct AuditMemory {
  struct Pair {
    int a, b;        // triangles of the cloth; in body_pairs b is one of obstacles, numbered over all
    double gap = 0;  // [m], a lower bound in exact arithmetic; 0: none is known
    int shared = 0;  // vertices
  };
  std::vector<Points> reference;  // cloth, then obstacles; empty: nothing is remembered
  std::vector<Points> last;       // where the last audit was
  bool moving = false;            // the last audit was of a motion
  bool slow = false;              // and the motion was small
  double reach = 0;               // pairs farther apart than this are not listed [m]
  std::vector<Pair> self_pairs, body_pairs;
  MotionEnd end;    // of the last motion that was looked at as a whole
  int inside = -1;  // cloth vertices inside obstacles at the reference; -1: not known
};

// Pairs that an audit has to look at: all others stay apart.
struct AuditQuestions {
  bool all = true;  // nothing is known
  std::vector<AuditMemory::Pair> self_pairs, body_pairs;
};

// The pairs to look at for the straight motion of cloth and bodies; for a state both ends are the same. Takes a new
// reference where the last one is too far away and little has moved since the last audit. One memory serves one scene,
// with one value of `self` (pairs of the cloth with itself).
AuditQuestions open_questions(AuditMemory&, const MovingBody& cloth, std::span<const MovingBody> bodies, bool self);

}  // namespace selvedge
