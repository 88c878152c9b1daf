#include "physics/steppers/recovering_stepper.hpp"

#include <utility>

#include "collision/geometry/error.hpp"
#include "collision/geometry/stopwatch.hpp"
#include "collision/untangle/caught.hpp"
#include "physics/frame/bounded_step.hpp"
#include "physics/recovery/drawn.hpp"
#include "physics/recovery/parting.hpp"
#include "physics/scene/features.hpp"
#include "physics/solve/contact_terms.hpp"
#include "physics/steppers/substeps.hpp"

namespace selvedge {
namespace {

constexpr const char *clean_block = "recovering.last_clean", *clean_obstacles_block = "recovering.last_clean_obstacles";

class RecoveringStepper final : public Stepper {
 public:
  RecoveringStepper(const Scene& scene, std::unique_ptr<Stepper> inner, const RecoveryOptions& options)
      : scene_(scene),
        options_(options),
        inner_(std::move(inner)),
        has_contact_(features_of(scene).self_contact || features_of(scene).obstacles),
        world_(
            make_contact_world(scene.surface, obstacle_surfaces(scene), features_of(scene).self_contact, &scene.rest)),
        masses_(lumped_masses(scene)),
        inverse_mass_(inverse_masses(scene, world_.node_count)),
        edge_length_(mean_edge_length(scene)),
        self_crossings_(world_) {
    if (!inner_->traits().honours_extras)
      throw Error("the stepper `" + inner_->traits().name + "` cannot be told what to leave alone",
                  "inner stepper of a recovering one", "give one that honours extras");
  }

  const StepperTraits& traits() const override { return inner_->traits(); }
  StepReport step(const State& from, const Drive& drive, double dt, State& to, const StepExtras& extras) override;

 private:
  StepReport step_parted(const State& from, const Drive& drive, double dt, State& to, const StepExtras& extras);
  AddedTerm added_term(const Parting&, const Drive&, const Points& x0, double h) const;

  const Scene& scene_;
  RecoveryOptions options_;
  std::unique_ptr<Stepper> inner_;
  bool has_contact_;
  ContactWorld world_;
  Eigen::VectorXd masses_, inverse_mass_;
  double edge_length_;
  SelfCrossings self_crossings_;
};

// Terms that keep separations, and draw cloth to its skinned targets: stiffly if no part of a body is
// switched off.
AddedTerm RecoveringStepper::added_term(const Parting& parting, const Drive& drive, const Points& x0, double h) const {
  AddedTerm added;
  if (!parting.separations.empty())
    added = added_pushes(
        push_terms(parting.separations, inverse_mass_, options_.push_softness * scene_.contact.thickness, h));
  const auto draw = [&](const std::vector<char>& marked, double stiffness) {
    if (marked.empty()) return;
    added = sum_of(std::move(added),
                   drawing_term(marked, masses_, x0, drive.skinned_targets, options_.drawing_speed * h, h, stiffness));
  };
  draw(parting.drawn, parting.left_alone.switched_off.empty() ? options_.drawing_stiffness : 1);
  draw(parting.trapped, options_.trapped_stiffness);
  return added;
}

// By obstacle: 1 for bodies that are known not to cross themselves.
std::vector<char> apart_bodies(const Drive& drive) {
  std::vector<char> apart;
  for (const BodyFrame& body : drive.bodies) apart.push_back(body.apart);
  return apart;
}

Exemption both_of(Exemption a, const Exemption& b) {
  return {either(std::move(a.self), b.self), either(std::move(a.body), b.body),
          either(std::move(a.switched_off), b.switched_off)};
}

StepReport stopped_report(const std::string& by) {
  StepReport report;
  report.by = by;
  reject(Reason::stopped, report);
  return report;
}

StepReport RecoveringStepper::step_parted(const State& from, const Drive& drive, double dt, State& to,
                                          const StepExtras& extras) {
  Stopwatch watch;
  const Points wanted = gather_nodes(from.x, drive.obstacles);
  const LastClean before = from.clean ? LastClean{} : last_clean(from);
  const RecoveryTargets where{
      &wanted, &drive.skinned_targets, gather_nodes(before.x, before.obstacles), scene_.contact.thickness,
      dt,      apart_bodies(drive)};
  Points nodes = gather_nodes(from.x, from.obstacles), v = from.v;
  UntanglingBudget budget{options_.untangling_passes, &extras.stop};
  const Parting parting = part_at_start(world_, self_crossings_, inverse_mass_, edge_length_, from.clean, where,
                                        options_, nodes, v, budget);
  const auto add_parting = [&, parted = watch.lap()](StepReport report) {
    report.seconds.response += parted;
    report.untangling += budget.used;
    report.out_of_untangling = report.out_of_untangling || budget.ran_out;
    if (!parting.left_alone.switched_off.empty()) report.switched_off = switched_off_counts(world_, parting.left_alone);
    return report;
  };
  if (stopped(extras.stop)) return add_parting(stopped_report(traits().name));
  if (!parting.left_alone.any() && parting.separations.empty() && parting.drawn.empty() &&
      nodes.topRows(v.rows()) == from.x)
    return add_parting(inner_->step(from, drive, dt, to, extras));
  State start = from;
  start.x = nodes.topRows(v.rows());
  start.v = v;
  if (start.x != from.x) forget_motion(start.memory);
  const Exemption left_alone = extras.left_alone ? both_of(parting.left_alone, *extras.left_alone) : parting.left_alone;
  StepExtras all = extras;
  all.left_alone = &left_alone;
  if (!parting.separations.empty() || !parting.drawn.empty() || !parting.trapped.empty())
    all.added = [&](const Points& x0, double h) {
      AddedTerm own = added_term(parting, drive, x0, h);
      return extras.added ? sum_of(extras.added(x0, h), std::move(own)) : own;
    };
  const StepReport report = add_parting(inner_->step(start, drive, dt, to, all));
  // Cloth that was drawn stiffly loses its velocity; otherwise it would overshoot its targets.
  if (report.status == StepStatus::accepted && parting.left_alone.switched_off.empty())
    for (std::size_t k = 0; k < parting.drawn.size(); ++k)
      if (parting.drawn[k]) to.v.row(static_cast<Eigen::Index>(k)).setZero();
  return report;
}

StepReport RecoveringStepper::step(const State& from, const Drive& drive, double dt, State& to,
                                   const StepExtras& extras) {
  if (const auto restart = restart_of(from, drive, traits().max_substeps)) {
    StepReport report = step(restart->state, drive, dt, to, extras);
    report.collision.jumped = restart->jumped;
    return report;
  }
  StepReport report = bounded_step(traits().name, extras.stop, [&] {
    return has_contact_ ? step_parted(from, drive, dt, to, extras) : inner_->step(from, drive, dt, to, extras);
  });
  if (report.status == StepStatus::accepted && drive.skinned_targets.rows() > 0)
    remember(from.clean ? LastClean{from.x, from.obstacles} : last_clean(from), to);
  return report;
}

}  // namespace

LastClean last_clean(const State& state) {
  const MemoryRows* x = find_rows(state.memory, clean_block, state.x.rows());
  const MemoryRows* obstacles = find_rows(state.memory, clean_obstacles_block, joined_rows(state.obstacles).rows());
  if (!x || !obstacles) return {};
  return {*x, split_rows(*obstacles, state.obstacles)};
}

void remember(const LastClean& clean, State& state) {
  Memory blocks;
  if (clean.x.rows() > 0)
    blocks = {{clean_block, clean.x, RowsOf::vertices, true},
              {clean_obstacles_block, joined_rows(clean.obstacles), RowsOf::obstacle_vertices, true}};
  replace_blocks("recovering", std::move(blocks), state.memory);
}

std::unique_ptr<Stepper> make_recovering_stepper(const Scene& scene, std::unique_ptr<Stepper> inner,
                                                 const RecoveryOptions& options) {
  return std::make_unique<RecoveringStepper>(scene, std::move(inner), options);
}

}  // namespace selvedge
