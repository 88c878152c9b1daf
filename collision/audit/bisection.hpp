#pragma once

#include <array>
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

// A cell of space with the boxes that touch it. A pair of boxes belongs to the cell that holds the lowest corner of
// their common part, so that each pair is visited once.
struct Cell {
  ExactBox bounds;  // half-open: lo <= p < hi
  std::vector<int> first, second;
};

// Halves space until each cell has few boxes or halving no longer helps. Cells without a possible pair are left out: a
// pair is two of `first` (where within_first), or one of `first` and one of `second`.
std::vector<Cell> bisect(std::span<const ExactBox> first, std::span<const ExactBox> second, bool within_first);

// How many pairs an audit may look at. The audit also ends where the stop flag of the thread's scope says so.
class AuditBudget {
 public:
  explicit AuditBudget(std::int64_t triangles) : pairs_(triangles) {}
  bool add(std::int64_t pairs) { return pairs_.add(pairs) && !stop_.wanted(); }
  bool exceeded() const { return pairs_.exceeded() || stop_.was_wanted(); }
  // Throws Stopped or TooManyPairs if the audit has to end.
  void check() const {
    stop_.check();
    pairs_.check();
  }

 private:
  PairBudget pairs_;
  StopPoll stop_;
};

// Visits the pairs that belong to the cell: self(a, b) for two of `first` (where within_first), other(a, c) for one of
// `first` and one of `second`. Boxes are those given to bisect. Each pair takes one from the budget, and so do eight
// comparisons of boxes. Once the budget is spent, here or on another thread, some pairs are not visited.
template <typename Self, typename Other>
void visit_pairs(const Cell& cell, std::span<const ExactBox> first, std::span<const ExactBox> second, bool within_first,
                 AuditBudget& budget, Self&& self, Other&& other);

// Joins what was found in each cell, list by list.
template <typename Found, typename... Lists>
Found joined(const std::vector<Found>& parts, Lists... lists) {
  Found all;
  const auto append = [&](const Found& part, auto list) {
    (all.*list).insert((all.*list).end(), (part.*list).begin(), (part.*list).end());
  };
  for (const Found& part : parts) (append(part, lists), ...);
  return all;
}

// Copies of a cell's boxes, in the order of their lower ends along an axis.
struct Sweep {
  struct Entry {
    ExactBox box;
    int item;
  };
  std::vector<Entry> entries;
  int axis;

  Sweep(std::span<const ExactBox> boxes, std::span<const int> items, int axis);

  // Calls visit(item) for the entries from index `from` on that overlap the box, if the pair belongs to the cell with
  // these bounds. Returns how many were compared.
  template <typename Visit>
  std::size_t overlapping(std::size_t from, const ExactBox& box, const ExactBox& bounds, Visit&& visit) const {
    std::size_t i = from;
    for (; i < entries.size() && entries[i].box.lo[axis] <= box.hi[axis]; ++i)
      if (meet_in(bounds, box, entries[i].box)) visit(entries[i].item);
    return i - from;
  }

 private:
  // Do boxes a and b overlap, and does the pair belong within the bounds? Without branches.
  static bool meet_in(const ExactBox& bounds, const ExactBox& a, const ExactBox& b) {
    bool meet = true;
    for (int k = 0; k < 3; ++k) {
      const double lo = a.lo[k] > b.lo[k] ? a.lo[k] : b.lo[k];
      meet &= (lo <= a.hi[k]) & (lo <= b.hi[k]) & (lo >= bounds.lo[k]) & (lo < bounds.hi[k]);
    }
    return meet;
  }
};

// The axis along which the boxes of a cell are spread the widest, in units of their own extent.
int sweep_axis(const Cell&, std::span<const ExactBox> first);

template <typename Self, typename Other>
void visit_pairs(const Cell& cell, std::span<const ExactBox> first, std::span<const ExactBox> second, bool within_first,
                 AuditBudget& budget, Self&& self, Other&& other) {
  const int axis = sweep_axis(cell, first);
  const Sweep mine(first, cell.first, axis), theirs(second, cell.second, axis);
  constexpr std::int64_t reported_at_once = 1 << 12;
  std::int64_t unreported = 0;  // not yet reported to the budget
  for (std::size_t i = 0; i < mine.entries.size(); ++i) {
    const Sweep::Entry& a = mine.entries[i];
    std::size_t compared = 0;
    if (within_first)
      compared += mine.overlapping(i + 1, a.box, cell.bounds, [&](int b) {
        ++unreported;
        self(a.item, b);
      });
    compared += theirs.overlapping(0, a.box, cell.bounds, [&](int c) {
      ++unreported;
      other(a.item, c);
    });
    unreported += static_cast<std::int64_t>(compared / 8);
    if (unreported >= reported_at_once && !budget.add(std::exchange(unreported, 0))) return;
  }
  budget.add(unreported);
}

}  // namespace selvedge
