#include <catch2/catch.hpp>

#include <atomic>

#include "collision/geometry/parallel.hpp"
#include "collision/geometry/stop_scope.hpp"

namespace selvedge::test_stop_scope {

TEST_CASE("stop scope: a parallel loop ends soon after its flag is true", "[stop_scope]") {
  const ThreadLimit one(1);
  int asked = 0;
  std::atomic<int> done = 0;
  const StopFlag flag = [&] { return ++asked > 10; };
  const StopScope scope(flag);
  CHECK_THROWS_AS(parallel_for(1000, 1, [&](int) { ++done; }), Stopped);
  CHECK(done == 10);
}

TEST_CASE("stop scope: on several threads the flag is asked by the one that has the scope alone", "[stop_scope]") {
  const ThreadLimit several(4);
  const std::thread::id own = std::this_thread::get_id();
  std::atomic<int> elsewhere = 0, asked = 0;
  const StopFlag flag = [&] {
    elsewhere += std::this_thread::get_id() != own;
    ++asked;
    return false;
  };
  const StopScope scope(flag);
  std::atomic<int> done = 0;
  parallel_for(1000, 1, [&](int) { ++done; });
  CHECK(done == 1000);
  CHECK(elsewhere == 0);
}

TEST_CASE("stop scope: an inner scope asks its own flag, or nobody, and the outer one comes back", "[stop_scope]") {
  CHECK_NOTHROW(check_stop());
  const StopFlag yes = [] { return true; }, no = [] { return false; }, nobody;
  const StopScope outer(yes);
  CHECK_THROWS_AS(check_stop(), Stopped);
  {
    const StopScope inner(no);
    CHECK_NOTHROW(check_stop());
    const StopScope innermost(nobody);
    CHECK_NOTHROW(check_stop());
  }
  CHECK_THROWS_AS(check_stop(), Stopped);
  std::thread([] { CHECK_NOTHROW(check_stop()); }).join();
}

}  // namespace selvedge::test_stop_scope
