#include "collision/geometry/error.hpp"

#include <catch2/catch.hpp>

#include "collision/geometry/path_beside.hpp"

namespace selvedge::test_error {

TEST_CASE("error: a message does not end at a NUL byte", "[error]") {
  const Error error(std::string("is `a\0b`", 8), "file", "cure");
  CHECK(std::string(error.what()) == "file: is `a\\0b`\n  cure: cure");
  CHECK(error.problem() == "is `a\\0b`");
}

TEST_CASE("error: who asked for the input stands before its place", "[error]") {
  const auto fails = []() -> int { throw Error("is bad", "line 3", "mend it"); };
  CHECK_THROWS_WITH(read_for("suite.yaml", fails), "suite.yaml: line 3: is bad\n  cure: mend it");
  CHECK(read_for("suite.yaml", [] { return 3; }) == 3);
}

TEST_CASE("error: a file that is written beside its place has the name of that place", "[error]") {
  CHECK(path_in_place(path_beside("folder/run.h5")) == "folder/run.h5");
  CHECK(path_in_place(path_beside("a")) == "a");
  for (const char* other : {"folder/run.h5", "a.part", "a.0123.part", "a.0123456789abcdeg.part"})
    CHECK(path_in_place(other) == other);
}

}  // namespace selvedge::test_error
