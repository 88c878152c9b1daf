#pragma once

#include <span>
#include <vector>

#include "physics/linear/coarsening.hpp"
#include "physics/linear/linear_system.hpp"
#include "physics/linear/pcg.hpp"

namespace selvedge {

// Coarse matrices P^T A P with patterns worked out once. A matrix acts as
//   y_i = D_i u_i + sum_j B_ij (u_j - u_i),
// which keeps translations exact in float whatever the stiffness, and so does its product. Sources and targets are
// arrays of block pairs, as for column_of().

// The fine vertices that interpolate from each coarse one.
struct Restriction {
  std::vector<int> begin, fine;
  std::vector<double> weight;
};
Restriction transpose(const Prolongation&);

// Weight times a source block, which is added to a target block.
struct ProductTerm {
  int source;  // an entry of the fine pattern, or ~i: the diagonal of row i
  float weight;
};
// The targets of coarse row a are begin[a] .. begin[a + 1], on the diagonal and right of it; `reflect` fills in the
// rest. Target k is the sum of the terms first[k] .. first[k + 1].
struct Product {
  std::vector<int> begin;
  std::vector<int> target;  // an entry of the coarse pattern, or -1: the diagonal of the row
  std::vector<int> first;
  std::vector<ProductTerm> term;
  std::vector<int> mirror;  // for an entry of the coarse pattern left of the diagonal, the entry of which it is
                            // the transpose; for others -1
};

// Entries whose blocks are a number times I3 that never changes. Their part of a product is summed when it is made.
struct ConstantEntries {
  std::vector<double> value;          // of each entry of the fine pattern; NaN where it is not constant
  std::vector<double> sum, diagonal;  // of the product: by entry of the coarse pattern, 0 left of the diagonal; by row
};

// The product for matrices with this pattern; `diagonal`: they have a diagonal. `constant` may be null.
Product make_product(const RowPattern& fine, bool diagonal, const Prolongation&, const Restriction&, RowPattern& coarse,
                     ConstantEntries* constant = nullptr);

// The product for contacts; the sources are their 3 x 3 factors.
Product make_product(std::span<const ContactBlock>, const Prolongation&, RowPattern& coarse);

// Adds to the target blocks of rows [begin, end), on the diagonal and right of it.
void accumulate(const Product&, const BlockPair<float>* source, const BlockColumns<float>* source_diagonal,
                BlockPair<float>* target, BlockColumns<float>* target_diagonal, int begin, int end);

// Writes the target blocks of rows [begin, end) that are left of the diagonal, once all others are complete.
void reflect(const Product&, const RowPattern&, BlockPair<float>* target, int begin, int end);

}  // namespace selvedge
