#pragma once

#include <span>
#include <string>
#include <vector>

#include "collision/audit/audit.hpp"

namespace selvedge {

// A pair of triangles that intersects in one opinion only. In pairs with a body `second` is the body's triangle, bodies
// numbered on end.
struct Disagreement {
  int frame = 0;
  int first = 0, second = 0;
  bool with_body = false;
  bool ours = false;    // exact signs say that it intersects; FCL says the opposite
  double margin = 0;    // how far the triangles would have to be moved for the answer to change, at most [m]
  bool beyond = false;  // margin above 1e-9 of the size: there plain floating point must not err
};

// What FCL says of the frames of a check.
struct Opinion {
  std::vector<int> pairs_by_frame;  // self and bodies
  int frames_against_body = 0;      // frames in which the cloth is not collision-free against the bodies
  std::vector<Disagreement> disagreements;
  int beyond_rounding = 0;  // of them
};

// Adds FCL's opinion of one frame to that of the audit. Frames must be finite. Throws Error where the build has no FCL.
void add_opinion(const Surface& cloth, const Points& x, std::span<const AuditBody> bodies, const Audit& ours, int frame,
                 Opinion&);

// Whether FCL says the same of every pair of cloth and bodies, but for pairs within rounding. `ours`: the audit's
// pairs, sorted, bodies' triangles numbered on end. Throws Error where the build has no FCL.
bool agrees_on_bodies(const Surface& cloth, const Points& x, std::span<const AuditBody> bodies,
                      const std::vector<std::pair<int, int>>& ours);

// Widest gap along any direction in which two triangles can be told apart, negative where they intersect: the least
// depth along one [m].
double separation(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

std::string opinion_text(const Opinion&);

}  // namespace selvedge
