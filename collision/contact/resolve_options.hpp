#pragma once

#include "collision/geometry/stop_flag.hpp"

namespace selvedge {

struct ResolveOptions {
  double thickness = 2e-3;   // distance that resting layers keep [m]
  double separation = 2e-4;  // no pair that started farther apart comes closer [m]; the same part of their rest
                             // distance holds for pairs of one cloth that rest closer than the thickness
  double friction = 0.3, self_friction = 0.3;
  int impulse_rounds = 4;  // rounds of single impulses before zones
  int zone_rounds = 30;    // rounds of impact zones before the last resort
  int zone_sweeps = 200;
  bool rigid_zones = false;  // zones of free nodes go on as rigid bodies
  bool last_resort = true;   // false: leave what zones do not settle, and say that it is not clean
  int yield_rounds = 20;     // last resort, first part: obstacles give way
  StopFlag stop = {};        // asked once a zone and a round: true ends it, not clean
};

// What resolve did.
struct ResolveReport {
  bool clean = false;    // the last test of all pairs found no impact
  bool stopped = false;  // by the flag: x1 is junk
  int impulses = 0, zones = 0;
  int largest_zone = 0;                           // nodes of it that are free
  int found = 0;                                  // impacts of the motion as it was asked for
  int shortened = 0;                              // zones whose motion was shortened, once a halving
  int held = 0;                                   // cloth vertices in them
  double broad_phase = 0, ccd = 0, response = 0;  // [s]
};

}  // namespace selvedge
