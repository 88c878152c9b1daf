#include "pipeline/scene/config_scene.hpp"

// What a scene file says of the solver.
namespace selvedge {
namespace {

using namespace table;

const Options<NewtonOptions>& newton_options() {
  using O = NewtonOptions;
  static const Options<O> table(
      "newton", "When Newton goes beyond its usual step, Hessian and number of iterations.",
      {number("nearly_linear", &O::nearly_linear, Unit::none, positive,
              "change of the potential over its slope, beyond which a longer step is tried"),
       number("longest_step", &O::longest_step, Unit::none, positive, "in Newton steps"),
       integer("exact_from", &O::exact_from, not_negative, "iterations before the exact Hessian is tried"),
       number("stiff", &O::stiff, Unit::none, positive,
              "mean stiffness over inertia, beyond which cloth counts as stiff"),
       number("stiff_allowance", &O::stiff_allowance, Unit::none, positive,
              "how many goals long a motion may be that has the energy which stiff cloth can still gain"),
       number("far_energy", &O::far_energy, Unit::none, positive,
              "part of the potential that a step with contact may still gain at the end"),
       integer("more_iterations", &O::more_iterations, at_least_one, "most by these two rules, times max_newton")});
  return table;
}

const Options<ContactTermOptions>& contact_term_options() {
  using O = ContactTermOptions;
  static const Options<O> table(
      "contact_term", "How contact enters the incremental potential.",
      {number("stiffness", &O::stiffness, Unit::none, positive,
              "at first, in masses of the pair over the time step squared"),
       number("overlap_removed", &O::overlap_removed, Unit::none, not_negative, "part of an overlap, a step"),
       number("onset", &O::onset, Unit::none, positive, "over which the force sets in, in thicknesses"),
       number("load_sink", &O::load_sink, Unit::none, positive, "how far a load may press a term in, in thicknesses"),
       number("impact_sink", &O::impact_sink, Unit::none, not_negative,
              "how far an impact may sink, of the gap at which it is stopped"),
       number("max_stiffening", &O::max_stiffening, Unit::none, positive, "most that loads raise a stiffness, a step"),
       number("same_side", &O::same_side, Unit::none, not_negative,
              "cosine of old and new normal, beyond which a term is linearised anew"),
       integer("static_friction_sweeps", &O::static_friction_sweeps, not_negative, "of Gauss-Seidel over the pairs")});
  return table;
}

const Options<SubstepOptions>& substep_options() {
  using O = SubstepOptions;
  static const Options<O> table(
      "substep", "How a step is cut into substeps, and how a substep alternates solves with the response.",
      {number("max_motion", &O::max_motion, Unit::none, positive, "of a vertex in a substep, in mean edges"),
       number("max_slide", &O::max_slide, Unit::none, positive, "of a touching pair in a substep, in mean edges"),
       number("deep_impact", &O::deep_impact, Unit::none, positive,
              "depth, in mean edges, from which an impact becomes a term of the next solve"),
       number("longest", &O::longest, Unit::time, positive, "a longer step takes two substeps at least"),
       number("first_tolerance", &O::first_tolerance, Unit::none, positive,
              "of the first solve, which finds impacts and normal forces, over that of others"),
       number("friction_tolerance", &O::friction_tolerance, Unit::none, positive, "of solves with friction, likewise"),
       number("contact_iterations", &O::contact_iterations, Unit::none, positive,
              "of a solve with contact, in parts of max_newton"),
       integer("max_passes", &O::max_passes, at_least_one, "solves after the first one, at most,"),
       integer("pinched_passes", &O::pinched_passes, at_least_one, "and where there is no room"),
       number("normal_change", &O::normal_change, Unit::none, positive,
              "relative change of the lagged normal forces, beyond which the substep is solved again"),
       integer("max_halvings", &O::max_halvings, not_negative,
               "of a substep whose zones do not converge, before the last resort"),
       integer("halving_zone_rounds", &O::halving_zone_rounds, at_least_one,
               "of zones in a substep that may still be halved,"),
       integer("pinched_zone_rounds", &O::pinched_zone_rounds, at_least_one, "and where there is no room"),
       number("tearing", &O::tearing, Unit::none, positive,
              "how far a response may raise the potential, in the energy that there is"),
       number("kept_motion", &O::kept_motion, Unit::none, {.low = 0, .high = 1},
              "part of the motion to the first impact that cloth keeps which stops short"),
       section(&O::contact, contact_term_options(), "terms of the potential")});
  return table;
}

const Options<RoomOptions>& room_options() {
  using O = RoomOptions;
  static const Options<O> table(
      "room", "How obstacles that would close on cloth give way before the solve.",
      {number("obstacle_mass", &O::obstacle_mass, Unit::none, positive,
              "of a node that gives way, in mean cloth vertices"),
       integer("sweeps", &O::sweeps, at_least_one, "of a block of projected Gauss-Seidel"),
       integer("min_blocks", &O::min_blocks, at_least_one, "fewest"),
       integer("max_blocks", &O::max_blocks, at_least_one, "most"),
       number("growing", &O::growing, Unit::none, positive,
              "push of a multiplier a sweep, in separations, beyond which it grows"),
       number("steady", &O::steady, Unit::none, positive,
              "part of all growth in the next block, beyond which demands contradict each other"),
       integer("max_rounds", &O::max_rounds, at_least_one, "searches for pairs"),
       number("few", &O::few, Unit::none, not_negative, "new demands, of all, that the response sees to"),
       number("steepest_lag", &O::steepest_lag, Unit::none, positive,
              "largest change of lag over the distance between two nodes")});
  return table;
}

const Options<ResolveOptions>& response_options() {
  using O = ResolveOptions;
  static const Options<O> table(
      "response", "Bridson's response to what meets on the way.",
      {integer("impulse_rounds", &O::impulse_rounds, not_negative, "of single impulses before zones"),
       integer("zone_rounds", &O::zone_rounds, at_least_one, "of impact zones before the last resort"),
       integer("zone_sweeps", &O::zone_sweeps, at_least_one, "of Gauss-Seidel in a zone"),
       integer("yield_rounds", &O::yield_rounds, not_negative, "in which obstacles give way to zones"),
       number("yielding_mass", &O::yielding_mass, Unit::none, positive,
              "of their nodes at first, in mean cloth vertices; halved in each round"),
       integer("motion_halvings", &O::motion_halvings, not_negative, "of a zone's motion before it is held still"),
       section(&O::room, room_options(), "how obstacles give way before the solve")});
  return table;
}

const OptionRows<ImplicitEulerOptions>& implicit_euler_options() {
  using O = ImplicitEulerOptions;
  static const OptionRows<O> rows{
      number("velocity_tolerance", &O::velocity_tolerance, Unit::speed, positive,
             "Newton ends when the RMS of its displacement is below this times the time step,"),
      number("relative_tolerance", &O::relative_tolerance, Unit::none, not_negative,
             "or below this part of the RMS motion in the step"),
      integer("max_newton", &O::max_newton, at_least_one, "iterations a step"),
      choice("linear_solver", &O::linear_solver,
             {{"automatic", LinearSolver::automatic},
              {"cholmod", LinearSolver::cholmod},
              {"pcg", LinearSolver::pcg},
              {"multigrid", LinearSolver::multigrid}},
             "`automatic`: cholmod for the smallest scenes, otherwise multigrid"),
      number("linear_tolerance", &O::linear_tolerance, Unit::none,
             {.low = 0, .high = 1, .low_in = false, .high_in = false},
             "residual of PCG in a Newton iteration, relative, in its preconditioner's norm"),
      integer("max_linear", &O::max_linear, at_least_one, "PCG iterations"),
      number("slip_speed", &O::slip_speed, Unit::speed, positive, "below it friction is viscous"),
      integer("max_newton_step", &O::max_newton_step, at_least_one, "iterations of a whole step, over all its solves"),
      section(&O::newton, newton_options(), "when Newton goes beyond its usual step")};
  return rows;
}

}  // namespace

const Options<ConventionalOptions>& solver_options() {
  using O = ConventionalOptions;
  static const Options<O> table(
      "solver", "",
      OptionRows<O>{choice(
          "integrator", &O::integrator, {{"implicit_euler", Integrator::implicit_euler}, {"bdf2", Integrator::bdf2}},
          "`bdf2`: of second order in time where nothing touches, with less damping; implicit Euler elsewhere. "
          "Not of the stepper `icm`")} +
          inside(&O::implicit_euler, implicit_euler_options()) +
          OptionRows<O>{section(&O::substep, substep_options(), "how a step is cut, and how contact is solved"),
                        section(&O::resolve, response_options(), "Bridson's response")});
  return table;
}

}  // namespace selvedge
