#include <catch2/catch.hpp>

#include <cerrno>
#include <system_error>

#include "collision/geometry/error.hpp"
#include "pipeline/host/cure_to_write.hpp"
#include "pipeline/host/write_file.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::test_cure_to_write {

TEST_CASE("what helps where a write has failed depends on the reason") {
  struct Case {
    int reason;
    const char* cure;
  };
  for (const Case& one : {Case{EFBIG, "ulimit -f"}, Case{ENOSPC, "free some space"}, Case{EDQUOT, "free some space"},
                          Case{ENOTDIR, "a file is where a folder"}, Case{EEXIST, "a file is where a folder"},
                          Case{EISDIR, "name a file"}, Case{ENAMETOOLONG, "shorter"}, Case{EROFS, "may be written"}}) {
    const std::string reason = std::generic_category().message(one.reason);
    INFO(reason);
    REQUIRE_THAT(cure_to_write(reason), Catch::Contains(one.cure));
  }
}

TEST_CASE("a folder that cannot be made is named with what helps") {
  const fake::Folder folder("make_folder");
  const std::string file = fake::write(folder, "file", "").string();
  struct Case {
    std::string path, where, cure;
  };
  for (const Case& one :
       {Case{"", "the folder to write to", "`.` is the present folder"}, Case{file, file, "a file is where a folder"},
        Case{file + "/below", file + "/below", "a file is where a folder"}}) {
    INFO(one.path);
    try {
      make_folder(one.path);
      FAIL("was made");
    } catch (const Error& error) {
      CHECK(error.where() == one.where);
      CHECK_THAT(error.cure(), Catch::Contains(one.cure));
    }
  }
}

}  // namespace selvedge::test_cure_to_write
