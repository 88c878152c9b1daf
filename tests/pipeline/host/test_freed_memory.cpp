#include <sys/resource.h>

#include <catch2/catch.hpp>

#include <cstdlib>
#include <vector>

#include "pipeline/host/freed_memory.hpp"

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

namespace selvedge::test_freed_memory {

namespace {

// Pages that this process had to ask the system for.
long faults() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_minflt;
}

}  // namespace

TEST_CASE("Freed memory serves the next allocation, without new pages from the system", "[freed_memory]") {
  if (std::getenv("MALLOC_TRIM_THRESHOLD_") || std::getenv("GLIBC_TUNABLES")) return;
  keep_freed_memory();
  constexpr int size = 1 << 20, blocks = 64, times = 20, page = 4096;
  const auto use = [] { return std::vector<std::vector<char>>(blocks, std::vector<char>(size, 1)).size(); };
  use();
  const long before = faults();
  for (int i = 0; i < times; ++i) REQUIRE(use() == blocks);
  CHECK(faults() - before < 2 * blocks * (size / page));  // ten times that where it is given back
}

}  // namespace selvedge::test_freed_memory

#endif
