#include "physics/linear/pcg.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

#include <Eigen/LU>

#include "collision/geometry/parallel.hpp"
#include "collision/geometry/stop_scope.hpp"

namespace selvedge {
namespace {

constexpr int pcg_chunk = 64;   // rows of one partial sum; fixed, so that sums do not depend on the number of threads
constexpr double foreseen = 4;  // safety factor on the expected square of the norm
constexpr int small = 8;        // with fewer chunks one thread is faster than a team

double sum(const std::vector<double>& partial) { return std::accumulate(partial.begin(), partial.end(), 0.0); }

template <class Real>
void set(const Vec3& v, Quad<Real>& quad) {
  for (int k = 0; k < 3; ++k) quad.lanes[k] = static_cast<Real>(v[k]);
  quad.lanes[3] = 0;
}

template <class Real>
void add(const BlockColumns<Real>& block, BlockPair<Real>* blocks, int entry) {
  for (int k = 0; k < 3; ++k) column_of(blocks, entry, k).lanes += block.column[k].lanes;
}

bool share_an_element(const PairPattern& pattern, int i, int j) {
  const auto first = pattern.column.begin();
  return i == j || std::binary_search(first + pattern.row_begin[i], first + pattern.row_begin[i + 1], j);
}

template <class Real>
void product(const Quads<Real>& a, const Quads<Real>& b, int rows, std::vector<double>& partial) {
#pragma omp for schedule(static)
  for (int c = 0; c < chunks_of(rows, pcg_chunk); ++c)
    partial[c] = dot(a.data(), b.data(), c * pcg_chunk, std::min(rows, (c + 1) * pcg_chunk));
}

}  // namespace

template <class Real>
void PcgMatrix<Real>::lay_out(const LinearSystem& system) {
  const PairPattern& pattern = system.pattern;
  const bool flat = system.flat.rows() > 0;
  near_.begin = far_.begin = {0};
  for (int i = 0; i < pattern.rows; ++i) {
    const auto first = pattern.column.begin() + pattern.row_begin[i],
               last = pattern.column.begin() + pattern.row_begin[i + 1];
    near_.column.insert(near_.column.end(), first, last);
    for (int k = pattern.row_begin[i]; k < pattern.row_begin[i + 1]; ++k) near_entry_.push_back(k);
    near_.end_row(i);
    near_entry_.resize(near_.column.size(), -1);
    near_place_.resize(near_.column.size(), -1);
    for (int k = flat ? system.flat.outerIndexPtr()[i] : 0; flat && k < system.flat.outerIndexPtr()[i + 1]; ++k) {
      const int j = system.flat.innerIndexPtr()[k];
      if (j == i) continue;
      const auto found = std::lower_bound(first, last, j);
      if (found != last && *found == j) {
        near_place_[near_.begin[i] + (found - first)] = k;
      } else {
        far_.column.push_back(j);
        far_place_.push_back(k);
      }
    }
    far_.end_row(i);
    far_place_.resize(far_.column.size(), -1);
  }
  for (std::vector<int>* list : {&near_.column, &near_entry_, &near_place_, &far_.column, &far_place_})
    list->shrink_to_fit();
  blocks_.assign(near_.column.size() / 2, {});
  diagonal_.resize(rows());
  far_value_.assign(far_.column.size(), Real(0));
  is_held_.assign(rows(), false);
  held_.resize(rows());
}

template <class Real>
void PcgMatrix<Real>::sort_contacts(const LinearSystem& system) {
  const auto nodes = [](const ContactBlock& contact) { return contact.nodes; };
  if (!std::ranges::equal(system.contacts, known_, {}, nodes)) {
    known_.clear();
    is_near_.clear();
    for (const ContactBlock& contact : system.contacts) {
      bool near = true;
      for (const int i : contact.nodes)
        for (const int j : contact.nodes) near = near && (i < 0 || j < 0 || share_an_element(system.pattern, i, j));
      known_.push_back(contact.nodes);
      is_near_.push_back(near);
    }
  }
  contacts_.clear();
  for (std::size_t c = 0; c < known_.size(); ++c)
    if (!is_near_[c]) contacts_.push_back(system.contacts[c]);
}

// Row i of w w^T (x) C: w_i C (s u_i + sum_j w_j (u_j - u_i)), s the sum of all weights.
template <class Real>
void PcgMatrix<Real>::add_contacts(const LinearSystem& system, int i) {
  Mat3 held = Mat3::Zero();
  is_held_[i] = false;
  for (int l = system.lists.begin[i]; l < system.lists.begin[i + 1]; ++l) {
    const int c = system.lists.contact[l];
    if (!is_near_[c]) continue;
    const ContactBlock& contact = system.contacts[c];
    const Mat3 factor = system.lists.weight[l] * contact_matrix(contact);
    double sum = 0;
    for (int n = 0; n < 4; ++n) {
      if (contact.nodes[n] < 0) continue;
      sum += contact.weights[n];
      for (int k = near_.begin[i]; k < near_.begin[i + 1] && contact.nodes[n] != i; ++k)
        if (near_.column[k] == contact.nodes[n]) add(columns_of<Real>(contact.weights[n] * factor), blocks_.data(), k);
    }
    held += sum * factor;
    is_held_[i] = true;
  }
  if (is_held_[i]) held_[i] = columns_of<Real>(held);
}

template <class Real>
void PcgMatrix<Real>::fill_row(const LinearSystem& system, int i) {
  const double* flat = system.flat.rows() > 0 ? system.flat.valuePtr() : nullptr;
  diagonal_[i] = static_cast<Real>(system.diagonal[i]);
  for (int k = near_.begin[i]; k < near_.begin[i + 1]; ++k) {
    if (near_entry_[k] < 0) continue;
    const double* pair = system.pairs[system.pattern.pair[near_entry_[k]]].data();
    const double bend = near_place_[k] >= 0 ? system.flat_scale[i] * flat[near_place_[k]] : 0;
    const int down = near_.column[k] > i ? 1 : 3, across = 4 - down;
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < 3; ++r)
        column_of(blocks_.data(), k, c).lanes[r] = static_cast<Real>(pair[across * c + down * r] + (r == c ? bend : 0));
  }
  for (int k = far_.begin[i]; k < far_.begin[i + 1]; ++k)
    if (far_place_[k] >= 0) far_value_[k] = static_cast<Real>(system.flat_scale[i] * flat[far_place_[k]]);
  if (!system.lists.begin.empty()) add_contacts(system, i);
}

template <class Real>
void PcgMatrix<Real>::fill_contacts() {
  const int contacts = static_cast<int>(contacts_.size());
  lists_ = list_contacts(contacts_, rows());
  nodes_.resize(4 * contacts);
  weights_.resize(4 * contacts);
  normals_.resize(contacts);
  response_.resize(contacts);
  tangent_.resize(contacts);
  difference_.resize(contacts);
  for (int c = 0; c < contacts; ++c) {
    const ContactBlock& contact = contacts_[c];
    for (int k = 0; k < 4; ++k) {
      nodes_[4 * c + k] = std::max(contact.nodes[k], 0);
      weights_[4 * c + k] = contact.nodes[k] < 0 ? Real(0) : static_cast<Real>(contact.weights[k]);
    }
    set(contact.normal, normals_[c]);
    tangent_[c] = static_cast<Real>(contact.tangent_stiffness);
    difference_[c] = static_cast<Real>(contact.normal_stiffness - contact.tangent_stiffness);
  }
  weights_by_row_.assign(lists_.weight.begin(), lists_.weight.end());
  contact_view_ = {nodes_.data(), weights_.data(), normals_.data(), tangent_.data(), difference_.data()};
}

template <class Real>
void PcgMatrix<Real>::fill(const LinearSystem& system) {
  if (near_.begin.empty()) lay_out(system);
  assert(near_entry_.size() >= system.pattern.column.size());
  sort_contacts(system);
  fill_contacts();
  const bool touched = !system.lists.begin.empty();
#pragma omp parallel for schedule(static) if (chunks_of(rows(), pcg_chunk) > small)
  for (int i = 0; i < rows(); ++i) fill_row(system, i);
  if (!touched) std::ranges::fill(is_held_, false);

  view_ = {};
  view_.begin = near_.begin.data();
  view_.column = near_.column.data();
  view_.block = blocks_.data();
  view_.diagonal = diagonal_.data();
  if (touched) {
    view_.is_held = is_held_.data();
    view_.held = held_.data();
  }
  if (!far_.column.empty()) {
    view_.far_begin = far_.begin.data();
    view_.far_column = far_.column.data();
    view_.far_value = far_value_.data();
  }
  if (!contacts_.empty()) {
    view_.contact_begin = lists_.begin.data();
    view_.contact = lists_.contact.data();
    view_.contact_weight = weights_by_row_.data();
    view_.contact_response = response_.data();
  }
}

template <class Real>
BlockColumns<Real> PcgMatrix<Real>::diagonal(int i) const {
  BlockColumns<Real> own = columns_of<Real>(Mat3::Identity());
  for (int k = 0; k < 3; ++k) {
    own.column[k].lanes *= diagonal_[i];
    if (is_held_[i]) own.column[k].lanes += held_[i].column[k].lanes;
  }
  return own;
}

template <class Real>
int PcgMatrix<Real>::chunks() const {
  return chunks_of(rows(), pcg_chunk);
}

template <class Real>
void PcgMatrix<Real>::multiply(const Quads<Real>& p, Quads<Real>& q, std::vector<double>& partial) {
  const int contacts = static_cast<int>(contacts_.size());
  if (contacts > 0) {
#pragma omp for schedule(static)
    for (int c = 0; c < chunks_of(contacts, pcg_chunk); ++c)
      contact_responses(contact_view_, p.data(), response_.data(), c * pcg_chunk,
                        std::min(contacts, (c + 1) * pcg_chunk));
  }
#pragma omp for schedule(static)
  for (int c = 0; c < chunks_of(rows(), pcg_chunk); ++c)
    partial[c] = multiply_rows(view_, p.data(), q.data(), c * pcg_chunk, std::min(rows(), (c + 1) * pcg_chunk));
}

template <class Real>
void BlockJacobi<Real>::fill(std::span<const Mat3> diagonal, std::span<const char> free) {
  const int rows = static_cast<int>(diagonal.size());
  inverse_.resize(rows);
#pragma omp parallel for schedule(static) if (chunks_of(rows, pcg_chunk) > small)
  for (int i = 0; i < rows; ++i)
    inverse_[i] = columns_of<Real>(free[i] ? Mat3(diagonal[i].inverse()) : Mat3(Mat3::Zero()));
}

template <class Real>
void BlockJacobi<Real>::apply(const Quads<Real>& r, Quads<Real>& z) const {
  const int rows = static_cast<int>(inverse_.size());
#pragma omp for schedule(static)
  for (int c = 0; c < chunks_of(rows, pcg_chunk); ++c)
    multiply_diagonal(inverse_.data(), r.data(), z.data(), c * pcg_chunk, std::min(rows, (c + 1) * pcg_chunk));
}

template <class Real>
PcgReport pcg(PcgMatrix<Real>& a, const Preconditioner<Real>& precondition, double tolerance, int max_iterations,
              PcgVectors<Real>& v) {
  const int rows = a.rows(), chunks = chunks_of(rows, pcg_chunk);
  v.x.assign(rows, Quad<Real>{});
  v.p.assign(rows, Quad<Real>{});
  v.z.resize(rows);
  v.q.resize(rows);
  v.partial_rz.assign(chunks, 0.0);
  v.partial_pq.assign(chunks, 0.0);
  PcgReport report;
  StopPoll stop;
#pragma omp parallel if (chunks > small)
  {
    // Every thread computes the scalars by itself and gets the same bits.
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
      stop.wanted();  // before the barrier, so that all threads know the same after it
#pragma omp for schedule(static)
      for (int c = 0; c < chunks; ++c)
        turn(static_cast<Real>(keep), v.z.data(), v.p.data(), c * pcg_chunk, std::min(rows, (c + 1) * pcg_chunk));
      if (stop.was_wanted()) break;
      a.multiply(v.p, v.q, v.partial_pq);
      const double pq = sum(v.partial_pq);
      if (!(pq > 0) || !std::isfinite(pq)) {
        own.end = std::isfinite(pq) ? PcgEnd::not_positive : PcgEnd::not_finite;
        break;
      }
#pragma omp for schedule(static)
      for (int c = 0; c < chunks; ++c)
        advance(static_cast<Real>(rz / pq), v.p.data(), v.q.data(), v.x.data(), v.r.data(), c * pcg_chunk,
                std::min(rows, (c + 1) * pcg_chunk));
      // At the mean rate so far this step reached the goal with room to spare: saves one use of the preconditioner.
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
  stop.check();
  return report;
}

template class PcgMatrix<float>;
template class PcgMatrix<double>;
template class BlockJacobi<float>;
template class BlockJacobi<double>;
template PcgReport pcg(PcgMatrix<float>&, const Preconditioner<float>&, double, int, PcgVectors<float>&);
template PcgReport pcg(PcgMatrix<double>&, const Preconditioner<double>&, double, int, PcgVectors<double>&);

}  // namespace selvedge
