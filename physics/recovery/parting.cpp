#include "physics/recovery/parting.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "collision/untangle/find_exemption.hpp"
#include "physics/recovery/drawn.hpp"
#include "physics/recovery/pierced.hpp"
#include "physics/recovery/put_on.hpp"

namespace selvedge {
namespace {

std::vector<char> dressed_ones(std::vector<char> marked, const Points& targets) {
  for (std::size_t v = 0; v < marked.size(); ++v)
    marked[v] = marked[v] && targets.rows() > 0 && targets.row(static_cast<Eigen::Index>(v)).allFinite();
  return marked;
}

// Vertices of the cloth on or inside contours with itself if all dressed vertices were at their skinned targets; empty
// if there are none.
std::vector<char> crossed_at_targets(const ContactWorld& world, const Points& nodes, const Points& targets) {
  Points there = nodes.topRows(world.cloth->vertex_count);
  for (Eigen::Index v = 0; v < targets.rows(); ++v)
    if (targets.row(v).allFinite()) there.row(v) = targets.row(v);
  return find_exemption(make_contact_world(*world.cloth, {}, true), there).self;
}

// Removes the mark of vertices that are `tangled` with cloth: at their skinned targets they may be tangled too.
std::vector<char> without(std::vector<char> marked, const std::vector<char>& tangled) {
  for (std::size_t v = 0; v < std::min(marked.size(), tangled.size()); ++v) marked[v] = marked[v] && !tangled[v];
  return marked;
}

// Finds what is tangled. True if the cloth is too tangled to be parted: its own stiffness has to open it.
bool find_tangled(const ContactWorld& world, const Points& nodes, const RecoveryOptions& options, Exemption& tangled) {
  const std::optional<Exemption> untouched = too_tangled(world, nodes, options);
  tangled = untouched ? *untouched : find_exemption(world, nodes);
  return untouched.has_value();
}

// Parts what is still tangled. Trapped cloth is drawn, unless it is tangled with cloth. True if untangling finds no way
// to part anything.
bool part_the_rest(const ContactWorld& world, const Eigen::VectorXd& inverse_mass, const RecoveryTargets& where,
                   const RecoveryOptions& options, Points& nodes, UntanglingBudget& budget, Parting& parting) {
  std::vector<char> tangled = parting.left_alone.self;
  if (!tangled.empty() && !parting.left_alone.switched_off.empty())
    tangled = either(std::move(tangled), crossed_at_targets(world, nodes, *where.skinned_targets));
  const double reach = options.speed * where.h;
  Recovery recovery = recover(world, inverse_mass, reach, parting.left_alone, parting.drawn, nodes, &budget, options);
  parting.left_alone = std::move(recovery.left_alone);
  parting.separations = std::move(recovery.separations);
  if (!parting.left_alone.switched_off.empty()) {
    parting.trapped = without(dressed_ones(std::move(recovery.trapped), *where.skinned_targets), tangled);
    parting.drawn = without(std::move(parting.drawn), tangled);
  }
  return recovery.stuck;
}

}  // namespace

// The order is that of docs/recovery.md.
Parting part_at_start(const ContactWorld& world, SelfCrossings& self_crossings, const Eigen::VectorXd& inverse_mass,
                      double edge_length, bool clean, const RecoveryTargets& where, const RecoveryOptions& options,
                      Points& nodes, Points& v, UntanglingBudget& budget) {
  const Points &wanted = *where.wanted, &targets = *where.skinned_targets;
  Parting parting;
  // 1. Find what is tangled.
  const bool opens_itself = !clean && nodes.allFinite() && find_tangled(world, nodes, options, parting.left_alone);
  // 2. Let through cloth that is caught where a body crosses itself.
  self_crossings.switch_off(nodes, wanted, targets, parting.left_alone, where.apart);
  // 3. Put on again cloth that a limb has gone through, or that has sunken in.
  std::vector<char> pierced, sunken;
  if (!opens_itself) {
    pierced = pierced_vertices(world, parting.left_alone, nodes, wanted, targets,
                               options.pierced_distance * edge_length, options);
    sunken = sunken_vertices(world, parting.left_alone, targets, options);
  }
  const bool placed = put_on(world, either(sunken, pierced), where, nodes, v, &budget, options) == PutOn::done;
  if (placed) {
    parting.left_alone = find_exemption(world, nodes);
    pierced.clear();
  }
  // 4. Without a place, draw it to its skinned targets; likewise cloth where a body crosses itself.
  parting.drawn = either(drawn_vertices(world, parting.left_alone, targets, nodes, edge_length), pierced);
  // 5. Part other tangled cloth.
  const bool stuck = parting.left_alone.tangled() && !opens_itself &&
                     part_the_rest(world, inverse_mass, where, options, nodes, budget, parting);
  // 6. If there is no way out, draw sunken cloth too.
  if (stuck && !placed) pierced = either(std::move(pierced), sunken);
  parting.drawn = either(std::move(parting.drawn), pierced);
  parting.left_alone.body = either(std::move(parting.left_alone.body), pierced);
  return parting;
}

}  // namespace selvedge
