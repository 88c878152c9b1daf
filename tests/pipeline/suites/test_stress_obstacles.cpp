#include "tests/pipeline/short_stress.hpp"

using namespace selvedge;

TEST_CASE("The stress scenes against obstacles pass in their short form", "[stress][short]") {
  fake::check_short_forms(fake::stress_against_obstacles);
}
