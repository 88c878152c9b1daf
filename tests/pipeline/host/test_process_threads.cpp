#include "pipeline/host/process_threads.hpp"

#include <catch2/catch.hpp>
#include <cstdlib>
#include <string>

#include "collision/geometry/parallel.hpp"

namespace selvedge::test_process_threads {

TEST_CASE("absurdly many threads are taken back, and the caller is told", "[process_threads]") {
  const char* set = std::getenv("OMP_NUM_THREADS");
  const std::string before = set ? set : "";
  const ThreadLimit as_it_is(most_threads());  // restores the number of this thread
  setenv("OMP_NUM_THREADS", "2,100000", 1);
  const std::optional<std::string> limited = limit_threads();
  const std::string now = std::getenv("OMP_NUM_THREADS");
  const int threads = most_threads();
  setenv("OMP_NUM_THREADS", "2", 1);
  CHECK_FALSE(limit_threads());
  set ? setenv("OMP_NUM_THREADS", before.c_str(), 1) : unsetenv("OMP_NUM_THREADS");
  REQUIRE(limited);
  CHECK_THAT(*limited, Catch::Contains("OMP_NUM_THREADS=2,100000 is more than"));
  CHECK(now.find(',') == std::string::npos);
  CHECK(threads <= std::stoi(now));
}

}  // namespace selvedge::test_process_threads
