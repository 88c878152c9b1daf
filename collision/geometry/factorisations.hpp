#pragma once

#include <Eigen/SparseCore>

#include "collision/geometry/points.hpp"

namespace selvedge {

// Factorisations of symmetric matrices. Eigen's take seconds to compile in every file that uses them; here they are
// compiled once. For tiny matrices the call costs too much for inner loops.

// In ascending order.
Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& matrix);

// Eigenvalues in ascending order, and eigenvectors as columns.
struct Spectrum3 {
  Vec3 values;
  Mat3 vectors;
};
Spectrum3 symmetric_spectrum3(const Mat3& matrix);

// The solution x of matrix * x = right, one column for each column of `right`. The matrix must not be singular.
Eigen::MatrixXd solve_symmetric(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& right);
// The same for a sparse, positive definite matrix (assert), of which the lower triangle is read.
Eigen::MatrixXd solve_symmetric(const Eigen::SparseMatrix<double>& matrix, const Eigen::MatrixXd& right);

}  // namespace selvedge
