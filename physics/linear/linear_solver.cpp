#include "physics/linear/linear_solver.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "collision/geometry/error.hpp"
#include "collision/geometry/stop_scope.hpp"
#include "physics/linear/cholesky.hpp"
#include "physics/linear/lower_triangle.hpp"
#include "physics/linear/multigrid.hpp"
#include "physics/linear/pcg.hpp"

namespace selvedge {
namespace {

// Free vertices up to which CHOLMOD is taken. Measured on hanging N x N sheets, one thread, steps of 1/60 s: 1.7 ms per
// frame against 0.5 ms with block Jacobi for 81 vertices, and 53 against 10 for 625.
constexpr int direct_limit = 60;

constexpr int stiff_iterations = 150;  // if an automatic PCG solve takes more, CHOLMOD takes the next ones
constexpr int stiff_turns = 1000;      // number of solves by CHOLMOD before PCG is tried again

constexpr double jacobi_share = 0.4;           // of a tolerance: block Jacobi's norm underrates smooth errors
constexpr double float_tolerance = 1e-3;       // reached by one pass in float
constexpr double refinement_tolerance = 1e-4;  // of each pass if several are needed
constexpr int max_passes = 12;

// All data of a PCG solve in one precision.
template <class Real>
struct Iterative {
  PcgMatrix<Real> matrix;
  BlockJacobi<Real> jacobi;
  PcgVectors<Real> vectors;
  Preconditioner<Real> preconditioner;

  void take_jacobi(std::span<const Mat3> diagonal, std::span<const char> free) {
    jacobi.fill(diagonal, free);
    preconditioner = [this](const Quads<Real>& r, Quads<Real>& z) { jacobi.apply(r, z); };
  }

  // x += A^-1 right; `right` is scaled into the range of Real.
  PcgReport add_solution(const Points& right, std::span<const char> free, double tolerance, int iterations, Points& x) {
    const int rows = static_cast<int>(right.rows());
    const double scale = right.cwiseAbs().maxCoeff();
    if (!(scale > 0)) return {PcgEnd::converged, 0};
    vectors.r.resize(rows);
    for (int i = 0; i < rows; ++i)
      for (int k = 0; k < 4; ++k)
        vectors.r[i].lanes[k] = free[i] && k < 3 ? static_cast<Real>(right(i, k) / scale) : Real(0);
    const PcgReport report = pcg(matrix, preconditioner, tolerance, iterations, vectors);
    if (report.end == PcgEnd::not_finite) return report;
    for (int i = 0; i < rows; ++i)
      if (free[i])
        for (int k = 0; k < 3; ++k) x(i, k) += scale * static_cast<double>(vectors.x[i].lanes[k]);
    return report;
  }
};

double preconditioner_norm(const Points& r, std::span<const Mat3> diagonal, std::span<const char> free) {
  double sum = 0;
  for (int i = 0; i < r.rows(); ++i)
    if (free[i]) sum += row(r, i).dot(diagonal[i].inverse() * row(r, i));
  return std::sqrt(std::max(sum, 0.0));
}

}  // namespace

LinearSolver chosen_solver(LinearSolver wanted, int free_vertices) {
  if (wanted == LinearSolver::cholmod && !Cholesky::available())
    throw Error("this build has no CHOLMOD", "linear solver",
                "choose multigrid, pcg or automatic, or build with SuiteSparse (libsuitesparse-dev)");
  if (wanted != LinearSolver::automatic) return wanted;
  return Cholesky::available() && free_vertices <= direct_limit ? LinearSolver::cholmod : LinearSolver::multigrid;
}

struct LinearSystemSolver::Impl {
  LinearSolver chosen;
  bool automatic = false;
  bool stands_in = false;  // PCG does what CHOLMOD would do in a build that has it: it solves as well
  int direct_turns = 0;    // solves left for CHOLMOD, since PCG found the system stiff
  Cholesky cholesky;
  LowerTriangle lower;
  std::vector<double> packed_right, packed_solution;
  Vertices vertices;  // for multigrid; empty once that is made
  std::vector<char> free;
  std::unique_ptr<Multigrid> multigrid;  // made when first needed
  int coarse_builds = 0;                 // so far
  int fresh_iterations = -1;             // of PCG when the coarse levels were new; -1: make them anew
  Iterative<float> single;
  std::unique_ptr<Iterative<double>> full;  // made when float fails first

  bool solve_direct(const LinearSystem&, std::span<const Mat3> diagonal, const Points& right, Points& x);
  double prepare_single(const LinearSystem&, std::span<const Mat3> diagonal);
  void judge_preconditioner(const LinearReport&);
  template <class Real>
  LinearReport solve_iterative(Iterative<Real>&, const LinearSystem&, std::span<const Mat3> diagonal,
                               const Points& right, double tolerance, int max_iterations, Points& x);
};

bool LinearSystemSolver::Impl::solve_direct(const LinearSystem& system, std::span<const Mat3> diagonal,
                                            const Points& right, Points& x) {
  check_stop();
  if (update_pattern(system, lower) && !cholesky.analyse(lower.size(), lower.column_begin, lower.row)) {
    lower = {};
    return false;
  }
  fill_values(system, diagonal, lower);
  packed_right.resize(lower.size());
  packed_solution.resize(lower.size());
  for (std::size_t b = 0; b < lower.vertex.size(); ++b)
    for (int k = 0; k < 3; ++k) packed_right[3 * b + k] = right(lower.vertex[b], k);
  check_stop();
  if (!cholesky.factor(lower.value) || !cholesky.solve(packed_right, packed_solution)) return false;
  x.setZero(right.rows(), 3);
  for (std::size_t b = 0; b < lower.vertex.size(); ++b)
    for (int k = 0; k < 3; ++k) x(lower.vertex[b], k) = packed_solution[3 * b + k];
  return x.allFinite();
}

template <class Real>
LinearReport LinearSystemSolver::Impl::solve_iterative(Iterative<Real>& method, const LinearSystem& system,
                                                       std::span<const Mat3> diagonal, const Points& right,
                                                       double tolerance, int max_iterations, Points& x) {
  LinearReport report;
  x.setZero(right.rows(), 3);
  if (tolerance >= float_tolerance) {
    const PcgReport pass = method.add_solution(right, system.free, tolerance, max_iterations, x);
    return {pass.end == PcgEnd::converged, pass.iterations};
  }
  // Iterative refinement: residuals in double, corrections in the method's precision.
  Points residual = right, product;
  const double first = preconditioner_norm(right, diagonal, system.free);
  double norm = first;
  for (int pass = 0; pass < max_passes && norm > tolerance * first; ++pass) {
    const double wanted = std::max(refinement_tolerance, 0.5 * tolerance * first / norm);
    Points next = x;
    const PcgReport end = method.add_solution(residual, system.free, wanted, max_iterations - report.iterations, next);
    report.iterations += end.iterations;
    multiply(system, next, product);
    residual = right - product;
    const double next_norm = preconditioner_norm(residual, diagonal, system.free);
    if (!(next_norm < 0.5 * norm)) break;
    x = next;
    norm = next_norm;
  }
  report.converged = norm <= tolerance * first;
  return report;
}

// Prepares multigrid, or block Jacobi if multigrid is not possible. Returns the factor on tolerances for it.
double LinearSystemSolver::Impl::prepare_single(const LinearSystem& system, std::span<const Mat3> diagonal) {
  single.matrix.fill(system);
  if (chosen == LinearSolver::multigrid) {
    if (!multigrid) {
      multigrid = std::make_unique<Multigrid>(vertices, free);  // a stop may end this
      vertices = {};
    }
    const bool kept = fresh_iterations >= 0;
    if (kept) multigrid->fill_finest(system, diagonal, single.matrix);
    coarse_builds += !kept;
    if (kept || multigrid->fill(system, diagonal, single.matrix)) {
      single.preconditioner = [this](const Quads<float>& r, Quads<float>& z) { multigrid->apply(r, z); };
      return 1;
    }
  }
  single.take_jacobi(diagonal, system.free);
  return jacobi_share;
}

LinearSystemSolver::LinearSystemSolver(LinearSolver wanted, Vertices vertices, std::span<const char> free)
    : impl_(std::make_unique<Impl>()) {
  impl_->vertices = std::move(vertices);
  impl_->free.assign(free.begin(), free.end());
  impl_->automatic = wanted == LinearSolver::automatic;
  const int free_vertices = static_cast<int>(std::ranges::count(free, 1));
  impl_->chosen = chosen_solver(wanted, free_vertices);
  impl_->stands_in = impl_->automatic && !Cholesky::available() && free_vertices <= direct_limit;
}
LinearSystemSolver::~LinearSystemSolver() = default;
LinearSolver LinearSystemSolver::chosen() const { return impl_->chosen; }

// After a solve with the preconditioner of prepare_single(). Coarse levels of an earlier system are kept as long as PCG
// needs no more iterations than with the system for which they were made.
void LinearSystemSolver::Impl::judge_preconditioner(const LinearReport& report) {
  if (fresh_iterations < 0)
    fresh_iterations = report.converged ? report.iterations : -1;
  else if (!report.converged || report.iterations > fresh_iterations)
    fresh_iterations = -1;
}

void LinearSystemSolver::start_family() { impl_->fresh_iterations = -1; }

LinearReport LinearSystemSolver::solve(const LinearSystem& system, std::span<const Mat3> diagonal, const Points& right,
                                       double tolerance, int max_iterations, Points& x, Definite definite) {
  Impl& impl = *impl_;
  LinearReport report;
  if (impl.chosen == LinearSolver::cholmod || impl.direct_turns > 0) {
    impl.direct_turns = std::max(0, impl.direct_turns - 1);
    if (impl.solve_direct(system, diagonal, right, x)) return {true, 1};
    if (definite == Definite::perhaps) return {false, 1};
  }
  if (impl.chosen != LinearSolver::cholmod) {
    const int builds_before = impl.coarse_builds;
    const double share = impl.prepare_single(system, diagonal);
    const double wanted = impl.stands_in ? std::min(tolerance, float_tolerance) : share * tolerance;
    report = impl.solve_iterative(impl.single, system, diagonal, right, wanted, max_iterations, x);
    report.coarse_builds = impl.coarse_builds - builds_before;
    if (share == 1) impl.judge_preconditioner(report);
    if (impl.automatic && report.iterations > stiff_iterations && Cholesky::available())
      impl.direct_turns = stiff_turns;
    if (report.converged || definite == Definite::perhaps) return report;
    if (impl.solve_direct(system, diagonal, right, x)) return {true, report.iterations + 1, report.coarse_builds};
  }
  if (!impl.full) impl.full = std::make_unique<Iterative<double>>();
  impl.full->matrix.fill(system);
  impl.full->take_jacobi(diagonal, system.free);
  const LinearReport last = impl.solve_iterative(*impl.full, system, diagonal, right, tolerance, max_iterations, x);
  return {last.converged, report.iterations + last.iterations, report.coarse_builds};
}

}  // namespace selvedge
