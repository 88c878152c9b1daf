#include "collision/exact/exact_integer.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

namespace selvedge {
namespace {

__extension__ using Wide = unsigned __int128;

struct Split {
  std::uint64_t odd;  // value = +- odd * 2^exponent
  int exponent;
};

// value must not be 0.
Split split(double value) {
  const auto bits = std::bit_cast<std::uint64_t>(value);
  const int biased = static_cast<int>(bits >> 52 & 0x7ff);
  const std::uint64_t fraction = bits & 0xfffffffffffff;
  const std::uint64_t mantissa = biased == 0 ? fraction : fraction | std::uint64_t{1} << 52;
  const int zeros = std::countr_zero(mantissa);
  return {mantissa >> zeros, std::max(biased, 1) - 1075 + zeros};
}

}  // namespace

int lowest_exponent(double value) {
  assert(std::isfinite(value));
  return value == 0 ? 1 << 20 : split(value).exponent;
}

ExactInteger::ExactInteger(double value, int exponent) : size_(0), negative_(value < 0) {
  if (value == 0) return;
  const Split parts = split(value);
  const int shift = parts.exponent - exponent;
  assert(shift >= 0);
  size_ = shift / 64 + 2;
  std::fill_n(limb_.at, size_, 0);
  const Wide shifted = static_cast<Wide>(parts.odd) << (shift % 64);
  limb_.at[shift / 64] = static_cast<std::uint64_t>(shifted);
  limb_.at[shift / 64 + 1] = static_cast<std::uint64_t>(shifted >> 64);
  trim();
}

ExactInteger& ExactInteger::operator=(const ExactInteger& other) {
  size_ = other.size_;
  negative_ = other.negative_;
  std::copy_n(other.limb_.at, size_, limb_.at);
  return *this;
}

int ExactInteger::compare_size(const ExactInteger& a, const ExactInteger& b) {
  if (a.size_ != b.size_) return a.size_ < b.size_ ? -1 : 1;
  for (int i = a.size_ - 1; i >= 0; --i)
    if (a.limb_.at[i] != b.limb_.at[i]) return a.limb_.at[i] < b.limb_.at[i] ? -1 : 1;
  return 0;
}

ExactInteger ExactInteger::add_sizes(const ExactInteger& a, const ExactInteger& b) {
  const ExactInteger &large = a.size_ >= b.size_ ? a : b, &small = a.size_ >= b.size_ ? b : a;
  ExactInteger sum;
  std::uint64_t carry = 0;
  for (int i = 0; i < large.size_; ++i) {
    const Wide here = static_cast<Wide>(large.limb_.at[i]) + (i < small.size_ ? small.limb_.at[i] : 0) + carry;
    sum.limb_.at[i] = static_cast<std::uint64_t>(here);
    carry = static_cast<std::uint64_t>(here >> 64);
  }
  sum.size_ = large.size_;
  if (carry) sum.limb_.at[sum.size_++] = carry;
  return sum;
}

ExactInteger ExactInteger::subtract_sizes(const ExactInteger& large, const ExactInteger& small) {
  ExactInteger difference;
  std::uint64_t borrow = 0;
  for (int i = 0; i < large.size_; ++i) {
    const Wide taken = static_cast<Wide>(i < small.size_ ? small.limb_.at[i] : 0) + borrow;
    borrow = large.limb_.at[i] < taken;
    difference.limb_.at[i] = large.limb_.at[i] - static_cast<std::uint64_t>(taken);
  }
  difference.size_ = large.size_;
  difference.trim();
  return difference;
}

ExactInteger ExactInteger::sum(const ExactInteger& a, const ExactInteger& b, bool b_negative) {
  const bool a_larger = compare_size(a, b) >= 0;
  ExactInteger result = a.negative_ == b_negative ? add_sizes(a, b)
                        : a_larger                ? subtract_sizes(a, b)
                                                  : subtract_sizes(b, a);
  result.negative_ = a_larger ? a.negative_ : b_negative;
  return result;
}

ExactInteger operator*(const ExactInteger& a, const ExactInteger& b) {
  ExactInteger product;
  if (a.size_ == 0 || b.size_ == 0) return product;
  assert(a.size_ + b.size_ <= ExactInteger::capacity);
  product.size_ = a.size_ + b.size_;
  product.negative_ = a.negative_ != b.negative_;
  std::fill_n(product.limb_.at, product.size_, 0);
  for (int i = 0; i < a.size_; ++i) {
    std::uint64_t carry = 0;
    for (int j = 0; j < b.size_; ++j) {
      const Wide here = static_cast<Wide>(a.limb_.at[i]) * b.limb_.at[j] + product.limb_.at[i + j] + carry;
      product.limb_.at[i + j] = static_cast<std::uint64_t>(here);
      carry = static_cast<std::uint64_t>(here >> 64);
    }
    product.limb_.at[i + b.size_] = carry;
  }
  product.trim();
  return product;
}

}  // namespace selvedge
