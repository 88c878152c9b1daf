#include <catch2/catch.hpp>

#include "tests/sources.hpp"

namespace selvedge::test_extending {

using namespace selvedge::sources;

namespace {

using Tables = std::map<std::string, std::string>;  // of members that keys are bound to: "Struct::member", and the file

Tables bound_members(const Texts& sources) {
  static const std::regex begin(R"(\bOption(s|Rows)?<(\w+)>&? \w+\(.*\) \{)"), bound(R"((range_of\()?&(\w+)::(\w+))");
  Tables found;
  for (const auto& [file, text] : sources) {
    std::istringstream lines(file.ends_with(".cpp") && !file.starts_with("tests/") ? text : "");
    std::string own;  // struct of the table that the line is in
    std::smatch table;
    for (std::string line; std::getline(lines, line);) {
      if (line == "}") own.clear();
      if (std::regex_search(line, table, begin)) own = table[2];
      if (own.empty()) continue;
      for (std::sregex_iterator match(line.begin(), line.end(), bound), end; match != end; ++match)
        if (!(*match)[1].matched)
          found[((*match)[2] == "O" ? own : (*match)[2].str()) + "::" + (*match)[3].str()] = file;
    }
  }
  return found;
}

// Members that keys are bound to have no comment, and the comment of their struct names the file of the keys.
Complaints twice_described(const Texts& sources, const Tables& tables) {
  static const std::regex begin(R"(^struct (\w+) \{)"), word(R"(\w+)");
  Complaints complaints;
  for (const auto& [file, text] : sources) {
    std::istringstream lines(file.ends_with(".hpp") ? text : "");
    std::string own, above;  // the struct that the line is in, and the comment above the line
    std::smatch name;
    std::string about;  // the struct's comment
    int number = 0;
    for (std::string line; std::getline(lines, line);) {
      const std::string code = line.substr(0, line.find("//"));
      const bool is_comment = code.find_first_not_of(' ') == std::string::npos && code.size() < line.size();
      ++number;
      if (line == "};") own.clear();
      if (std::regex_search(line, name, begin)) own = name[1], about = above;
      for (std::sregex_iterator match(code.begin(), code.end(), word), end; match != end && !own.empty(); ++match) {
        const auto table = tables.find(own + "::" + match->str());
        if (table == tables.end() || code.find("static ") != std::string::npos) continue;
        if (!above.empty() || code.size() < line.size())
          complaints.push_back(at(file, number) + table->first + " is described at its key: " + table->second);
        if (about.find("bound to them: ") == std::string::npos || about.find(table->second) == std::string::npos)
          complaints.push_back(at(file, number) + own + " lacks where its members are described: " + table->second);
      }
      above = is_comment ? above + line.substr(line.find("//") + 2) : "";
    }
  }
  return complaints;
}

}  // namespace

TEST_CASE("modules: an option is described at its key alone", "[modules]") {
  const Texts sources = all_sources();
  const Tables tables = bound_members(sources);
  CHECK(tables.size() > 250);
  CHECK(listed(twice_described(sources, tables)) == "");

  const Tables one =
      bound_members({{"a.cpp", "const Options<A>& a() {\n  number(\"b\", &O::b, range_of(&O::c));\n}\n"}});
  CHECK(one == Tables{{"A::b", "a.cpp"}});
  const std::string where = "// An A.\n// Keys are bound to them: a.cpp.\n";
  CHECK(twice_described({{"a.hpp", where + "struct A {\n  int b = 1;\n  int c = 0;  // [m]\n};\n"}}, one).empty());
  CHECK(twice_described({{"a.hpp", where + "struct A {\n  int b = 1;  // [m]\n};\n"}}, one).size() == 1);
  CHECK(twice_described({{"a.hpp", where + "struct A {\n  // Of c.\n  int c = 0, b = 1;\n};\n"}}, one).size() == 1);
  CHECK(twice_described({{"a.hpp", "// An A.\nstruct A {\n  int b = 1;\n};\n"}}, one).size() == 1);
}

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
