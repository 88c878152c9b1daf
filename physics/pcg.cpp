#include "physics/pcg.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace selvedge {
namespace {

constexpr int chunk = 256;      // rows of one partial sum; fixed, so that sums do not depend on the number of threads
constexpr double foreseen = 4;  // times what the square of the norm is expected to be
constexpr int small = 2;        // chunks below which a team of threads costs more than it saves

int chunks_of(int rows) { return (rows + chunk - 1) / chunk; }

double sum(const std::vector<double>& partial) {
  double total = 0;
  for (double part : partial) total += part;
  return total;
}

template <class Real>
void set(const Vec3& v, Quad<Real>& quad) {
  for (int k = 0; k < 3; ++k) quad.lanes[k] = static_cast<Real>(v[k]);
  quad.lanes[3] = 0;
}

template <class Real>
void product(const Quads<Real>& a, const Quads<Real>& b, int rows, std::vector<double>& partial) {
#pragma omp for schedule(static)
  for (int c = 0; c < chunks_of(rows); ++c)
    partial[c] = dot(a.data(), b.data(), c * chunk, std::min(rows, (c + 1) * chunk));
}

}  // namespace

template <class Real>
void PcgMatrix<Real>::fill(const LinearSystem& system) {
  const PairPattern& pattern = system.pattern;
  rows_ = pattern.rows;
  const bool flat = system.flat.rows() > 0;
  blocks_.resize(pattern.column.size());
  diagonal_.resize(rows_);
  if (flat) flat_.resize(system.flat.nonZeros());
#pragma omp parallel for schedule(static) if (chunks_of(rows_) > small)
  for (int i = 0; i < rows_; ++i) {
    diagonal_[i] = static_cast<Real>(system.diagonal[i]);
    for (int k = pattern.row_begin[i]; k < pattern.row_begin[i + 1]; ++k) {
      const Mat3& block = system.pairs[pattern.pair[k]];
      blocks_[k] = columns_of<Real>(pattern.column[k] > i ? block : Mat3(block.transpose()));
    }
    if (flat)
      for (int k = system.flat.outerIndexPtr()[i]; k < system.flat.outerIndexPtr()[i + 1]; ++k)
        flat_[k] = static_cast<Real>(system.flat_scale[i] * system.flat.valuePtr()[k]);
  }

  const int contacts = static_cast<int>(system.contacts.size());
  nodes_.resize(4 * contacts);
  weights_.resize(4 * contacts);
  normals_.resize(contacts);
  response_.resize(contacts);
  tangent_.resize(contacts);
  difference_.resize(contacts);
  for (int c = 0; c < contacts; ++c) {
    const ContactBlock& contact = system.contacts[c];
    for (int k = 0; k < 4; ++k) {
      nodes_[4 * c + k] = std::max(contact.nodes[k], 0);
      weights_[4 * c + k] = contact.nodes[k] < 0 ? Real(0) : static_cast<Real>(contact.weights[k]);
    }
    set(contact.normal, normals_[c]);
    tangent_[c] = static_cast<Real>(contact.tangent_stiffness);
    difference_[c] = static_cast<Real>(contact.normal_stiffness - contact.tangent_stiffness);
  }
  weights_by_row_.assign(system.lists.weight.begin(), system.lists.weight.end());

  view_ = {};
  view_.begin = pattern.row_begin.data();
  view_.column = pattern.column.data();
  view_.block = blocks_.data();
  view_.diagonal = diagonal_.data();
  if (flat) {
    view_.flat_begin = system.flat.outerIndexPtr();
    view_.flat_column = system.flat.innerIndexPtr();
    view_.flat_value = flat_.data();
  }
  if (contacts > 0) {
    view_.contact_begin = system.lists.begin.data();
    view_.contact = system.lists.contact.data();
    view_.contact_weight = weights_by_row_.data();
    view_.contact_response = response_.data();
  }
  contact_view_ = {nodes_.data(), weights_.data(), normals_.data(), tangent_.data(), difference_.data()};
}

template <class Real>
void PcgMatrix<Real>::multiply(const Quads<Real>& p, Quads<Real>& q, std::vector<double>& partial) {
  if (contacts() > 0) {
#pragma omp for schedule(static)
    for (int c = 0; c < chunks_of(contacts()); ++c)
      contact_responses(contact_view_, p.data(), response_.data(), c * chunk, std::min(contacts(), (c + 1) * chunk));
  }
#pragma omp for schedule(static)
  for (int c = 0; c < chunks_of(rows_); ++c)
    partial[c] = multiply_rows(view_, p.data(), q.data(), c * chunk, std::min(rows_, (c + 1) * chunk));
}

template <class Real>
void BlockJacobi<Real>::fill(std::span<const Mat3> diagonal, std::span<const char> free) {
  const int rows = static_cast<int>(diagonal.size());
  inverse_.resize(rows);
#pragma omp parallel for schedule(static) if (chunks_of(rows) > small)
  for (int i = 0; i < rows; ++i)
    inverse_[i] = columns_of<Real>(free[i] ? Mat3(diagonal[i].inverse()) : Mat3(Mat3::Zero()));
}

template <class Real>
void BlockJacobi<Real>::apply(const Quads<Real>& r, Quads<Real>& z) const {
  const int rows = static_cast<int>(inverse_.size());
#pragma omp for schedule(static)
  for (int c = 0; c < chunks_of(rows); ++c)
    multiply_diagonal(inverse_.data(), r.data(), z.data(), c * chunk, std::min(rows, (c + 1) * chunk));
}

template <class Real>
PcgReport pcg(PcgMatrix<Real>& a, const Preconditioner<Real>& precondition, double tolerance, int max_iterations,
              PcgVectors<Real>& v) {
  const int rows = a.rows(), chunks = chunks_of(rows);
  v.x.assign(rows, Quad<Real>{});
  v.p.assign(rows, Quad<Real>{});
  v.z.resize(rows);
  v.q.resize(rows);
  v.partial_rz.assign(chunks, 0.0);
  v.partial_pq.assign(chunks, 0.0);
  PcgReport report;
#pragma omp parallel if (chunks > small)
  {
    // Every thread keeps the scalars for itself and gets the same bits.
    PcgReport own;
    precondition(v.r, v.z);
    product(v.r, v.z, rows, v.partial_rz);
    double rz = sum(v.partial_rz), keep = 0;
    const double first = rz, goal = tolerance * tolerance * first;
    for (;; ++own.iterations) {
      if (!std::isfinite(rz) || rz < 0) {
        own.end = std::isfinite(rz) ? PcgEnd::not_positive : PcgEnd::not_finite;
        break;
      }
      if (rz <= goal) own.end = PcgEnd::converged;
      if (rz <= goal || own.iterations == max_iterations) break;
#pragma omp for schedule(static)
      for (int c = 0; c < chunks; ++c)
        turn(static_cast<Real>(keep), v.z.data(), v.p.data(), c * chunk, std::min(rows, (c + 1) * chunk));
      a.multiply(v.p, v.q, v.partial_pq);
      const double pq = sum(v.partial_pq);
      if (!(pq > 0) || !std::isfinite(pq)) {
        own.end = std::isfinite(pq) ? PcgEnd::not_positive : PcgEnd::not_finite;
        break;
      }
#pragma omp for schedule(static)
      for (int c = 0; c < chunks; ++c)
        advance(static_cast<Real>(rz / pq), v.p.data(), v.q.data(), v.x.data(), v.r.data(), c * chunk,
                std::min(rows, (c + 1) * chunk));
      // At the mean rate so far this step was the last one needed, and more: the preconditioner need not confirm it.
      if (own.iterations > 0 && foreseen * rz * std::pow(rz / first, 1.0 / own.iterations) < goal) {
        own.end = PcgEnd::converged;
        ++own.iterations;
        break;
      }
      precondition(v.r, v.z);
      product(v.r, v.z, rows, v.partial_rz);
      const double next = sum(v.partial_rz);
      keep = next / rz;
      rz = next;
    }
#pragma omp single
    report = own;
  }
  return report;
}

template class PcgMatrix<float>;
template class PcgMatrix<double>;
template class BlockJacobi<float>;
template class BlockJacobi<double>;
template PcgReport pcg(PcgMatrix<float>&, const Preconditioner<float>&, double, int, PcgVectors<float>&);
template PcgReport pcg(PcgMatrix<double>&, const Preconditioner<double>&, double, int, PcgVectors<double>&);

}  // namespace selvedge
