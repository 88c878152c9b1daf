#include "tests/pipeline/short_stress.hpp"

namespace selvedge::test_stress_itself {

TEST_CASE("The stress scenes of cloth against itself pass in their short form", "[stress][short]") {
  fake::check_short_forms(fake::stress_against_itself);
}

}  // namespace selvedge::test_stress_itself
