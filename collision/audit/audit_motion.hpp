#pragma once

#include <array>
#include <compare>
#include <functional>
#include <span>
#include <vector>

#include "collision/audit/moving_body.hpp"

namespace selvedge {

// Two primitives that meet on their way. Nodes v, f0, f1, f2 or a0, a1, b0, b1; the cloth's come first in the
// numbering, then each body's, on end.
struct PassedPair {
  bool edges = false;
  std::array<int, 4> nodes;
  auto operator<=>(const PassedPair&) const = default;
};

struct MotionAudit {
  std::vector<PassedPair> passed;  // sorted
  // Pairs of which it is not known, for there are more to prove than an audit may; they count as passed.
  int given_up = 0;
  bool whole = true;  // false: it ended early. At least `given_up` are not proven apart, and none is listed.
  int nonfinite = 0;  // vertices with an undefined coordinate at either end (their triangles are left out)
  int passed_through() const { return static_cast<int>(passed.size()) + given_up; }
};

struct AuditMemory;

// Which pairs are not asked about, by their nodes as in PassedPair; empty: all are.
using LeftOut = std::function<bool(const std::array<int, 4>&)>;

// Independent proof that a motion is clean: vertex-face and edge-edge pairs that share no vertex, of the cloth with
// itself (where `self`) and with the bodies, that are not proven to stay apart while all vertices move straight. Shares
// no code with the solver's tree, distances or continuous detection.
//
// A pair is apart over an interval of time if one fixed direction separates it at both ends: along a fixed direction
// every gap of two nodes is linear in time. Where no direction among those of the closest features does, the interval
// is halved; what is not apart after `max_halvings`, or in 4,096 parts, counts as passed. So a pair that meets is
// always found, and one that is found came within about its motion times 2^-max_halvings, or the rounding of its size.
// Where very many are hard to prove, in a soup of coincident vertices say, the budget of proof_budget.hpp ends it: the
// result says so and is never clean. memory: saves time, and changes nothing else. Throws TooManyPairs as the audit of
// a state does.
MotionAudit audit_motion(const Surface& cloth, const Points& x0, const Points& x1, std::span<const MovingBody> bodies,
                         bool self = true, AuditMemory* memory = nullptr, const LeftOut& left_out = {},
                         int max_halvings = 30);

}  // namespace selvedge
