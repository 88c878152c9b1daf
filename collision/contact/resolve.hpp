#pragma once

#include "collision/contact/path_pairs.hpp"
#include "collision/contact/response.hpp"

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
};

struct ResolveReport {
  bool clean = false;  // the last test of all pairs found no impact
  int impulses = 0, zones = 0;
  int shortened = 0;                              // zones whose motion was shortened, once a halving
  int held = 0;                                   // cloth vertices in them
  double broad_phase = 0, ccd = 0, response = 0;  // [s]
};

// Every impact of the straight motion x0 -> x1 in which something can move, sorted by pair.
std::vector<Impact> find_impacts(PairSearch&, const Eigen::VectorXd& inverse_mass, const ResolveOptions&,
                                 const Points& x0, const Points& x1, PathPairs&, ResolveReport& times);

// Bridson, Fedkiw and Anderson 2002 on one screen: impulses, then inelastic impact zones. Where a zone does not
// converge, as a last resort, obstacles that pinch it give way, and if that does not do, its motion is shortened toward
// the start of the step, which is clean. On return the straight motion x0 -> x1 is free of contact as tested by CCD
// (report.clean), and that path is the path taken. `path` may come from find_impacts with the same x0; it leaves with
// every pair that is within the thickness at the new x1.
ResolveReport resolve(PairSearch&, const ContactWorld&, const Eigen::VectorXd& inverse_mass, const ResolveOptions&,
                      const Points& x0, Points& x1, PathPairs& path);

}  // namespace selvedge
