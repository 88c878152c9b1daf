#include <catch2/catch.hpp>

#include "tests/sources.hpp"

namespace selvedge::test_modules {

// The repository keeps to its own rules: which module may include which, where heavy packages may appear, how long a
// file may be. Rooms inside modules: test_rooms.cpp.

using namespace selvedge::sources;

namespace {

constexpr int longest_file = 450;

// A heavy package: how its headers are spelt, and the files that may include them.
struct Heavy {
  std::string package, header, files;
};
const std::vector<Heavy> heavy_packages = {
    {"HDF5", "(hdf5|H5.*)\\.h(pp)?", "(learned|pipeline)/.*/[^/]*hdf5[^/]*|pipeline/tools/info\\.cpp"},
    {"CHOLMOD", "(.*/)?cholmod\\.h", ".*_cholmod\\.cpp"},
    {"Open MPI", "mpi\\.h", "pipeline/mpi/.*_mpi\\.cpp"},
    {"libtorch", "(torch|ATen|c10)/.*", "learned/.*_torch\\.(cpp|hpp)"},
    {"FCL", "fcl/.*", ".*_fcl\\.cpp"},
    {"yaml-cpp", "yaml-cpp/.*", "pipeline/.*yaml.*"},
    {"CLI11", "CLI/.*", "pipeline/.*\\.cpp"},
    {"nlohmann-json", "nlohmann/.*", "pipeline/(host/json_text\\.hpp|view/view_data\\.cpp)"},
    {"fmt", "fmt/.*", "pipeline/.*"},
    {"tinygltf", "tiny_gltf\\.h", ".*_tinygltf\\.cpp"},
    {"libzip", "zip\\.h", "pipeline/formats/zip_archive\\.cpp"},
    {"Catch2", "catch2/.*", "tests/.*"},
};

// `file` is the path from the repository's root. A module includes itself and the modules to its left in the chain,
// by path from the root; tests include every module, and beside them what the tests of their own folder share.
Complaints wrong_directions(const std::string& file, const std::string& text) {
  const auto position = [](const std::string& folder) { return std::find(chain.begin(), chain.end(), folder); };
  const auto folder = [](const std::string& path) { return path.substr(0, path.find('/')); };
  const std::string own = folder(file);
  Complaints complaints;
  for (const Include& include : includes(text)) {
    const std::string theirs = folder(include.header);
    const bool is_module = position(theirs) != chain.end();
    if (is_module && own != "tests" && position(theirs) > position(own))
      complaints.push_back(at(file, include.line) + own + " must not include " + include.header);
    if (is_module != include.quoted && theirs != "tests")
      complaints.push_back(at(file, include.line) +
                           "\"...\" is for our own headers, by path from the root: " + include.header);
    if (theirs == "tests" && own != "tests")
      complaints.push_back(at(file, include.line) + own + " must not include " + include.header);
  }
  return complaints;
}

Complaints misplaced_packages(const std::string& file, const std::string& text) {
  Complaints complaints;
  for (const Include& include : includes(text))
    for (const Heavy& heavy : heavy_packages)
      if (std::regex_match(include.header, std::regex(heavy.header)) && !file.starts_with("tests/") &&
          !std::regex_match(file, std::regex(heavy.files)))
        complaints.push_back(at(file, include.line) + heavy.package + " is for files like " + heavy.files);
  return complaints;
}

Complaints bad_shape(const std::string& file, const std::string& text) {
  Complaints complaints;
  const auto lines = static_cast<int>(std::count(text.begin(), text.end(), '\n'));
  if (lines > longest_file) complaints.push_back(at(file, lines) + "longer than " + std::to_string(longest_file));
  if (std::regex_search(file, std::regex("(^|[/_])(utils?|helpers?|misc)([/_.]|$)")))
    complaints.push_back(at(file, 1) + "the name does not say what is in it");
  if (file.ends_with(".hpp") && !text.starts_with("#pragma once\n"))
    complaints.push_back(at(file, 1) + "a header begins with #pragma once");
  return complaints;
}

// Links [text](path) of a Markdown page, and `folder/file` names in it, must lead to something; capitals stand for a
// name of the reader's choice.
Complaints dead_references(const fs::path& top, const std::string& file, const std::string& text) {
  static const std::regex reference(
      R"(\]\(([^)#:\s]+)(#[^)]*)?\)|`((collision|physics|pipeline|tests|configs|cmake|docs)/[a-z\d_/.-]+\.[a-z\d]+)`)");
  Complaints complaints;
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number)
    for (std::sregex_iterator match(line.begin(), line.end(), reference), end; match != end; ++match) {
      const bool is_link = (*match)[1].matched;
      const std::string target = is_link ? (*match)[1] : (*match)[3];
      if (!fs::exists(is_link ? (top / file).parent_path() / target : top / target))
        complaints.push_back(at(file, number) + "leads nowhere: " + target);
    }
  return complaints;
}

// Prose of a Markdown page is at most 120 columns wide. Tables, code, blocks between fences and what the program writes
// at a page's end may be wider.
Complaints wide_lines(const std::string& file, const std::string& text) {
  static const std::regex fence(R"(^\s*(```|~~~).*)"), other(R"(^(\s*\|| {4,}\S).*)");
  Complaints complaints;
  std::istringstream lines(text);
  std::string line;
  bool fenced = false;
  for (int number = 1; std::getline(lines, line); ++number) {
    if (line.starts_with("<!-- written by:") || line == "<!-- tables -->") break;
    if (std::regex_match(line, fence)) fenced = !fenced;
    if (fenced || line.size() <= 120 || std::regex_match(line, other)) continue;
    complaints.push_back(at(file, number) + "wider than 120 columns");
  }
  return complaints;
}

// Lines with which git marks a conflict that a merge has left.
Complaints conflict_markers(const std::string& file, const std::string& text) {
  static const std::string ours = std::string(7, '<') + ' ', theirs = std::string(7, '>') + ' ';
  Complaints complaints;
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number)
    if (line.starts_with(ours) || line.starts_with(theirs))
      complaints.push_back(at(file, number) + "a merge has left a conflict");
  return complaints;
}

// Every text file of the repository, by path from the root; what .gitignore names at the root is left out.
Texts all_texts() {
  static const std::set<std::string> foreign = {".git", "build", "out", ".cache", "shared"};
  Texts found;
  for (fs::recursive_directory_iterator entry(root), end; entry != end; ++entry) {
    if (entry.depth() == 0 && foreign.contains(entry->path().filename().string())) {
      entry.disable_recursion_pending();
    } else if (entry->is_regular_file()) {
      std::string text = read(entry->path());
      if (text.find('\0') == std::string::npos)
        found[entry->path().lexically_relative(root).generic_string()] = std::move(text);
    }
  }
  return found;
}

Texts pages() {
  Texts all = texts("docs", {".md"});
  for (const std::string page : {"README.md", "CHANGELOG.md"}) all[page] = read(root / page);
  return all;
}

}  // namespace

TEST_CASE("modules: includes go left along the chain", "[modules]") {
  CHECK(listed(over_all_sources(wrong_directions)) == "");

  CHECK(wrong_directions("physics/a.cpp", "#include \"physics/a.hpp\"\n#include <vector>\n").empty());
  CHECK(wrong_directions("pipeline/a.cpp", "#include \"collision/a.hpp\"\n").empty());
  CHECK(listed(wrong_directions("collision/a.cpp", "\n#include \"physics/scene/scene.hpp\"\n")) ==
        "\ncollision/a.cpp:2: collision must not include physics/scene/scene.hpp");
  CHECK(wrong_directions("collision/a.cpp", "#include <physics/scene/scene.hpp>\n").size() == 2);
  CHECK(wrong_directions("physics/a.cpp", "#include \"scene.hpp\"\n").size() == 1);
  CHECK(wrong_directions("physics/a.cpp", "#include \"../collision/bvh.hpp\"\n").size() == 1);
  CHECK(wrong_directions("physics/a.cpp", "  #  include \"tests/grid.hpp\"\n").size() == 1);
}

TEST_CASE("modules: heavy packages stay in the files named for them", "[modules]") {
  CHECK(listed(over_all_sources(misplaced_packages)) == "");

  CHECK(misplaced_packages("pipeline/hdf5/trajectory_hdf5.cpp", "#include <hdf5.h>\n").empty());
  CHECK(misplaced_packages("pipeline/tools/check.cpp", "#include <hdf5.h>\n").size() == 1);
  CHECK(misplaced_packages("collision/sdf_hdf5.cpp", "#include <hdf5.h>\n").size() == 1);
  CHECK(misplaced_packages("physics/solver.cpp", "#include <cholmod.h>\n").size() == 1);
  CHECK(misplaced_packages("physics/solver.cpp", "#include <suitesparse/cholmod.h>\n").size() == 1);
  CHECK(misplaced_packages("learned/engine.cpp", "#include <torch/torch.h>\n").size() == 1);
  CHECK(misplaced_packages("physics/scene/scene.cpp", "#include <yaml-cpp/yaml.h>\n").size() == 1);
  CHECK(misplaced_packages("pipeline/scene/setup.hpp", "#include <nlohmann/json.hpp>\n").size() == 1);
}

TEST_CASE("modules: files are short and say in their names what they hold", "[modules]") {
  CHECK(all_sources().size() > 20);
  CHECK(listed(over_all_sources(bad_shape)) == "");

  CHECK(bad_shape("physics/scene/scene.cpp", std::string(longest_file, '\n')).empty());
  CHECK(bad_shape("physics/scene/scene.cpp", std::string(longest_file + 1, '\n')).size() == 1);
  CHECK(bad_shape("physics/mesh_utils.cpp", "").size() == 1);
  CHECK(bad_shape("pipeline/util/a.cpp", "").size() == 1);
  CHECK(bad_shape("pipeline/utility_of_wool.cpp", "").empty());
  CHECK(bad_shape("physics/scene/scene.hpp", "int a;\n").size() == 1);
}

TEST_CASE("modules: test files have names of their own", "[modules]") {
  std::map<std::string, int> count;  // ctest picks the cases of a file by its name without the folder
  for (const auto& [file, text] : texts("tests", {".cpp"})) ++count[fs::path(file).stem().string()];
  for (const auto& [name, times] : count) {
    INFO(name);
    CHECK(times == 1);
  }
}

TEST_CASE("modules: what the documents name exists", "[modules]") {
  Complaints all;
  for (const auto& [file, text] : pages())
    for (const std::string& complaint : dead_references(root, file, text)) all.push_back(complaint);
  CHECK(listed(all) == "");

  CHECK(
      dead_references(root, "docs/a.md", "[it](../README.md#top) and `tests/main.cpp`, https://a.b (c.md)\n").empty());
  CHECK(dead_references(root, "docs/a.md", "\n[it](README.md)\n") ==
        Complaints{"docs/a.md:2: leads nowhere: README.md"});
  CHECK(dead_references(root, "README.md", "see `physics/nothing.cpp`\n").size() == 1);
}

TEST_CASE("modules: prose of the documents is at most 120 columns wide", "[modules]") {
  Complaints all;
  for (const auto& [file, text] : pages())
    for (const std::string& complaint : wide_lines(file, text)) all.push_back(complaint);
  CHECK(listed(all) == "");

  const std::string wide = std::string(121, 'a');
  CHECK(wide_lines("a.md", "b\n" + wide + "\n") == Complaints{"a.md:2: wider than 120 columns"});
  CHECK(wide_lines("a.md", "```\n" + wide + "\n```\n    " + wide + "\n| " + wide + " |\n").empty());
  CHECK(wide_lines("a.md", "```\n```\n* " + wide + "\n").size() == 1);
  CHECK(wide_lines("a.md", "<!-- written by: it -->\n" + wide + "\n").empty());
}

TEST_CASE("modules: no file holds a conflict of a merge", "[modules]") {
  Complaints all;
  const Texts files = all_texts();
  for (const auto& [file, text] : files)
    for (const std::string& complaint : conflict_markers(file, text)) all.push_back(complaint);
  CHECK(listed(all) == "");
  for (const std::string some : {"Makefile", "docs/hybrid.md", "configs/demo.yaml", "tests/test_modules.cpp"})
    CHECK(files.contains(some));

  const std::string seven(7, '<');
  CHECK(conflict_markers("a.md", "a\n" + seven + " HEAD\n") == Complaints{"a.md:2: a merge has left a conflict"});
  CHECK(conflict_markers("a.md", std::string(7, '>') + " branch").size() == 1);
  CHECK(conflict_markers("a.md", seven + "\n " + seven + " HEAD\n=======\n").empty());
}

TEST_CASE("modules: headers do not define two types of one name", "[modules]") {
  // Each module is in one namespace, tests in theirs; two layouts under one name would be merged by the linker without
  // a word.
  static const std::regex definition(R"((^|\n)(struct|class|enum class) (\w+)[^;{<]*\{)");
  static const std::regex space(R"((^|\n)namespace ([\w:]+) \{)");
  std::map<std::string, std::string> where;
  for (const auto& [file, text] : all_sources()) {
    if (!file.ends_with(".hpp")) continue;
    std::smatch inside;
    const std::string prefix = std::regex_search(text, inside, space) ? inside[2].str() + "::" : "";
    for (std::sregex_iterator match(text.begin(), text.end(), definition), end; match != end; ++match) {
      const auto [known, fresh] = where.emplace(prefix + (*match)[3].str(), file);
      INFO(file << " and " << known->second << ": " << known->first);
      CHECK(fresh);
    }
  }
  CHECK(where.size() > 50);
}

}  // namespace selvedge::test_modules
