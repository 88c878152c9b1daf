#pragma once

#include <span>
#include <utility>
#include <vector>

#include "collision/audit/moving_body.hpp"

namespace selvedge {

// Where a motion ended, and which triangles have boxes within `reach` of each other there: the search for pairs of the
// motion serves the state at its end, rounded to float, too.
struct MotionEnd {
  std::vector<Points> x;                                    // cloth, then obstacles; empty: none is known
  double reach = 0;                                         // [m]
  bool self = true;                                         // pairs of the cloth with itself were looked for
  std::vector<std::pair<int, int>> self_pairs, body_pairs;  // as in AuditMemory
};

// Four times what rounding to float moves a coordinate by, at most, at the end of these motions [m].
double reach_of_rounding(const MovingBody& cloth, std::span<const MovingBody> bodies);

// Are all coordinates within the reach of where the motion ended? Then other triangles than those listed are apart.
bool is_at_end(const MotionEnd&, const MovingBody& cloth, std::span<const MovingBody> bodies, bool self);

// What the audit remembers of a scene, so that what rests need not be proven again: which pairs of triangles were near
// each other at some reference positions, and how far apart they were proven to be. A displacement budget of the
// audit's own: two triangles stay apart while the largest displacements of their vertices from there sum to less than
// their gap, on any path. A cache: an audit has the same result with it or without, and with any of its states.
struct AuditMemory {
  struct Pair {
    int a, b;        // triangles of the cloth; or of the cloth, and of obstacles, numbered on end
    double gap = 0;  // [m], a lower bound in exact arithmetic; 0: none is known
    int shared = 0;  // vertices
  };
  std::vector<Points> reference;  // cloth, then obstacles; empty: nothing is remembered
  std::vector<Points> last;       // where the last audit was
  bool moving = false;            // it was of a motion
  bool slow = false;              // and there was little of that
  double reach = 0;               // pairs farther apart than this are not listed [m]
  std::vector<Pair> self_pairs, body_pairs;
  MotionEnd end;    // of the last motion that was looked at as a whole
  int inside = -1;  // cloth vertices inside obstacles at the reference; -1: not known
};

// Pairs that an audit has to look at: all others are apart the whole way.
struct AuditQuestions {
  bool all = true;  // nothing is known
  std::vector<AuditMemory::Pair> self_pairs, body_pairs;
};

// For the straight motion of the cloth and the bodies, or for a state, where both ends are the same. Remembers anew
// where the last reference is too far away, if little has moved since the last audit. One memory serves one scene, with
// one value of `self` (the cloth's pairs with itself).
AuditQuestions open_questions(AuditMemory&, const MovingBody& cloth, std::span<const MovingBody> bodies, bool self);

}  // namespace selvedge
