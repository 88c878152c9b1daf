#include "pipeline/shapes/random_shifts.hpp"

#include "learned/network/uniform_numbers.hpp"

namespace selvedge {

Points random_shifts(Eigen::Index rows, std::uint64_t seed) {
  Points shifts(rows, 3);
  for (Eigen::Index i = 0; i < shifts.size(); ++i)
    shifts.data()[i] = static_cast<double>(splitmix64(seed) >> 11) * 0x1p-52 - 1;
  return shifts;
}

}  // namespace selvedge
