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
  bool pinched = false;           // they do: cloth left them no room in the step that ended here
  bool clean = false;             // known to be free of intersections, by the audit of the frame that ended here
  std::vector<int> cut_out;       // triangles that are out of the simulation, ascending (cut_out.hpp)
  Memory memory;                  // each block is read by its owner alone
};

// A body at the end of a step, as the scene has it.
struct BodyFrame {
  Eigen::VectorXd shape;            // coefficients of its model
  Points rotations;                 // one row a joint: axis times angle [rad], relative to the parent
  Vec3 translation = Vec3::Zero();  // of the pose [m]
  Points joints;                    // where they are [m]
  bool is_body() const { return joints.rows() > 0; }
};

// What the world imposes on a step, given at the step's END.
struct Drive {
  Points pins;                       // one row a Scene::pins entry [m]
  std::vector<Points> obstacles;     // wanted positions [m]
  Vec3 wind = Vec3::Zero();          // [m/s]
  Vec3 acceleration = Vec3::Zero();  // gravity [m/s2]
  Points worn;                       // one row a vertex: where the body that wears it takes it without forces, not a
                                     // number where none does; empty where nothing is worn
  std::vector<BodyFrame> bodies;     // one an obstacle, without joints where it is no body; empty: there is none
};

enum class StepStatus { not_run, accepted, rejected };
// Why a step was rejected.
enum class Reason { none, not_converged, not_finite, penetrating, energy_gain, overstretched, stopped, too_many_pairs };

// Doubts about an accepted step. More than one may be set.
struct Doubts {
  bool not_converged = false;  // solves ended farther from their minimum than is tolerated
  bool penetrating = false;    // triangles cross, by the audit of the state
  bool energy_gain = false;    // energy came from nowhere (energy_balance.hpp)
  bool any() const { return not_converged || penetrating || energy_gain; }
  bool operator==(const Doubts&) const = default;
};

struct PhaseTimes {  // [s]
  double solve = 0, broad_phase = 0, ccd = 0, response = 0, audit = 0;
  double graph = 0, network = 0;  // of a learned stepper
  double guard = 0;               // of a hybrid one
  double total() const { return solve + broad_phase + ccd + response + audit + graph + network + guard; }
  PhaseTimes& operator+=(const PhaseTimes&);
};

// Work done, counted: no clock and no other program on the machine changes it. What caches save is not in it.
struct StepCounts {
  int solves = 0;               // minimisations of the incremental potential
  int coarse_builds = 0;        // of multigrid's coarse levels
  int searches = 0;             // for pairs that come near each other, in part or whole
  std::int64_t candidates = 0;  // pairs whose boxes those found to overlap
  int audits = 0;               // of a motion or of positions
  std::int64_t swept = 0;       // pairs whose paths were tested for a first contact
  std::int64_t projected = 0;   // vertices that impact zones moved, once a projection
  StepCounts& operator+=(const StepCounts&);
};

struct CollisionReport {
  int contacts = 0;         // proximity pairs in the implicit solve, last substep
  int impulses = 0;         // impacts met with an impulse, all substeps
  int zones = 0;            // impact zones projected, all substeps
  int halved_substeps = 0;  // substeps done again in two halves because zones did not converge
  int shortened = 0;        // zones whose motion was shortened toward the last clean state, once a halving
  int held_vertices = 0;    // cloth vertices in them, all substeps
  int passed_through = 0;   // pairs that met on their way by the audit of the motion, those left alone not counted
  int left_alone = 0;       // cloth vertices on or inside a contour at the start, after recovery
  int cut_out = 0;          // triangles out of the simulation at the end: no pair is counted of them
  int pushed_out = 0;       // cloth vertices that the repulsive layer moved (refu_stepper.hpp)
  int jumped = 0;           // obstacles put where they were wanted without a sweep: too far for one
  double min_gap = std::numeric_limits<double>::infinity();  // of the contacts [m]
  double obstacle_lag = 0;  // largest distance of an obstacle vertex from where it was wanted [m]
  int pairs_before = 0,
      pairs_after = 0;      // intersecting triangle pairs by the audit; -1, or 0 in a step that did not look
  int pairs_wanted = 0;     // the same with obstacles where they were wanted
  double depth_wanted = 0;  // how deep a cloth vertex lies in a wanted closed obstacle [m]
};

// What a hybrid stepper has done with another stepper's proposal (guard.hpp, hybrid_stepper.hpp).
enum class Verdict {
  none,           // the stepper is no hybrid one
  admitted,       // the proposal is the step, as it was or after a correction
  refined,        // a solve began at it
  no_history,     // not asked for: the proposer has not seen the frame before
  tangled,        // not asked for: the step starts tangled, or where an obstacle lags or jumps
  waiting,        // not asked for: one was refused a short while ago
  too_slow,       // not asked for: it takes longer than it saves
  not_made,       // the proposer rejected the step
  not_finite,     // refused, and so are all that follow
  moved_too_far,  // from where the cloth's velocities take it
  overstretched,
  energy_gain,
  unbalanced,  // forces that nothing explains
  penetrating  // something passed through, crosses, or is inside a body
};

struct PartOfScene;  // part_of_scene.hpp

// Where a substep ended. Every node went there along a straight line.
struct SubstepEnd {
  Points nodes;  // cloth, then obstacles (gather_nodes) [m]
  // What contact left alone on the way. Absent: nothing if the frame's start is clean, else what crosses at the start
  // of this substep.
  std::optional<Exemption> left_alone;
};

// How a step went, for the audit of its motion.
struct StepPath {
  Points start;  // [m]
  std::vector<SubstepEnd> substeps;
  std::shared_ptr<const PartOfScene> part;  // of the scene that was stepped, whose nodes these are; null: all of it
};

// Each member of it and of its parts but `path` has a row in pipeline/reports/report_fields.cpp.
struct StepReport {  // starts as failure
  StepStatus status = StepStatus::not_run;
  Reason reason = Reason::none;  // none unless it is rejected
  Doubts doubts;                 // of an accepted one
  std::string by;                // who made the state
  bool fell_back = false;        // a proposal was refused, and another stepper took the step
  Verdict verdict = Verdict::none;
  int substeps = 0;
  int resting = 0;     // cloths that were left out because they rest (resting_stepper.hpp)
  int iterations = 0;  // Newton, all substeps
  int untangling = 0;  // passes before the step, of cloth that starts tangled
  // Its budget of them ran out: solves that came later are rough; what is tangled still (left_alone) waits for the
  // next.
  bool out_of_newton = false, out_of_untangling = false;
  bool out_of_response = false;  // impulses and impact zones used up theirs: later motion was shortened at once
  // The audit of the motion used up its budget: `passed_through` counts what it gave up, or says only that as many
  // passed at least.
  bool out_of_proofs = false;
  int linear_iterations = 0;
  double residual = 0;  // largest force imbalance at the last substep's end [N]
  double unsolved = 0;  // bound of the RMS distance from where exact solves would end, summed over substeps [m]
  PhaseTimes seconds;
  StepCounts counts;
  CollisionReport collision;
  // Of each obstacle: triangles that contact leaves alone somewhere in the step, for they cross others of it or are
  // next to such; empty: none of any.
  std::vector<int> switched_off;
  std::optional<Audit> audit;  // of the state that was made, rounded to float (frame_audits.hpp); absent: not audited
  StepPath path;               // of the step, until its audit (judge_frame)
};

struct AddedTerm;  // physics/solve/step_problem.hpp

// What another stepper may hand to a step beside the world. Traits say whether a stepper honours it, but for `stop`.
struct StepExtras {
  // Where the cloth may be at the end, n x 3 [m]. The implicit solve starts there where its own guess is worse.
  const Points* guess = nullptr;
  const Exemption* left_alone = nullptr;  // what contact leaves alone; null: nothing
  // A further term of the potential in a substep of h [s] from positions x0; empty: none.
  std::function<AddedTerm(const Points& x0, double h)> added = {};
  // Asked once a Newton iteration, untangling pass and impact zone; true: the step is rejected as `stopped`, and `to`
  // is junk. A stepper that has none of these hands it on, or is done soon.
  StopFlag stop = {};
  bool any() const { return guess || left_alone || added; }  // of what traits speak of
};

// What a scene must have.
struct StepperNeeds {
  bool worn = false;       // Drive::worn
  bool bodies = false;     // Drive::bodies
  bool obstacles = false;  // one at least
};

struct StepperTraits {
  std::string name;
  int past_frames = 0;  // before `from` that it remembers in State::memory
  StepperNeeds needs = {};
  std::optional<double> only_dt = {};  // the only time step that it takes [s]
  bool may_leave_out_cloths = true;    // a step of some of the cloths is what a step of all of them does with these
  bool honours_extras = false;
  int max_substeps = 1;  // obstacles that move by more than so many times their own size are put where they are wanted
  std::vector<std::string> ignores =
      {};                         // forces of a scene that it lacks, by their names in plan_lines (features.hpp)
  bool accepts(double dt) const;  // [s]
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
