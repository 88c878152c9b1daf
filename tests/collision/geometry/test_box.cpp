#include "collision/geometry/box.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

namespace selvedge::test_box {

TEST_CASE("box: a value is rounded to the nearest float on its side, and to none beyond", "[box]") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> mantissa(-2, 2);
  std::uniform_int_distribution<int> exponent(-160, 130);
  std::vector<double> values{0.0,   -0.0,   1.0,      -1.0,      1e-60,    -1e-60,
                             1e300, -1e300, INFINITY, -INFINITY, 0x1p-149, -0x1p-149};
  for (int i = 0; i < 10000; ++i) values.push_back(std::ldexp(mantissa(random), exponent(random)));
  for (int i = 0; i < 1000; ++i) values.push_back(static_cast<float>(mantissa(random)));
  for (const double value : values) {
    const float down = round_down(value), up = round_up(value);
    CAPTURE(value);
    REQUIRE(static_cast<double>(down) <= value);
    REQUIRE(static_cast<double>(up) >= value);
    if (down < INFINITY) REQUIRE_FALSE(static_cast<double>(std::nextafterf(down, INFINITY)) <= value);
    if (up > -INFINITY) REQUIRE_FALSE(static_cast<double>(std::nextafterf(up, -INFINITY)) >= value);
  }
}

}  // namespace selvedge::test_box
