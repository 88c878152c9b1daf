#pragma once

#include <array>
#include <compare>
#include <functional>
#include <span>
#include <vector>

#include "collision/audit/moving_body.hpp"

namespace selvedge {

// Two primitives that meet during a motion. Nodes v, f0, f1, f2 or a0, a1, b0, b1, numbered over all surfaces: first
// the cloth's, then each body's.
struct PassedPair {
  bool edges = false;
  std::array<int, 4> nodes;
  auto operator<=>(const PassedPair&) const = default;
};

struct MotionAudit {
  std::vector<PassedPair> passed;  // sorted
  // Pairs left undecided because the budget of proofs was spent; they count as passed.
  int given_up = 0;
  bool whole = true;  // false: it ended early; at least `given_up` pairs are not proven apart, and none is listed
  int nonfinite = 0;  // vertices with an undefined coordinate at either end (their triangles are left out)
  int passed_through() const { return static_cast<int>(passed.size()) + given_up; }
};

struct AuditMemory;

// True for pairs that the audit leaves out, by their nodes as in PassedPair. Empty: it leaves none out.
using LeftOut = std::function<bool(const std::array<int, 4>&)>;

// Independent proof that a motion is clean. Lists vertex-face and edge-edge pairs without a common vertex that are not
// proven to stay apart while all vertices move straight: of the cloth with itself (where `self`), and with the bodies.
// Shares no code with the solver's tree, distances or continuous detection.
//
// A pair is apart over an interval of time if one fixed direction separates it at both ends: along a fixed direction
// every gap of two nodes is linear in time. Where none of the closest features' directions does, the interval is
// halved. A pair not proven apart after 30 halvings, or in 4,096 parts, counts as passed. So a pair that meets is
// always found, and one that is found came within about its motion times 2^-30, or the rounding of its size. Where very
// many pairs are hard to prove (many coincident vertices, say), the budget of proof_budget.hpp ends the audit: the
// result says so and is never clean. `memory` only saves time. Throws TooManyPairs as the audit of a state does.
MotionAudit audit_motion(const Surface& cloth, const Points& x0, const Points& x1, std::span<const MovingBody> bodies,
                         bool self = true, AuditMemory* memory = nullptr, const LeftOut& left_out = {});

}  // namespace selvedge
