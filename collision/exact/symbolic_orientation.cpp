#include "collision/exact/symbolic_orientation.hpp"

#include <algorithm>
#include <cassert>
#include <vector>

#include "collision/exact/orientation.hpp"

namespace selvedge {
namespace {

using Rows = std::array<const Vec3*, 4>;

// A product of infinitesimals in the expansion of the determinant with rows (point, 1): chosen entries of the matrix,
// no two in a row or column.
struct Term {
  std::array<int, 4> column{-1, -1, -1, -1};  // of the entry chosen in each row, -1: none
  int sign = 1;                               // sign of the remaining minor in the determinant
};

int parity_sign(const std::array<int, 4>& permutation) {
  int sign = 1;
  for (int i = 0; i < 4; ++i)
    for (int j = i + 1; j < 4; ++j)
      if (permutation[i] > permutation[j]) sign = -sign;
  return sign;
}

// The sign of a minor in Laplace's expansion: that of the permutation that keeps the remaining rows and columns in
// order.
int minor_sign(const std::array<int, 4>& column) {
  std::array<int, 4> permutation = column;
  std::array<bool, 4> used{};
  for (int c : column)
    if (c >= 0) used[c] = true;
  int next = 0;
  for (int& c : permutation) {
    if (c >= 0) continue;
    while (used[next]) ++next;
    c = next++;
  }
  return parity_sign(permutation);
}

// All products, largest first. Bit 3 r + 2 - k stands for coordinate k of row r; read as a number, larger bits mean a
// smaller product.
std::vector<Term> make_terms() {
  std::vector<Term> terms;
  for (int bits = 1; bits < 1 << 12; ++bits) {
    Term term;
    std::array<bool, 3> used{};
    bool valid = true;
    for (int bit = 0; bit < 12; ++bit) {
      if (!(bits >> bit & 1)) continue;
      const int row = bit / 3, column = 2 - bit % 3;
      valid = valid && term.column[row] < 0 && !used[column];
      term.column[row] = column;
      used[column] = true;
    }
    if (!valid) continue;
    term.sign = minor_sign(term.column);
    terms.push_back(term);
    // Three chosen entries leave the minor (1).
    if (std::all_of(used.begin(), used.end(), [](bool u) { return u; })) break;
  }
  return terms;
}

// Sign of the minor of the rows and columns that the term does not use. The last column is ones.
int minor(const Rows& rows, const Term& term) {
  std::array<const Vec3*, 3> left{};
  int count = 0;
  std::array<bool, 3> used{};
  for (int r = 0; r < 4; ++r) {
    if (term.column[r] >= 0)
      used[term.column[r]] = true;
    else
      left[count++] = rows[r];
  }
  if (count == 1) return 1;
  std::array<int, 3> axes{};
  int free = 0;
  for (int k = 0; k < 3; ++k)
    if (!used[k]) axes[free++] = k;
  if (count == 2) {
    const double p = (*left[0])[axes[0]], q = (*left[1])[axes[0]];
    return (p > q) - (p < q);
  }
  const auto flat = [&](int i) { return Vec2((*left[i])[axes[0]], (*left[i])[axes[1]]); };
  return orient2d(flat(0), flat(1), flat(2));
}

}  // namespace

int symbolic_orient3d(const RankedPoint& a, const RankedPoint& b, const RankedPoint& c, const RankedPoint& d,
                      bool& exact_zero) {
  if (const int sign = orient3d(*a.at, *b.at, *c.at, *d.at)) return sign;
  exact_zero = true;
  static const std::vector<Term> terms = make_terms();
  const std::array<RankedPoint, 4> points{a, b, c, d};
  std::array<int, 4> order{0, 1, 2, 3};
  std::sort(order.begin(), order.end(), [&](int i, int j) { return points[i].rank < points[j].rank; });
  const Rows rows{points[order[0]].at, points[order[1]].at, points[order[2]].at, points[order[3]].at};
  // The determinant of the rows (point, 1) is minus that of the differences from the first.
  const int sign = -parity_sign(order);
  for (const Term& term : terms)
    if (const int left = minor(rows, term)) return sign * term.sign * left;
  assert(false);
  return 0;
}

}  // namespace selvedge
