#include "physics/steppers/carried_guess.hpp"

#include "collision/geometry/turned_frames.hpp"

namespace selvedge {
namespace {

constexpr const char *target_block = "carried.target", *motion_block = "carried.motion",
                     *target_before_block = "carried.target_before", *motion_before_block = "carried.motion_before";

constexpr std::size_t at(CarriedTerm term) { return static_cast<std::size_t>(term); }

bool has_target(const Points& targets, Eigen::Index v) { return targets.rows() > 0 && targets.row(v).allFinite(); }

// The skinned target of cloth that a body wears, the place of all other cloth.
Points all_targets(const Drive& drive, const Points& x) {
  Points all = x;
  for (Eigen::Index v = 0; v < x.rows(); ++v)
    if (has_target(drive.skinned_targets, v)) all.row(v) = drive.skinned_targets.row(v);
  return all;
}

WantedTerms terms_of(const CarriedModel& model) {
  WantedTerms wanted{};
  for (int k = 0; k < carried_term_count; ++k)
    wanted[static_cast<std::size_t>(k)] =
        model.own.rows() > 0 ? (model.own.col(k).array() != 0).any() : model.scene[k] != 0;
  return wanted;
}

bool looks_back(const WantedTerms& wanted) {
  return wanted[at(CarriedTerm::target_before)] || wanted[at(CarriedTerm::motion_before)];
}

// How far each offset is from the mean of its neighbours'.
Points smoothing_of(const Surface& surface, const Points& offset) {
  Points mean = Points::Zero(offset.rows(), 3);
  Eigen::VectorXd count = Eigen::VectorXd::Zero(offset.rows());
  for (const auto& edge : surface.edges.rowwise())
    for (int end = 0; end < 2; ++end) {
      mean.row(edge[end]) += offset.row(edge[1 - end]);
      count[edge[end]] += 1;
    }
  return mean.array().colwise() / count.array().max(1) - offset.array();
}

// By how much each offset changes as the skinned target turns.
Points turn_of(const Surface& surface, const Points& before, const Points& after, const Points& offset) {
  const std::vector<Mat3> turned = turned_frames(surface, before, after);
  Points turn(offset.rows(), 3);
  for (Eigen::Index v = 0; v < offset.rows(); ++v)
    turn.row(v) = (turned[static_cast<std::size_t>(v)] * offset.row(v).transpose()).transpose() - offset.row(v);
  return turn;
}

}  // namespace

const std::array<const char*, carried_term_count>& carried_term_names() {
  static constexpr std::array<const char*, carried_term_count> names{
      "target", "motion", "target_before", "motion_before", "offset", "turn", "smoothing", "gravity"};
  return names;
}

CarriedSet default_carried_set() {
  CarriedSet set = CarriedSet::Zero();
  set[static_cast<int>(CarriedTerm::target)] = 1;
  set[static_cast<int>(CarriedTerm::motion)] = 0.6;
  return set;
}

CarriedTerms carried_terms(const Scene& scene, const State& from, const Drive& drive, double dt,
                           const WantedTerms& wanted) {
  const Eigen::Index n = from.x.rows();
  CarriedTerms terms;
  terms.worn.resize(static_cast<std::size_t>(n));
  for (Eigen::Index v = 0; v < n; ++v) terms.worn[static_cast<std::size_t>(v)] = has_target(drive.skinned_targets, v);
  const MemoryRows *target = carried_targets(from), *motion = find_rows(from.memory, motion_block, n),
                   *target_before = find_rows(from.memory, target_before_block, n),
                   *motion_before = find_rows(from.memory, motion_before_block, n);
  terms.known = target && motion && (!looks_back(wanted) || (target_before && motion_before));
  const auto set = [&](CarriedTerm term, const auto& make) {
    if (!wanted[at(term)]) return;
    Points& rows = terms.rows[at(term)] = make();
    for (Eigen::Index v = 0; v < n; ++v)
      if (!terms.worn[static_cast<std::size_t>(v)]) rows.row(v).setZero();
  };
  if (!target || drive.skinned_targets.rows() == 0) return terms;
  if (motion) set(CarriedTerm::motion, [&]() -> Points { return *motion; });
  set(CarriedTerm::target, [&]() -> Points { return drive.skinned_targets - *target; });
  if (!terms.known) return terms;
  const Points offset = from.x - *target;
  if (target_before) set(CarriedTerm::target_before, [&]() -> Points { return *target - *target_before; });
  if (motion_before) set(CarriedTerm::motion_before, [&]() -> Points { return *motion_before; });
  set(CarriedTerm::offset, [&]() -> Points { return offset; });
  set(CarriedTerm::turn, [&] { return turn_of(scene.surface, *target, drive.skinned_targets, offset); });
  set(CarriedTerm::smoothing, [&] { return smoothing_of(scene.surface, offset); });
  set(CarriedTerm::gravity, [&]() -> Points { return dt * dt * drive.acceleration.transpose().replicate(n, 1); });
  return terms;
}

Points carried_guess(const Scene& scene, const State& from, const Drive& drive, double dt, const CarriedModel& model) {
  CarriedTerms terms = carried_terms(scene, from, drive, dt, terms_of(model));
  const CarriedModel standard;
  const CarriedModel& used = terms.known ? model : standard;
  if (!terms.known) terms = carried_terms(scene, from, drive, dt, terms_of(used));
  const bool has_targets = carried_targets(from) != nullptr;
  Points x = from.x;
  for (Eigen::Index v = 0; v < x.rows(); ++v) {
    if (!terms.worn[static_cast<std::size_t>(v)]) {
      x.row(v) += dt * (from.v.row(v) + dt * drive.acceleration.transpose());
      continue;
    }
    if (!has_targets) x.row(v) += dt * from.v.row(v);
    for (int k = 0; k < carried_term_count; ++k)
      if (const Points& rows = terms.rows[static_cast<std::size_t>(k)]; rows.rows() > 0)
        x.row(v) += (used.own.rows() > 0 ? used.own(v, k) : used.scene[k]) * rows.row(v);
  }
  x(scene.pins, Eigen::all) = drive.pins;
  return x;
}

int past_frames(const CarriedModel& model) { return looks_back(terms_of(model)) ? 2 : 1; }

const MemoryRows* carried_targets(const State& state) { return find_rows(state.memory, target_block, state.x.rows()); }

std::vector<MemoryBlock> carried_memory(const State& from, const Drive& drive, const Points& x, int past_frames) {
  const Points now = all_targets(drive, x);
  Points motion = Points::Zero(x.rows(), 3);
  const MemoryRows *before = carried_targets(from), *moved = find_rows(from.memory, motion_block, from.x.rows());
  if (before) motion = (x - from.x) - (now - Points(*before));
  std::vector<MemoryBlock> blocks{{target_block, now, RowsOf::vertices, true},
                                  {motion_block, motion, RowsOf::vertices}};
  if (past_frames < 2 || !before || !moved) return blocks;
  blocks.push_back({target_before_block, *before, RowsOf::vertices, true});
  blocks.push_back({motion_before_block, *moved, RowsOf::vertices});
  return blocks;
}

}  // namespace selvedge
