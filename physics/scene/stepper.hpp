#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "collision/audit/audit.hpp"
#include "collision/geometry/points.hpp"

namespace selvedge {

// Where the last substep began, for an integrator of two steps that may go on from it.
struct StepHistory {
  double h = 0;  // its length [s]; 0: there is none
  Points x, v;
};

// How long each cloth has been where it is, and in which wind and under which gravity.
struct Rest {
  std::vector<double> seconds;  // one a cloth; empty: not known
  Points place;                 // about where, all cloths on end
  Vec3 wind = Vec3::Zero(), acceleration = Vec3::Zero();
};

// Where everything was when cloth that is tangled now was clean last.
struct LastClean {
  Points x;
  std::vector<Points> obstacles;
};

// Something that one stepper alone reads in its next step. A checkpoint writes it without knowing it. A step of another
// stepper ends without it.
struct MemoryBlock {
  std::string name;  // "stepper.quantity"
  Points rows;
};

// All that the next step depends on: a copy is a checkpoint.
struct State {
  double time = 0;  // [s]
  int frame = 0;
  Points x, v;                    // cloth, all cloths on end
  std::vector<Points> obstacles;  // where they are; may lag behind Drive::obstacles
  bool pinched = false;           // they do: cloth left them no room in the step that ended here
  bool clean = false;             // known to be free of intersections, by the audit of the step that ended here
  LastClean last_clean;           // of worn cloth that is not clean; empty: it is, or never was
  StepHistory history;
  Rest rest;
  std::vector<int> cut_out;  // triangles that are out of the simulation, ascending (cut_out.hpp)
  std::vector<MemoryBlock> memory;
};

// What the world imposes on a step, given at the step's END.
struct Drive {
  Points pins;                       // one row a Scene::pins entry
  std::vector<Points> obstacles;     // wanted positions
  Vec3 wind = Vec3::Zero();          // [m/s]
  Vec3 acceleration = Vec3::Zero();  // gravity [m/s2]
  Points worn;                       // one row a vertex: where the body that wears it takes it without forces, not a
                                     // number where none does; empty where nothing is worn
};

enum class StepStatus { not_run, accepted, rejected };
enum class Reason { none, not_converged, not_finite, penetrating, energy_gain, overstretched };

struct PhaseTimes {  // [s]
  double solve = 0, broad_phase = 0, ccd = 0, response = 0, audit = 0;
  double graph = 0, network = 0;  // of a learned stepper
  double total() const { return solve + broad_phase + ccd + response + audit + graph + network; }
};

struct CollisionReport {
  int contacts = 0;         // proximity pairs in the implicit solve, last substep
  int impulses = 0;         // impacts met with an impulse, all substeps
  int zones = 0;            // impact zones projected, all substeps
  int halved_substeps = 0;  // substeps done again in two halves because zones did not settle
  int shortened = 0;        // zones whose motion was shortened toward the last clean state, once a halving
  int held_vertices = 0;    // cloth vertices in them, all substeps
  int passed_through = 0;   // pairs that met on their way by the audit of the motion, those left alone not counted
  int left_alone = 0;       // cloth vertices on or inside a contour at the start, after recovery
  int cut_out = 0;          // triangles out of the simulation at the end: no pair is counted of them
  int pushed_out = 0;       // cloth vertices that the repulsive layer moved (refu_stepper.hpp)
  int jumped = 0;           // obstacles put where they were wanted without a sweep: too far for one
  double min_gap = std::numeric_limits<double>::infinity();  // of the contacts [m]
  double obstacle_lag = 0;                // largest distance of an obstacle vertex from where it was wanted [m]
  int pairs_before = 0, pairs_after = 0;  // intersecting triangle pairs by the audit; -1: not audited
  int pairs_wanted = 0;                   // the same with obstacles where they were wanted
  double depth_wanted = 0;                // how deep a cloth vertex lies in a wanted closed obstacle [m]
};

struct StepReport {  // starts as failure
  StepStatus status = StepStatus::not_run;
  Reason reason = Reason::none;
  std::string by;  // who made the state
  bool fell_back = false;
  int substeps = 0;
  int resting = 0;     // cloths that were left out because they rest (resting_stepper.hpp)
  int iterations = 0;  // Newton, all substeps
  int linear_iterations = 0;
  double residual = 0;  // largest force imbalance at the last substep's end [N]
  PhaseTimes seconds;
  CollisionReport collision;
  std::optional<Audit> audit;  // of the state that was made, rounded to float (step_audit.hpp); absent: not audited
};

struct StepperTraits {
  std::string name;
  std::optional<double> only_dt = {};  // the only time step that it takes [s]
  bool may_leave_out_cloths = true;    // a step of some of the cloths is what a step of all of them does with these
};

class Stepper {
 public:
  virtual ~Stepper() = default;
  virtual const StepperTraits& traits() const = 0;
  // Writes from.time + dt into `to`. If rejected, `to` is junk and `from` is untouched: going back is doing nothing.
  // Never throws for numerical trouble.
  virtual StepReport step(const State& from, const Drive&, double dt, State& to) = 0;
};

}  // namespace selvedge
