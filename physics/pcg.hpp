#pragma once

#include <functional>
#include <vector>

#include "physics/linear_system.hpp"
#include "physics/pcg_kernels.hpp"

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

// z = M^-1 r on all rows. Called by every thread of an OpenMP team, with its loops shared among them; complete when it
// returns. z must be zero on rows that are not free, whatever r is there.
template <class Real>
using Preconditioner = std::function<void(const Quads<Real>& r, Quads<Real>& z)>;

// A LinearSystem in the layout of the kernels. Keeps pointers into the system's pattern and lists.
template <class Real>
class PcgMatrix {
 public:
  void fill(const LinearSystem&);
  int rows() const { return rows_; }
  std::span<const BlockColumns<Real>> blocks() const { return blocks_; }  // as PairPattern::column has them
  int contacts() const { return static_cast<int>(response_.size()); }
  // q = A p by the calling team; partial sums of p . q, one a chunk.
  void multiply(const Quads<Real>& p, Quads<Real>& q, std::vector<double>& partial);

 private:
  int rows_ = 0;
  RowView<Real> view_{};
  ContactView<Real> contact_view_{};
  std::vector<BlockColumns<Real>> blocks_;
  std::vector<Real> diagonal_, flat_, weights_by_row_;
  std::vector<int> nodes_;
  std::vector<Real> weights_, tangent_, difference_;
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
// sqrt(r . M^-1 r) has fallen by `tolerance`. Whatever the end, x is finite or the report says not_finite, and every
// iterate lowers x . A x / 2 - b . x.
template <class Real>
PcgReport pcg(PcgMatrix<Real>&, const Preconditioner<Real>&, double tolerance, int max_iterations, PcgVectors<Real>&);

}  // namespace selvedge
