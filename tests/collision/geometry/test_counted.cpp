#include "collision/geometry/counted.hpp"

#include <catch2/catch.hpp>

namespace selvedge::test_counted {

TEST_CASE("a number and its noun agree", "[counted]") {
  CHECK(counted(0, "frame") == "0 frames");
  CHECK(counted(1, "frame") == "1 frame");
  CHECK(counted(2, "frame") == "2 frames");
  CHECK(counted(1, "vertex", "vertices") == "1 vertex");
  CHECK(counted(3, "vertex", "vertices") == "3 vertices");
  CHECK(by_number(1, "is", "are") == "is");
  CHECK(by_number(0, "is", "are") == "are");
}

}  // namespace selvedge::test_counted
