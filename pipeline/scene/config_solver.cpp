#include "pipeline/scene/config_scene.hpp"

// What a scene file says of the solver.
namespace selvedge {
namespace {

using namespace table;

const Options<NewtonOptions>& newton_options() {
  using O = NewtonOptions;
  static const Options<O> table(
      "newton", "When Newton's method takes longer steps, the exact Hessian or more iterations than usual.",
      {integer("exact_from", &O::exact_from, not_negative,
               "Number of iterations with a filtered Hessian before the exact one is tried.")},
      {}, {},
      constants("physics/solve/implicit_euler.hpp", {{"nearly_linear", O::nearly_linear},
                                                     {"longest_step", O::longest_step},
                                                     {"stiff", O::stiff},
                                                     {"stiff_allowance", O::stiff_allowance},
                                                     {"far_energy", O::far_energy},
                                                     {"more_iterations", O::more_iterations}}));
  return table;
}

const Options<ContactTermOptions>& contact_term_options() {
  using O = ContactTermOptions;
  static const Options<O> table(
      "contact_term", "Contact terms of the incremental potential.",
      {number("stiffness", &O::stiffness, Unit::none, positive,
              "Stiffness of a new contact, in masses of the pair over the time step squared."),
       number("overlap_removed", &O::overlap_removed, Unit::none, not_negative,
              "Fraction of an overlap that a substep removes, and of a gap by which a load may sink in a substep.")},
      {}, {},
      constants("physics/solve/contact_term_options.hpp", {{"onset", O::onset},
                                                           {"load_sink", O::load_sink},
                                                           {"impact_sink", O::impact_sink},
                                                           {"max_stiffening", O::max_stiffening},
                                                           {"same_side", O::same_side},
                                                           {"static_friction_sweeps", O::static_friction_sweeps}}));
  return table;
}

const Options<SubstepOptions>& substep_options() {
  using O = SubstepOptions;
  static const Options<O> table(
      "substep", "How a step is divided into substeps, and how a substep alternates solves with the contact response.",
      {number("longest", &O::longest, Unit::time, positive,
              "Longest substep that `auto` chooses, since implicit Euler damps longer ones visibly, and fast bodies "
              "leave contact too much to resolve in them."),
       number("first_tolerance", &O::first_tolerance, Unit::none, positive,
              "Factor on the tolerance of the first solve, which only finds impacts and normal forces."),
       number("friction_tolerance", &O::friction_tolerance, Unit::none, positive,
              "Factor on the tolerance from the third solve of a substep on, and of all solves with friction where "
              "touching cloth does not move. Cloth sticks only if it is small."),
       integer("max_passes", &O::max_passes, not_negative,
               "Largest number of solves of a substep after the first one. With 0 the response resolves all impacts."),
       number("normal_change", &O::normal_change, Unit::none, positive,
              "Relative change of the lagged normal forces above which a substep is solved again."),
       section(&O::contact, contact_term_options(), "Contact terms of the incremental potential.")},
      {}, {},
      constants("physics/steppers/substep_options.hpp", {{"max_motion", O::max_motion},
                                                         {"max_slide", O::max_slide},
                                                         {"deep_impact", O::deep_impact},
                                                         {"contact_iterations", O::contact_iterations},
                                                         {"pinched_passes", O::pinched_passes},
                                                         {"max_halvings", O::max_halvings},
                                                         {"halving_zone_rounds", O::halving_zone_rounds},
                                                         {"pinched_zone_rounds", O::pinched_zone_rounds},
                                                         {"tearing", O::max_energy_ratio},
                                                         {"kept_motion", O::part_to_impact}}));
  return table;
}

const Options<RoomOptions>& room_options() {
  using O = RoomOptions;
  static const Options<O> table(
      "room",
      "How obstacles yield before the solve where they would pinch cloth. A constraint here is a pair that must not "
      "come closer.",
      {integer("sweeps", &O::sweeps, at_least_one, "Number of projected Gauss-Seidel sweeps in a block."),
       integer("max_rounds", &O::max_rounds, at_least_one, "Largest number of rounds, each with a search for pairs.")},
      {}, {},
      constants("collision/contact/resolve_options.hpp", {{"obstacle_mass", O::obstacle_mass},
                                                          {"min_blocks", O::min_blocks},
                                                          {"max_blocks", O::max_blocks},
                                                          {"growing", O::growing},
                                                          {"steady", O::steady},
                                                          {"few", O::few},
                                                          {"steepest_lag", O::steepest_lag}}));
  return table;
}

const Options<ResolveOptions>& response_options() {
  using O = ResolveOptions;
  static const Options<O> table(
      "response",
      "Contact response to impacts during a step: impulses, impact zones and a last resort (Bridson et al. 2002).",
      {integer("impulse_rounds", &O::impulse_rounds, not_negative,
               "Largest number of rounds of single impulses before impact zones."),
       integer("zone_rounds", &O::zone_rounds, at_least_one,
               "Largest number of rounds of impact zones before the last resort."),
       integer("zone_sweeps", &O::zone_sweeps, at_least_one,
               "Largest number of Gauss-Seidel sweeps over an impact zone in a round."),
       section(&O::room, room_options(), "How obstacles yield before the solve.")},
      {}, {},
      constants("collision/contact/resolve_options.hpp", {{"yield_rounds", O::yield_rounds},
                                                          {"yielding_mass", O::yielding_mass},
                                                          {"motion_halvings", O::motion_halvings}}));
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
      integer("max_newton", &O::max_newton, at_least_one,
              "Largest number of Newton iterations in a solve. Solves with contact take half as many, and a solve that "
              "is still far from its minimum takes more."),
      choice(
          "linear_solver", &O::linear_solver,
          {{"automatic", LinearSolver::automatic},
           {"cholmod", LinearSolver::cholmod},
           {"pcg", LinearSolver::pcg},
           {"multigrid", LinearSolver::multigrid}},
          "Linear solver. `automatic` takes `cholmod` for the smallest scenes, else `multigrid`. `pcg` (block Jacobi) "
          "is rough at the default `linear_tolerance`: cloth stretches in fast contact, and a sheet that slides down a "
          "slope lags by a fifth. With 1e-3 it does not lag."),
      number("linear_tolerance", &O::linear_tolerance, Unit::none,
             {.low = 0, .high = 1, .low_in = false, .high_in = false},
             "Relative residual at which PCG ends, in the norm of its preconditioner. It is lowered for stiff cloth."),
      integer("max_linear", &O::max_linear, at_least_one, "Largest number of PCG iterations."),
      number("slip_speed", &O::slip_speed, Unit::speed, positive, "Sliding speed below which friction is viscous."),
      integer("max_newton_step", &O::max_newton_step, at_least_one,
              "Largest number of Newton iterations in a whole step, over all its solves. Beyond it each solve takes "
              "one, and the report says `out_of_newton`: contact holds, but the solves are rough."),
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
                           "Time integrator. `bdf2` is second-order accurate with less damping, and implicit Euler for "
                           "vertices that begin to touch something; the stepper `icm` lacks it."),
                    choice("guess", &O::guess, {{"inertia", FirstGuess::inertia}, {"carried", FirstGuess::carried}},
                           "Where the first solve of a step begins. `inertia`: where velocities take the cloth. "
                           "`carried`: where it moves with its body, if the potential is lower there.")} +
          inside(&O::implicit_euler, implicit_euler_options()) +
          OptionRows<O>{section(&O::substep, substep_options(), "Substeps and the contact solve."),
                        section(&O::resolve, response_options(), "Contact response: impulses and impact zones.")});
  return table;
}

}  // namespace selvedge
