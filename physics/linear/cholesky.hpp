#pragma once

#include <memory>
#include <span>

namespace selvedge {

// Sparse Cholesky factorisation by CHOLMOD (supernodal), with BLAS limited to one thread. In a build without
// SuiteSparse available() is false and every call returns false.
class Cholesky {
 public:
  Cholesky();
  ~Cholesky();
  static bool available();
  // Lower triangle by columns, rows ascending, every diagonal entry present. Keeps the pattern by reference.
  bool analyse(int size, std::span<int> column_begin, std::span<int> row);
  // False if the matrix is not positive definite or memory is short.
  bool factor(std::span<double> values);
  bool solve(std::span<double> right, std::span<double> solution);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace selvedge
