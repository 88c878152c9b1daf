#include "pipeline/scene/config_scene.hpp"
#include "pipeline/scene/quality.hpp"

// What a scene file says of the run.
namespace selvedge {
namespace {

using namespace table;

const Options<IcmOptions>& icm_options() {
  using O = IcmOptions;
  static const Options<O> table(
      "icm",
      "Minimises intersection contours together with the cloth's energy, without continuous collision detection and "
      "without a network.",
      {integer("outer_iterations", &O::outer_iterations, at_least_one,
               "Outer iterations of a substep. Each finds contact pairs anew and then minimises."),
       number("contour_weight", &O::contour_weight, Unit::none, not_negative,
              "Weight of the sum of squared contour segment lengths, in mean vertex masses over the time step squared. "
              "A larger value shortens contours faster."),
       choice("contour_gradient", &O::contour_gradient,
              {{"translational", ContourGradient::translational}, {"full", ContourGradient::full}},
              "Gradient of the contour energy. `translational` moves edges and does not shorten them; `full` is the "
              "exact derivative."),
       number("push_speed", &O::push_speed, Unit::speed, not_negative,
              "Speed at which vertices that a contour encloses are pushed back. 0: the contour energy acts alone."),
       number("reach", &O::reach, Unit::length, not_negative,
              "Largest distance of pairs that are kept from passing each other. A value below the contact thickness "
              "counts as the thickness."),
       number("push_softness", &O::push_softness, Unit::none, positive,
              "Distance over which the push sets in, in contact thicknesses.")});
  return table;
}

const Options<LearnedRun>& learned_options() {
  using O = LearnedRun;
  static const Options<O> table(
      "learned", "A network makes the frames, at 30 a second. Penetrations are not removed; they are reported.",
      {path("weights", &O::weights,
            "Weights of the network, a file that `selvedge train` or `selvedge weights import` writes. Of the stepper "
            "`carried_fitted`: its coefficients, by `selvedge teach`. The path is relative to the scene file."),
       flag("settle", &O::settle,
            "True: the first frame begins with a pass of the network in which the cloth falls to rest, as in "
            "ContourCraft's training. HOOD always has this pass."),
       choice("device", &O::device, network_devices(),
              "What computes the network. `cpu`: the program's kernels. `libtorch`: libtorch on the CPU (`make "
              "torch`). `cuda`: libtorch on a GPU. `auto`: `cuda` where there is a GPU, else `cpu`."),
       choice("numbers", &O::numbers, network_numbers(),
              "Numbers that the device `cpu` multiplies. `int16`: integers of 16 bits with a scale for each row, on "
              "processors with AVX-512 VNNI. `auto`: those where the processor has them, else `float32`."),
       flag("step_lengths", &O::step_lengths,
            "Of a network whose output is added to the carried guess (`student`). True: the smooth and the rough part "
            "of the output are each followed as far as the incremental potential falls. False: the whole output is "
            "taken, as it always is before a rough solve (`run.hybrid.mode: rough`).")});
  return table;
}

const Options<GuardOptions>& guard_options() {
  using O = GuardOptions;
  static const Options<O> table(
      "guard",
      "Limits of a proposed step (docs/hybrid.md). A proposal that exceeds one is refused. Accelerations are relative "
      "to free flight without gravity.",
      {number("acceleration", &O::acceleration, Unit::acceleration, positive, "Largest acceleration of a vertex."),
       number("mean_acceleration", &O::mean_acceleration, Unit::acceleration, positive,
              "Largest RMS acceleration of all vertices. It may be exceeded where `change_of_motion` is met."),
       number("change_of_motion", &O::change_of_motion, Unit::none, not_negative,
              "Largest RMS change of the displacement in a step, relative to the RMS displacement. It may be exceeded "
              "where `mean_acceleration` is met."),
       number("stretch", &O::stretch, Unit::none, positive,
              "Largest principal stretch of a triangle, unless `stretch_growth` allows more."),
       number("stretch_growth", &O::stretch_growth, Unit::none, positive,
              "Ratio of the largest stretch after the step to that before it. It counts where it allows more than "
              "`stretch`."),
       number("energy_growth", &O::energy_growth, Unit::none, not_negative,
              "Largest growth of the elastic energy in the step, in units of the cloth's weight times its mean edge "
              "length."),
       number("patch_acceleration", &O::patch_acceleration, Unit::acceleration, positive,
              "Largest RMS residual acceleration of patches of vertices: the gradient of the step's potential on a "
              "patch over its mass. Patches in contact are left out."),
       number("unexplained", &O::unexplained, Unit::none, positive,
              "Largest ratio of the residual acceleration of patches to the RMS acceleration of all vertices. It is "
              "tested where `change_of_motion` is exceeded."),
       number("imbalance", &O::imbalance, Unit::length, positive,
              "Largest RMS displacement by one Jacobi sweep on the step's potential, of vertices without contact."),
       number("decrement", &O::decrement, Unit::none, positive,
              "Largest energy that the sweep of `imbalance` would gain, in units of the cloth's weight times its mean "
              "edge length."),
       integer("patch_size", &O::patch_size, at_least_one, "Approximate number of vertices in a patch."),
       number("still", &O::still, Unit::length, positive,
              "Lower bound of the RMS displacement that `change_of_motion` divides by. Slower cloth counts as still."),
       number("slight", &O::slight, Unit::acceleration, not_negative,
              "Residual acceleration of patches that `unexplained` always admits, and the largest of cloth that flies "
              "free.")});
  return table;
}

const Options<HybridOptions>& hybrid_options() {
  using O = HybridOptions;
  static const Options<O> table(
      "hybrid",
      "The network of `learned` proposes a step, and a guard judges it. Where the guard refuses, the conventional "
      "stepper takes the step from the same state.",
      {choice("mode", &O::mode,
              {{"fallback", HybridMode::fallback},
               {"corrected", HybridMode::corrected},
               {"response", HybridMode::response},
               {"rough", HybridMode::rough}},
              "How a proposal is used. `fallback`: as it is. `corrected`: after the contact response. `response`: "
              "after the contact response, judged by its motion, its stretch, the audits and the energy alone. "
              "`rough`: as the first guess of one rough solve, judged in the same way."),
       integer("admitted_to_halve", &O::admitted_to_halve, at_least_one,
               "Number of proposals that must be admitted in a row to halve the pause after the next refusal."),
       integer(
           "longest_stretch", &O::longest_stretch, at_least_one,
           "Longest pause after a refusal, in frames without a proposal. Each refusal doubles the pause: 1, 2, 4, ..."),
       flag("stop_when_slow", &O::stop_when_slow,
            "True: no proposals are made while they take more time than they save. Results then depend on the clock."),
       number(
           "extra_time", &O::extra_time, Unit::none, not_negative,
           "Share of the time so far that proposals may lose against the conventional stepper, with `stop_when_slow`."),
       section(&O::guard, guard_options(), "Limits of a proposed step.")});
  return table;
}

const Options<RefuRun>& refu_options() {
  using O = RefuRun;
  static const Options<O> table(
      "refu", "A repulsive layer (Tan et al. 2022) that pushes vertices out of closed bodies at the end of a frame.",
      {flag("on", &O::on, "True: the layer acts after every frame, behind any stepper."),
       number("alpha", &O::alpha, Unit::none, {.low = 0, .high = 1000},
              "Length of the push, in multiples of the penetration depth. Vertices that are still inside are then "
              "projected onto the surface."),
       path("weights", &O::weights,
            "Weights of a network that predicts `alpha` for each vertex (configs/weights/refu.h5). The path is "
            "relative to the scene file. Default: `alpha` is the same for all."),
       integer("edge_pass", &O::edge_pass, not_negative,
               "Number of rounds that move edges which still cross the body out of it."),
       number("order", &O::order, Unit::length, not_negative,
              "Height above the body below which cloth moves with vertices that are pushed out beneath it, so that "
              "layers keep their order. 0: it does not move with them.")});
  return table;
}

const Options<RestingOptions>& resting_options() {
  using O = RestingOptions;
  static const Options<O> table("resting", "When a cloth counts as resting.",
                                {number("still_edges", &O::still_edges, Unit::none, not_negative,
                                        "Largest displacement of a vertex of a resting cloth, in mean edge lengths."),
                                 number("still_seconds", &O::still_seconds, Unit::time, positive,
                                        "Time in which no vertex moves farther than `still_edges`.")});
  return table;
}

const Options<RecoveryOptions>& recovery_options() {
  using O = RecoveryOptions;
  static const Options<O> table(
      "recovery",
      "A step that starts tangled first untangles the cloth, or puts a garment on its body again. Its skinned target "
      "is where skinning alone would put it.",
      {integer("untangling_passes", &O::untangling_passes, at_least_one,
               "Largest number of untangling passes in a step. The next step goes on where they end."),
       number("speed", &O::speed, Unit::speed, positive, "Largest speed at which untangling moves a vertex."),
       number("farthest_place", &O::farthest_place, Unit::length, not_negative,
              "Largest distance that a vertex moves when a garment is put back on its body."),
       number("push_softness", &O::push_softness, Unit::none, positive,
              "Distance over which the force sets in that keeps untangled cloth apart, in contact thicknesses.")},
      {}, {},
      constants("physics/recovery/recovery_options.hpp", {{"hopeless_pairs", O::max_pairs_per_triangle},
                                                          {"max_pair_passes", O::max_pair_passes},
                                                          {"useful_motions", O::useful_motions},
                                                          {"min_passes", O::min_passes},
                                                          {"waiting_passes", O::trapped_passes},
                                                          {"max_halvings", O::max_halvings},
                                                          {"negligible_move", O::negligible_move},
                                                          {"placing_passes", O::placing_passes},
                                                          {"max_placing_pair_passes", O::max_placing_pair_passes},
                                                          {"pierced_part", O::pierced_part},
                                                          {"astray", O::pierced_distance},
                                                          {"sunken_part", O::sunken_part},
                                                          {"long_limb", O::long_limb},
                                                          {"carrying_speed", O::drawing_speed},
                                                          {"carrying_stiffness", O::drawing_stiffness},
                                                          {"crossing_stiffness", O::trapped_stiffness}}));
  return table;
}

const OptionRows<ConventionalOptions>& substep_count_options() {
  using O = ConventionalOptions;
  static const OptionRows<O> rows{
      or_word(integer("substeps", &O::substeps, at_least_one,
                      "Number of time steps in a frame. `auto` chooses it from the speed of what touches, for `icm` "
                      "from the largest speed of all."),
              "auto"),
      or_word(
          integer("min_substeps", &O::min_substeps, at_least_one,
                  "Smallest number of substeps that `auto` chooses. `auto`, which `icm` always has: as many as keep "
                  "a substep within `solver.substep.longest`."),
          "auto"),
      integer("max_substeps", &O::max_substeps, at_least_one,
              "Largest number of substeps that `auto` chooses. A frame whose response runs out of its budget is made "
              "again with so many, also where `substeps` is a number.")};
  return rows;
}

const OptionRows<ConventionalOptions>& contact_force_options() {
  using O = ConventionalOptions;
  static const OptionRows<O> rows{
      flag("contact_forces", &O::contact_forces,
           "True: the trajectory has what contact exerts on each vertex (docs/files.md). Steppers "
           "without a solve have none.")};
  return rows;
}

}  // namespace

const Options<RunOptions>& run_options() {
  using O = RunOptions;
  static const Options<O> table(
      "run", "",
      OptionRows<O>{integer("frames", &O::frames, at_least_one, "Number of frames."),
                    number("fps", &O::fps, Unit::rate, positive, "Frames a second."),
                    word("quality", &O::quality, quality_names(),
                         "Preset for other keys, from fast to accurate (docs/benchmarks.md). A key that the file gives "
                         "keeps its value.")} +
          inside(&O::conventional, substep_count_options() + contact_force_options()) +
          OptionRows<O>{word("stepper", &O::stepper, known_kinds().names(), "Method that makes the frames."),
                        flag("rest", &O::rest, "True: a resting cloth is not simulated while nothing near it moves."),
                        section(&O::resting, resting_options(), "When a cloth counts as resting."),
                        section(&O::recovery, recovery_options(), "How a tangled start is untangled."),
                        section(&O::icm, icm_options(), "Options of the stepper `icm`."),
                        section(&O::learned, learned_options(), "Options of the stepper `learned`."),
                        section(&O::hybrid, hybrid_options(), "Options of the stepper `hybrid`."),
                        section(&O::refu, refu_options(), "Repulsive layer behind the stepper.")});
  return table;
}

const Options<RunOptions>& output_options() {
  static const Options<RunOptions> table(
      "output", "", {path("folder", &RunOptions::output, "Folder of the results. Default: the command chooses it.")});
  return table;
}

}  // namespace selvedge
