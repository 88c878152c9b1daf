#include <catch2/catch.hpp>

#include "tests/sources.hpp"

namespace selvedge::test_site {

// Whoever reads docs/ finds every page: in the navigation of the site (docs/site/mkdocs.yml) and on the front page, or
// in the index of measurements or of decisions. That the site builds and its links hold is for `make docs`.

using namespace selvedge::sources;

namespace {

constexpr int longest_front_page = 120;
const std::set<std::string> indexed = {"docs/results", "docs/decisions"};

std::set<std::string> all_matches(const std::string& text, const std::regex& pattern) {
  std::set<std::string> found;
  for (std::sregex_iterator match(text.begin(), text.end(), pattern), end; match != end; ++match)
    found.insert((*match)[1]);
  return found;
}

// Pages of the navigation, as mkdocs.yml spells them: "- Title: page.md".
std::set<std::string> navigation(const std::string& yaml) {
  return all_matches(yaml, std::regex(R"(\n *- [^\n:]+: (\S+\.md)(?=\n))"));
}

// Files that a page links to, from the root.
std::set<std::string> linked(const std::string& file, const std::string& text) {
  std::set<std::string> found;
  for (const std::string& target : all_matches(text, std::regex(R"(\]\(([^)#:\s]+)(#[^)]*)?\))")))
    found.insert((fs::path(file).parent_path() / target).lexically_normal().generic_string());
  return found;
}

// `docs`: all pages by path from the root, with the front page.
Complaints lost_pages(const Texts& docs, const std::string& yaml) {
  const std::set<std::string> shown = navigation(yaml), front = linked("README.md", docs.at("README.md"));
  Complaints complaints;
  for (const auto& [file, text] : docs) {
    const std::string folder = fs::path(file).parent_path().generic_string(), index = folder + "/README.md";
    if (file == "README.md" || folder == "docs/site") continue;
    if (indexed.contains(folder) && file != index) {
      if (!docs.contains(index) || !linked(index, docs.at(index)).contains(file))
        complaints.push_back(at(file, 1) + "is not in " + index);
      continue;
    }
    if (!shown.contains(fs::path(file).lexically_relative("docs").generic_string()))
      complaints.push_back(at(file, 1) + "is not in the navigation of docs/site/mkdocs.yml");
    if (!front.contains(file)) complaints.push_back(at(file, 1) + "is not on the front page, README.md");
  }
  return complaints;
}

Texts docs_and_front_page() {
  Texts all = texts("docs", {".md"});
  all["README.md"] = read(root / "README.md");
  return all;
}

}  // namespace

TEST_CASE("site: every page is in the navigation, or in the index of its folder", "[site]") {
  const std::string yaml = read(root / "docs/site/mkdocs.yml");
  CHECK(navigation(yaml).size() > 30);
  CHECK(listed(lost_pages(docs_and_front_page(), yaml)) == "");

  const std::string nav = "\nnav:\n  - Use:\n      - The scene: a.md\n";
  CHECK(lost_pages({{"README.md", "[a](docs/a.md#top)"}, {"docs/a.md", ""}}, nav).empty());
  CHECK(lost_pages({{"README.md", ""}, {"docs/a.md", ""}}, nav) ==
        Complaints{"docs/a.md:1: is not on the front page, README.md"});
  CHECK(lost_pages({{"README.md", "[b](docs/b.md)"}, {"docs/b.md", ""}}, nav) ==
        Complaints{"docs/b.md:1: is not in the navigation of docs/site/mkdocs.yml"});
  CHECK(lost_pages({{"README.md", ""}, {"docs/results/c.md", ""}}, nav) ==
        Complaints{"docs/results/c.md:1: is not in docs/results/README.md"});
}

TEST_CASE("site: the navigation names pages that are there", "[site]") {
  const std::set<std::string> elsewhere = {"index.md", "changelog.md"};  // README.md and CHANGELOG.md
  for (const std::string& page : navigation(read(root / "docs/site/mkdocs.yml"))) {
    INFO(page);
    CHECK((elsewhere.contains(page) || fs::exists(root / "docs" / page) || fs::exists(root / "docs/site" / page)));
  }
}

TEST_CASE("site: the front page is short", "[site]") {
  const std::string text = read(root / "README.md");
  CHECK(std::count(text.begin(), text.end(), '\n') <= longest_front_page);
}

TEST_CASE("site: the Python reference has all that the package has", "[site]") {
  const std::string package = read(root / "pipeline/python/selvedge/__init__.py");
  const std::string all = package.substr(package.find("__all__"), package.find(']') - package.find("__all__"));
  const std::set<std::string> names = all_matches(all, std::regex("\"(\\w+)\""));
  CHECK(names.size() > 10);
  CHECK(all_matches(read(root / "docs/site/python_api.md"), std::regex(R"(::: selvedge\.(\w+))")) == names);
}

}  // namespace selvedge::test_site
