#pragma once

#include <map>

#include "learned/losses/objective.hpp"
#include "physics/scene/scene.hpp"
#include "physics/scene/stepper.hpp"

namespace selvedge {

// The energies that HOOD minimises (hood_losses() with full weights), for a frame of any stepper [J].
struct HoodLosses {
  // By the names of the terms. `gravity` has the work of the wind, too, if there is wind.
  std::map<std::string, double> terms{{"stretching", 0}, {"bending", 0},  {"inertia", 0},
                                      {"gravity", 0},    {"friction", 0}, {"collision", 0}};
  double total = 0;
  double grad_norm = 0;  // mean over the vertices that are not pinned of |d total / d x_i| [N]
};

// The potential that measures a frame: always that of one frame of 1/30 s, whichever stepper made the frame in however
// many steps. It has HOOD's energies with the scene's materials as networks read them (vertex_material), gravity and
// wind of the drive, and the penalty of bodies closer than 2 mm, but no contact of cloth with cloth.
struct HoodJudge {
  LossGarment garment;
  Surface body;  // all obstacles
  std::vector<int> pins;
  LossOptions losses;
  LossSearch search;
};
HoodJudge make_hood_judge(const Scene&);

// A frame and the two before it. Each body: all obstacles one after the other, empty if there are none.
struct JudgedFrame {
  Points before, now, next;  // of the cloth [m]
  Points body_before, body_now, body_next;
  Points acceleration;  // by all forces without contact, one row per vertex [m/s2]
};

// The energies of `next` [J] and the norm of their gradient [N].
HoodLosses hood_losses_of(HoodJudge&, const JudgedFrame&);

// The excess of the frame's total over the minimum that is found when starting from it, and the mass-scaled residual:
// sqrt(sum |g_i|^2 / m_i) [N/sqrt(kg)].
struct Suboptimality {
  double excess = 0;    // E(x) - E(x*) [J]
  double residual = 0;  // at x
};
Suboptimality suboptimality_of(HoodJudge&, const JudgedFrame&);

}  // namespace selvedge
