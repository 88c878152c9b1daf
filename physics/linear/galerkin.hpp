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
// blocks in pairs, as column_of() has them.

// The fine vertices that interpolate from each coarse one.
struct Restriction {
  std::vector<int> begin, fine;
  std::vector<double> weight;
};
Restriction transpose(const Prolongation&);

// Adds weight times a source block to a target block; row by row of the target. Targets are on the diagonal or right of
// it: what is left of it comes by symmetry.
struct ProductTerm {
  int source;  // an entry of the fine pattern, or ~i: the diagonal of row i
  int target;  // an entry of the coarse pattern, or -1: the diagonal of the row
  float weight;
};
struct Product {
  std::vector<int> begin;
  std::vector<ProductTerm> term;
  std::vector<int> mirror;  // of an entry of the coarse pattern left of the diagonal, the one that it is the transpose
                            // of; of others -1
};

// The product of a matrix of this pattern; `diagonal`: it has one.
Product make_product(const RowPattern& fine, bool diagonal, const Prolongation&, const Restriction&,
                     RowPattern& coarse);

// The product of contacts, which are the sources: their 3 x 3 factors.
Product make_product(std::span<const ContactBlock>, const Prolongation&, RowPattern& coarse);

// Adds to the target blocks of rows [begin, end), left of the diagonal nothing.
void accumulate(const Product&, const BlockPair<float>* source, const BlockColumns<float>* source_diagonal,
                BlockPair<float>* target, BlockColumns<float>* target_diagonal, int begin, int end);

// Writes the target blocks of rows [begin, end) that are left of the diagonal, once all others are complete.
void reflect(const Product&, const RowPattern&, BlockPair<float>* target, int begin, int end);

}  // namespace selvedge
