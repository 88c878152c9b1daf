#include "pipeline/scene/config_scene.hpp"
#include "pipeline/scene/quality.hpp"

// What a scene file says of the run.
namespace selvedge {
namespace {

using namespace table;

const Options<IcmOptions>& icm_options() {
  using O = IcmOptions;
  static const Options<O> table(
      "icm", "Contours minimised together with the cloth's energy, without continuous detection and without learning.",
      {integer("outer_iterations", &O::outer_iterations, at_least_one,
               "a substep: pairs found anew, then a minimisation"),
       number("contour_weight", &O::contour_weight, Unit::none, not_negative,
              "of the contours' squared segment lengths, in mean vertex masses over the time step squared"),
       choice("contour_gradient", &O::contour_gradient,
              {{"translational", ContourGradient::translational}, {"full", ContourGradient::full}},
              "`translational`: edges are moved, not shortened"),
       number("push_speed", &O::push_speed, Unit::speed, not_negative,
              "at which what contours enclose is asked back; 0: the contour energy alone"),
       number("reach", &O::reach, Unit::length, not_negative,
              "how far apart pairs may be that are kept from passing each other; the thickness at least")});
  return table;
}

const Options<LearnedRun>& learned_options() {
  using O = LearnedRun;
  static const Options<O> table(
      "learned", "A network makes the frames, at 30 a second. What passes through on the way stays and is reported.",
      {path("weights", &O::weights, "weight file (`selvedge weights import`); seen from the scene file"),
       flag("settle", &O::settle,
            "the first frame begins with a pass in which the cloth falls to rest, as ContourCraft's training does; "
            "HOOD always has one")});
  return table;
}

const Options<GuardOptions>& guard_options() {
  using O = GuardOptions;
  static const Options<O> table(
      "guard", "What a proposal may do (docs/hybrid.md).",
      {number("acceleration", &O::acceleration, Unit::acceleration, positive, "of a vertex in the step, at most"),
       number("mean_acceleration", &O::mean_acceleration, Unit::acceleration, positive, "RMS of all vertices; or"),
       number("change_of_motion", &O::change_of_motion, Unit::none, not_negative,
              "RMS change of the motion over the motion, whichever allows more"),
       number("stretch", &O::stretch, Unit::none, positive, "largest of a triangle; or"),
       number("stretch_growth", &O::stretch_growth, Unit::none, positive,
              "over the largest at the start, whichever allows more"),
       number("energy_growth", &O::energy_growth, Unit::none, not_negative,
              "of the elastic energy, in the cloth's weight times its mean edge"),
       number("patch_acceleration", &O::patch_acceleration, Unit::acceleration, positive,
              "RMS of the force on patches of the cloth that contact cannot explain, over their mass"),
       number("unexplained", &O::unexplained, Unit::none, positive,
              "the same over the mean acceleration, where the motion changes by more than `change_of_motion`"),
       number("imbalance", &O::imbalance, Unit::length, positive,
              "RMS of how far a Jacobi sweep of the potential would move vertices that nothing touches"),
       number("decrement", &O::decrement, Unit::none, positive,
              "energy that this sweep would gain, in the cloth's weight times its mean edge")});
  return table;
}

const Options<HybridOptions>& hybrid_options() {
  using O = HybridOptions;
  static const Options<O> table(
      "hybrid",
      "The network of `learned` proposes a step. A guard judges it, and where it refuses, the conventional stepper "
      "takes the step from the same state.",
      {choice("mode", &O::mode,
              {{"fallback", HybridMode::fallback},
               {"corrected", HybridMode::corrected},
               {"refined", HybridMode::refined},
               {"gated", HybridMode::gated},
               {"after_k", HybridMode::after_k}},
              "`fallback`: the proposal itself; `corrected`: its motion after the response to contact; `refined`: a "
              "conventional solve begins at it; `gated`: corrected, after a line search of the step's potential; "
              "`after_k`: gated, from where k Newton iterations come to"),
       or_word(integer("newton", &O::newton, at_least_one,
                       "k of `after_k`, or most iterations of a solve of `refined`; `auto`: 2, or max_newton"),
               "auto"),
       integer("gate_steps", &O::gate_steps, at_least_one, "places where `gated` asks the potential"),
       integer("longest_stretch", &O::longest_stretch, at_least_one,
               "frames without a proposal after several refusals: 1, 2, 4 .. of them"),
       flag("stop_when_slow", &O::stop_when_slow,
            "ask for no proposal where those have cost more time than they have saved; frames then depend on the "
            "clock"),
       number("extra_time", &O::extra_time, Unit::none, not_negative,
              "what proposals may cost then, of the time so far"),
       section(&O::guard, guard_options(), "when a proposal is admitted")});
  return table;
}

const Options<RefuRun>& refu_options() {
  using O = RefuRun;
  static const Options<O> table(
      "refu", "Vertices that a frame leaves inside a closed body are pushed out of it.",
      {flag("on", &O::on, "after every frame of whatever stepper"),
       number("alpha", &O::alpha, Unit::none, not_negative,
              "how far, in multiples of the depth; what is still inside then is projected"),
       path("weights", &O::weights,
            "scales by what neighbours know instead (configs/weights/refu.h5); seen from the scene file"),
       integer("edge_pass", &O::edge_pass, not_negative, "rounds that lift edges which still cross the body")});
  return table;
}

const OptionRows<ConventionalOptions>& substep_options() {
  using O = ConventionalOptions;
  static const OptionRows<O> rows{or_word(integer("substeps", &O::substeps, at_least_one,
                                                  "time steps a frame; `auto`: from the speed of what touches"),
                                          "auto"),
                                  or_word(integer("min_substeps", &O::min_substeps, at_least_one,
                                                  "fewest that `auto` takes; `auto`: 2 of a frame longer than 1/48 s"),
                                          "auto"),
                                  integer("max_substeps", &O::max_substeps, at_least_one, "most that `auto` takes")};
  return rows;
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
      number("slip_speed", &O::slip_speed, Unit::speed, positive, "below it friction is viscous")};
  return rows;
}

}  // namespace

const Options<RunOptions>& run_options() {
  using O = RunOptions;
  static const Options<O> table(
      "run", "",
      OptionRows<O>{integer("frames", &O::frames, at_least_one, "how many"),
                    number("fps", &O::fps, Unit::rate, positive, "frames a second"),
                    word("quality", &O::quality, quality_names(),
                         "values of other keys, which they override where they are given (docs/benchmarks.md)")} +
          inside(&O::conventional, substep_options()) +
          OptionRows<O>{
              word("stepper", &O::stepper, known_kinds().names(), "who makes the frames"),
              flag("rest", &O::rest, "cloths that rest, with nothing moving near them, are left out of the work"),
              section(&O::icm, icm_options(), "of the stepper `icm`"),
              section(&O::learned, learned_options(), "of the stepper `learned`"),
              section(&O::hybrid, hybrid_options(), "of the stepper `hybrid`"),
              section(&O::refu, refu_options(), "a repulsive layer behind the stepper")});
  return table;
}

const Options<ConventionalOptions>& solver_options() {
  using O = ConventionalOptions;
  static const Options<O> table(
      "solver", "",
      OptionRows<O>{choice(
          "integrator", &O::integrator, {{"implicit_euler", Integrator::implicit_euler}, {"bdf2", Integrator::bdf2}},
          "`bdf2`: of second order in time where nothing touches, with less damping; implicit Euler elsewhere. "
          "Not of the stepper `icm`")} +
          inside(&O::implicit_euler, implicit_euler_options()));
  return table;
}

const Options<RunOptions>& output_options() {
  static const Options<RunOptions> table(
      "output", "", {path("folder", &RunOptions::output, "for the results; left out: chosen by the command")});
  return table;
}

}  // namespace selvedge
