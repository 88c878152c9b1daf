#include "pipeline/motions/clip_split.hpp"

#include <algorithm>

#include "pipeline/config/config_tables.hpp"
#include "pipeline/motions/clip_procedural.hpp"

namespace selvedge {
namespace {

using namespace table;

const Section& entry_section() {
  static const Section table{
      "clip",
      "",
      {needed(text("name", "of a procedural clip")), needed(integer("frames", at_least_one, "", "at 30 a second")),
       needed(word("split", {"training", "validation"}, "", "what it is for"))}};
  return table;
}

const Section& file_section() {
  static const Section table{
      "clips",
      "The whole file.",
      {text("description", "for people"), needed(sections("clips", entry_section(), "", "all clips"))}};
  return table;
}

}  // namespace

std::vector<ClipEntry> read_clip_split(const std::filesystem::path& path) {
  const Config config = read_config(path, file_section());
  const std::vector<std::string> known = procedural_clip_names();
  std::vector<ClipEntry> entries;
  for (const Config& item : config["clips"].items) {
    const std::string& name = item["name"].text();
    if (std::find(known.begin(), known.end(), name) == known.end())
      item["name"].fail("is `" + name + "`", "clips: " + joined(known) + suggestion(name, known));
    if (std::any_of(entries.begin(), entries.end(), [&](const ClipEntry& entry) { return entry.name == name; }))
      item["name"].fail("comes twice: `" + name + "`", "name a clip once");
    entries.push_back({name, item["frames"].integer(), item["split"].text() == "validation"});
  }
  return entries;
}

}  // namespace selvedge
