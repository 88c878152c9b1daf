#include "collision/geometry/factorisations.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/SparseCholesky>
#include <cassert>

namespace selvedge {

Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& matrix) {
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix, Eigen::EigenvaluesOnly).eigenvalues();
}

Spectrum3 symmetric_spectrum3(const Mat3& matrix) {
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(matrix);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Eigen::MatrixXd solve_symmetric(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& right) {
  return matrix.ldlt().solve(right);
}

Eigen::MatrixXd solve_symmetric(const Eigen::SparseMatrix<double>& matrix, const Eigen::MatrixXd& right) {
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(matrix);
  assert(factor.info() == Eigen::Success);
  return factor.solve(right);
}

}  // namespace selvedge
