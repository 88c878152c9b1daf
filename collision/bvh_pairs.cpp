#include <algorithm>
#include <numeric>

#include "collision/bvh.hpp"

namespace selvedge {
namespace {

using Pairs = std::vector<std::pair<int, int>>;

// All pairs of an item below node a of the first tree with one below node b of the second; within one tree a == b
// stands for the pairs below that node.
struct Work {
  int a, b;
};

struct Traversal {
  const Bvh& first;
  const Bvh& second;
  bool within_one;

  bool is_self(Work w) const { return within_one && w.a == w.b; }
  bool is_leaf(Work w) const {
    return is_self(w) ? first.nodes[w.a].left < 0 : first.nodes[w.a].left < 0 && second.nodes[w.b].left < 0;
  }

  // The one rule of descent. Appends the parts of w, which is no leaf, that may hold overlapping pairs.
  void split(Work w, std::vector<Work>& out) const {
    const Bvh::Node &a = first.nodes[w.a], &b = second.nodes[w.b];
    const auto add = [&](int i, int j) {
      if (overlap(first.nodes[i].box, second.nodes[j].box)) out.push_back({i, j});
    };
    if (is_self(w)) {
      out.push_back({a.left, a.left});
      out.push_back({a.right, a.right});
      add(a.left, a.right);
    } else if (b.left < 0) {
      add(a.left, w.b);
      add(a.right, w.b);
    } else if (a.left < 0) {
      add(w.a, b.left);
      add(w.a, b.right);
    } else {
      add(a.left, b.left);
      add(a.left, b.right);
      add(a.right, b.left);
      add(a.right, b.right);
    }
  }

  void collect(Work root, Pairs& pairs) const {
    std::vector<Work> stack{root};
    while (!stack.empty()) {
      const Work w = stack.back();
      stack.pop_back();
      if (!is_leaf(w)) {
        split(w, stack);
      } else if (!is_self(w)) {
        const int i = ~first.nodes[w.a].left, j = ~second.nodes[w.b].left;
        within_one ? pairs.emplace_back(std::min(i, j), std::max(i, j)) : pairs.emplace_back(i, j);
      }
    }
  }
};

// Enough parts to share out evenly, found by a rule that knows nothing of threads.
std::vector<Work> frontier(const Traversal& traversal, Work root) {
  constexpr std::size_t enough = 256;
  std::vector<Work> front{root}, next;
  for (bool grows = true; grows && front.size() < enough; front.swap(next)) {
    next.clear();
    grows = false;
    for (const Work w : front) {
      if (traversal.is_leaf(w)) {
        next.push_back(w);
      } else {
        traversal.split(w, next);
        grows = true;
      }
    }
  }
  return front;
}

void all_pairs(const Traversal& traversal, Pairs& pairs) {
  const std::vector<Work> front = frontier(traversal, {0, 0});
  const int count = static_cast<int>(front.size());
  std::vector<Pairs> found(front.size());
#pragma omp parallel for schedule(dynamic, 1)
  for (int i = 0; i < count; ++i) traversal.collect(front[i], found[i]);
  const std::size_t total = std::accumulate(found.begin(), found.end(), std::size_t{0},
                                            [](std::size_t sum, const Pairs& part) { return sum + part.size(); });
  pairs.clear();
  pairs.reserve(total);
  for (const Pairs& part : found) pairs.insert(pairs.end(), part.begin(), part.end());
}

}  // namespace

void self_pairs(const Bvh& tree, Pairs& pairs) {
  pairs.clear();
  if (tree.item_count > 1) all_pairs({tree, tree, true}, pairs);
}

void cross_pairs(const Bvh& a, const Bvh& b, Pairs& pairs) {
  pairs.clear();
  if (a.item_count > 0 && b.item_count > 0 && overlap(a.nodes.front().box, b.nodes.front().box))
    all_pairs({a, b, false}, pairs);
}

}  // namespace selvedge
