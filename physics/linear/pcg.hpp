#pragma once

#include <functional>
#include <vector>

#include "physics/linear/linear_system.hpp"
#include "physics/linear/pcg_kernels.hpp"

namespace selvedge {

template <class Real>
using Quads = std::vector<Quad<Real>>;

// A block in the kernels' layout, and back.
template <class Real>
BlockColumns<Real> columns_of(const Mat3& block) {
  BlockColumns<Real> columns{};
  for (int k = 0; k < 3; ++k)
    for (int r = 0; r < 3; ++r) columns.column[k].lanes[r] = static_cast<Real>(block(r, k));
  return columns;
}
template <class Real>
Mat3 block_of(const BlockColumns<Real>& columns) {
  Mat3 block;
  for (int k = 0; k < 3; ++k)
    for (int r = 0; r < 3; ++r) block(r, k) = columns.column[k].lanes[r];
  return block;
}

// Entries off the diagonal by rows, in any order. The number in each row is even: if necessary the last entry has the
// row's own index and a zero block.
struct RowPattern {
  std::vector<int> begin, column;
  int rows() const { return static_cast<int>(begin.size()) - 1; }
  void end_row(int row) {
    if (column.size() % 2 != 0) column.push_back(row);
    begin.push_back(static_cast<int>(column.size()));
  }
};

// z = M^-1 r on all rows. Every thread of an OpenMP team calls it, and they share its loops; the result is complete on
// return. z must be zero on rows that are not free, whatever r is.
template <class Real>
using Preconditioner = std::function<void(const Quads<Real>& r, Quads<Real>& z)>;

// A LinearSystem in the layout of the kernels. Flat entries and contacts between vertices that share an element are
// added to its blocks; other ones are stored separately.
template <class Real>
class PcgMatrix {
 public:
  void fill(const LinearSystem&);  // all systems must have the patterns of the first one
  int rows() const { return near_.rows(); }
  const RowPattern& pattern() const { return near_; }
  const BlockPair<Real>* blocks() const { return blocks_.data(); }
  BlockColumns<Real> diagonal(int i) const;       // acts on the row's own motion, not on differences
  const RowPattern& far() const { return far_; }  // flat entries outside of blocks; far_place: where their values are
  std::span<const int> far_place() const { return far_place_; }
  std::span<const ContactBlock> contacts() const { return contacts_; }  // those outside of blocks
  // q = A p, by all threads of the calling team; partial: sums of p . q, one for each of chunks().
  int chunks() const;
  void multiply(const Quads<Real>& p, Quads<Real>& q, std::vector<double>& partial);

 private:
  void lay_out(const LinearSystem&);
  void sort_contacts(const LinearSystem&);
  void fill_row(const LinearSystem&, int i);
  void add_contacts(const LinearSystem&, int i);
  void fill_contacts();

  RowPattern near_, far_;
  std::vector<int> near_entry_, near_place_, far_place_;  // indices in the system's pattern and flat matrix; -1: none
  std::vector<BlockPair<Real>> blocks_;
  std::vector<Real> diagonal_, far_value_;
  std::vector<std::array<int, 4>> known_;  // nodes of all contacts at the last sort_contacts
  std::vector<char> is_near_;              // of each contact: 1 if it is added to the blocks
  std::vector<char> is_held_;              // of each row: 1 if such contacts act on its own motion, by `held_`
  std::vector<BlockColumns<Real>> held_;
  std::vector<ContactBlock> contacts_;
  ContactLists lists_;
  ContactView<Real> contact_view_{};
  RowView<Real> view_{};
  std::vector<int> nodes_;
  std::vector<Real> weights_, tangent_, difference_, weights_by_row_;
  Quads<Real> normals_, response_;
};

// Inverses of the diagonal blocks; zero where not free.
template <class Real>
class BlockJacobi {
 public:
  void fill(std::span<const Mat3> diagonal, std::span<const char> free);
  void apply(const Quads<Real>& r, Quads<Real>& z) const;

 private:
  std::vector<BlockColumns<Real>> inverse_;
};

enum class PcgEnd { converged, too_many, not_positive, not_finite };
struct PcgReport {
  PcgEnd end = PcgEnd::too_many;
  int iterations = 0;
};

template <class Real>
struct PcgVectors {
  Quads<Real> x, r, z, p, q;
  std::vector<double> partial_rz, partial_pq;
};

// Preconditioned conjugate gradients from x = 0 on A x = r (vectors.r, overwritten by the residual), until the norm
// sqrt(r . M^-1 r) has fallen by `tolerance`. At any end x is finite or the report says not_finite. Every iteration
// lowers x . A x / 2 - b . x.
template <class Real>
PcgReport pcg(PcgMatrix<Real>&, const Preconditioner<Real>&, double tolerance, int max_iterations, PcgVectors<Real>&);

}  // namespace selvedge
