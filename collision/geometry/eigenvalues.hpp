#pragma once

#include <Eigen/Core>

namespace selvedge {

// The eigenvalues of a symmetric matrix in ascending order, and its eigenvectors as columns. For small matrices that
// are not in an inner loop: compiled here once.
struct Spectrum {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};
Spectrum symmetric_spectrum(const Eigen::MatrixXd& matrix);
Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& matrix);

}  // namespace selvedge
