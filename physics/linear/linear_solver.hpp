#pragma once

#include <memory>

#include "physics/linear/coarsening.hpp"
#include "physics/linear/linear_system.hpp"

namespace selvedge {

// Whether a matrix is known to be positive definite on its free rows. Exact Hessians may not be.
enum class Definite { yes, perhaps };

struct LinearReport {
  bool converged = false;
  int iterations = 0;     // of PCG; a direct solve counts as one
  int coarse_builds = 0;  // of multigrid's coarse levels
};

// `automatic` takes CHOLMOD, where the build has it, for scenes of few free vertices, and multigrid for larger ones. If
// a system is so stiff that multigrid needs very many iterations, CHOLMOD takes over for a while. Asking for CHOLMOD in
// a build without it is an Error; `automatic` solves the few vertices by PCG to 1e-3 there, whatever the tolerance.
LinearSolver chosen_solver(LinearSolver wanted, int free_vertices);

// CHOLMOD and PCG behind one call. Holds caches: patterns, hierarchies, factors, vectors.
class LinearSystemSolver {
 public:
  // The hierarchy is made from the vertices when first needed.
  LinearSystemSolver(LinearSolver wanted, Vertices, std::span<const char> free);
  ~LinearSystemSolver();
  LinearSolver chosen() const;

  // Begins a family of systems: of one step, with the same contacts. The preconditioner is made for the first system
  // and reused for the others, as long as it is good enough.
  void start_family();

  // Solves A x = right; `diagonal` are the blocks of diagonal_blocks(). x is zero on rows that are not free. PCG stops
  // when the residual's preconditioner norm has fallen by `tolerance`; it works in float, refined in double if the
  // tolerance needs that. If PCG does not converge, CHOLMOD (or PCG in double) tries. If nothing converges, x is the
  // best direction found: finite, and zero if there was none. A matrix that is `perhaps` definite gets one attempt.
  LinearReport solve(const LinearSystem&, std::span<const Mat3> diagonal, const Points& right, double tolerance,
                     int max_iterations, Points& x, Definite = Definite::yes);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace selvedge
