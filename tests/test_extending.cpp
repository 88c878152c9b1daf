#include <catch2/catch.hpp>

#include "tests/sources.hpp"

namespace selvedge::test_extending {

using namespace selvedge::sources;

TEST_CASE("modules: docs/extending.md shows code that is compiled", "[modules]") {
  // The file that the page has named last has each block of C++, line for line.
  const std::string page = read(root / "docs/extending.md"), fence = "```cpp\n";
  static const std::regex path(R"((tests|docs)/[\w/]+\.cpp)");
  int blocks = 0;
  std::string file;
  for (std::size_t from = 0, at; (at = page.find(fence, from)) != std::string::npos; ++blocks) {
    const std::string before = page.substr(from, at - from);
    for (std::sregex_iterator named(before.begin(), before.end(), path), none; named != none; ++named)
      file = named->str();
    const std::size_t begin = at + fence.size();
    from = page.find("```", begin);
    const std::string code = page.substr(begin, from - begin);
    INFO(file << "\n" << code);
    CHECK(read(root / file).find(code) != std::string::npos);
    from += 3;
  }
  CHECK(blocks >= 5);
}

}  // namespace selvedge::test_extending
