#include "collision/contact_pairs.hpp"

#include <algorithm>

#include "collision/exemption.hpp"

namespace selvedge {
namespace {

// A surface that takes part in a search: its tree and, by leaf of the tree, the vertices and edges that the leaf's
// triangles own, in groups like leaves.
struct Side {
  const Surface& surface;
  int first_node;
  const Bvh& bvh;
  const PrimitiveGroups &vertices, &edges;
};

// The straight motion of all nodes that is searched.
struct Motion {
  const Points &from, &to;
  double radius;
  bool still;

  Motion(const Points& x0, const Points& x1, double r) : from(x0), to(x1), radius(r * (1 + 1e-9)), still(x0 == x1) {}

  // 1: the second primitive lies more than the radius above the first one along the axis; -1: below; 0: neither.
  static int order(const Points& x, const NodePair& pair, int split, int axis, double radius) {
    double lo[2], hi[2];
    for (int i = 0; i < 4; ++i) {
      const int side = i >= split;
      const double at = x(pair.nodes[i], axis);
      const bool first = i == 0 || i == split;
      lo[side] = first ? at : std::min(lo[side], at);
      hi[side] = first ? at : std::max(hi[side], at);
    }
    return lo[1] - hi[0] > radius ? 1 : lo[0] - hi[1] > radius ? -1 : 0;
  }
  // Boxes round whole motions overlap where cloth moves by many of its edges. What moves along together is told apart
  // by an axis that keeps the two apart at both ends, and so all the way.
  bool keeps_apart(const NodePair& pair) const {
    if (still) return false;
    const int split = pair.kind == PairKind::vertex_face ? 1 : 2;
    for (int axis = 0; axis < 3; ++axis)
      if (const int before = order(from, pair, split, axis, radius);
          before != 0 && before == order(to, pair, split, axis, radius))
        return true;
    return false;
  }
};

struct LeafPairs {
  const Side &a, &b;
  bool same;  // one surface: primitives that share a vertex are no pair
  const Motion& motion;

  void keep(const NodePair& pair, std::vector<NodePair>& pairs) const {
    if (!motion.keeps_apart(pair)) pairs.push_back(pair);
  }

  void vertex_face(const Side& p, int v, const Side& f, int face, std::vector<NodePair>& pairs) const {
    const int* n = f.surface.triangles.data() + 3 * face;
    if (same && (v == n[0] || v == n[1] || v == n[2])) return;
    keep({PairKind::vertex_face, {v + p.first_node, n[0] + f.first_node, n[1] + f.first_node, n[2] + f.first_node}},
         pairs);
  }
  void edge_edge(int ea, int eb, std::vector<NodePair>& pairs) const {
    if (same && eb < ea) std::swap(ea, eb);
    const int *m = a.surface.edges.data() + 2 * ea, *n = b.surface.edges.data() + 2 * eb;
    if (same && (m[0] == n[0] || m[0] == n[1] || m[1] == n[0] || m[1] == n[1])) return;
    keep({PairKind::edge_edge, {m[0] + a.first_node, m[1] + a.first_node, n[0] + b.first_node, n[1] + b.first_node}},
         pairs);
  }
  void vertices_with_faces(const Side& p, int leaf_p, const Side& f, int leaf_f, const Box& box_f,
                           std::vector<NodePair>& pairs) const {
    const Bvh::Leaf& faces = f.bvh.leaves[leaf_f];
    for (const Bvh::Leaf& group : p.vertices.of(leaf_p))
      for_each_overlap(group, faces, box_f,
                       [&](int i, int j) { vertex_face(p, group.item[i], f, faces.item[j], pairs); });
  }
  void edges_with_edges(int leaf_a, int leaf_b, const Box& box_b, std::vector<NodePair>& pairs) const {
    for (const Bvh::Leaf& first : a.edges.of(leaf_a))
      for (const Bvh::Leaf& second : b.edges.of(leaf_b))
        for_each_overlap(first, second, box_b, [&](int i, int j) { edge_edge(first.item[i], second.item[j], pairs); });
  }
  void edges_within(int leaf, const Box& box, std::vector<NodePair>& pairs) const {
    const auto groups = a.edges.of(leaf);
    for (std::size_t g = 0; g < groups.size(); ++g) {
      const Bvh::Leaf& own = groups[g];
      for_each_overlap(own, [&](int i, int j) { edge_edge(own.item[i], own.item[j], pairs); });
      for (const Bvh::Leaf& later : groups.subspan(g + 1))
        for_each_overlap(own, later, box, [&](int i, int j) { edge_edge(own.item[i], later.item[j], pairs); });
    }
  }
  void operator()(NodeWork w, std::vector<NodePair>& pairs) const {
    const Bvh::Node &node_a = a.bvh.nodes[w.a], &node_b = b.bvh.nodes[w.b];
    vertices_with_faces(a, ~node_a.child, b, ~node_b.child, node_b.box, pairs);
    if (same && w.a == w.b) {
      edges_within(~node_a.child, node_a.box, pairs);
    } else {
      vertices_with_faces(b, ~node_b.child, a, ~node_a.child, node_a.box, pairs);
      edges_with_edges(~node_a.child, ~node_b.child, node_b.box, pairs);
    }
  }
};

}  // namespace

// Fills groups with what the triangles of each leaf own: corner k of triangle t has the primitive primitives(t, k).
void PrimitiveGroups::share_out(const Bvh& bvh, const Triangles& primitives, const std::vector<int>& owner) {
  groups.clear();
  begin.assign(1, 0);
  for (const Bvh::Leaf& leaf : bvh.leaves) {
    int used = Bvh::leaf_size;
    for (const int t : leaf.item)
      for (int k = 0; t >= 0 && k < 3; ++k) {
        const int item = primitives(t, k);
        if (owner[item] != t) continue;
        if (used == Bvh::leaf_size) {
          used = 0;
          std::ranges::fill(groups.emplace_back().item, -1);
        }
        groups.back().item[used++] = item;
      }
    begin.push_back(static_cast<int>(groups.size()));
  }
}

void PrimitiveGroups::set_boxes(std::span<const Box> boxes) {
  const int count = static_cast<int>(groups.size());
#pragma omp parallel for schedule(static)
  for (int g = 0; g < count; ++g) set_leaf_boxes(groups[g], boxes);
}

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

Closest closest(PairKind kind, const std::array<Vec3, 4>& x) {
  return kind == PairKind::vertex_face ? point_triangle(x[0], x[1], x[2], x[3]) : edge_edge(x[0], x[1], x[2], x[3]);
}

PairSearch::PairSearch(const ContactWorld& world) : world_(world) {
  cloth_.surface = world.cloth;
  obstacles_.resize(world.obstacles.size());
  for (std::size_t k = 0; k < world.obstacles.size(); ++k) {
    obstacles_[k].surface = world.obstacles[k];
    obstacles_[k].first_node = world.first_node[k];
  }
}

void PairSearch::update(Part& part, const Points& x0, const Points& x1, double radius) {
  const auto from = x0.middleRows(part.first_node, part.surface->vertex_count);
  const auto to = x1.middleRows(part.first_node, part.surface->vertex_count);
  if (part.radius == radius && part.from == from && part.to == to) return;
  part.radius = radius;
  part.from = from;
  part.to = to;
  vertex_boxes(part.from, part.to, radius / 2, part.vertex_boxes);
  edge_boxes(*part.surface, part.vertex_boxes, part.edge_boxes);
  triangle_boxes(*part.surface, part.vertex_boxes, part.triangle_boxes);
  if (selvedge::update(part.tree, part.triangle_boxes)) {
    part.vertices.share_out(part.tree.bvh, part.surface->triangles, part.surface->vertex_owner);
    part.edges.share_out(part.tree.bvh, part.surface->triangle_edges, part.surface->edge_owner);
  }
  part.vertices.set_boxes(part.vertex_boxes);
  part.edges.set_boxes(part.edge_boxes);
}

void PairSearch::find(const Points& x0, const Points& x1, double radius, std::vector<NodePair>& pairs) {
  pairs.clear();
  update(cloth_, x0, x1, radius);
  const auto side = [](const Part& p) { return Side{*p.surface, p.first_node, p.tree.bvh, p.vertices, p.edges}; };
  const Side cloth = side(cloth_);
  const Motion motion(x0, x1, radius);
  if (world_.self)
    gather(BvhTraversal{cloth.bvh, cloth.bvh, true}, scratch_, pairs, LeafPairs{cloth, cloth, true, motion});
  for (Part& obstacle : obstacles_) {
    update(obstacle, x0, x1, radius);
    const Side body = side(obstacle);
    gather(BvhTraversal{cloth.bvh, body.bvh, false}, scratch_, pairs, LeafPairs{cloth, body, false, motion});
  }
  if (left_out_)
    std::erase_if(pairs, [this](const NodePair& pair) { return left_out_->leaves_alone(world_, pair.nodes); });
}

}  // namespace selvedge
