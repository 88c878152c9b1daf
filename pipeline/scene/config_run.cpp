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
              "how far apart pairs may be that are kept from passing each other; the thickness at least"),
       number("push_softness", &O::push_softness, Unit::none, positive, "over which a push sets in, in thicknesses")});
  return table;
}

const Options<LearnedRun>& learned_options() {
  using O = LearnedRun;
  static const Options<O> table(
      "learned", "A network makes the frames, at 30 a second. What passes through on the way stays and is reported.",
      {path("weights", &O::weights, "weight file (`selvedge weights import`); seen from the scene file"),
       flag("settle", &O::settle,
            "the first frame begins with a pass in which the cloth falls to rest, as ContourCraft's training does; "
            "HOOD always has one"),
       choice(
           "device", &O::device, network_devices(),
           "what computes the network. `cpu`: the program's kernels; `libtorch`: libtorch on the CPU (`make torch`); "
           "`cuda`: libtorch on a GPU; `auto`: `cuda` where there is one, else `cpu`")});
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
              "energy that this sweep would gain, in the cloth's weight times its mean edge"),
       integer("patch_size", &O::patch_size, at_least_one, "vertices of a patch, about"),
       number("still", &O::still, Unit::length, positive, "RMS motion in a step that counts as none"),
       number("slight", &O::slight, Unit::acceleration, not_negative,
              "mean acceleration that nothing has to explain")});
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
       integer("admitted_to_halve", &O::admitted_to_halve, at_least_one,
               "proposals admitted in a row that halve the next stretch without one"),
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
       number("alpha", &O::alpha, Unit::none, {.low = 0, .high = 1000},
              "how far, in multiples of the depth; what is still inside then is projected"),
       path("weights", &O::weights,
            "scales by what neighbours know instead (configs/weights/refu.h5); seen from the scene file"),
       integer("edge_pass", &O::edge_pass, not_negative, "rounds that lift edges which still cross the body"),
       number("order", &O::order, Unit::length, not_negative,
              "height over the body up to which cloth goes along with what is pushed out under it, so that layers keep "
              "their order; 0: none does")});
  return table;
}

const Options<RestingOptions>& resting_options() {
  using O = RestingOptions;
  static const Options<O> table(
      "resting", "A cloth rests if it hardly moves for a while.",
      {number("still_edges", &O::still_edges, Unit::none, not_negative, "largest motion of a vertex, in mean edges"),
       number("still_seconds", &O::still_seconds, Unit::time, positive, "how long no vertex moves by more")});
  return table;
}

const Options<RecoveryOptions>& recovery_options() {
  using O = RecoveryOptions;
  static const Options<O> table(
      "recovery", "A step that starts tangled first untangles the cloth, or puts it on again.",
      {integer("untangling_passes", &O::untangling_passes, at_least_one, "most of a step; the next one goes on"),
       number("speed", &O::speed, Unit::speed, positive, "largest of a tangled vertex"),
       integer("hopeless_pairs", &O::hopeless_pairs, at_least_one,
               "crossing pairs a triangle, beyond which the cloth's own stiffness has to open it"),
       integer("max_pair_passes", &O::max_pair_passes, at_least_one, "most crossing pairs times passes of a step"),
       number("useful_motions", &O::useful_motions, Unit::none, positive,
              "displacements longer than this many times what a step can move are not looked for"),
       integer("min_passes", &O::min_passes, at_least_one, "fewest passes, however short the step"),
       integer("waiting_passes", &O::waiting_passes, at_least_one, "passes at a body that crosses itself"),
       integer("max_halvings", &O::max_halvings, not_negative,
               "most halvings of a motion that makes cloth cross itself in more pairs"),
       number("negligible_move", &O::negligible_move, Unit::none, not_negative,
              "a displacement that counts as none, in mean edges"),
       number("farthest_place", &O::farthest_place, Unit::length, not_negative,
              "how far from where it is a vertex may be put on"),
       integer("placing_passes", &O::placing_passes, at_least_one, "most passes where cloth is put on"),
       integer("max_placing_pair_passes", &O::max_placing_pair_passes, at_least_one,
               "most crossing pairs times passes there"),
       number("pierced_part", &O::pierced_part, Unit::none, not_negative,
              "part of a component that is tangled and astray, beyond which a limb has gone through it"),
       number("astray", &O::astray, Unit::none, not_negative, "from its skinned target, in mean edges"),
       number("sunken_part", &O::sunken_part, Unit::none, not_negative,
              "part of a component that is tangled, beyond which it has sunken into the body"),
       number("long_limb", &O::long_limb, Unit::none, positive,
              "how far a limb reaches beyond a contour, in the contour's radii"),
       number("carrying_speed", &O::carrying_speed, Unit::speed, positive,
              "largest at which cloth is drawn to its skinned target"),
       number("carrying_stiffness", &O::carrying_stiffness, Unit::none, positive,
              "how much stiffer than its inertia it is drawn where the body is free of itself"),
       number("crossing_stiffness", &O::crossing_stiffness, Unit::none, positive,
              "how much stiffer it is drawn where the body is not"),
       number("push_softness", &O::push_softness, Unit::none, positive,
              "over which what keeps parted cloth parted sets in, in thicknesses")});
  return table;
}

const OptionRows<ConventionalOptions>& substep_count_options() {
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

}  // namespace

const Options<RunOptions>& run_options() {
  using O = RunOptions;
  static const Options<O> table(
      "run", "",
      OptionRows<O>{integer("frames", &O::frames, at_least_one, "how many"),
                    number("fps", &O::fps, Unit::rate, positive, "frames a second"),
                    word("quality", &O::quality, quality_names(),
                         "values of other keys, which they override where they are given (docs/benchmarks.md)")} +
          inside(&O::conventional, substep_count_options()) +
          OptionRows<O>{
              word("stepper", &O::stepper, known_kinds().names(), "who makes the frames"),
              flag("rest", &O::rest, "cloths that rest, with nothing moving near them, are left out of the work"),
              section(&O::resting, resting_options(), "when a cloth rests"),
              section(&O::recovery, recovery_options(), "what a step does that starts tangled"),
              section(&O::icm, icm_options(), "of the stepper `icm`"),
              section(&O::learned, learned_options(), "of the stepper `learned`"),
              section(&O::hybrid, hybrid_options(), "of the stepper `hybrid`"),
              section(&O::refu, refu_options(), "a repulsive layer behind the stepper")});
  return table;
}

const Options<RunOptions>& output_options() {
  static const Options<RunOptions> table(
      "output", "", {path("folder", &RunOptions::output, "for the results; left out: chosen by the command")});
  return table;
}

}  // namespace selvedge
