#pragma once

#include <array>
#include <cstdint>

namespace selvedge {

// Signed integer, wide enough for sums of a few products of three differences of any finite doubles on a common power
// of two, each interpolated between two values with a weight of 53 and one of 40 bits: 3 * (2098 + 1 + 93 + 2) bits.
// Lives on the stack and touches only the limbs that it uses.
class ExactInteger {
 public:
  ExactInteger() : size_(0), negative_(false) {}
  ExactInteger(const ExactInteger& other) { *this = other; }
  ExactInteger& operator=(const ExactInteger& other);
  // value / 2^exponent, which must be whole; see lowest_exponent.
  ExactInteger(double value, int exponent);

  int sign() const { return size_ == 0 ? 0 : negative_ ? -1 : 1; }

  friend ExactInteger operator+(const ExactInteger& a, const ExactInteger& b) { return sum(a, b, b.negative_); }
  friend ExactInteger operator-(const ExactInteger& a, const ExactInteger& b) { return sum(a, b, !b.negative_); }
  friend ExactInteger operator*(const ExactInteger& a, const ExactInteger& b);

 private:
  static constexpr int capacity = 110;
  struct Uninitialised {
    std::uint64_t at[capacity];
    // Constructed empty on purpose: clearing 800 bytes would cost more than the sums do.
    Uninitialised() {}
  };

  static ExactInteger sum(const ExactInteger& a, const ExactInteger& b, bool b_negative);
  static int compare_size(const ExactInteger& a, const ExactInteger& b);
  static ExactInteger add_sizes(const ExactInteger& a, const ExactInteger& b);
  static ExactInteger subtract_sizes(const ExactInteger& large, const ExactInteger& small);
  void trim() {
    while (size_ > 0 && limb_.at[size_ - 1] == 0) --size_;
  }

  Uninitialised limb_;  // least significant first
  int size_;
  bool negative_;
};

// Largest e such that value / 2^e is whole; a large number for 0, which is a multiple of every power of two.
int lowest_exponent(double value);

}  // namespace selvedge
