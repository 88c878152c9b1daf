#pragma once

#include <memory>

#include "physics/linear/coarsening.hpp"
#include "physics/linear/pcg.hpp"

namespace selvedge {

// One symmetric V-cycle of Galerkin multigrid as a preconditioner in float: the hierarchy of vertices is made once from
// the rest shape, the patterns of the coarse matrices once, those of contacts whenever contacts change. Smoothed by
// Chebyshev polynomials of the fourth kind over block Jacobi (Lottes 2023), solved by Cholesky on the coarsest level.
class Multigrid {
 public:
  Multigrid(const Vertices&, std::span<const char> free);
  ~Multigrid();
  // `fine` is the system's matrix in float and stays where it is until the last apply(). False where the mesh is too
  // small to have a coarse level, or the matrix turned out not to be positive definite: there is nothing to apply then.
  bool fill(const LinearSystem&, std::span<const Mat3> diagonal, PcgMatrix<float>& fine);
  // For a system like the one of the last fill() that did well, with the same contacts: the finest level's smoother
  // alone; the coarse levels stay as they are. What comes of it is symmetric and positive definite all the same, for
  // the coarse correction, whatever matrix it is of, is applied between one smoother and its transpose.
  void fill_finest(const LinearSystem&, std::span<const Mat3> diagonal, PcgMatrix<float>& fine);
  // z = M^-1 r, as Preconditioner asks for.
  void apply(const Quads<float>& r, Quads<float>& z);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace selvedge
