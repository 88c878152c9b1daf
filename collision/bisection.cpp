#include "collision/bisection.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

namespace selvedge {
namespace {

constexpr std::size_t few = 40;
// Halves that together hold more than this many times the boxes of the whole are not worth it.
constexpr double too_many = 1.6;

struct Boxes {
  std::span<const ExactBox> first, second;
  bool within_first;

  bool has_pair(const Region& r) const {
    return (within_first && r.first.size() > 1) || (!r.first.empty() && !r.second.empty());
  }
};

struct Spread {
  double width, middle;
  int axis;
};

// Extent and mean of the box centres along each axis, widest first.
std::array<Spread, 3> spreads(const Boxes& boxes, const Region& r) {
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
bool halve(const Boxes& boxes, const Region& whole, Region& lower, Region& upper) {
  const std::size_t count = whole.first.size() + whole.second.size();
  if (count <= few) return false;
  for (const Spread& cut : spreads(boxes, whole)) {
    lower = upper = Region{whole.bounds, {}, {}};
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

}  // namespace

std::vector<Region> bisect(std::span<const ExactBox> first, std::span<const ExactBox> second, bool within_first) {
  const Boxes boxes{first, second, within_first};
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const ExactBox space{{-infinity, -infinity, -infinity}, {infinity, infinity, infinity}};
  std::vector<Region> stack{{space, count_up(first.size()), count_up(second.size())}}, finished;
  while (!stack.empty()) {
    const Region region = std::move(stack.back());
    stack.pop_back();
    if (!boxes.has_pair(region)) continue;
    Region lower, upper;
    if (halve(boxes, region, lower, upper)) {
      stack.push_back(std::move(upper));
      stack.push_back(std::move(lower));
    } else {
      finished.push_back(region);
    }
  }
  return finished;
}

}  // namespace selvedge
