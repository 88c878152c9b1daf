#include "physics/put_on.hpp"

#include <algorithm>
#include <span>

#include "collision/exemption.hpp"
#include "collision/untangle.hpp"
#include "collision/world_sheets.hpp"

namespace selvedge {
namespace {

constexpr double most_way = 0.3;       // [m]
constexpr int enough_iterations = 60;  // of untangling: what is worn is shallow in the body, or not to be parted
constexpr int most_parting = 100'000;  // pairs times iterations of it

// Over the step, of the obstacles' node that is nearest to a place at its end.
Vec3 way_of_nearest(const ContactWorld& world, const Points& nodes, const Points& wanted, const Vec3& place) {
  const Eigen::Index first = world.cloth->vertex_count;
  Eigen::Index nearest = 0;
  (wanted.bottomRows(wanted.rows() - first).rowwise() - place.transpose()).rowwise().squaredNorm().minCoeff(&nearest);
  return (wanted.row(first + nearest) - nodes.row(first + nearest)).transpose();
}

// Tangled there, of what is marked or was not tangled before.
bool is_tangled(const Exemption& there, const Exemption& before, const std::vector<char>& marked) {
  const std::vector<char> now = either(there.body, there.self), then = either(before.body, before.self);
  for (std::size_t v = 0; v < now.size(); ++v)
    if (now[v] && (marked[v] || then.empty() || !then[v])) return true;
  return false;
}

}  // namespace

PutOn put_on(const ContactWorld& world, const std::vector<char>& marked, const Points& wanted, const Points& worn,
             double h, Points& nodes, Points& v) {
  std::vector<int> vertices;
  for (int i = 0; i < static_cast<int>(marked.size()); ++i)
    if (marked[i]) vertices.push_back(i);
  if (vertices.empty()) return PutOn::nothing;
  Points ways(static_cast<Eigen::Index>(vertices.size()), 3);
  for (std::size_t k = 0; k < vertices.size(); ++k)
    ways.row(static_cast<Eigen::Index>(k)) = way_of_nearest(world, nodes, wanted, row(worn, vertices[k])).transpose();
  Points there = nodes;
  there(vertices, Eigen::all) = worn(vertices, Eigen::all) - ways;
  if (!((there - nodes).rowwise().squaredNorm().maxCoeff() <= most_way * most_way)) return PutOn::too_far;
  const WorldSheets sheets(world, there);
  UntangleOptions options;
  const int pairs = intersecting_pairs(find_segments(sheets.views));
  options.iterations = std::min(enough_iterations, most_parting / std::max(1, pairs));
  options.second_opinion = false;  // a place that the first does not find is looked for again in the next step
  const UntangleResult parted =
      untangle(*world.cloth, sheets.positions[0], std::span(sheets.views).subspan(1), options);
  there.topRows(parted.x.rows()) = parted.x;  // of other layers as well, which the place may go through
  if (is_tangled(find_exemption(world, there), find_exemption(world, nodes), marked)) return PutOn::no_place;
  nodes = there;
  v(vertices, Eigen::all) = ways / h;
  return PutOn::done;
}

}  // namespace selvedge
