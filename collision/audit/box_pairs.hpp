#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "collision/geometry/pair_budget.hpp"
#include "collision/geometry/stop_scope.hpp"
#include "collision/geometry/surface.hpp"

namespace selvedge {

// Broad phase of the audit; shares no code with the tree of the solver. Boxes are closed and kept in double as given.
struct ExactBox {
  std::array<double, 3> lo, hi;
};

inline constexpr double endless = std::numeric_limits<double>::infinity();
inline constexpr ExactBox everywhere{{-endless, -endless, -endless}, {endless, endless, endless}};
ExactBox box_of(const Surface&, const Points& x, int triangle, double margin = 0);  // grown by the margin
ExactBox hull_of(std::span<const ExactBox>);  // of no boxes: a box that overlaps nothing

bool overlap(const ExactBox&, const ExactBox&);

// How many pairs an audit may look at. The audit also ends where the stop flag of the thread's scope says so.
class AuditBudget {
 public:
  explicit AuditBudget(std::int64_t triangles) : pairs_(triangles) {}
  bool add(std::int64_t pairs) { return pairs_.add(pairs) && !stop_.wanted(); }
  bool exceeded() const { return pairs_.exceeded() || stop_.was_wanted(); }
  // Throws Stopped or TooManyPairs if the audit has to end.
  void check() {
    stop_.check();
    pairs_.check();
  }

 private:
  PairBudget pairs_;
  StopPoll stop_;
};

// Joins what was found in each part of a search, list by list.
template <typename Found, typename... Lists>
Found joined(const std::vector<Found>& parts, Lists... lists) {
  Found all;
  const auto append = [&](const Found& part, auto list) {
    (all.*list).insert((all.*list).end(), (part.*list).begin(), (part.*list).end());
  };
  for (const Found& part : parts) (append(part, lists), ...);
  return all;
}

// The sides of a box in pairs, for comparisons of two at once: its lower sides, then its upper sides with the other
// sign.
struct BoxSides {
  using Two [[gnu::vector_size(16)]] = double;
  Two first, second, third;

  BoxSides() = default;
  explicit BoxSides(const ExactBox& box)
      : first{box.lo[0], box.lo[1]}, second{box.lo[2], -box.hi[0]}, third{-box.hi[1], -box.hi[2]} {}
};

// What the sides of another box are compared with.
struct FacingSides {
  BoxSides::Two first, second, third;

  explicit FacingSides(const BoxSides& box)
      : first{-box.second[1], -box.third[0]},
        second{-box.third[1], -box.first[0]},
        third{-box.first[1], -box.second[0]} {}
};

[[gnu::always_inline]] inline bool overlap(const BoxSides& a, const FacingSides& b) {
  const auto apart = (a.first > b.first) | (a.second > b.second) | (a.third > b.third);
  return (apart[0] | apart[1]) == 0;
}

// Boxes, halved again and again where their centres are spread the widest, until few are left.
struct BoxTree {
  struct Node {
    BoxSides box;  // round its boxes
    int begin, end;
    int upper;  // the child with the upper half; the other one follows the node. 0: a leaf
  };
  std::vector<Node> nodes;
  std::vector<BoxSides> boxes;  // those of a leaf stand together
  std::vector<int> item;        // the number of each as given

  explicit BoxTree(std::span<const ExactBox>);
};

// Pairs of boxes that overlap: two of `first` (where within_first), or one of `first` and one of `second`. The search
// has parts, which depend on the boxes alone and may be visited on different threads.
class BoxPairs {
 public:
  BoxPairs(std::span<const ExactBox> first, std::span<const ExactBox> second, bool within_first);
  int parts() const { return static_cast<int>(parts_.size()); }

  // Visits the pairs of a part, each once: self(a, b) for two of `first`, other(a, c) for one of `first` and one of
  // `second`. Each pair takes one from the budget, and so do eight comparisons of boxes. Once the budget is spent, here
  // or on another thread, some pairs are not visited.
  template <typename Self, typename Other>
  void visit(int part, AuditBudget& budget, Self&& self, Other&& other) const;

 private:
  // All pairs of a box below node a of `first` with one below node b of `first` (where `within`) or of `second`.
  struct Nodes {
    int a, b;
    bool within;
  };
  const BoxTree::Node& node_a(const Nodes& nodes) const { return first_.nodes[nodes.a]; }
  const BoxTree& tree_b(const Nodes& nodes) const { return nodes.within ? first_ : second_; }
  const BoxTree::Node& node_b(const Nodes& nodes) const { return tree_b(nodes).nodes[nodes.b]; }
  bool are_leaves(const Nodes& nodes) const { return node_a(nodes).upper == 0 && node_b(nodes).upper == 0; }
  void split(const Nodes& nodes, std::vector<Nodes>& to) const;

  // Calls visit for the pairs of two leaves. Returns how many boxes were compared.
  template <typename Visit>
  std::int64_t visit_leaves(const Nodes& nodes, Visit&& visit) const;

  BoxTree first_, second_;
  std::vector<Nodes> parts_;
};

template <typename Visit>
std::int64_t BoxPairs::visit_leaves(const Nodes& nodes, Visit&& visit) const {
  const BoxTree::Node &a = node_a(nodes), &b = node_b(nodes);
  const BoxTree& tree = tree_b(nodes);
  const bool one = nodes.within && nodes.a == nodes.b;
  const FacingSides round_b(b.box);
  std::int64_t compared = a.end - a.begin;
  for (int i = a.begin; i < a.end; ++i) {
    if (!overlap(first_.boxes[i], round_b)) continue;
    const FacingSides mine(first_.boxes[i]);
    const int from = one ? i + 1 : b.begin;
    compared += b.end - from;
    for (int j = from; j < b.end; ++j)
      if (overlap(tree.boxes[j], mine)) visit(first_.item[i], tree.item[j]);
  }
  return compared;
}

template <typename Self, typename Other>
void BoxPairs::visit(int part, AuditBudget& budget, Self&& self, Other&& other) const {
  constexpr std::int64_t reported_at_once = 1 << 12;
  std::int64_t pairs = 0, compared = 0;  // not yet reported to the budget
  std::vector<Nodes> stack{parts_[part]};
  while (!stack.empty()) {
    const Nodes nodes = stack.back();
    stack.pop_back();
    if (!are_leaves(nodes)) {
      split(nodes, stack);
    } else if (nodes.within) {
      compared += visit_leaves(nodes, [&](int a, int b) {
        ++pairs;
        self(a, b);
      });
    } else {
      compared += visit_leaves(nodes, [&](int a, int c) {
        ++pairs;
        other(a, c);
      });
    }
    if (pairs + compared / 8 < reported_at_once) continue;
    if (!budget.add(std::exchange(pairs, 0) + std::exchange(compared, 0) / 8)) return;
  }
  budget.add(pairs + compared / 8);
}

}  // namespace selvedge
