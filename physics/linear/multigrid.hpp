#pragma once

#include <memory>

#include "physics/linear/coarsening.hpp"
#include "physics/linear/pcg.hpp"

namespace selvedge {

// One symmetric V-cycle of Galerkin multigrid as a preconditioner in float. The hierarchy of vertices (from the rest
// shape) and the patterns of the coarse matrices are made once, patterns of contacts whenever contacts change. Smoothed
// by Chebyshev polynomials of the fourth kind over block Jacobi (Lottes 2023), solved by Cholesky on the coarsest
// level.
class Multigrid {
 public:
  Multigrid(const Vertices&, std::span<const char> free);
  ~Multigrid();
  // `fine` is the system's matrix in float; it must stay in place until the last apply(). False if the mesh is too
  // small for a coarse level or the matrix is not positive definite; apply() must not be called then.
  bool fill(const LinearSystem&, std::span<const Mat3> diagonal, PcgMatrix<float>& fine);
  // For a system similar to that of the last successful fill(), with the same contacts: fills the finest level's
  // smoother alone and keeps the coarse levels. The preconditioner stays symmetric and positive definite, since the
  // coarse correction, for any matrix, is applied between a smoother and its transpose.
  void fill_finest(const LinearSystem&, std::span<const Mat3> diagonal, PcgMatrix<float>& fine);
  // z = M^-1 r, with the contract of Preconditioner (pcg.hpp).
  void apply(const Quads<float>& r, Quads<float>& z);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace selvedge
