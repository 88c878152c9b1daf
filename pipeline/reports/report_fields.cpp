#include "pipeline/reports/report_fields.hpp"

namespace selvedge {

using namespace report_table;

namespace {

const std::vector<std::string>& status_names() {
  static const std::vector<std::string> names{"not_run", "accepted", "rejected"};
  return names;
}

}  // namespace

// Trajectories hold the numbers, so that a reason which no step has any more, `overstretched`, keeps its own.
const std::vector<std::string>& reason_names() {
  static const std::vector<std::string> names{"none",        "not_converged", "not_finite", "penetrating",
                                              "energy_gain", "overstretched", "stopped",    "too_many_pairs"};
  return names;
}

const std::vector<std::string>& verdict_names() {
  static const std::vector<std::string> names{
      "none",     "admitted",   "refined",       "no_history",    "tangled",     "waiting",    "too_slow",
      "not_made", "not_finite", "moved_too_far", "overstretched", "energy_gain", "unbalanced", "penetrating"};
  return names;
}

const BoundFields<PhaseTimes>& phase_fields() {
  using P = PhaseTimes;
  const std::string key = "ms_per_frame.by_phase";
  const std::vector<InSummary> mean{{key, Over::milliseconds}}, where_there{{key, Over::milliseconds_where_there}};
  static const BoundFields<P> all{
      field("solve", &P::solve, "s", "Newton's method and its linear solver", mean),
      field("broad_phase", &P::broad_phase, "s", "searches for pairs", mean),
      field("ccd", &P::ccd, "s", "tests of paths for a first contact", mean),
      field("response", &P::response, "s", "impulses and impact zones", mean),
      field("graph", &P::graph, "s", "construction of the graph that the network of a learned stepper reads",
            where_there),
      field("network", &P::network, "s", "evaluation of the network of a learned stepper", where_there),
      field("guard", &P::guard, "s", "tests of proposals by the guard of [the hybrid](hybrid.md)", where_there),
      field("audit", &P::audit, "s", "audits of motions and positions", mean),
      field("body", &P::body, "s",
            "making the drive: bodies with their soft tissue, pins and skinned targets. If it is made beside a step, "
            "the time that the step waited for it",
            mean)};
  return all;
}

const BoundFields<StepCounts>& count_fields() {
  using C = StepCounts;
  static const BoundFields<C> all{
      field("solves", &C::solves, "",
            "minimisations of the incremental potential. This column and the next six leave out work that caches save, "
            "so a resumed run may count more",
            {{"solves", Over::sum}}),
      field("coarse_builds", &C::coarse_builds, "", "constructions of the coarse levels of multigrid",
            {{"coarse_builds", Over::sum}}),
      field("searches", &C::searches, "", "searches for pairs that come near each other", {{"searches", Over::sum}}),
      field("candidates", &C::candidates, "", "pairs with overlapping boxes that these searches found",
            {{"candidates", Over::sum}}),
      field("audits", &C::audits, "", "audits of a motion or of positions", {{"audits", Over::sum}}),
      field("swept", &C::swept, "", "pairs whose paths were tested for a first contact", {{"swept", Over::sum}}),
      field("projected", &C::projected, "", "vertices that impact zones moved, summed over projections",
            {{"projected", Over::sum}})};
  return all;
}

const BoundFields<CollisionReport>& collision_fields() {
  using C = CollisionReport;
  static const BoundFields<C> all{
      field("contacts", &C::contacts, "", "proximity pairs in the last solve", {{"max_contacts", Over::largest}},
            Page::yes),
      field("impulses", &C::impulses, "", "impacts that an impulse resolved, all substeps", {{"impulses", Over::sum}}),
      field("zones", &C::zones, "", "impact zones projected, all substeps", {{"zones", Over::sum}}),
      field("halved_substeps", &C::halved_substeps, "",
            "substeps done again in two halves because impact zones did not converge",
            {{"halved_substeps", Over::sum}}),
      field("shortened", &C::shortened, "", "zones whose motion was shortened", {{"shortened_zones", Over::sum}}),
      field("held_vertices", &C::held_vertices, "", "cloth vertices in zones whose motion was shortened, all substeps",
            {{"held_vertices", Over::sum}}),
      field("passed_through", &C::passed_through, "", "pairs that met during the motion, by its audit",
            {{"passed_through", Over::sum}}),
      field("left_alone", &C::left_alone, "",
            "cloth vertices that were tangled at the start of the step; contact leaves them alone until they are free"),
      field("cut_out", &C::cut_out, "",
            "triangles that are out of the simulation in this frame ([cut starts](garments.md#how-it-starts)); their "
            "pairs are not counted",
            {{"cut_out_triangles", Over::at_start},
             {"cut_out_triangles_at_end", Over::at_end},
             {"cut_out_last_frame", Over::last_frame}}),
      field(
          "pushed_out", &C::pushed_out, "",
          "cloth vertices that [the repulsive layer](repulsion.md), or the settling of a network, moved out of bodies",
          {{"pushed_out", Over::sum}}, Page::yes),
      field("jumped", &C::jumped, "",
            "obstacles that were to move farther than their own size in a substep; they are put at their wanted "
            "positions without a sweep",
            {{"jumped", Over::sum}, {"jumped_first_frame", Over::first_frame}}),
      field("contact_gap", &C::min_gap, "m", "smallest gap of the contacts", {{"min_contact_gap", Over::smallest}}),
      field("obstacle_lag", &C::obstacle_lag, "m", "largest distance of an obstacle from its wanted position",
            {{"max_obstacle_lag", Over::largest}}),
      field("pairs_before", &C::pairs_before, "",
            "intersecting pairs at the start that the stepper found; -1 if it did not count them"),
      field("pairs_after", &C::pairs_after, "", "the same at the end"),
      field("pairs_wanted", &C::pairs_wanted, "",
            "intersecting pairs at the end, with obstacles at their wanted positions",
            {{"intersecting_pairs_wanted", Over::largest}}),
      field("depth_wanted", &C::depth_wanted, "m",
            "largest depth of a cloth vertex in an obstacle at its wanted position",
            {{"max_depth_wanted", Over::largest}})};
  return all;
}

const BoundFields<Doubts>& doubt_fields() {
  using D = Doubts;
  static const BoundFields<D> all{
      field("not_converged", &D::not_converged, "",
            "1 if solves of an accepted step ended farther from their minimum than is tolerated",
            {{"not_converged_frames", Over::frames}}, Page::yes),
      field("penetrating", &D::penetrating, "",
            "1 if triangles cross after an accepted step, by the audit of the state",
            {{"penetrating_frames", Over::frames}}, Page::yes),
      field("energy_gain", &D::energy_gain, "",
            "1 if [energy came from nowhere](stability.md#frame-by-frame) in an accepted step",
            {{"energy_gains", Over::frames}, {"energy_gains_first_frame", Over::first_frame}}, Page::yes)};
  return all;
}

namespace {

BoundFields<StepReport> own_fields() {
  using R = StepReport;
  return {
      field("by", &R::by, "", "stepper that made the state: row of `codes/by`", {}, Page::yes),
      field("reason", &R::reason, reason_names(),
            "why the step was rejected: row of `codes/reason`. Files of older versions have doubts about accepted "
            "steps here; readers turn them into the three columns below",
            {}, Page::yes),
      field("status", &R::status, status_names(), "whether the step was accepted or rejected: row of `codes/status`"),
      field("fell_back", &R::fell_back, "", "1 if another stepper took the step after a proposal was refused", {},
            Page::yes),
      field("verdict", &R::verdict, verdict_names(),
            "what [the hybrid](hybrid.md) did with a proposal: row of `codes/verdict`", {{"verdicts", Over::by_word}},
            Page::yes),
      field("substeps", &R::substeps, "", "number of substeps", {{"substeps", Over::sum}}),
      field("resting", &R::resting, "", "cloths that were left out because they rest"),
      field("iterations", &R::iterations, "", "iterations of Newton's method, all substeps",
            {{"iterations", Over::sum}}, Page::yes),
      field("linear_iterations", &R::linear_iterations, "", "iterations of the linear solver, all substeps",
            {{"linear_iterations", Over::sum}}),
      field("residual", &R::residual, "N", "largest unbalanced force at the end of the last substep",
            {{"max_residual", Over::largest}}),
      field("unsolved", &R::unsolved, "m", "bound of the RMS distance from where exact solves would end",
            {{"max_unsolved", Over::largest}}, Page::yes),
      field("untangling", &R::untangling, "", "passes of untangling before the step",
            {{"untangling_passes", Over::sum}}),
      field("out_of_newton", &R::out_of_newton, "",
            "1 if [the budget](overview.md#budgets) of Newton iterations ran out; later solves are rough",
            {{"out_of_newton_frames", Over::frames}}, Page::yes),
      field("out_of_untangling", &R::out_of_untangling, "",
            "1 if the budget of untangling passes ran out; cloth that is still tangled waits for the next frame",
            {{"out_of_untangling_frames", Over::frames}}, Page::yes),
      field("out_of_response", &R::out_of_response, "",
            "1 if the budget of impulses and impact zones ran out; later impacts shortened the motion at once",
            {{"out_of_response_frames", Over::frames}}, Page::yes),
      field("out_of_proofs", &R::out_of_proofs, "",
            "1 if the budget of the audit of the motion ran out; pairs that it gave up count in `passed_through`",
            {{"out_of_proofs_frames", Over::frames}}, Page::yes),
      field("switched_off", &R::switched_off, "",
            "sum of the row of `frames/switched_off`; the page and Python have the triangles by obstacle",
            {{"switched_off", Over::by_obstacle}}, Page::yes),
      {.name = "audited",
       .unit = "",
       .about = "whether the state was audited; the columns of the audit have the result",
       .get = [](const R& report) { return FieldValue(report.audit.has_value()); }}};
}

}  // namespace

const BoundFields<StepReport>& report_fields() {
  using R = StepReport;
  static const BoundFields<R> all = own_fields() + inside(&R::doubts, doubt_fields()) +
                                    inside(&R::seconds, phase_fields(), "_seconds") +
                                    inside(&R::counts, count_fields()) + inside(&R::collision, collision_fields());
  return all;
}

}  // namespace selvedge
