#pragma once

#include <algorithm>
#include <span>
#include <vector>

namespace selvedge {

// Lists of numbers, one after the other: list i is item[begin[i] .. begin[i + 1]).
struct IndexLists {
  std::vector<int> begin, item;

  std::span<const int> of(int list) const {
    return {item.data() + begin[list], static_cast<std::size_t>(begin[list + 1] - begin[list])};
  }
};

// For each value 0 .. count - 1 the indices at which it stands in `values`, ascending. Values below 0 are left out.
IndexLists indices_by_value(std::span<const int> values, int count);

// Sorts a list and leaves out repeats.
template <class Item>
void sort_once(std::vector<Item>& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

}  // namespace selvedge
