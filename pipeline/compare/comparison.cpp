#include "pipeline/compare/comparison.hpp"

#include <algorithm>

#include "pipeline/config/options.hpp"

namespace selvedge {
namespace {

using namespace table;

const Options<CompareScene>& compared_scene_options() {
  using O = CompareScene;
  static const Options<O> table(
      "compared_scene", "",
      {needed(path("file", "scene file, from this file's folder")), text("name", "left out: the file's"),
       texts("set", &O::overrides, "`key=value` overrides of the scene"),
       integer("states", &O::states, at_least_one, "common states, spread over the run"),
       integer("horizon", &O::horizon, at_least_one, "frames from each of them")},
      "file");
  return table;
}

const Section& setting_section() {
  static const Section table{
      "setting",
      "",
      "",
      {},
      {needed(text("name", "")), texts("set", "`key=value` overrides of every scene; none: its defaults")}};
  return table;
}

const Options<Comparison>& comparison_options() {
  using O = Comparison;
  static const Options<O> table(
      "comparison", "The whole file.",
      {text("description", "for people"),
       needed(sections("scenes", compared_scene_options().section, "", "at least one")),
       needed(sections("settings", setting_section(), "", "at least one")),
       texts("reference", &O::reference, "`key=value` overrides of the temporal reference, beside its time step"),
       integer("repeats", &O::repeats, at_least_one, "timed runs of each setting"),
       number("jitter", &O::jitter, Unit::none, not_negative, "of the floor's states, in mean edge lengths"),
       texts("short_form", "`key=value` overrides of this file that make it shorter (`--short`)")});
  return table;
}

void check_names(const Config& list, const std::vector<std::string>& names) {
  if (names.empty()) list.fail("is empty", "give at least one");
  for (std::size_t k = 0; k < names.size(); ++k)
    if (std::find(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(k), names[k]) !=
        names.begin() + static_cast<std::ptrdiff_t>(k))
      list.items[k].fail("has the name `" + names[k] + "` of another", "give every one its own name");
}

}  // namespace

Comparison read_comparison(const std::filesystem::path& file, bool short_form) {
  Config config = read_config(file, comparison_options().section);
  if (short_form && !config["short_form"].words.empty())
    config = read_config(file, comparison_options().section, config["short_form"].words);
  Comparison comparison = comparison_options().read(config);
  comparison.file = file;
  std::vector<std::string> scenes, settings;
  for (const Config& item : config["scenes"].items) {
    CompareScene scene = compared_scene_options().read(item);
    scene.file = file.parent_path() / item["file"].text();
    scene.name = item["name"].given ? item["name"].text() : scene.file.stem().string();
    scenes.push_back(scene.name);
    comparison.scenes.push_back(std::move(scene));
  }
  for (const Config& item : config["settings"].items) {
    settings.push_back(item["name"].text());
    comparison.settings.push_back({item["name"].text(), item["set"].words});
  }
  check_names(config["scenes"], scenes);
  check_names(config["settings"], settings);
  return comparison;
}

}  // namespace selvedge
