#include "tests/pipeline/short_stress.hpp"

namespace selvedge::test_stress_obstacles {

TEST_CASE("The stress scenes against obstacles pass in their short form", "[stress][short]") {
  fake::check_short_forms(fake::stress_against_obstacles);
}

}  // namespace selvedge::test_stress_obstacles
