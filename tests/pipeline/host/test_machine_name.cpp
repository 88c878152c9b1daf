#include "pipeline/host/machine_name.hpp"

#include <catch2/catch.hpp>

#include "collision/geometry/parallel.hpp"

namespace selvedge::test_machine_name {

TEST_CASE("a machine's name says how many threads work", "[cells]") {
  CHECK(machine_name().starts_with(host_name() + ", "));
  {
    const ThreadLimit one(1);
    CHECK(machine_name().ends_with(", 1 thread"));
  }
  if (!has_openmp()) return;
  const ThreadLimit three(3);
  CHECK(machine_name().ends_with(", 3 threads"));
}

}  // namespace selvedge::test_machine_name
