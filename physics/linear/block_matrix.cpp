#include "physics/linear/block_matrix.hpp"

#include <algorithm>
#include <cassert>

#include "collision/geometry/lists.hpp"

namespace selvedge {

PairPattern make_pair_pattern(int rows, std::span<const int> element_begin, std::span<const int> element_nodes) {
  PairPattern pattern;
  pattern.rows = rows;
  for (std::size_t e = 0; e + 1 < element_begin.size(); ++e)
    for (int i = element_begin[e]; i < element_begin[e + 1]; ++i)
      for (int j = i + 1; j < element_begin[e + 1]; ++j) {
        const auto [low, high] = std::minmax({element_nodes[i], element_nodes[j]});
        pattern.pairs.push_back({low, high});
      }
  sort_once(pattern.pairs);

  std::vector<int> ends;
  for (const auto& pair : pattern.pairs) ends.insert(ends.end(), pair.begin(), pair.end());
  IndexLists by = indices_by_value(ends, rows);
  pattern.pairs.shrink_to_fit();
  pattern.column.reserve(by.item.size());
  pattern.pair.reserve(by.item.size());
  // As pairs are ascending, so are the columns of a row.
  for (const int i : by.item) {
    pattern.column.push_back(ends[i ^ 1]);
    pattern.pair.push_back(i / 2);
  }
  pattern.row_begin = std::move(by.begin);
  return pattern;
}

int find_pair(const PairPattern& pattern, int a, int b) {
  const std::array<int, 2> wanted{std::min(a, b), std::max(a, b)};
  const auto found = std::lower_bound(pattern.pairs.begin(), pattern.pairs.end(), wanted);
  assert(found != pattern.pairs.end() && *found == wanted);
  return static_cast<int>(found - pattern.pairs.begin());
}

Vec3 multiply_row(const PairPattern& pattern, const PairBlocks& blocks, const Points& u, int i) {
  Vec3 sum = Vec3::Zero();
  const Vec3 own = row(u, i);
  for (int entry = pattern.row_begin[i]; entry < pattern.row_begin[i + 1]; ++entry) {
    const int j = pattern.column[entry];
    const Mat3& block = blocks[pattern.pair[entry]];
    const Vec3 difference = row(u, j) - own;
    if (j > i)
      sum.noalias() += block * difference;
    else
      sum.noalias() += block.transpose() * difference;
  }
  return sum;
}

Mat3 diagonal_block(const PairPattern& pattern, const PairBlocks& blocks, int i) {
  Mat3 sum = Mat3::Zero();
  for (int entry = pattern.row_begin[i]; entry < pattern.row_begin[i + 1]; ++entry) {
    const Mat3& block = blocks[pattern.pair[entry]];
    sum -= block + block.transpose();
  }
  return 0.5 * sum;
}

}  // namespace selvedge
