#include "physics/recovery/parting.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "collision/untangle/find_exemption.hpp"
#include "physics/recovery/carrying.hpp"
#include "physics/recovery/pierced.hpp"
#include "physics/recovery/put_on.hpp"

namespace selvedge {
namespace {

std::vector<char> worn_ones(std::vector<char> marked, const Points& worn) {
  for (std::size_t v = 0; v < marked.size(); ++v)
    marked[v] = marked[v] && worn.rows() > 0 && worn.row(static_cast<Eigen::Index>(v)).allFinite();
  return marked;
}

// Vertices of the cloth that cross it where all is worn; empty where there are none.
std::vector<char> crossed_as_worn(const ContactWorld& world, const Points& nodes, const Points& worn) {
  Points there = nodes.topRows(world.cloth->vertex_count);
  for (Eigen::Index v = 0; v < worn.rows(); ++v)
    if (worn.row(v).allFinite()) there.row(v) = worn.row(v);
  return find_exemption(make_contact_world(*world.cloth, {}, true), there).self;
}

// Not the marked ones that are `tangled` with cloth: where they are worn they may be so as well.
std::vector<char> without(std::vector<char> marked, const std::vector<char>& tangled) {
  for (std::size_t v = 0; v < std::min(marked.size(), tangled.size()); ++v) marked[v] = marked[v] && !tangled[v];
  return marked;
}

}  // namespace

Parting part_at_start(const ContactWorld& world, SelfCrossings& self_crossings, const Eigen::VectorXd& inverse_mass,
                      double edge_length, bool clean, const WornPlaces& where, const RecoveryOptions& options,
                      Points& nodes, Points& v, UntanglingBudget& budget) {
  const Points &wanted = *where.wanted, &worn = *where.worn;
  Parting parting;
  std::optional<Exemption> untouched;
  if (!clean && nodes.allFinite()) {
    untouched = hopeless(world, nodes, options);
    parting.left = untouched ? *untouched : find_exemption(world, nodes);
  }
  self_crossings.switch_off(nodes, wanted, worn, parting.left);
  std::vector<char> pierced, sunken;
  if (!untouched)
    pierced = pierced_vertices(world, parting.left, nodes, wanted, worn, options.astray * edge_length, options);
  if (!untouched) sunken = sunken_vertices(world, parting.left, worn, options);
  const PutOn put = put_on(world, either(sunken, pierced), where, nodes, v, &budget, options);
  if (put == PutOn::done) parting.left = find_exemption(world, nodes);
  if (put == PutOn::done) pierced.clear();
  parting.carried = either(carried_vertices(world, parting.left, worn, nodes, edge_length), pierced);
  if (parting.left.cloth() && !untouched) {
    const double reach = options.speed * where.h;
    std::vector<char> tangled = parting.left.self;
    if (!tangled.empty() && !parting.left.off.empty())
      tangled = either(std::move(tangled), crossed_as_worn(world, nodes, worn));
    Recovery recovery = recover(world, inverse_mass, reach, parting.left, parting.carried, nodes, &budget, options);
    parting.left = std::move(recovery.left);
    parting.gained = std::move(recovery.gained);
    if (!parting.left.off.empty()) {
      parting.waits = without(worn_ones(std::move(recovery.waits), worn), tangled);
      parting.carried = without(std::move(parting.carried), tangled);
    }
    if (recovery.stuck && put != PutOn::done) pierced = either(std::move(pierced), sunken);
  }
  parting.carried = either(std::move(parting.carried), pierced);
  parting.left.body = either(std::move(parting.left.body), pierced);
  return parting;
}

}  // namespace selvedge
