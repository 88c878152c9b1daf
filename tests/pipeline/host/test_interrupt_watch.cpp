#include <catch2/catch.hpp>
#include <csignal>

#include "pipeline/host/interrupt.hpp"

namespace selvedge::test_interrupt_watch {

TEST_CASE("interrupt watch: a hangup is noted, and stays ignored where it was", "[interrupt_watch]") {
  const auto before = std::signal(SIGHUP, SIG_IGN);
  {
    const InterruptWatch watch;
    std::raise(SIGHUP);
    CHECK_FALSE(InterruptWatch::interrupted());
  }
  std::signal(SIGHUP, SIG_DFL);
  {
    const InterruptWatch watch;
    std::raise(SIGHUP);
    std::raise(SIGHUP);
    CHECK(InterruptWatch::interrupted());
  }
  std::signal(SIGHUP, before);
}

}  // namespace selvedge::test_interrupt_watch
