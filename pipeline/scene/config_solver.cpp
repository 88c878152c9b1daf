#include "pipeline/scene/config_scene.hpp"

// What a scene file says of the solver.
namespace selvedge {
namespace {

using namespace table;

const Options<NewtonOptions>& newton_options() {
  using O = NewtonOptions;
  static const Options<O> table(
      "newton", "When Newton's method takes longer steps, the exact Hessian or more iterations than usual.",
      {number("nearly_linear", &O::nearly_linear, Unit::none, positive,
              "Ratio of the potential's change to its linear prediction above which a longer step is tried. A "
              "quadratic potential has 0.5."),
       number("longest_step", &O::longest_step, Unit::none, positive,
              "Longest step of the line search, in Newton steps."),
       integer("exact_from", &O::exact_from, not_negative,
               "Number of iterations with a filtered Hessian before the exact one is tried."),
       number("stiff", &O::stiff, Unit::none, positive,
              "Ratio of the mean stiffness to the mass over the time step squared above which cloth counts as stiff."),
       number("stiff_allowance", &O::stiff_allowance, Unit::none, positive,
              "Energy that the last step of stiff cloth may gain: that of a displacement of this many times the usual "
              "tolerance against inertia. A smaller value takes more iterations."),
       number("far_energy", &O::far_energy, Unit::none, positive,
              "With contact, Newton goes on while a step gains more than this fraction of the potential."),
       integer("more_iterations", &O::more_iterations, at_least_one,
               "Largest number of iterations by `stiff_allowance` and `far_energy`, in multiples of `max_newton`.")});
  return table;
}

const Options<ContactTermOptions>& contact_term_options() {
  using O = ContactTermOptions;
  static const Options<O> table(
      "contact_term", "Contact terms of the incremental potential.",
      {number("stiffness", &O::stiffness, Unit::none, positive,
              "Stiffness of a new contact, in masses of the pair over the time step squared."),
       number("overlap_removed", &O::overlap_removed, Unit::none, not_negative,
              "Fraction of an overlap by which a step lifts, and of the gap by which a load may sink in a step."),
       number("onset", &O::onset, Unit::none, positive,
              "Distance over which the force sets in, in contact thicknesses."),
       number(
           "load_sink", &O::load_sink, Unit::none, positive,
           "Depth to which a load may press a contact, in contact thicknesses. A smaller value makes contact stiffer."),
       number("impact_sink", &O::impact_sink, Unit::none, not_negative,
              "Depth to which a stopped impact may sink, as a fraction of the gap at which it is stopped."),
       number("max_stiffening", &O::max_stiffening, Unit::none, positive,
              "Largest factor by which loads raise the stiffness of a contact in a step."),
       number("same_side", &O::same_side, Unit::none, not_negative,
              "A contact is linearised anew only if the cosine between its old and new normals is larger."),
       integer("static_friction_sweeps", &O::static_friction_sweeps, not_negative,
               "Number of Gauss-Seidel sweeps over the pairs for static friction.")});
  return table;
}

const Options<SubstepOptions>& substep_options() {
  using O = SubstepOptions;
  static const Options<O> table(
      "substep", "How a step is divided into substeps, and how a substep alternates solves with the contact response.",
      {number("max_motion", &O::max_motion, Unit::none, positive,
              "Largest displacement in a substep of pairs that meet (with `icm`: of any vertex), in mean edge lengths. "
              "A smaller value takes more substeps."),
       number("max_slide", &O::max_slide, Unit::none, positive,
              "Largest slide of a touching pair in a substep, in mean edge lengths. Larger values may lock cloth that "
              "is pulled round a post."),
       number("deep_impact", &O::deep_impact, Unit::none, positive,
              "Depth from which an impact becomes a contact term of the next solve, in mean edge lengths."),
       number("longest", &O::longest, Unit::time, positive,
              "Longest step that may stay undivided. A longer one takes at least two substeps."),
       number("first_tolerance", &O::first_tolerance, Unit::none, positive,
              "Factor on the tolerance of the first solve, which finds impacts and normal forces."),
       number("friction_tolerance", &O::friction_tolerance, Unit::none, positive,
              "Factor on the tolerance of solves with friction. Sticking cloth needs a small value."),
       number("contact_iterations", &O::contact_iterations, Unit::none, positive,
              "Largest number of Newton iterations of a solve with contact, as a fraction of `max_newton`."),
       integer("max_passes", &O::max_passes, at_least_one,
               "Largest number of solves of a substep after the first one."),
       integer("pinched_passes", &O::pinched_passes, at_least_one,
               "Largest number of these solves where obstacles leave the cloth no room."),
       number("normal_change", &O::normal_change, Unit::none, positive,
              "Relative change of the lagged normal forces above which a substep is solved again."),
       integer("max_halvings", &O::max_halvings, not_negative,
               "How often a substep is halved whose impact zones do not converge, before the last resort."),
       integer("halving_zone_rounds", &O::halving_zone_rounds, at_least_one,
               "Number of rounds of impact zones in a substep that may still be halved."),
       integer("pinched_zone_rounds", &O::pinched_zone_rounds, at_least_one,
               "Number of rounds of impact zones where obstacles leave the cloth no room."),
       number("tearing", &O::tearing, Unit::none, positive,
              "Ratio of the potential after the contact response to the energy before it above which the response is "
              "refused."),
       number("kept_motion", &O::kept_motion, Unit::none, {.low = 0, .high = 1},
              "Fraction of the motion up to the first impact that is kept where the last resort is refused, too."),
       section(&O::contact, contact_term_options(), "Contact terms of the incremental potential.")});
  return table;
}

const Options<RoomOptions>& room_options() {
  using O = RoomOptions;
  static const Options<O> table(
      "room",
      "How obstacles yield before the solve where they would pinch cloth. A constraint here is a pair that must not "
      "come closer.",
      {number("obstacle_mass", &O::obstacle_mass, Unit::none, positive,
              "Mass of an obstacle node that yields, in mean masses of cloth vertices. A larger mass presses layers "
              "together more."),
       integer("sweeps", &O::sweeps, at_least_one, "Number of projected Gauss-Seidel sweeps in a block."),
       integer("min_blocks", &O::min_blocks, at_least_one, "Smallest number of blocks."),
       integer("max_blocks", &O::max_blocks, at_least_one, "Largest number of blocks."),
       number("growing", &O::growing, Unit::none, positive,
              "Push of a constraint in a sweep above which its multiplier counts as growing, in multiples of the "
              "minimum separation of pairs."),
       number("steady", &O::steady, Unit::none, positive,
              "Ratio of the growth of all multipliers in a block to that in the block before, above which constraints "
              "count as contradictory. Obstacles then yield."),
       integer("max_rounds", &O::max_rounds, at_least_one, "Largest number of searches for pairs."),
       number("few", &O::few, Unit::none, not_negative,
              "Fraction of new constraints in a search below which no further search is made. The contact response "
              "meets those."),
       number("steepest_lag", &O::steepest_lag, Unit::none, positive,
              "Largest difference in lag between two nodes of an obstacle, relative to their distance. It keeps a body "
              "from folding into itself.")});
  return table;
}

const Options<ResolveOptions>& response_options() {
  using O = ResolveOptions;
  static const Options<O> table(
      "response",
      "Contact response to impacts during a step: impulses, impact zones and a last resort (Bridson et al. 2002).",
      {integer("impulse_rounds", &O::impulse_rounds, not_negative, "Number of rounds of impulses before impact zones."),
       integer("zone_rounds", &O::zone_rounds, at_least_one,
               "Number of rounds of impact zones before the last resort."),
       integer("zone_sweeps", &O::zone_sweeps, at_least_one, "Number of Gauss-Seidel sweeps in an impact zone."),
       integer("yield_rounds", &O::yield_rounds, not_negative,
               "Number of rounds of the last resort in which obstacles yield to impact zones."),
       number("yielding_mass", &O::yielding_mass, Unit::none, positive,
              "Mass of an obstacle node in the first of these rounds, in mean masses of cloth vertices. Each round "
              "halves it."),
       integer("motion_halvings", &O::motion_halvings, not_negative,
               "How often the motion of an impact zone is halved before it is held still."),
       section(&O::room, room_options(), "How obstacles yield before the solve.")});
  return table;
}

const OptionRows<ImplicitEulerOptions>& implicit_euler_options() {
  using O = ImplicitEulerOptions;
  static const OptionRows<O> rows{
      number("velocity_tolerance", &O::velocity_tolerance, Unit::speed, positive,
             "Newton ends when the RMS displacement of its step is below this times the time step, or meets "
             "`relative_tolerance`."),
      number("relative_tolerance", &O::relative_tolerance, Unit::none, not_negative,
             "Newton also ends when the RMS displacement of its step is below this fraction of the RMS displacement in "
             "the time step."),
      integer("max_newton", &O::max_newton, at_least_one, "Largest number of Newton iterations in a solve."),
      choice("linear_solver", &O::linear_solver,
             {{"automatic", LinearSolver::automatic},
              {"cholmod", LinearSolver::cholmod},
              {"pcg", LinearSolver::pcg},
              {"multigrid", LinearSolver::multigrid}},
             "Linear solver. `automatic` takes `cholmod` for the smallest scenes, else `multigrid`."),
      number("linear_tolerance", &O::linear_tolerance, Unit::none,
             {.low = 0, .high = 1, .low_in = false, .high_in = false},
             "Relative residual at which PCG ends, in the norm of its preconditioner."),
      integer("max_linear", &O::max_linear, at_least_one, "Largest number of PCG iterations."),
      number("slip_speed", &O::slip_speed, Unit::speed, positive, "Sliding speed below which friction is viscous."),
      integer("max_newton_step", &O::max_newton_step, at_least_one,
              "Largest number of Newton iterations in a whole step, over all its solves."),
      section(&O::newton, newton_options(), "When Newton's method goes beyond its usual step.")};
  return rows;
}

}  // namespace

const Options<ConventionalOptions>& solver_options() {
  using O = ConventionalOptions;
  static const Options<O> table(
      "solver", "Time integration with Newton's method, and contact.",
      OptionRows<O>{choice("integrator", &O::integrator,
                           {{"implicit_euler", Integrator::implicit_euler}, {"bdf2", Integrator::bdf2}},
                           "Time integrator. `bdf2` is second-order accurate with less damping where nothing touches, "
                           "and implicit Euler elsewhere; the stepper `icm` lacks it.")} +
          inside(&O::implicit_euler, implicit_euler_options()) +
          OptionRows<O>{section(&O::substep, substep_options(), "Substeps and the contact solve."),
                        section(&O::resolve, response_options(), "Contact response: impulses and impact zones.")});
  return table;
}

}  // namespace selvedge
