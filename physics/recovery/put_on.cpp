#include "physics/recovery/put_on.hpp"

#include <algorithm>
#include <span>

#include "collision/untangle/find_exemption.hpp"
#include "collision/untangle/untangle.hpp"
#include "collision/untangle/world_sheets.hpp"
#include "physics/recovery/carried_along.hpp"

namespace selvedge {
namespace {

struct Place {
  Points nodes, displacements;  // with the marked vertices at this place, and their displacements in the step
  int pairs;                    // number of pairs of triangles that cross there
};

// The displacements in the step of the obstacle nodes nearest to `places`, with obstacles as in `at`.
Points obstacle_displacements(const ContactWorld& world, const Points& at, const Points& places, const Points& nodes,
                              const Points& wanted) {
  const std::vector<int> nearest = nearest_obstacle_nodes(world, at, places);
  return wanted(nearest, Eigen::all) - nodes(nearest, Eigen::all);
}

// Places within `farthest`, the least tangled first: the skinned targets, and where the cloth was clean last, moved
// along with obstacles since.
std::vector<Place> places_for(const ContactWorld& world, const std::vector<int>& vertices, const RecoveryTargets& where,
                              const Points& nodes, double farthest) {
  std::vector<Place> places;
  const auto add = [&](const Points& there, Points displacements) {
    if (!((there - nodes(vertices, Eigen::all)).rowwise().squaredNorm().maxCoeff() <= farthest * farthest)) return;
    Place place{nodes, std::move(displacements), 0};
    place.nodes(vertices, Eigen::all) = there;
    place.pairs = intersecting_pairs(find_segments(WorldSheets(world, place.nodes).views));
    places.push_back(std::move(place));
  };
  const Points &wanted = *where.wanted, targets = (*where.skinned_targets)(vertices, Eigen::all);
  const Points displacements = obstacle_displacements(world, wanted, targets, nodes, wanted);
  add(targets - displacements, displacements);
  if (where.last_clean.rows() > 0) {
    const Points carried = carried_along(world, where.last_clean, nodes, where.thickness)(vertices, Eigen::all);
    add(carried, obstacle_displacements(world, nodes, carried, nodes, wanted));
  }
  std::ranges::stable_sort(places, {}, &Place::pairs);
  return places;
}

UntangleResult part(const ContactWorld& world, const Place& place, const RecoveryOptions& limits,
                    UntanglingBudget& budget) {
  const WorldSheets sheets(world, place.nodes);
  UntangleOptions options;
  options.iterations = std::min(limits.placing_passes, limits.max_placing_pair_passes / std::max(1, place.pairs));
  options.second_rule = false;  // if the first rule fails, the next step tries again
  return budget.untangle(*world.cloth, sheets.positions[0], std::span(sheets.views).subspan(1), options);
}

// Is any vertex tangled at a place that is marked, or was not tangled before?
bool is_tangled(const Exemption& there, const Exemption& before, const std::vector<char>& marked) {
  const std::vector<char> now = either(there.body, there.self), then = either(before.body, before.self);
  for (std::size_t v = 0; v < now.size(); ++v)
    if (now[v] && (marked[v] || then.empty() || !then[v])) return true;
  return false;
}

}  // namespace

PutOn put_on(const ContactWorld& world, const std::vector<char>& marked, const RecoveryTargets& where, Points& nodes,
             Points& v, UntanglingBudget* budget, const RecoveryOptions& limits) {
  std::vector<int> vertices;
  for (int i = 0; i < static_cast<int>(marked.size()); ++i)
    if (marked[i]) vertices.push_back(i);
  if (vertices.empty()) return PutOn::nothing;
  std::vector<Place> places = places_for(world, vertices, where, nodes, limits.farthest_place);
  if (places.empty()) return PutOn::too_far;
  const Exemption before = find_exemption(world, nodes);
  UntanglingBudget ample;
  for (Place& place : places) {
    const UntangleResult parted = part(world, place, limits, budget ? *budget : ample);
    place.nodes.topRows(parted.x.rows()) = parted.x;  // moves other layers too, which the place may cross
    if (is_tangled(find_exemption(world, place.nodes), before, marked)) continue;
    nodes = std::move(place.nodes);
    v(vertices, Eigen::all) = place.displacements / where.h;
    return PutOn::done;
  }
  return PutOn::no_place;
}

}  // namespace selvedge
