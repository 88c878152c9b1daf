#pragma once

#include <span>
#include <string>
#include <vector>

#include "collision/audit/audit.hpp"

namespace selvedge {

// A pair of triangles that only one of the two finds to intersect. In pairs with a body, `second` counts through the
// triangles of all bodies.
struct Disagreement {
  int frame = 0;
  int first = 0, second = 0;
  bool with_body = false;
  bool ours = false;    // exact signs find an intersection and FCL does not; false: the opposite
  double margin = 0;    // upper bound of the motion that changes the answer [m]
  bool beyond = false;  // margin above 1e-9 of the size, where floating point must not err
};

// FCL's results for the frames of a check.
struct Opinion {
  std::vector<int> pairs_by_frame;  // with itself and with bodies
  int frames_against_body = 0;      // frames in which FCL finds a pair with a body
  std::vector<Disagreement> disagreements;
  int beyond_rounding = 0;  // number of disagreements with `beyond`
};

// Adds FCL's result for one frame. Frames must be finite. Throws Error if the build has no FCL.
void add_opinion(const Surface& cloth, const Points& x, std::span<const AuditBody> bodies, const Audit& ours, int frame,
                 Opinion&);

// Whether FCL agrees on every pair of cloth and bodies, except for pairs within rounding. `ours` has the audit's pairs,
// sorted; bodies' triangles are numbered through all bodies. Throws Error if the build has no FCL.
bool agrees_on_bodies(const Surface& cloth, const Points& x, std::span<const AuditBody> bodies,
                      const std::vector<std::pair<int, int>>& ours);

// The widest gap of two triangles along any separating direction [m]. It is negative if they intersect, and then minus
// the least depth.
double separation(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

std::string opinion_text(const Opinion&);

}  // namespace selvedge
