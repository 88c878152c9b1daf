#include "physics/linear/lower_triangle.hpp"

#include <algorithm>
#include <cassert>

namespace selvedge {
namespace {

// Calls visit(i, j, block) for every pair of different vertices that the system couples, possibly more than once.
// block() makes the block with the rows of vertex i and the columns of vertex j.
template <class Visit>
void for_each_coupling(const LinearSystem& system, Visit visit) {
  for (std::size_t p = 0; p < system.pattern.pairs.size(); ++p)
    visit(system.pattern.pairs[p][0], system.pattern.pairs[p][1], [&] { return system.pairs[p]; });
  for (int i = 0; i < system.flat.rows(); ++i)
    for (SparseMatrix::InnerIterator entry(system.flat, i); entry; ++entry)
      if (entry.col() > i)
        visit(i, static_cast<int>(entry.col()),
              [&] { return Mat3(system.flat_scale[i] * entry.value() * Mat3::Identity()); });
  for (const ContactBlock& contact : system.contacts)
    for (int k = 0; k < 4; ++k)
      for (int l = k + 1; l < 4; ++l)
        if (contact.nodes[k] >= 0 && contact.nodes[l] >= 0)
          visit(contact.nodes[k], contact.nodes[l],
                [&] { return Mat3(contact.weights[k] * contact.weights[l] * contact_matrix(contact)); });
}

// Adds `block` (rows of vertex i, columns of vertex j) at its place below the diagonal.
void add_block(LowerTriangle& lower, int i, int j, const Mat3& block) {
  const int a = lower.free_index[i], b = lower.free_index[j];
  if (a < 0 || b < 0) return;
  const int column = std::min(a, b), target = std::max(a, b);
  const auto begin = lower.block_row.begin() + lower.block_begin[column];
  const auto end = lower.block_row.begin() + lower.block_begin[column + 1];
  const auto found = std::lower_bound(begin, end, target);
  assert(found != end && *found == target);
  const int offset = 3 * static_cast<int>(found - begin);
  for (int c = 0; c < 3; ++c) {
    double* values = lower.value.data() + lower.column_begin[3 * column + c] + (3 - c) + offset;
    for (int r = 0; r < 3; ++r) values[r] += a > b ? block(r, c) : block(c, r);
  }
}

}  // namespace

bool update_pattern(const LinearSystem& system, LowerTriangle& lower) {
  LowerTriangle next;
  next.free_index.assign(system.pattern.rows, -1);
  for (int i = 0; i < system.pattern.rows; ++i)
    if (system.free[i]) {
      next.free_index[i] = static_cast<int>(next.vertex.size());
      next.vertex.push_back(i);
    }
  for (const ContactBlock& contact : system.contacts) next.contact_nodes.push_back(contact.nodes);
  if (next.free_index == lower.free_index && next.contact_nodes == lower.contact_nodes) return false;
  const int blocks = static_cast<int>(next.vertex.size());
  std::vector<std::vector<int>> below(blocks);
  for_each_coupling(system, [&](int i, int j, const auto&) {
    const auto [low, high] = std::minmax({next.free_index[i], next.free_index[j]});
    if (low >= 0) below[low].push_back(high);
  });
  next.block_begin = next.column_begin = {0};
  for (int b = 0; b < blocks; ++b) {
    sort_once(below[b]);
    next.block_row.insert(next.block_row.end(), below[b].begin(), below[b].end());
    next.block_begin.push_back(static_cast<int>(next.block_row.size()));
    for (int c = 0; c < 3; ++c) {
      for (int r = c; r < 3; ++r) next.row.push_back(3 * b + r);
      for (int a : below[b])
        for (int r = 0; r < 3; ++r) next.row.push_back(3 * a + r);
      next.column_begin.push_back(static_cast<int>(next.row.size()));
    }
  }
  lower = std::move(next);
  return true;
}

void fill_values(const LinearSystem& system, std::span<const Mat3> diagonal, LowerTriangle& lower) {
  lower.value.assign(lower.row.size(), 0.0);
  for (int b = 0; b < static_cast<int>(lower.vertex.size()); ++b)
    for (int c = 0; c < 3; ++c)
      for (int r = c; r < 3; ++r) lower.value[lower.column_begin[3 * b + c] + r - c] = diagonal[lower.vertex[b]](r, c);
  for_each_coupling(system, [&](int i, int j, const auto& block) { add_block(lower, i, j, block()); });
}

}  // namespace selvedge
