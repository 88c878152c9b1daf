#include "pipeline/cells/cell_list.hpp"

#include <algorithm>
#include <set>

#include "collision/geometry/error.hpp"
#include "pipeline/config/config.hpp"

namespace selvedge {
namespace {

bool is_plain(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9'); }

}  // namespace

std::string cell_name(const std::string& text) {
  std::string name = text;
  std::ranges::replace_if(
      name, [](char c) { return !is_plain(c) && c != '.' && c != '_' && c != '-'; }, '_');
  return name.empty() || !is_plain(name[0]) ? "c" + name : name;
}

void number_equal_names(std::vector<std::string>& names) {
  std::set<std::string> taken;
  for (std::string& name : names) {
    const std::string first = name;
    for (int k = 2; !taken.insert(name).second; ++k) name = first + "_" + std::to_string(k);
  }
}

std::size_t number_of(const CellList& list, const std::string& name) {
  const auto found = std::ranges::find(list.names, name);
  if (found != list.names.end()) return static_cast<std::size_t>(found - list.names.begin());
  throw Error("there is no cell `" + name + "`" + suggestion(name, list.names), list.file.string(),
              "`selvedge cells " + list.file.string() + "` lists them");
}

// The median row of the wardrobe took 65 us a vertex and frame with its audits (docs/garments/wardrobe.csv).
double rough_seconds(int vertices, double frames) { return 65e-6 * vertices * frames; }

}  // namespace selvedge
