#pragma once

// The inner loops of PCG over ranges of rows, compiled for several instruction sets. Vertices are four lanes wide (x,
// y, z, 0), so that a block times a vertex is three multiplications of a column by a lane; a row's blocks are taken
// two at a time.

namespace selvedge {

template <class Real>
struct Quad;
template <>
struct Quad<float> {
  using Lanes = float __attribute__((vector_size(16)));
  Lanes lanes;
};
template <>
struct alignas(32) Quad<double> {  // clones for wide registers assume this alignment, others would not
  using Lanes = double __attribute__((vector_size(32)));
  Lanes lanes;
};

template <class Real>
struct BlockColumns {
  Quad<Real> column[3];
};

// The blocks of two entries of a row: an even one and the next.
template <class Real>
struct BlockPair {
  Quad<Real> column[3][2];
};
template <class Pair>  // column k of a block of a matrix that is stored in pairs
auto& column_of(Pair* pairs, int entry, int k) {
  return pairs[entry / 2].column[k][entry % 2];
}

// A LinearSystem's matrix by rows: y_i = (diagonal_i + held_i) u_i + sum B_ij (u_j - u_i) + contacts. Rows have even
// numbers of entries, from an even index on. Null pointers: no such term.
template <class Real>
struct RowView {
  const int* begin;
  const int* column;
  const BlockPair<Real>* block;
  const Real* diagonal;
  const char* is_held;
  const BlockColumns<Real>* held;
  const int* far_begin;
  const int* far_column;
  const Real* far_value;
  const int* contact_begin;
  const int* contact;
  const Real* contact_weight;
  const Quad<Real>* contact_response;
};

template <class Real>
struct ContactView {
  const int* node;  // four per contact, 0 if unused
  const Real* weight;
  const Quad<Real>* normal;
  const Real* tangent_stiffness;
  const Real* difference;  // normal - tangent stiffness
};

// y = A u over rows [begin, end); returns u . y of these rows.
double multiply_rows(const RowView<float>&, const Quad<float>* u, Quad<float>* y, int begin, int end);
double multiply_rows(const RowView<double>&, const Quad<double>* u, Quad<double>* y, int begin, int end);

// A coarse level's matrix by rows: y_i = D_i u_i + sum B_ij (u_j - u_i), the sum over two sets of blocks, laid out
// like those of a RowView.
struct LevelView {
  const BlockColumns<float>* diagonal;
  const int* begin[2];
  const int* column[2];
  const BlockPair<float>* block[2];
};
void multiply_level(const LevelView&, const Quad<float>* u, Quad<float>* y, int begin, int end);

// A sparse matrix of scalar weights by rows: y = P u, or y += P u.
struct WeightView {
  const int* begin;
  const int* column;
  const float* weight;
};
void gather(const WeightView&, const Quad<float>* u, Quad<float>* y, int begin, int end);
void add_gathered(const WeightView&, const Quad<float>* u, Quad<float>* step, Quad<float>* y, int begin, int end);

// One step of a Chebyshev iteration: residual -= product, step = keep step + factor inverse residual, x += step.
void chebyshev(float keep, float factor, const BlockColumns<float>* inverse, const Quad<float>* product,
               Quad<float>* residual, Quad<float>* step, Quad<float>* x, int begin, int end);

// The force of contacts [begin, end) for a node with weight 1.
void contact_responses(const ContactView<float>&, const Quad<float>* u, Quad<float>* response, int begin, int end);
void contact_responses(const ContactView<double>&, const Quad<double>* u, Quad<double>* response, int begin, int end);

// y = B u with one block per row.
void multiply_diagonal(const BlockColumns<float>*, const Quad<float>* u, Quad<float>* y, int begin, int end);
void multiply_diagonal(const BlockColumns<double>*, const Quad<double>* u, Quad<double>* y, int begin, int end);

// x += step p, r -= step q.
void advance(float step, const Quad<float>* p, const Quad<float>* q, Quad<float>* x, Quad<float>* r, int begin,
             int end);
void advance(double step, const Quad<double>* p, const Quad<double>* q, Quad<double>* x, Quad<double>* r, int begin,
             int end);

// p = z + keep p.
void turn(float keep, const Quad<float>* z, Quad<float>* p, int begin, int end);
void turn(double keep, const Quad<double>* z, Quad<double>* p, int begin, int end);

double dot(const Quad<float>* a, const Quad<float>* b, int begin, int end);
double dot(const Quad<double>* a, const Quad<double>* b, int begin, int end);

}  // namespace selvedge
