#include "physics/steppers/icm_stepper.hpp"

#include <algorithm>
#include <utility>

#include "collision/contact/proximity.hpp"
#include "collision/contour/find_contours.hpp"
#include "collision/geometry/floating_point.hpp"
#include "collision/geometry/stopwatch.hpp"
#include "collision/untangle/caught.hpp"
#include "collision/untangle/find_exemption.hpp"
#include "collision/untangle/separation.hpp"
#include "physics/frame/bounded_step.hpp"
#include "physics/frame/frame_audits.hpp"
#include "physics/recovery/recovery.hpp"
#include "physics/scene/features.hpp"
#include "physics/scene/scene_numbers.hpp"
#include "physics/solve/contact_terms.hpp"
#include "physics/solve/contour_potential.hpp"
#include "physics/solve/energy_balance.hpp"
#include "physics/solve/euler_torque.hpp"
#include "physics/steppers/count_solve.hpp"
#include "physics/steppers/finish_step.hpp"
#include "physics/steppers/substeps.hpp"

namespace selvedge {
namespace {

double mean_mass(const Eigen::VectorXd& inverse_mass) {
  double sum = 0;
  int count = 0;
  for (const double inverse : inverse_mass)
    if (inverse > 0) {
      sum += 1 / inverse;
      ++count;
    }
  return count > 0 ? sum / count : 0;
}

// The data of one substep.
struct IcmWork {
  std::vector<NodePair> held;          // pairs that have a term, sorted
  std::vector<ContactTerm> repulsion;  // their terms
  Exemption exemption;                 // at the start
  Points v, unbalanced;                // at the end [m/s], and the unbalanced forces after the last solve [N]
  const StopFlag* stop = nullptr;
};

class IcmStepper final : public Stepper {
 public:
  IcmStepper(const Scene& scene, const IcmOptions& options)
      : scene_(scene),
        options_(options),
        features_(features_of(scene)),
        world_(make_contact_world(scene.surface, obstacle_surfaces(scene), features_.self_contact, &scene.rest)),
        search_(world_),
        inverse_mass_(inverse_masses(scene, world_.node_count)),
        mean_mass_(mean_mass(inverse_mass_)),
        edge_length_(mean_edge_length(scene)),
        solver_(scene, options.implicit_euler),
        euler_torque_(scene),
        energy_(scene, solver_.elastic()),
        self_crossings_(world_),
        traits_{.name = "icm", .max_substeps = options.substeps.value_or(options.max_substeps)} {}

  const StepperTraits& traits() const override { return traits_; }
  StepReport step(const State& from, const Drive& drive, double dt, State& to, const StepExtras& extras) override {
    check_time_step(dt, "stepper `" + traits_.name + "`");
    return bounded_step(traits_.name, extras.stop, [&] { return take_step(from, drive, dt, to, extras); });
  }

 private:
  StepReport take_step(const State& from, const Drive& drive, double dt, State& to, const StepExtras&);
  bool has_contact() const { return features_.self_contact || features_.obstacles; }
  void find_pairs(const Points& nodes0, const Points& at, const Points& nodes1, double h, const Exemption&, IcmWork&,
                  StepReport&);
  std::vector<ContactTerm> pushes(ContourPotential&, const Points& x, double h) const;
  bool minimise(const StepProblem&, Points& x, IcmWork&, StepReport&);
  void end_substep(const StepProblem&, const Points& x, Points& nodes1, IcmWork&);
  bool substep(const SubstepState&, const Points& pins, const Drive&, double h, Points& nodes1, IcmWork&, StepReport&);

  const Scene& scene_;
  IcmOptions options_;
  Features features_;
  ContactWorld world_;
  PairSearch search_;
  Eigen::VectorXd inverse_mass_;
  double mean_mass_, edge_length_;
  ImplicitEuler solver_;
  EulerTorque euler_torque_;
  EnergyBalance energy_;
  SelfCrossings self_crossings_;
  StepperTraits traits_;
  std::vector<NodePair> pairs_;  // scratch
};

// Adds terms for the pairs that are near at `at` and have none yet. A pair keeps the side on which it was first found
// in the substep, as in equation 5 of the paper (icm_stepper.hpp).
void IcmStepper::find_pairs(const Points& nodes0, const Points& at, const Points& nodes1, double h,
                            const Exemption& exemption, IcmWork& work, StepReport& report) {
  const double reach = std::max(options_.reach, scene_.contact.thickness);
  search_.find(at, at, reach, pairs_);
  std::erase_if(pairs_, [&](const NodePair& pair) {
    return std::binary_search(work.held.begin(), work.held.end(), pair) || exemption.leaves_alone(world_, pair.nodes);
  });
  std::vector<Proximity> near = find_proximities(world_, pairs_, at, reach);
  for (Proximity& p : near) {
    p.rest_gap = std::min(p.rest_gap, scene_.contact.thickness);
    report.collision.min_gap = std::min(report.collision.min_gap, p.gap);
  }
  const auto terms =
      contact_terms({scene_, world_, inverse_mass_, nodes0, nodes1, h, options_.substep.contact}, near).terms;
  work.repulsion.insert(work.repulsion.end(), terms.begin(), terms.end());
  for (const Proximity& p : near) work.held.push_back(p.pair);
  std::sort(work.held.begin(), work.held.end());
}

// Moving enclosed vertices out may lengthen a contour at first, so that they are pushed back directly.
std::vector<ContactTerm> IcmStepper::pushes(ContourPotential& contour, const Points& x, double h) const {
  if (options_.push_speed == 0) return {};
  const Segments& found = contour.segments(x);
  const std::vector<Contour> contours = find_contours(contour.sheets(), found);
  const auto separations =
      part_contours(contour.sheets(), found, contours, enclosed_regions(contour.sheets(), found, contours),
                    {scene_.contact.thickness, options_.push_speed * h});
  return push_terms(separations, inverse_mass_, options_.push_softness * scene_.contact.thickness, h,
                    options_.substep.contact);
}

bool IcmStepper::minimise(const StepProblem& problem, Points& x, IcmWork& work, StepReport& report) {
  Stopwatch watch;
  const NewtonReport newton = solver_.solve(problem, x);
  count_solve(newton, report);
  work.unbalanced = solver_.gradient(problem, x);
  report.residual = largest_row(work.unbalanced);
  if (!newton.converged) report.doubts.not_converged = true;
  report.seconds.solve += watch.lap();
  return newton.finite && !newton.stopped && x.allFinite();
}

// Velocities are the change of positions, without the torque that implicit Euler adds.
void IcmStepper::end_substep(const StepProblem& problem, const Points& x, Points& nodes1, IcmWork& work) {
  nodes1.topRows(x.rows()) = x;
  work.v = (x - *problem.x0) / problem.h;
  euler_torque_.take_back(problem, x, work.unbalanced, work.v);
}

// nodes1 has obstacles at their ends and the cloth's first guess. False if the result is not finite or was stopped.
bool IcmStepper::substep(const SubstepState& now, const Points& pins, const Drive& drive, double h, Points& nodes1,
                         IcmWork& work, StepReport& report) {
  const int n = scene_.surface.vertex_count;
  const Points x0 = now.nodes.topRows(n);
  Points x = nodes1.topRows(n);
  StepProblem problem{h, &x0, &now.v, &pins, drive.acceleration, drive.wind, {}, 1};
  problem.stop = work.stop;
  if (!has_contact()) {
    if (!minimise(problem, x, work, report)) return false;
    end_substep(problem, x, nodes1, work);
    return true;
  }
  ContourPotential contour(world_, nodes1, options_.contour_weight * mean_mass_ / (h * h), options_.contour_gradient);
  const AddedTerm added{[&](const Points& at) { return contour.value(at); },
                        [&](const Points& at, Points& gradient, std::vector<ContactBlock>& blocks) {
                          contour.add_derivatives(at, gradient, blocks);
                        }};
  if (options_.contour_weight > 0) problem.added = &added;
  Points at = now.nodes;
  for (int k = 0; k < options_.outer_iterations; ++k) {
    Stopwatch watch;
    Exemption exemption = find_exemption(world_, at);
    self_crossings_.switch_off(now.nodes, nodes1, {}, exemption);
    if (k == 0) work.exemption = exemption;
    find_pairs(now.nodes, at, nodes1, h, exemption, work, report);
    if (k == 0 && !work.repulsion.empty())
      set_load_stiffness(work.repulsion, inverse_mass_, -solver_.gradient(problem, x), options_.substep.contact);
    std::vector<ContactTerm> terms = pushes(contour, at.topRows(n), h);
    terms.insert(terms.end(), work.repulsion.begin(), work.repulsion.end());
    report.seconds.response += watch.lap();
    problem.contacts = terms;
    if (!minimise(problem, x, work, report)) return false;
    at = nodes1;
    at.topRows(n) = x;
    lag_normal_forces(work.repulsion, x);
    raise_stiffness(work.repulsion, x);
  }
  report.collision.contacts = static_cast<int>(work.repulsion.size());
  end_substep(problem, x, nodes1, work);
  return true;
}

StepReport IcmStepper::take_step(const State& from, const Drive& drive, double dt, State& to,
                                 const StepExtras& extras) {
  restore_standard_arithmetic();
  if (const auto restart = restart_of(from, drive, traits_.max_substeps)) {
    StepReport report = take_step(restart->state, drive, dt, to, extras);
    report.collision.jumped = restart->jumped;
    return report;
  }
  StepReport report;
  report.by = traits_.name;
  const int n = scene_.surface.vertex_count;
  const int planned = options_.substeps
                          ? *options_.substeps
                          : substeps_for_speed(from, drive, dt, edge_length_, options_.max_substeps, options_.substep);
  SubstepState now{gather_nodes(from.x, from.obstacles), from.v};
  const Points wanted = gather_nodes(from.x, drive.obstacles);
  Exemption all;  // switched-off nodes of all substeps
  if (has_contact() && !from.clean && now.nodes.allFinite())
    report.collision.pairs_before = audit_positions(scene_, from.x, from.obstacles).intersecting_pairs();
  for (int s = 0; s < planned; ++s) {
    const double part = 1.0 / (planned - s);  // of what is left of the frame
    const double h = dt / planned;
    Points next = now.nodes + part * (wanted - now.nodes);
    next.topRows(n) = now.nodes.topRows(n) + h * now.v;
    const Points held = now.nodes(scene_.pins, Eigen::all);
    IcmWork work;
    work.stop = &extras.stop;
    if (!now.nodes.allFinite() || !substep(now, held + part * (drive.pins - held), drive, h, next, work, report)) {
      reject(stopped(extras.stop) ? Reason::stopped : Reason::not_finite, report);
      return report;
    }
    ++report.substeps;
    now.v = std::move(work.v);
    if (s == 0) report.path.start = now.nodes;
    report.path.substeps.push_back({next, work.exemption});
    if (s == 0) report.collision.left_alone = work.exemption.tangled_vertices();
    all.switched_off = either(std::move(all.switched_off), work.exemption.switched_off);
    now.nodes = std::move(next);
  }
  if (!all.switched_off.empty()) report.switched_off = switched_off_counts(world_, all);
  finish_step(from, drive, dt, {now.nodes.topRows(n), std::move(now.v), drive.obstacles}, to, report);
  if (energy_(from, drive, to).from_nowhere()) reject(Reason::energy_gain, report);
  return report;
}

}  // namespace

std::unique_ptr<Stepper> make_icm_stepper(const Scene& scene, const IcmOptions& options) {
  return std::make_unique<IcmStepper>(scene, options);
}

}  // namespace selvedge
