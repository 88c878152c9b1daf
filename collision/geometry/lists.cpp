#include "collision/geometry/lists.hpp"

#include <numeric>

namespace selvedge {

IndexLists indices_by_value(std::span<const int> values, int count) {
  IndexLists by{std::vector<int>(static_cast<std::size_t>(count) + 1, 0), {}};
  for (const int value : values)
    if (value >= 0) ++by.begin[value + 1];
  std::partial_sum(by.begin.begin(), by.begin.end(), by.begin.begin());
  by.item.resize(by.begin.back());
  std::vector<int> next(by.begin.begin(), by.begin.end() - 1);
  for (std::size_t i = 0; i < values.size(); ++i)
    if (values[i] >= 0) by.item[next[values[i]]++] = static_cast<int>(i);
  return by;
}

}  // namespace selvedge
