#include "collision/contact/proximity.hpp"

#include <algorithm>
#include <cmath>

#include "collision/contact/contact_normal.hpp"
#include "collision/geometry/distance.hpp"
#include "collision/geometry/stop_scope.hpp"

namespace selvedge {
namespace {

// Are both closest points inside the edges? Vertex-face pairs cover contact at ends.
bool crosses_inside(const Closest& c) {
  return c.weights[0] > 0 && c.weights[1] > 0 && c.weights[2] < 0 && c.weights[3] < 0;
}

constexpr double rest_gap_ratio = 0.7;  // of the rest distance, for a pair that is close at rest

std::vector<Proximity> close_pairs(const ContactWorld& world, std::span<const NodePair> candidates, const Points& x,
                                   double thickness) {
  constexpr int chunk = 8192;
  const int chunks = (static_cast<int>(candidates.size()) + chunk - 1) / chunk;
  std::vector<std::vector<Proximity>> found(chunks);
  StopPoll stop;
#pragma omp parallel for schedule(dynamic)
  for (int c = 0; c < chunks; ++c) {
    if (stop.wanted()) continue;
    for (const NodePair& pair :
         candidates.subspan(c * chunk, std::min<std::size_t>(chunk, candidates.size() - c * chunk))) {
      const Closest near = closest(pair, x);
      if (near.squared_distance >= thickness * thickness || near.squared_distance == 0) continue;
      if (pair.kind == PairKind::edge_edge && !crosses_inside(near)) continue;
      const double gap = std::sqrt(near.squared_distance),
                   keep = std::min(thickness, rest_gap_ratio * rest_distance(world, pair));
      if (gap >= keep) continue;
      Vec3 between = Vec3::Zero();
      for (int i = 0; i < 4; ++i) between += near.weights[i] * row(x, pair.nodes[i]);
      found[c].push_back({pair, near.weights, between.normalized(), gap, keep});
    }
  }
  stop.check();
  std::vector<Proximity> all;
  for (const auto& list : found) all.insert(all.end(), list.begin(), list.end());
  std::sort(all.begin(), all.end(), [](const Proximity& a, const Proximity& b) { return a.pair < b.pair; });
  return all;
}

}  // namespace

std::vector<Proximity> find_proximities(const ContactWorld& world, std::span<const NodePair> candidates,
                                        const Points& x, double thickness) {
  const std::vector<Proximity> all = close_pairs(world, candidates, x, thickness);
  const Points normals = vertex_normals(*world.cloth, x.topRows(world.cloth->vertex_count));
  std::vector<std::pair<std::array<int, 4>, std::pair<double, int>>>
      claims;  // (primitive, partner, side) -> (gap, index)
  claims.reserve(2 * all.size());
  const auto claim = [&](int i, int a, int b, int partner_node, double sign) {
    const Vec3 up = world.is_cloth(a) ? Vec3(normals.row(a).transpose()) : Vec3(Vec3::Zero());
    const int side = sign * all[i].normal.dot(up) >= 0 ? 1 : -1;
    claims.push_back({{a, b, world.obstacle_of(partner_node), side}, {all[i].gap, i}});
  };
  for (int i = 0; i < static_cast<int>(all.size()); ++i) {
    const auto& n = all[i].pair.nodes;
    if (all[i].pair.kind == PairKind::vertex_face) {
      claim(i, n[0], -1, n[1], -1);
    } else {
      claim(i, n[0], n[1], n[2], -1);
      claim(i, n[2], n[3], n[0], 1);
    }
  }
  std::sort(claims.begin(), claims.end());
  std::vector<char> keep(all.size(), 0);
  for (std::size_t c = 0; c < claims.size(); ++c)
    if (c == 0 || claims[c].first != claims[c - 1].first) keep[claims[c].second.second] = 1;
  std::vector<Proximity> kept;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (keep[i]) kept.push_back(all[i]);
  const int count = static_cast<int>(kept.size());
#pragma omp parallel for schedule(static) if (count > 64)
  for (int i = 0; i < count; ++i) {
    Proximity& p = kept[i];
    const Vec3 between = p.gap * p.normal;
    p.normal = contact_normal(world, p.pair, p.weights, between, x);
    p.gap = p.normal.dot(between);
  }
  return kept;
}

}  // namespace selvedge
