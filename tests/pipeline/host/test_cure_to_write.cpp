#include <catch2/catch.hpp>

#include <cerrno>
#include <system_error>

#include "pipeline/host/cure_to_write.hpp"

namespace selvedge::test_cure_to_write {

TEST_CASE("what helps where a write has failed depends on the reason") {
  struct Case {
    int reason;
    const char* cure;
  };
  for (const Case& one : {Case{EFBIG, "ulimit -f"}, Case{ENOSPC, "free some space"}, Case{EDQUOT, "free some space"},
                          Case{EROFS, "may be written"}}) {
    const std::string reason = std::generic_category().message(one.reason);
    INFO(reason);
    REQUIRE_THAT(cure_to_write(reason), Catch::Contains(one.cure));
  }
}

}  // namespace selvedge::test_cure_to_write
