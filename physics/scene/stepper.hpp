#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "collision/audit/audit.hpp"
#include "collision/contact/exemption.hpp"
#include "collision/geometry/stop_flag.hpp"
#include "physics/scene/memory.hpp"

namespace selvedge {

// All that the next step depends on: a copy is a checkpoint.
struct State {
  double time = 0;  // [s]
  int frame = 0;
  Points x, v;                    // one row a vertex, cloth after cloth [m], [m/s]
  std::vector<Points> obstacles;  // where they are [m]; may lag behind Drive::obstacles
  bool pinched = false;           // obstacles lag: cloth left them no room in the step that ended here
  bool clean = false;             // known to be free of intersections, by the audit of the frame that ended here
  std::vector<int> cut_out;       // triangles that take no part in the simulation, ascending (cut_out.hpp)
  Memory memory;                  // each block is read by its owner alone
};

// The shape and pose of a body at the end of a step.
struct BodyFrame {
  Eigen::VectorXd shape;            // coefficients of its model
  Points rotations;                 // one row per joint: axis times angle [rad], relative to the parent
  Vec3 translation = Vec3::Zero();  // of the pose [m]
  Points joints;                    // where they are [m]
  bool apart = false;               // no triangles of its surface are known to intersect; false says nothing
  bool is_body() const { return joints.rows() > 0; }
};

// What the world imposes on a step, given at the step's END.
struct Drive {
  Points pins;                       // one row a Scene::pins entry [m]
  std::vector<Points> obstacles;     // wanted positions [m]
  Vec3 wind = Vec3::Zero();          // [m/s]
  Vec3 acceleration = Vec3::Zero();  // gravity [m/s2]
  Points skinned_targets;            // one row per vertex: where its body takes it without forces [m]; NaN where no
                                     // body wears it; empty if no cloth is dressed
  std::vector<BodyFrame> bodies;     // one per obstacle, without joints if it is no body; empty: there are no bodies
};

enum class StepStatus { not_run, accepted, rejected };
// Why a step was rejected.
enum class Reason { none, not_converged, not_finite, penetrating, energy_gain, overstretched, stopped, too_many_pairs };

// Doubts about an accepted step. More than one may be set.
struct Doubts {
  bool not_converged = false;  // solves ended farther from their minimum than tolerated
  bool penetrating = false;    // triangles cross, by the audit of the state
  bool energy_gain = false;    // the cloth gained energy without a source (energy_balance.hpp)
  bool any() const { return not_converged || penetrating || energy_gain; }
  bool operator==(const Doubts&) const = default;
};

struct PhaseTimes {  // [s]
  double solve = 0, broad_phase = 0, ccd = 0, response = 0, audit = 0;
  double graph = 0, network = 0;  // of a learned stepper
  double guard = 0;               // of a hybrid one
  double body = 0;                // of the drive, as far as the step waited for it
  double total() const { return solve + broad_phase + ccd + response + audit + graph + network + guard + body; }
  PhaseTimes& operator+=(const PhaseTimes&);
};

// Work done in counts, which do not depend on how busy the machine is. Work that caches save is not counted.
struct StepCounts {
  int solves = 0;               // minimisations of the incremental potential
  int coarse_builds = 0;        // of multigrid's coarse levels
  int searches = 0;             // for pairs that come near each other, partial ones included
  std::int64_t candidates = 0;  // pairs whose boxes those found to overlap
  int audits = 0;               // of a motion or of positions
  std::int64_t swept = 0;       // pairs whose paths were tested for a first contact
  std::int64_t projected = 0;   // vertices moved by impact zones, summed over projections
  StepCounts& operator+=(const StepCounts&);
};

struct CollisionReport {
  int contacts = 0;         // proximity pairs in the implicit solve, last substep
  int impulses = 0;         // impacts met with an impulse, all substeps
  int zones = 0;            // impact zones projected, all substeps
  int halved_substeps = 0;  // substeps done again in two halves because zones did not converge
  int shortened = 0;        // zones whose motion was shortened toward the last clean state, per halving
  int held_vertices = 0;    // cloth vertices in these zones, all substeps
  int passed_through = 0;   // pairs that met during the motion, by its audit; without those left alone
  int left_alone = 0;       // cloth vertices on or inside a contour at the start, after recovery
  int cut_out = 0;          // triangles that are cut out at the end; their pairs are not counted
  int pushed_out = 0;       // cloth vertices that the repulsive layer, or a network that settles, moved out of bodies
  int jumped = 0;           // obstacles moved to where they were wanted without a sweep, since it was too far
  double min_gap = std::numeric_limits<double>::infinity();  // of the contacts [m]
  double obstacle_lag = 0;  // largest distance of an obstacle vertex from where it was wanted [m]
  int pairs_before = 0,
      pairs_after = 0;      // intersecting triangle pairs by the audit; -1, or 0 in a step that did not look
  int pairs_wanted = 0;     // the same with obstacles where they were wanted
  double depth_wanted = 0;  // how deep a cloth vertex lies in a wanted closed obstacle [m]
};

// What a hybrid stepper did with another stepper's proposal (guard.hpp, hybrid_stepper.hpp).
enum class Verdict {
  none,           // the stepper is not a hybrid one
  admitted,       // the proposal became the step, as it was or corrected
  refined,        // a solve began at the proposal
  no_history,     // no proposal was asked for: the proposer lacks the frame before
  tangled,        // not asked for: the step starts tangled, or an obstacle lags or jumps
  waiting,        // not asked for: one was refused recently
  too_slow,       // not asked for: proposals take longer than they save
  not_made,       // the proposer rejected the step
  not_finite,     // the proposal was refused, as for all that follow
  moved_too_far,  // away from where the cloth's velocities take it
  overstretched,
  energy_gain,
  unbalanced,  // forces without a cause
  penetrating  // parts passed through each other, cross, or are inside a body
};

struct PartOfScene;    // part_of_scene.hpp
struct ContactForces;  // contact_forces.hpp

// Where a substep ended. Every node moved there along a straight line.
struct SubstepEnd {
  Points nodes;  // cloth, then obstacles (gather_nodes) [m]
  // What contact left alone in the substep. Absent: nothing if the frame's start is clean, else the pairs that cross at
  // the start of this substep.
  std::optional<Exemption> left_alone;
};

// The path of a step, for the audit of its motion.
struct StepPath {
  Points start;  // [m]
  std::vector<SubstepEnd> substeps;
  std::shared_ptr<const PartOfScene> part;  // the part of the scene that was stepped, with these nodes; null: all of it
};

// Each member except `path` and `contact_forces`, also of the structs inside, has a row in
// pipeline/reports/report_fields.cpp.
struct StepReport {  // starts as a failure
  StepStatus status = StepStatus::not_run;
  Reason reason = Reason::none;  // none unless the step is rejected
  Doubts doubts;                 // of an accepted step
  std::string by;                // the stepper that made the state
  bool fell_back = false;        // a proposal was refused, and another stepper took the step
  Verdict verdict = Verdict::none;
  int substeps = 0;
  int resting = 0;     // cloths that were left out because they rest (resting_stepper.hpp)
  int iterations = 0;  // Newton, all substeps
  int untangling = 0;  // passes before the step, of cloth that starts tangled
  // The budget of iterations or passes ran out: later solves are rough, or what is still tangled (left_alone) waits for
  // the next step.
  bool out_of_newton = false, out_of_untangling = false;
  bool out_of_response = false;  // the budget of the response ran out: later impacts shortened motion at once
  // The audit of the motion used up its budget: `passed_through` includes pairs that it gave up, or is a lower bound.
  bool out_of_proofs = false;
  int linear_iterations = 0;
  double residual = 0;  // largest force imbalance at the last substep's end [N]
  double unsolved = 0;  // bound of the RMS distance from exact minima, summed over substeps [m]
  PhaseTimes seconds;
  StepCounts counts;
  CollisionReport collision;
  // For each obstacle: the number of its triangles that contact leaves alone in some part of the step, since they cross
  // others of it or are next to such; empty: none.
  std::vector<int> switched_off;
  std::optional<Audit> audit;  // of the new state, rounded to float (frame_audits.hpp); absent: not audited
  StepPath path;               // kept until its audit (judge_frame)
  std::shared_ptr<const ContactForces> contact_forces;  // of each cloth vertex; null: not asked for, or not known
};

inline void reject(Reason reason, StepReport& report) {
  report.status = StepStatus::rejected;
  report.reason = reason;
}

struct AddedTerm;  // physics/solve/step_problem.hpp

// What one stepper may hand to another for a step, beside state and drive. Traits say whether a stepper honours it;
// `stop` and `proposal` are not covered by traits.
struct StepExtras {
  // A guess of the cloth at the end, n x 3 [m]. The implicit solve starts there unless its own guess is better.
  const Points* guess = nullptr;
  const Exemption* left_alone = nullptr;  // what contact leaves alone; null: nothing
  // Makes a further term of the potential, for a substep of h [s] from positions x0; empty: none.
  std::function<AddedTerm(const Points& x0, double h)> added = {};
  // Asked in each Newton iteration, untangling pass and impact zone. True: the step is rejected as `stopped`, and `to`
  // must not be used. A stepper without such loops hands it on, or ends soon.
  StopFlag stop = {};
  // The step is a proposal, of which the caller takes the positions alone and judges them: a stepper may leave out
  // doubts about it.
  bool proposal = false;
  bool any() const { return guess || left_alone || added; }  // those that traits cover
};

// What a scene must have for a stepper.
struct StepperNeeds {
  bool skinned_targets = false;  // Drive::skinned_targets
  bool bodies = false;           // Drive::bodies
  bool obstacles = false;        // at least one
};

struct StepperTraits {
  std::string name;
  int past_frames = 0;  // number of frames before `from` that it keeps in State::memory
  StepperNeeds needs = {};
  std::optional<double> only_dt = {};  // the only time step that it accepts [s]
  bool may_leave_out_cloths = true;    // a step of some cloths alone gives them the same motion
  bool honours_extras = false;
  bool reports_contact_forces = false;    // in steps that it solves
  int max_substeps = 1;                   // obstacles that move by more times their own size than this jump
  std::vector<std::string> ignores = {};  // forces that it does not model, by their names in plan_lines (features.hpp)
  bool accepts(double dt) const;          // [s]
};

// An accepted step leaves in `to`:
//   time, frame  from.time + dt and from.frame + 1;
//   x, v         finite, one row a vertex, pins at Drive::pins unless the report names motion that was shortened;
//   obstacles    where they ended, and pinched, whether one of them is not where the drive wanted it;
//   clean        false: judge_frame (physics/frame/frame_audits.hpp) decides after the step;
//   cut_out      what of from.cut_out is out still;
//   memory       what the stepper and its decorators may read in their next step, and nothing else.
// Its report has the path of the step. A stepper that has called judge_frame itself (the hybrid) leaves the audit of
// the state there in place of the path. finish_step (finish_step.hpp) does all this for positions and velocities.
class Stepper {
 public:
  virtual ~Stepper() = default;
  virtual const StepperTraits& traits() const = 0;
  // Steps by dt [s]. If rejected, `to` is junk and `from` is untouched: going back is doing nothing. Holds caches only:
  // a new stepper makes the same step. Never throws for numerical trouble (a search that meets more pairs than it may
  // look at is some: bounded_step.hpp); throws Error for a dt that it does not accept. Extras are ignored unless it
  // honours them.
  virtual StepReport step(const State& from, const Drive&, double dt, State& to, const StepExtras& = {}) = 0;
};

struct Scene;
using MakeStepper = std::function<std::unique_ptr<Stepper>(const Scene&)>;

}  // namespace selvedge
