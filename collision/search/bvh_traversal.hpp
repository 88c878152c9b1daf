#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <utility>
#include <vector>

#include "collision/geometry/pair_budget.hpp"
#include "collision/geometry/parallel.hpp"
#include "collision/search/bvh.hpp"

namespace selvedge {

// Stands for all pairs of an item below node a of the first tree with one below node b of the second. Within one tree a
// == b stands for the pairs of items below that node.
struct NodeWork {
  int a, b;
};

// The boxes of a node or item at both ends of its motion; the tree itself has boxes of the whole motion.
struct EndBoxes {
  Box start, end;
};

// Boxes of whole motions overlap where items move by many times their size. Two items that move along together are told
// apart by an axis along which their boxes are apart at the start and at the end, in the same order: as motions are
// straight, they then are apart all the way.
[[gnu::always_inline]] inline bool apart_in_order(const EndBoxes& a, const EndBoxes& b) {
  bool apart = false;
  for (int k = 0; k < 3; ++k)
    apart |= ((a.start.hi[k] < b.start.lo[k]) & (a.end.hi[k] < b.end.lo[k])) |
             ((b.start.hi[k] < a.start.lo[k]) & (b.end.hi[k] < a.end.lo[k]));
  return apart;
}

// A simultaneous traversal of two trees, or of one tree with itself (first and second are the same). The optional
// members leave pairs out. `quiet`: pairs of items below one marked node. `first_ends`, `second_ends`: nodes that are
// apart in order by these boxes. `first_marks`, `second_marks`: pairs of nodes of which neither is marked.
struct BvhTraversal {
  const Bvh& first;
  const Bvh& second;
  bool within_one;
  const std::vector<char>* quiet = nullptr;
  const EndBoxes *first_ends = nullptr, *second_ends = nullptr;  // by node
  const char *first_marks = nullptr, *second_marks = nullptr;

  bool is_self(NodeWork w) const { return within_one && w.a == w.b; }
  bool is_leaf(NodeWork w) const { return first.nodes[w.a].child < 0 && second.nodes[w.b].child < 0; }
  bool is_quiet(NodeWork w) const { return quiet && is_self(w) && (*quiet)[w.a]; }
  bool is_marked(NodeWork w) const { return !first_marks || first_marks[w.a] || second_marks[w.b]; }
  const Bvh::Leaf& leaf_a(NodeWork w) const { return first.leaves[~first.nodes[w.a].child]; }
  const Bvh::Leaf& leaf_b(NodeWork w) const { return second.leaves[~second.nodes[w.b].child]; }

  // The rule of descent. w is not a pair of leaves. Appends the parts of w that may hold overlapping pairs.
  void split(NodeWork w, std::vector<NodeWork>& out) const {
    const Bvh::Node &a = first.nodes[w.a], &b = second.nodes[w.b];
    const auto add = [&](int i, int j) {
      if (overlap(first.nodes[i].box, second.nodes[j].box) &&
          !(first_ends && apart_in_order(first_ends[i], second_ends[j])) && is_marked({i, j}))
        out.push_back({i, j});
    };
    if (is_self(w)) {
      if (is_quiet(w)) return;
      for (const int child : {a.child, a.child + 1})
        if (is_marked({child, child})) out.push_back({child, child});
      add(a.child, a.child + 1);
    } else if (b.child < 0) {
      add(a.child, w.b);
      add(a.child + 1, w.b);
    } else if (a.child < 0) {
      add(w.a, b.child);
      add(w.a, b.child + 1);
    } else {
      add(a.child, b.child);
      add(a.child, b.child + 1);
      add(a.child + 1, b.child);
      add(a.child + 1, b.child + 1);
    }
  }

  // Splits the traversal into enough parts to share them out evenly. They do not depend on the number of threads.
  std::vector<NodeWork> frontier() const;
};

// Turns comparisons of both halves of a leaf into one bit for each lane.
using LaneFlags [[gnu::vector_size(16)]] = int;
[[gnu::always_inline]] inline unsigned bits_of(LaneFlags first, LaneFlags second) {
  constexpr LaneFlags low{1, 2, 4, 8}, high{16, 32, 64, 128};
  const LaneFlags bits = (first & low) | (second & high);
  return static_cast<unsigned>(bits[0] | bits[1] | bits[2] | bits[3]);
}

// One bit for each item of the leaf: 1 where its box overlaps `box`.
[[gnu::always_inline]] inline unsigned overlaps(const Bvh::Leaf& leaf, const Box& box) {
  const auto half = [&](int h) {
    return (leaf.lo[0][h] <= box.hi[0]) & (leaf.hi[0][h] >= box.lo[0]) & (leaf.lo[1][h] <= box.hi[1]) &
           (leaf.hi[1][h] >= box.lo[1]) & (leaf.lo[2][h] <= box.hi[2]) & (leaf.hi[2][h] >= box.lo[2]);
  };
  return bits_of(half(0), half(1));
}

inline Box box_of(const Bvh::Leaf& leaf, int i) {
  Box box;
  for (int k = 0; k < 3; ++k) {
    box.lo[k] = leaf.lo[k][i / 4][i % 4];
    box.hi[k] = leaf.hi[k][i / 4][i % 4];
  }
  return box;
}

// Calls visit(i, j) for the places i in a and j in b whose boxes overlap, and returns their number. box_b is round all
// of b.
template <class Visit>
[[gnu::always_inline]] inline int for_each_overlap(const Bvh::Leaf& a, const Bvh::Leaf& b, const Box& box_b,
                                                   Visit&& visit) {
  int visited = 0;
  for (unsigned from = overlaps(a, box_b); from != 0; from &= from - 1) {
    const int i = std::countr_zero(from);
    for (unsigned bits = overlaps(b, box_of(a, i)); bits != 0; bits &= bits - 1, ++visited)
      visit(i, std::countr_zero(bits));
  }
  return visited;
}

// The same within one leaf, i < j.
template <class Visit>
[[gnu::always_inline]] inline int for_each_overlap(const Bvh::Leaf& a, Visit&& visit) {
  int visited = 0;
  for (int i = 0; i < Bvh::leaf_size && a.item[i] >= 0; ++i)
    for (unsigned bits = overlaps(a, box_of(a, i)) & (~1u << i); bits != 0; bits &= bits - 1, ++visited)
      visit(i, std::countr_zero(bits));
  return visited;
}

// One list for each part of a traversal. Keeping them between calls saves allocations.
template <class Item>
using PartLists = std::vector<std::vector<Item>>;

// Visits all pairs of leaves below `w`. Takes from the budget the pairs that the visits report, and eight more for each
// visit. Returns false if it ended early because the budget was spent.
template <class List, class Visit>
bool visit_below(const BvhTraversal& traversal, NodeWork w, List& list, PairBudget& budget, Visit&& visit) {
  constexpr std::int64_t reported_at_once = 1 << 14;
  std::vector<NodeWork> stack{w};
  std::int64_t unreported = 0;  // not yet reported to the budget
  while (!stack.empty()) {
    w = stack.back();
    stack.pop_back();
    if (!traversal.is_leaf(w)) {
      traversal.split(w, stack);
    } else if (!traversal.is_quiet(w)) {
      unreported += Bvh::leaf_size + visit(w, list);
      if (unreported >= reported_at_once && !budget.add(std::exchange(unreported, 0))) return false;
    }
  }
  return budget.add(unreported);
}

// Calls visit(w, list) for every pair of leaves whose boxes overlap (and every leaf with itself, within one tree), on
// all threads. A visit appends to its list, which has clear(), and returns how many pairs it has looked at. Returns how
// many of the lists it has used: what is in them and in which order depends on the trees alone. Throws TooManyPairs
// (pair_budget.hpp), without lists, where the visits have looked at too many.
template <class List, class Visit>
int visit_in_parts(const BvhTraversal& traversal, std::vector<List>& parts, Visit&& visit) {
  if (traversal.first.item_count == 0 || traversal.second.item_count == 0) return 0;
  const std::vector<NodeWork> front = traversal.frontier();
  const int count = static_cast<int>(front.size());
  if (parts.size() < front.size()) parts.resize(front.size());
  const std::int64_t items =
      traversal.first.item_count + (traversal.within_one ? std::int64_t{0} : traversal.second.item_count);
  PairBudget budget(items);
  parallel_for(count, 1, [&](int i) {
    parts[i].clear();
    visit_below(traversal, front[i], parts[i], budget, visit);
  });
  if (budget.exceeded()) std::vector<List>().swap(parts);
  budget.check();
  return count;
}

// The same with lists that are vectors, which are appended to `out`; `out` is empty where it throws.
template <class Item, class Visit>
void gather(const BvhTraversal& traversal, PartLists<Item>& parts, std::vector<Item>& out, Visit&& visit) {
  int count = 0;
  try {
    count = visit_in_parts(traversal, parts, visit);
  } catch (const TooManyPairs&) {
    std::vector<Item>().swap(out);
    throw;
  }
  std::vector<std::size_t> begin(count + 1, out.size());
  for (int i = 0; i < count; ++i) begin[i + 1] = begin[i] + parts[i].size();
  out.resize(begin[count]);
  parallel_for(count, 8, [&](int i) { std::copy(parts[i].begin(), parts[i].end(), out.data() + begin[i]); });
}

// gather for pairs of items whose boxes overlap: calls test(item of the first tree, item of the second, list).
template <class Item, class Test>
void gather_pairs(const BvhTraversal& traversal, PartLists<Item>& parts, std::vector<Item>& out, const Test& test) {
  gather(traversal, parts, out, [&](NodeWork w, std::vector<Item>& list) {
    const Bvh::Leaf &a = traversal.leaf_a(w), &b = traversal.leaf_b(w);
    const auto visit = [&](int i, int j) { test(a.item[i], b.item[j], list); };
    return traversal.is_self(w) ? for_each_overlap(a, visit)
                                : for_each_overlap(a, b, traversal.second.nodes[w.b].box, visit);
  });
}

}  // namespace selvedge
