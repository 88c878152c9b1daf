#include "physics/linear/pcg_kernels.hpp"

namespace selvedge {
namespace {

template <class Real>
[[gnu::always_inline]] inline double sum_of(const Quad<Real>& a) {
  return static_cast<double>(a.lanes[0]) + static_cast<double>(a.lanes[1]) + static_cast<double>(a.lanes[2]);
}

template <class Real>
[[gnu::always_inline]] inline void add_product(const BlockColumns<Real>& block, const Quad<Real>& u, Quad<Real>& y) {
  y.lanes += block.column[0].lanes * u.lanes[0];
  y.lanes += block.column[1].lanes * u.lanes[1];
  y.lanes += block.column[2].lanes * u.lanes[2];
}

template <class Real>
struct EightLanes;
template <>
struct EightLanes<float> {
  using Type = float __attribute__((vector_size(32)));
};
template <>
struct EightLanes<double> {
  using Type = double __attribute__((vector_size(64)));
};
template <class Real>
using Eight = typename EightLanes<Real>::Type;

template <class Real>
[[gnu::always_inline]] inline Eight<Real> side_by_side(const Quad<Real>& a, const Quad<Real>& b) {
  return __builtin_shufflevector(a.lanes, b.lanes, 0, 1, 2, 3, 4, 5, 6, 7);
}

template <class Real>
[[gnu::always_inline]] inline Quad<Real> everywhere(Real value) {
  return {typename Quad<Real>::Lanes{} + value};
}

template <class Real>
[[gnu::always_inline]] inline Eight<Real> eight_at(const Quad<Real> (&two)[2]) {
  Eight<Real> lanes;
  __builtin_memcpy(&lanes, two, sizeof lanes);
  return lanes;
}

template <class Real>
[[gnu::always_inline]] inline void add_products(const BlockPair<Real>& block, const Eight<Real>& u, Eight<Real>& y) {
  y += eight_at(block.column[0]) * __builtin_shufflevector(u, u, 0, 0, 0, 0, 4, 4, 4, 4);
  y += eight_at(block.column[1]) * __builtin_shufflevector(u, u, 1, 1, 1, 1, 5, 5, 5, 5);
  y += eight_at(block.column[2]) * __builtin_shufflevector(u, u, 2, 2, 2, 2, 6, 6, 6, 6);
}

template <class Real>
[[gnu::always_inline]] inline Quad<Real> sum_of_halves(const Eight<Real>& a) {
  return {__builtin_shufflevector(a, a, 0, 1, 2, 3) + __builtin_shufflevector(a, a, 4, 5, 6, 7)};
}

// Off-diagonal blocks act on differences, which keeps translations exact in any precision.
template <class Real>
[[gnu::always_inline]] inline double multiply_rows_inline(const RowView<Real>& a, const Quad<Real>* u, Quad<Real>* y,
                                                          int begin, int end) {
  Quad<Real> product{};
  for (int i = begin; i < end; ++i) {
    const Quad<Real> own = u[i];
    const Eight<Real> owns = side_by_side(own, own);
    Quad<Real> sum{own.lanes * a.diagonal[i]};
    Eight<Real> near{}, far{};
    for (int k = a.begin[i]; k < a.begin[i + 1]; k += 2)
      add_products(a.block[k / 2], side_by_side(u[a.column[k]], u[a.column[k + 1]]) - owns, near);
    if (a.far_begin)
      for (int k = a.far_begin[i]; k < a.far_begin[i + 1]; k += 2)
        far += (side_by_side(u[a.far_column[k]], u[a.far_column[k + 1]]) - owns) *
               side_by_side(everywhere(a.far_value[k]), everywhere(a.far_value[k + 1]));
    if (a.is_held && a.is_held[i]) add_product(a.held[i], own, sum);
    if (a.contact_begin)
      for (int k = a.contact_begin[i]; k < a.contact_begin[i + 1]; ++k)
        sum.lanes += a.contact_response[a.contact[k]].lanes * a.contact_weight[k];
    y[i].lanes = sum.lanes + sum_of_halves<Real>(near).lanes + sum_of_halves<Real>(far).lanes;
    product.lanes += y[i].lanes * own.lanes;
  }
  return sum_of(product);
}

template <class Real>
[[gnu::always_inline]] inline void contact_responses_inline(const ContactView<Real>& a, const Quad<Real>* u,
                                                            Quad<Real>* response, int begin, int end) {
  for (int c = begin; c < end; ++c) {
    Quad<Real> slip{};
    for (int k = 4 * c; k < 4 * c + 4; ++k) slip.lanes += u[a.node[k]].lanes * a.weight[k];
    const Quad<Real> product{slip.lanes * a.normal[c].lanes};
    const Real along = product.lanes[0] + product.lanes[1] + product.lanes[2];
    response[c].lanes = slip.lanes * a.tangent_stiffness[c] + a.normal[c].lanes * (a.difference[c] * along);
  }
}

template <class Real>
[[gnu::always_inline]] inline void multiply_diagonal_inline(const BlockColumns<Real>* b, const Quad<Real>* u,
                                                            Quad<Real>* y, int begin, int end) {
  for (int i = begin; i < end; ++i) {
    Quad<Real> sum{};
    add_product(b[i], u[i], sum);
    y[i] = sum;
  }
}

template <class Real>
[[gnu::always_inline]] inline void advance_inline(Real step, const Quad<Real>* p, const Quad<Real>* q, Quad<Real>* x,
                                                  Quad<Real>* r, int begin, int end) {
  for (int i = begin; i < end; ++i) {
    x[i].lanes += p[i].lanes * step;
    r[i].lanes -= q[i].lanes * step;
  }
}

template <class Real>
[[gnu::always_inline]] inline double dot_inline(const Quad<Real>* a, const Quad<Real>* b, int begin, int end) {
  Quad<Real> sum{};
  for (int i = begin; i < end; ++i) sum.lanes += a[i].lanes * b[i].lanes;
  return sum_of(sum);
}

[[gnu::always_inline]] inline void multiply_level_inline(const LevelView& a, const Quad<float>* u, Quad<float>* y,
                                                         int begin, int end) {
  for (int i = begin; i < end; ++i) {
    const Quad<float> own = u[i];
    const Eight<float> owns = side_by_side(own, own);
    Quad<float> sum{};
    add_product(a.diagonal[i], own, sum);
    Eight<float> sums{};
    for (int part = 0; part < 2; ++part)
      for (int k = a.begin[part][i]; k < a.begin[part][i + 1]; k += 2)
        add_products(a.block[part][k / 2], side_by_side(u[a.column[part][k]], u[a.column[part][k + 1]]) - owns, sums);
    y[i].lanes = sum.lanes + sum_of_halves<float>(sums).lanes;
  }
}

}  // namespace

// SELVEDGE_CLONES (CMake) makes the compiler generate one clone for each instruction set; the loader picks one for the
// machine. It is empty where that does not work: for other compilers, and for sanitizers, which start too late for the
// loader.

SELVEDGE_CLONES double multiply_rows(const RowView<float>& a, const Quad<float>* u, Quad<float>* y, int begin,
                                     int end) {
  return multiply_rows_inline(a, u, y, begin, end);
}
SELVEDGE_CLONES double multiply_rows(const RowView<double>& a, const Quad<double>* u, Quad<double>* y, int begin,
                                     int end) {
  return multiply_rows_inline(a, u, y, begin, end);
}
SELVEDGE_CLONES void multiply_level(const LevelView& a, const Quad<float>* u, Quad<float>* y, int begin, int end) {
  multiply_level_inline(a, u, y, begin, end);
}
SELVEDGE_CLONES void gather(const WeightView& p, const Quad<float>* u, Quad<float>* y, int begin, int end) {
  for (int i = begin; i < end; ++i) {
    Quad<float> sum{};
    for (int k = p.begin[i]; k < p.begin[i + 1]; ++k) sum.lanes += u[p.column[k]].lanes * p.weight[k];
    y[i] = sum;
  }
}
SELVEDGE_CLONES void add_gathered(const WeightView& p, const Quad<float>* u, Quad<float>* step, Quad<float>* y,
                                  int begin, int end) {
  gather(p, u, step, begin, end);
  for (int i = begin; i < end; ++i) y[i].lanes += step[i].lanes;
}
SELVEDGE_CLONES void chebyshev(float keep, float factor, const BlockColumns<float>* inverse, const Quad<float>* product,
                               Quad<float>* residual, Quad<float>* step, Quad<float>* x, int begin, int end) {
  for (int i = begin; i < end; ++i) {
    residual[i].lanes -= product[i].lanes;
    Quad<float> next{step[i].lanes * keep};
    add_product(inverse[i], {residual[i].lanes * factor}, next);
    step[i] = next;
    x[i].lanes += next.lanes;
  }
}
SELVEDGE_CLONES void contact_responses(const ContactView<float>& a, const Quad<float>* u, Quad<float>* response,
                                       int begin, int end) {
  contact_responses_inline(a, u, response, begin, end);
}
SELVEDGE_CLONES void contact_responses(const ContactView<double>& a, const Quad<double>* u, Quad<double>* response,
                                       int begin, int end) {
  contact_responses_inline(a, u, response, begin, end);
}
SELVEDGE_CLONES void multiply_diagonal(const BlockColumns<float>* b, const Quad<float>* u, Quad<float>* y, int begin,
                                       int end) {
  multiply_diagonal_inline(b, u, y, begin, end);
}
SELVEDGE_CLONES void multiply_diagonal(const BlockColumns<double>* b, const Quad<double>* u, Quad<double>* y, int begin,
                                       int end) {
  multiply_diagonal_inline(b, u, y, begin, end);
}
SELVEDGE_CLONES void advance(float step, const Quad<float>* p, const Quad<float>* q, Quad<float>* x, Quad<float>* r,
                             int begin, int end) {
  advance_inline(step, p, q, x, r, begin, end);
}
SELVEDGE_CLONES void advance(double step, const Quad<double>* p, const Quad<double>* q, Quad<double>* x,
                             Quad<double>* r, int begin, int end) {
  advance_inline(step, p, q, x, r, begin, end);
}
SELVEDGE_CLONES void turn(float keep, const Quad<float>* z, Quad<float>* p, int begin, int end) {
  for (int i = begin; i < end; ++i) p[i].lanes = z[i].lanes + p[i].lanes * keep;
}
SELVEDGE_CLONES void turn(double keep, const Quad<double>* z, Quad<double>* p, int begin, int end) {
  for (int i = begin; i < end; ++i) p[i].lanes = z[i].lanes + p[i].lanes * keep;
}
SELVEDGE_CLONES double dot(const Quad<float>* a, const Quad<float>* b, int begin, int end) {
  return dot_inline(a, b, begin, end);
}
SELVEDGE_CLONES double dot(const Quad<double>* a, const Quad<double>* b, int begin, int end) {
  return dot_inline(a, b, begin, end);
}

}  // namespace selvedge
