#include <catch2/catch.hpp>

#include "collision/geometry/error.hpp"
#include "pipeline/host/json_file.hpp"

namespace selvedge::test_json_file {

TEST_CASE("JSON of files: what is wrong is named with its line", "[json_file]") {
  struct Case {
    const char *text, *problem;  // empty: none
  };
  for (const Case& one :
       {Case{R"({"a": {"x": 1}, "b": {"x": 2}, "c": [{"x": 1}, {"x": 2}]})", ""}, Case{R"({"a": "a", "b": "a"})", ""},
        Case{"{\"a\": 1,\n \"b\": 2,\n \"a\": 3}", "f.json:3: `a` is given twice"},
        Case{"{\"k\": [{\"x\": 1,\n\"y\\\"\\\\\": 1,\n\"x\" :\n 2}]}", "f.json:3: `x` is given twice"},
        Case{"{\"\\u0061\": 1,\n\"a\": 2}", "f.json:2: `a` is given twice"},
        Case{"{\"a\":\n1,,}", "f.json:2: is no JSON"}, Case{"", "f.json:1: is no JSON"},
        Case{"[1e999]", "f.json: has a number that is too large"}}) {
    INFO(one.text);
    std::string said;
    try {
      json_of_file(one.text, "f.json");
    } catch (const Error& error) {
      said = error.what();
    }
    CHECK(said.substr(0, said.find('\n')) == one.problem);
  }
}

}  // namespace selvedge::test_json_file
