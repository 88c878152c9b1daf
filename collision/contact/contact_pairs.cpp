#include "collision/contact/contact_pairs.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "collision/contact/exemption.hpp"
#include "collision/contact/pair_motion.hpp"

namespace selvedge {
namespace {

// Primitives that a leaf of a tree owns, with boxes; for fast motion also with boxes at both ends.
struct Group {
  const Bvh::Leaf& leaf;
  const Bvh::Leaf *start = nullptr, *end = nullptr;

  // One bit for each item of the other group: 1 if item i may come near it.
  unsigned near(int i, const Group& other) const {
    const unsigned bits = overlaps(other.leaf, box_of(leaf, i));
    return bits == 0 || !start ? bits
                               : bits & ~apart_in_order(*other.start, *other.end, {box_of(*start, i), box_of(*end, i)});
  }
};

// A surface that takes part in a search. Without `node_ends` there are no boxes at both ends; without `marks` every
// node is visited.
struct Side {
  const SearchPart& part;
  const EndBoxes* node_ends;
  const char* marks;

  const Surface& surface() const { return *part.surface; }
  int first_node() const { return part.first_node; }
  const Bvh& bvh() const { return part.tree.bvh; }
  Group group(const Bvh::Leaf& leaf, const EndLeaves& ends, int at) const {
    return node_ends ? Group{leaf, &ends.start[at], &ends.end[at]} : Group{leaf};
  }
  Group faces(int leaf) const { return group(bvh().leaves[leaf], part.face_ends, leaf); }
  template <class Visit>
  void for_each_group(const PrimitiveGroups& all, int first, int last, Visit&& visit) const {
    for (int g = first; g < last; ++g) visit(group(all.groups[g], all.ends, g));
  }
};

// Calls visit(i, j) for the places i in a and j in b whose items may come near. box_b is round all of b.
template <class Visit>
[[gnu::always_inline]] inline void for_each_near(const Group& a, const Group& b, const Box& box_b, Visit&& visit) {
  for (unsigned from = overlaps(a.leaf, box_b); from != 0; from &= from - 1) {
    const int i = std::countr_zero(from);
    for (unsigned bits = a.near(i, b); bits != 0; bits &= bits - 1) visit(i, std::countr_zero(bits));
  }
}

// Which of the pairs with overlapping boxes a search lists.
struct Wanted {
  const ContactWorld& world;
  const std::vector<char>& marks;  // by node: only pairs with a marked one; empty: all pairs
  const Exemption* left_out;       // may be null
  const PairMotion* motion;        // only pairs that may come within `reach`; null: all pairs
  const Points& x0;
  double reach;

  void add(const NodePair& pair, FoundPairs& found) const {
    ++found.overlapping;
    if (!marks.empty() && std::ranges::none_of(pair.nodes, [&](int node) { return marks[node] != 0; })) return;
    if (left_out && left_out->leaves_alone(world, pair.nodes)) return;
    if (!motion) return found.pairs.push_back(pair);
    found.untested[found.untested_count++] = pair;
    if (found.untested_count == PairLanes::width) test(found);
  }
  // Lists those of the untested pairs that may come near.
  void test(FoundPairs& found) const {
    PairLanes lanes;
    for (int i = 0; i < found.untested_count; ++i) lanes.set(i, found.untested[i], x0, motion->displacements());
    std::array<float, PairLanes::width> gaps;
    const unsigned away = pair_kernels().stays_away(lanes, reach + motion->rounding(), gaps.data());
    for (int i = 0; i < found.untested_count; ++i) {
      if (away >> i & 1) continue;
      found.gap.push_back(gaps[i]);
      found.pairs.push_back(found.untested[i]);
    }
    found.untested_count = 0;
  }
};

struct LeafPairs {
  const Side &a, &b;
  bool same;  // both sides are one surface: primitives that share a vertex are no pair
  const Wanted& wanted;

  void vertex_face(const Side& p, int v, const Side& f, int face, FoundPairs& found) const {
    const int* n = f.surface().triangles.data() + 3 * face;
    if (same && (v == n[0] || v == n[1] || v == n[2])) return;
    wanted.add({PairKind::vertex_face,
                {v + p.first_node(), n[0] + f.first_node(), n[1] + f.first_node(), n[2] + f.first_node()}},
               found);
  }
  void edge_edge(int ea, int eb, FoundPairs& found) const {
    if (same && eb < ea) std::swap(ea, eb);
    const int *m = a.surface().edges.data() + 2 * ea, *n = b.surface().edges.data() + 2 * eb;
    if (same && (m[0] == n[0] || m[0] == n[1] || m[1] == n[0] || m[1] == n[1])) return;
    wanted.add({PairKind::edge_edge,
                {m[0] + a.first_node(), m[1] + a.first_node(), n[0] + b.first_node(), n[1] + b.first_node()}},
               found);
  }
  void vertices_with_faces(const Side& p, int leaf_p, const Side& f, int leaf_f, const Box& box_f,
                           FoundPairs& found) const {
    const Group faces = f.faces(leaf_f);
    p.for_each_group(
        p.part.vertices, p.part.vertices.begin[leaf_p], p.part.vertices.begin[leaf_p + 1], [&](const Group& group) {
          for_each_near(group, faces, box_f,
                        [&](int i, int j) { vertex_face(p, group.leaf.item[i], f, faces.leaf.item[j], found); });
        });
  }
  void edges_with_edges(const Group& first, int from, int to, const Box& box_b, FoundPairs& found) const {
    b.for_each_group(b.part.edges, from, to, [&](const Group& second) {
      for_each_near(first, second, box_b,
                    [&](int i, int j) { edge_edge(first.leaf.item[i], second.leaf.item[j], found); });
    });
  }
  void edges_with_edges(int leaf_a, int leaf_b, const Box& box_b, FoundPairs& found) const {
    a.for_each_group(a.part.edges, a.part.edges.begin[leaf_a], a.part.edges.begin[leaf_a + 1], [&](const Group& first) {
      edges_with_edges(first, b.part.edges.begin[leaf_b], b.part.edges.begin[leaf_b + 1], box_b, found);
    });
  }
  void edges_within(int leaf, const Box& box, FoundPairs& found) const {
    int next = a.part.edges.begin[leaf];
    const int last = a.part.edges.begin[leaf + 1];
    a.for_each_group(a.part.edges, next, last, [&](const Group& own) {
      for (int i = 0; i < Bvh::leaf_size && own.leaf.item[i] >= 0; ++i)
        for (unsigned bits = own.near(i, own) & (~1u << i); bits != 0; bits &= bits - 1)
          edge_edge(own.leaf.item[i], own.leaf.item[std::countr_zero(bits)], found);
      edges_with_edges(own, ++next, last, box, found);
    });
  }
  std::int64_t operator()(NodeWork w, FoundPairs& found) const {
    const std::int64_t before = found.overlapping;
    const Bvh::Node &node_a = a.bvh().nodes[w.a], &node_b = b.bvh().nodes[w.b];
    vertices_with_faces(a, ~node_a.child, b, ~node_b.child, node_b.box, found);
    if (same && w.a == w.b) {
      edges_within(~node_a.child, node_a.box, found);
    } else {
      vertices_with_faces(b, ~node_b.child, a, ~node_a.child, node_a.box, found);
      edges_with_edges(~node_a.child, ~node_b.child, node_b.box, found);
    }
    return found.overlapping - before;
  }
};

// Appends what a part has found. The next search uses its memory again, unless that is large.
void take(FoundPairs& found, std::vector<NodePair>& pairs, std::vector<double>& gap) {
  constexpr std::size_t small = 4096;
  pairs.insert(pairs.end(), found.pairs.begin(), found.pairs.end());
  gap.insert(gap.end(), found.gap.begin(), found.gap.end());
  if (found.pairs.capacity() > small) found = {};
}

}  // namespace

PairSearch::PairSearch(const ContactWorld& world) : world_(world), cloth_(*world.cloth, 0) {
  for (std::size_t k = 0; k < world.obstacles.size(); ++k)
    obstacles_.emplace_back(*world.obstacles[k], world.first_node[k]);
}

// Leaves that a traversal may come to have boxes of their vertices and edges: of two that overlap one is marked.
void PairSearch::fill(bool only_marked, Among among) {
  const auto box = [](const SearchPart& part, int node) { return part.tree.bvh.nodes[node].box; };
  cloth_.fill([&](int node) {
    const bool near_marked = only_marked && !cloth_.marks[node];
    if (among != Among::obstacles && (!near_marked || meets(cloth_, box(cloth_, node), true))) return true;
    return among != Among::cloth && std::ranges::any_of(obstacles_, [&](const SearchPart& obstacle) {
             return meets(obstacle, box(cloth_, node), near_marked);
           });
  });
  if (among == Among::cloth) return;
  for (SearchPart& obstacle : obstacles_)
    obstacle.fill([&](int node) { return meets(cloth_, box(obstacle, node), only_marked && !obstacle.marks[node]); });
}

void PairSearch::prepare(const Points& x0, const Points& x1, double radius, bool ends, const std::vector<char>& marks,
                         Among among) {
  const auto move = [&](SearchPart& part) {
    part.move(x0, x1, radius, ends);
    if (!marks.empty()) part.mark(marks);
  };
  move(cloth_);
  if (among != Among::cloth) std::ranges::for_each(obstacles_, move);
  fill(!marks.empty(), among);
}

void PairSearch::collect(const Points& x0, const Points& x1, double radius, const PairMotion* motion,
                         std::vector<NodePair>& pairs, std::vector<double>& gap, const std::vector<char>& marks,
                         Among among) {
  pairs.clear();
  gap.clear();
  // Boxes at both ends separate more pairs than boxes of whole motions only where motions are longer than the radius.
  const bool ends = !((x1 - x0).rowwise().squaredNorm().maxCoeff() <= radius * radius);
  prepare(x0, x1, radius, ends, marks, among);
  const auto side = [&](const SearchPart& p) {
    return Side{p, ends ? p.node_ends.data() : nullptr, marks.empty() ? nullptr : p.marks.data()};
  };
  const Side cloth = side(cloth_);
  const Wanted wanted{world_, marks, left_out_, motion, x0, radius};
  std::int64_t overlapping = 0;
  const auto gather_with = [&](const Side& other, bool same) {
    const int parts = visit_in_parts(BvhTraversal{cloth.bvh(), other.bvh(), same, nullptr, cloth.node_ends,
                                                  other.node_ends, cloth.marks, other.marks},
                                     scratch_, LeafPairs{cloth, other, same, wanted});
    std::size_t found = pairs.size();
    for (int i = 0; i < parts; ++i) {
      if (scratch_[i].untested_count > 0) wanted.test(scratch_[i]);
      found += scratch_[i].pairs.size();
    }
    pairs.reserve(found);
    if (motion) gap.reserve(found);
    for (int i = 0; i < parts; ++i) {
      overlapping += scratch_[i].overlapping;
      take(scratch_[i], pairs, gap);
    }
  };
  try {
    if (world_.self && among != Among::obstacles) gather_with(cloth, true);
    if (among != Among::cloth)
      for (const SearchPart& obstacle : obstacles_) gather_with(side(obstacle), false);
  } catch (const TooManyPairs&) {
    std::vector<NodePair>().swap(pairs);
    std::vector<double>().swap(gap);
    throw;
  }
  ++tally_.searches;
  tally_.candidates += overlapping;
}

void PairSearch::find(const Points& x0, const Points& x1, double radius, std::vector<NodePair>& pairs,
                      const std::vector<char>& marks) {
  std::vector<double> none;
  collect(x0, x1, radius, nullptr, pairs, none, marks, Among::all);
}

void PairSearch::find_near(const Points& x0, const Points& x1, double radius, std::vector<NodePair>& pairs,
                           std::vector<double>& gap, const std::vector<char>& marks, Among among) {
  const PairMotion motion(x0, x0, x1);
  collect(x0, x1, radius, &motion, pairs, gap, marks, among);
}

double rest_distance(const ContactWorld& world, const NodePair& pair) {
  const auto in_cloth = [&](int node) { return world.is_cloth(node); };
  if (!world.rest || !std::all_of(pair.nodes.begin(), pair.nodes.end(), in_cloth) ||
      world.cloth->component[pair.nodes[0]] != world.cloth->component[pair.nodes[3]])
    return std::numeric_limits<double>::infinity();
  return std::sqrt(closest(pair, *world.rest).squared_distance);
}

}  // namespace selvedge
