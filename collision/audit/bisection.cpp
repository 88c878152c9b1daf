#include "collision/audit/bisection.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <numeric>
#include <utility>

namespace selvedge {
namespace {

constexpr std::size_t few = 40;
// A cell is not cut if its halves together would hold more than this many times its boxes.
constexpr double too_many = 1.6;

struct Boxes {
  std::span<const ExactBox> first, second;
  bool within_first;

  bool has_pair(const Cell& r) const {
    return (within_first && r.first.size() > 1) || (!r.first.empty() && !r.second.empty());
  }
};

struct Spread {
  double width, middle;
  int axis;
};

// Extent and mean of the box centres along each axis, widest first.
std::array<Spread, 3> spreads(const Boxes& boxes, const Cell& r) {
  std::array<Spread, 3> result;
  for (int k = 0; k < 3; ++k) {
    double lo = std::numeric_limits<double>::max(), hi = -lo, sum = 0;
    const auto add = [&](const ExactBox& box) {
      const double centre = 0.5 * box.lo[k] + 0.5 * box.hi[k];
      lo = std::min(lo, centre);
      hi = std::max(hi, centre);
      sum += centre;
    };
    for (int i : r.first) add(boxes.first[i]);
    for (int i : r.second) add(boxes.second[i]);
    result[k] = {hi - lo, sum / static_cast<double>(r.first.size() + r.second.size()), k};
  }
  std::stable_sort(result.begin(), result.end(), [](const Spread& a, const Spread& b) { return a.width > b.width; });
  return result;
}

void distribute(std::span<const ExactBox> boxes, const std::vector<int>& items, const Spread& cut,
                std::vector<int>& lower, std::vector<int>& upper) {
  for (int i : items) {
    if (boxes[i].lo[cut.axis] < cut.middle) lower.push_back(i);
    if (boxes[i].hi[cut.axis] >= cut.middle) upper.push_back(i);
  }
}

// Cuts `whole` across the widest axis that helps; false if none does.
bool halve(const Boxes& boxes, const Cell& whole, Cell& lower, Cell& upper) {
  const std::size_t count = whole.first.size() + whole.second.size();
  if (count <= few) return false;
  for (const Spread& cut : spreads(boxes, whole)) {
    lower = upper = Cell{whole.bounds, {}, {}};
    lower.bounds.hi[cut.axis] = upper.bounds.lo[cut.axis] = cut.middle;
    distribute(boxes.first, whole.first, cut, lower.first, upper.first);
    distribute(boxes.second, whole.second, cut, lower.second, upper.second);
    const std::size_t below = lower.first.size() + lower.second.size(),
                      above = upper.first.size() + upper.second.size();
    if (below < count && above < count && static_cast<double>(below + above) < too_many * static_cast<double>(count))
      return true;
  }
  return false;
}

std::vector<int> count_up(std::size_t count) {
  std::vector<int> all(count);
  std::iota(all.begin(), all.end(), 0);
  return all;
}

// Cuts the cell until cutting does not pay any more, or until there are `enough` parts. Parts without a possible pair
// are dropped.
std::vector<Cell> cut(const Boxes& boxes, Cell whole, std::size_t enough) {
  std::vector<Cell> open{std::move(whole)}, next, finished;
  while (!open.empty() && open.size() < enough) {
    next.clear();
    for (Cell& cell : open) {
      if (!boxes.has_pair(cell)) continue;
      Cell lower, upper;
      if (halve(boxes, cell, lower, upper)) {
        next.push_back(std::move(lower));
        next.push_back(std::move(upper));
      } else {
        finished.push_back(std::move(cell));
      }
    }
    open.swap(next);
  }
  finished.insert(finished.end(), std::make_move_iterator(open.begin()), std::make_move_iterator(open.end()));
  return finished;
}

}  // namespace

ExactBox box_of(const Surface& surface, const Points& x, int triangle, double margin) {
  const int* v = surface.triangles.data() + 3 * triangle;
  ExactBox box;
  for (int k = 0; k < 3; ++k) {
    const auto [lo, hi] = std::minmax({x(v[0], k), x(v[1], k), x(v[2], k)});
    box.lo[k] = lo - margin;
    box.hi[k] = hi + margin;
  }
  return box;
}

ExactBox hull_of(std::span<const ExactBox> boxes) {
  ExactBox hull{{endless, endless, endless}, {-endless, -endless, -endless}};
  for (const ExactBox& box : boxes)
    for (int k = 0; k < 3; ++k) {
      hull.lo[k] = std::min(hull.lo[k], box.lo[k]);
      hull.hi[k] = std::max(hull.hi[k], box.hi[k]);
    }
  return hull;
}

bool overlap(const ExactBox& a, const ExactBox& b) {
  bool meet = true;
  for (int k = 0; k < 3; ++k) meet &= (a.lo[k] <= b.hi[k]) & (b.lo[k] <= a.hi[k]);
  return meet;
}

Sweep::Sweep(std::span<const ExactBox> boxes, std::span<const int> items, int along) : axis(along) {
  entries.reserve(items.size());
  for (const int item : items) entries.push_back({boxes[item], item});
  std::sort(entries.begin(), entries.end(), [along](const Entry& a, const Entry& b) {
    return a.box.lo[along] < b.box.lo[along] || (a.box.lo[along] == b.box.lo[along] && a.item < b.item);
  });
}

int sweep_axis(const Cell& cell, std::span<const ExactBox> first) {
  int best = 0;
  double widest = -1;
  for (int k = 0; k < 3; ++k) {
    double lo = endless, hi = -endless, extent = 0;
    for (const int i : cell.first) {
      lo = std::min(lo, first[i].lo[k]);
      hi = std::max(hi, first[i].hi[k]);
      extent += first[i].hi[k] - first[i].lo[k];
    }
    const double spread = extent > 0 ? (hi - lo) / extent : hi > lo ? endless : 0;
    if (spread > widest) {
      widest = spread;
      best = k;
    }
  }
  return best;
}

std::vector<Cell> bisect(std::span<const ExactBox> first, std::span<const ExactBox> second, bool within_first) {
  const Boxes boxes{first, second, within_first};
  // First cuts a few parts, then cuts these in parallel: the cells do not depend on the number of threads.
  std::vector<Cell> parts = cut(boxes, {everywhere, count_up(first.size()), count_up(second.size())}, 32);
  const int count = static_cast<int>(parts.size());
  std::vector<std::vector<Cell>> cut_up(parts.size());
#pragma omp parallel for schedule(dynamic)
  for (int p = 0; p < count; ++p) cut_up[p] = cut(boxes, std::move(parts[p]), std::numeric_limits<std::size_t>::max());
  std::vector<Cell> finished;
  for (std::vector<Cell>& some : cut_up)
    finished.insert(finished.end(), std::make_move_iterator(some.begin()), std::make_move_iterator(some.end()));
  return finished;
}

}  // namespace selvedge
