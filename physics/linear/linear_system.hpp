#pragma once

#include <array>
#include <span>
#include <vector>

#include "physics/energies/bending.hpp"
#include "physics/linear/block_matrix.hpp"

namespace selvedge {

enum class LinearSolver { automatic, cholmod, pcg, multigrid };  // pcg: block Jacobi; multigrid: PCG with a V-cycle

// Row i of a scalar matrix whose rows sum to zero, times u, for each coordinate.
Vec3 multiply_flat_row(const SparseMatrix& flat, const Points& u, int i);

// Second derivative of one contact: w w^T (x) (normal_stiffness n n^T + tangent_stiffness (I - n n^T)).
struct ContactBlock {
  std::array<int, 4> nodes{-1, -1, -1, -1};  // -1: unused, its weight is 0
  std::array<double, 4> weights{};
  Vec3 normal = Vec3::UnitY();
  double normal_stiffness = 0, tangent_stiffness = 0;  // [N/m]
};

Mat3 contact_matrix(const ContactBlock&);  // the 3 x 3 factor

// The contacts of each vertex, ascending.
struct ContactLists {
  std::vector<int> begin;  // size n + 1, or empty if there is no contact
  std::vector<int> contact;
  std::vector<double> weight;
};
ContactLists list_contacts(std::span<const ContactBlock>, int vertices);

// A = diagonal (x) I3 + pairs + (flat_scale flat) (x) I3 + contacts over n vertices. Rows and columns of vertices that
// are not free are those of the identity. Symmetric positive definite on the free ones [N/m]. Only refers to its parts.
struct LinearSystem {
  const PairPattern& pattern;
  const PairBlocks& pairs;
  std::span<const double> diagonal;    // n
  const SparseMatrix& flat;            // n x n with rows that sum to zero, or 0 x 0
  std::span<const double> flat_scale;  // n, the same for all vertices that flat connects
  std::span<const ContactBlock> contacts;
  const ContactLists& lists;
  std::span<const char> free;  // n
};

// y = A u in double on the free rows, zero elsewhere. u must be zero where not free.
void multiply(const LinearSystem&, const Points& u, Points& y);

// Diagonal blocks with every term, n.
void diagonal_blocks(const LinearSystem&, std::vector<Mat3>& blocks);

}  // namespace selvedge
