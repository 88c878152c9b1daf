#include "pipeline/shapes/random_shifts.hpp"

namespace selvedge {
namespace {

// The generator of Steele, Lea and Flood 2014 (SplitMix): the same numbers on every machine.
double uniform(std::uint64_t& state) {  // in [-1, 1)
  state += 0x9e3779b97f4a7c15u;
  std::uint64_t z = state;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  z ^= z >> 31;
  return static_cast<double>(z >> 11) * 0x1p-52 - 1;
}

}  // namespace

Points random_shifts(Eigen::Index rows, std::uint64_t seed) {
  Points shifts(rows, 3);
  for (Eigen::Index i = 0; i < shifts.size(); ++i) shifts.data()[i] = uniform(seed);
  return shifts;
}

}  // namespace selvedge
