#include "physics/steppers/substeps.hpp"

#include <catch2/catch.hpp>

#include "physics/steppers/substep_options.hpp"

namespace selvedge::test_substeps {

TEST_CASE("substeps: none is longer than the longest, whatever the frame rate", "[substeps]") {
  const SubstepOptions options;
  for (const auto& [fps, count] : {std::pair(1000.0, 1),
                                   {60.0, 1},
                                   {48.0, 1},
                                   {30.0, 2},
                                   {25.0, 2},
                                   {24.0, 2},
                                   {24000.0 / 1001, 2},
                                   {15.0, 4},
                                   {10.0, 5},
                                   {6.0, 8},
                                   {2.0, 24}}) {
    INFO(fps);
    CHECK(least_substeps(1 / fps, options) == count);
    CHECK(1 / fps / least_substeps(1 / fps, options) < 1.06 * options.longest);
  }
}

}  // namespace selvedge::test_substeps
