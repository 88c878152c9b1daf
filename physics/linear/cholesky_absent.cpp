#include "physics/linear/cholesky.hpp"

namespace selvedge {

struct Cholesky::Impl {};

Cholesky::Cholesky() = default;
Cholesky::~Cholesky() = default;
bool Cholesky::available() { return false; }
bool Cholesky::analyse(int, std::span<int>, std::span<int>) { return false; }
bool Cholesky::factor(std::span<double>) { return false; }
bool Cholesky::solve(std::span<double>, std::span<double>) { return false; }

}  // namespace selvedge
