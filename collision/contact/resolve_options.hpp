#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "collision/geometry/stop_flag.hpp"

namespace selvedge {

// How obstacles that would close on cloth give way before the solve (room.hpp). Members are described where keys are
// bound to them: pipeline/scene/config_solver.cpp.
struct RoomOptions {
  int sweeps = 25, max_rounds = 6;

  // The mass of an obstacle's node that gives way, in mean masses of cloth vertices. More presses layers together.
  static constexpr double obstacle_mass = 30;
  // Projection takes at least and at most so many blocks.
  static constexpr int min_blocks = 3, max_blocks = 20;
  // A constraint's multiplier counts as growing if it pushes by more than this part of the separation in each sweep.
  static constexpr double growing = 1;
  // Constraints contradict each other if at least this part of all growth remains in the next block.
  static constexpr double steady = 0.98;
  // New constraints are left to `resolve` if they are fewer than this part of all.
  static constexpr double few = 0.01;
  // Lag changes by at most this much of the distance between two nodes of a body.
  static constexpr double steepest_lag = 0.5;
};

// Work of a response in counts, so that it does not depend on how fast or busy the machine is.
struct ResponseWork {
  std::int64_t swept = 0;      // pairs whose paths were tested for a first contact
  std::int64_t projected = 0;  // vertices moved by impact zones, summed over projections

  ResponseWork& operator+=(const ResponseWork& other) {
    swept += other.swept;
    projected += other.projected;
    return *this;
  }
  bool reaches(const ResponseWork& most) const { return swept >= most.swept || projected >= most.projected; }
};

constexpr ResponseWork unbounded_work{std::numeric_limits<std::int64_t>::max(),
                                      std::numeric_limits<std::int64_t>::max()};

// How impacts in a step are resolved. Members are described where keys are bound to them:
// pipeline/scene/config_solver.cpp.
struct ResolveOptions {
  double thickness = 2e-3;   // distance that resting layers keep [m]
  double separation = 2e-4;  // no pair that started farther apart comes closer [m]; the same fraction of the rest
                             // distance holds for pairs of one cloth that rest closer than the thickness
  double friction = 0.3, self_friction = 0.3;
  int impulse_rounds = 4, zone_rounds = 30, zone_sweeps = 200;
  bool rigid_zones = false;  // zones of free nodes move as rigid bodies
  bool last_resort = true;   // false: impacts that zones do not solve are left, and the report is not clean
  int holding_rounds = 8;    // once work is spent: rounds of holding zones before everything is held
  const std::vector<char>* only = nullptr;  // by node: pairs with a node that has 0 are left alone; null: all count
  RoomOptions room;
  ResponseWork budget = unbounded_work;  // once it is spent, the last resort holds still what still meets
  StopFlag stop = {};                    // asked for each zone and round: true ends resolve, not clean

  // The last resort lets obstacles give way in `yield_rounds` rounds. Their nodes have `yielding_mass` mean masses of
  // cloth vertices in the first round, and half as much in each that follows.
  static constexpr int yield_rounds = 20;
  static constexpr double yielding_mass = 1e3;
  // Then it halves a zone's motion this many times before it holds the zone still.
  static constexpr int motion_halvings = 4;
};

// What resolve did.
struct ResolveReport {
  bool clean = false;    // the last test of all pairs found no impact
  bool stopped = false;  // by the flag: x1 must not be used
  int impulses = 0, zones = 0;
  int largest_zone = 0;  // its number of free nodes
  int found = 0;         // impacts of the motion as it was asked for
  int shortened = 0;     // zones whose motion was shortened, counted for each halving
  int held = 0;          // cloth vertices in these zones
  ResponseWork work;
  bool out_of_work = false;                       // the budget was spent
  double broad_phase = 0, ccd = 0, response = 0;  // [s]
};

}  // namespace selvedge
