#include "collision/contact_pairs.hpp"

#include <algorithm>
#include <cmath>

namespace selvedge {
namespace {

Box unite(const Box& a, const Box& b) {
  Box both;
  for (int k = 0; k < 3; ++k) {
    both.lo[k] = std::min(a.lo[k], b.lo[k]);
    both.hi[k] = std::max(a.hi[k], b.hi[k]);
  }
  return both;
}

Box moving_point_box(const Vec3& x0, const Vec3& x1, double radius) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  Box box;
  for (int k = 0; k < 3; ++k) {
    box.lo[k] = std::nextafter(static_cast<float>(std::min(x0[k], x1[k]) - radius), -infinity);
    box.hi[k] = std::nextafter(static_cast<float>(std::max(x0[k], x1[k]) + radius), infinity);
  }
  return box;
}

// One side of a pair of triangles: its surface, offset in the joint numbering, and boxes.
struct Side {
  const Surface& surface;
  int first_node;
  const std::vector<Box>& triangles;
  const std::vector<Box>& vertices;
  const std::vector<Box>& edges;
};

void vertex_face_pairs(const Side& p, int tp, const Side& f, int tf, bool same, std::vector<NodePair>& pairs) {
  const auto face = f.surface.triangles.row(tf);
  for (int k = 0; k < 3; ++k) {
    const int v = p.surface.triangles(tp, k);
    if (p.surface.vertex_owner[v] != tp) continue;
    if (same && (v == face(0) || v == face(1) || v == face(2))) continue;
    if (!overlap(p.vertices[v], f.triangles[tf])) continue;
    pairs.push_back({PairKind::vertex_face,
                     {v + p.first_node, face(0) + f.first_node, face(1) + f.first_node, face(2) + f.first_node}});
  }
}

void edge_edge_pairs(const Side& a, int ta, const Side& b, int tb, bool same, std::vector<NodePair>& pairs) {
  for (int i = 0; i < 3; ++i) {
    const int ea = a.surface.triangle_edges(ta, i);
    if (a.surface.edge_owner[ea] != ta) continue;
    const int a0 = a.surface.edges(ea, 0), a1 = a.surface.edges(ea, 1);
    for (int j = 0; j < 3; ++j) {
      const int eb = b.surface.triangle_edges(tb, j);
      if (b.surface.edge_owner[eb] != tb) continue;
      const int b0 = b.surface.edges(eb, 0), b1 = b.surface.edges(eb, 1);
      if (same && (a0 == b0 || a0 == b1 || a1 == b0 || a1 == b1)) continue;
      if (!overlap(a.edges[ea], b.edges[eb])) continue;
      pairs.push_back(
          {PairKind::edge_edge, {a0 + a.first_node, a1 + a.first_node, b0 + b.first_node, b1 + b.first_node}});
    }
  }
}

// Chunks of fixed size, joined in order: the same list for any number of threads.
void primitive_pairs(const Side& a, const Side& b, bool same, const std::vector<std::pair<int, int>>& triangles,
                     std::vector<NodePair>& pairs) {
  constexpr int chunk = 8192;
  const int chunks = (static_cast<int>(triangles.size()) + chunk - 1) / chunk;
  std::vector<std::vector<NodePair>> found(chunks);
#pragma omp parallel for schedule(dynamic)
  for (int c = 0; c < chunks; ++c) {
    const int end = std::min<int>((c + 1) * chunk, static_cast<int>(triangles.size()));
    for (int i = c * chunk; i < end; ++i) {
      const auto [ta, tb] = triangles[i];
      vertex_face_pairs(a, ta, b, tb, same, found[c]);
      vertex_face_pairs(b, tb, a, ta, same, found[c]);
      edge_edge_pairs(a, ta, b, tb, same, found[c]);
    }
  }
  for (const auto& list : found) pairs.insert(pairs.end(), list.begin(), list.end());
}

}  // namespace

int ContactWorld::obstacle_of(int node) const {
  if (is_cloth(node)) return -1;
  const auto above = std::upper_bound(first_node.begin(), first_node.end(), node);
  return static_cast<int>(above - first_node.begin()) - 1;
}

ContactWorld make_contact_world(const Surface& cloth, std::vector<const Surface*> obstacles, bool self) {
  ContactWorld world{&cloth, std::move(obstacles), {}, self, cloth.vertex_count};
  for (const Surface* obstacle : world.obstacles) {
    world.first_node.push_back(world.node_count);
    world.node_count += obstacle->vertex_count;
  }
  return world;
}

Points gather_nodes(const Points& cloth, const std::vector<Points>& obstacles) {
  Eigen::Index count = cloth.rows();
  for (const Points& obstacle : obstacles) count += obstacle.rows();
  Points nodes(count, 3);
  nodes.topRows(cloth.rows()) = cloth;
  Eigen::Index first = cloth.rows();
  for (const Points& obstacle : obstacles) {
    nodes.middleRows(first, obstacle.rows()) = obstacle;
    first += obstacle.rows();
  }
  return nodes;
}

std::array<Vec3, 4> corners(const NodePair& pair, const Points& x) {
  return {row(x, pair.nodes[0]), row(x, pair.nodes[1]), row(x, pair.nodes[2]), row(x, pair.nodes[3])};
}

PairSearch::PairSearch(const ContactWorld& world) : world_(world) {
  cloth_.surface = world.cloth;
  obstacles_.resize(world.obstacles.size());
  for (std::size_t k = 0; k < world.obstacles.size(); ++k) {
    obstacles_[k].surface = world.obstacles[k];
    obstacles_[k].first_node = world.first_node[k];
  }
}

void PairSearch::restart() {
  cloth_.stale = true;
  for (Part& obstacle : obstacles_) obstacle.stale = true;
}

void PairSearch::make_boxes(Part& part) {
  const Surface& s = *part.surface;
  part.vertex_boxes.resize(s.vertex_count);
  part.edge_boxes.resize(s.edges.rows());
  part.triangle_boxes.resize(s.triangles.rows());
#pragma omp parallel for schedule(static)
  for (int v = 0; v < s.vertex_count; ++v)
    part.vertex_boxes[v] = moving_point_box(row(part.from, v), row(part.to, v), part.radius / 2);
#pragma omp parallel for schedule(static)
  for (int e = 0; e < static_cast<int>(s.edges.rows()); ++e)
    part.edge_boxes[e] = unite(part.vertex_boxes[s.edges(e, 0)], part.vertex_boxes[s.edges(e, 1)]);
#pragma omp parallel for schedule(static)
  for (int t = 0; t < static_cast<int>(s.triangles.rows()); ++t)
    part.triangle_boxes[t] = unite(part.edge_boxes[s.triangle_edges(t, 0)], part.vertex_boxes[s.triangles(t, 2)]);
}

void PairSearch::update(Part& part, const Points& x0, const Points& x1, double radius) {
  const auto from = x0.middleRows(part.first_node, part.surface->vertex_count);
  const auto to = x1.middleRows(part.first_node, part.surface->vertex_count);
  const bool same = part.radius == radius && part.from == from && part.to == to;
  if (same && !(part.stale && part.refitted)) {
    part.stale = false;
    return;
  }
  part.radius = radius;
  part.from = from;
  part.to = to;
  make_boxes(part);
  if (!part.stale) refit(part.bvh, part.triangle_boxes);
  part.refitted = !part.stale;
  // A tree that has lost a quarter of its quality to refitting is built anew.
  if (part.stale || bvh_cost(part.bvh) > 1.25 * part.built_cost) {
    part.bvh = build_bvh(part.triangle_boxes);
    part.built_cost = bvh_cost(part.bvh);
    part.refitted = false;
  }
  part.stale = false;
}

void PairSearch::find(const Points& x0, const Points& x1, double radius, std::vector<NodePair>& pairs) {
  pairs.clear();
  update(cloth_, x0, x1, radius);
  const auto side = [](const Part& p) {
    return Side{*p.surface, p.first_node, p.triangle_boxes, p.vertex_boxes, p.edge_boxes};
  };
  if (world_.self) {
    self_pairs(cloth_.bvh, triangle_pairs_);
    primitive_pairs(side(cloth_), side(cloth_), true, triangle_pairs_, pairs);
  }
  for (Part& obstacle : obstacles_) {
    update(obstacle, x0, x1, radius);
    cross_pairs(cloth_.bvh, obstacle.bvh, triangle_pairs_);
    primitive_pairs(side(cloth_), side(obstacle), false, triangle_pairs_, pairs);
  }
}

}  // namespace selvedge
