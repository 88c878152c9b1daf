#include "tests/pipeline/short_stress.hpp"

namespace selvedge::test_stress_short {

TEST_CASE("Stress scenes pass in their short form", "[stress][short]") {
  fake::check_short_forms(fake::stress_each_time);
}

TEST_CASE("All other stress scenes pass in their short form", "[stress][short][.long]") {
  fake::check_short_forms(fake::stress_at_length);
}

}  // namespace selvedge::test_stress_short
