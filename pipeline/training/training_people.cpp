#include "pipeline/training/training_people.hpp"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "collision/geometry/error.hpp"
#include "pipeline/garments/outfit.hpp"
#include "pipeline/host/file_formats.hpp"
#include "pipeline/host/lower_extension.hpp"
#include "pipeline/motions/clip_split.hpp"
#include "pipeline/obstacles/setup_paths.hpp"
#include "pipeline/run/run_inputs_yaml.hpp"
#include "pipeline/scene/config_scene.hpp"

namespace selvedge {
namespace {

using namespace table;
namespace fs = std::filesystem;

const std::vector<std::string> body_keys_of_clips{"shape",       "animation", "joints",   "rest_frame",
                                                  "first_frame", "turns",     "blend_in", "start_pose"};

Key weight_key(const std::string& what) {
  return number("weight", Unit::none, positive, "1", "How often " + what + " is drawn, beside the others' weights.");
}

// `*` stands for any characters, including slashes. Every piece between stars is found where it first occurs.
bool matches(std::string_view pattern, std::string_view text) {
  std::size_t star = pattern.find('*');
  if (star == std::string_view::npos) return pattern == text;
  if (!text.starts_with(pattern.substr(0, star))) return false;
  text.remove_prefix(star);
  for (pattern.remove_prefix(star + 1); (star = pattern.find('*')) != std::string_view::npos;
       pattern.remove_prefix(star + 1)) {
    const std::size_t at = text.find(pattern.substr(0, star));
    if (at == std::string_view::npos) return false;
    text.remove_prefix(at + star);
  }
  return text.ends_with(pattern);
}

bool is_pattern(const std::string& text) { return text.find('*') != std::string::npos; }
bool is_file(const std::string& text) { return fs::path(text).has_extension(); }
bool is_clip_file(const fs::path& file) {
  const std::string extension = lower_extension(file);
  return extension == ".bvh" || extension == ".npz" || is_gltf(file);
}

std::string without_extension(const std::string& file) { return fs::path(file).replace_extension().generic_string(); }

// The default name of a clip: its file without the extension, unless another of `files` would have the same name.
std::string clip_name(const Config& clip, const std::vector<std::string>& files) {
  const std::string& file = clip["clip"].text();
  const auto same = [&](const std::string& other) { return without_extension(other) == without_extension(file); };
  std::string name = is_file(file) && std::ranges::count_if(files, same) == 1 ? without_extension(file) : file;
  if (clip["animation"].given) name += ":" + clip["animation"].text();
  return name;
}

void set_text(const std::string& value, Config& entry) {
  entry.words = {value};
  entry.given = true;
}

void set_path(const PathsOfFile& paths, Config& entry) {
  existing_path(entry, paths.folder);
  set_text(paths.seen(entry), entry);
}

// The files of clips that the pattern matches, ascending. They are searched below the folder before the first `*`.
std::vector<std::string> found_files(const Config& clip, const fs::path& folder) {
  const std::string& pattern = clip.text();
  const std::string begin = pattern.substr(0, pattern.find('*'));
  fs::path below = expanded_path(clip, begin.substr(0, begin.rfind('/') + 1), folder);
  if (below.empty()) below = ".";
  // Without a folder, entries are `./NAME` and the pattern may be `NAME`.
  const std::string whole = expanded_path(clip, pattern, folder).lexically_normal().generic_string();
  std::vector<std::string> files;
  constexpr auto skip_denied = fs::directory_options::skip_permission_denied;
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(below, skip_denied, ignored))
    if (entry.is_regular_file() && is_clip_file(entry.path()) &&
        matches(whole, entry.path().lexically_normal().generic_string()))
      files.push_back(pattern.starts_with('/') || pattern.starts_with('$')
                          ? entry.path().generic_string()
                          : entry.path().lexically_relative(folder.empty() ? "." : folder).generic_string());
  std::ranges::sort(files);
  if (files.empty())
    clip.fail("finds no .bvh, .npz, .glb or .gltf file",
              "`*` stands for any characters; files are looked for below " + below.string());
  return files;
}

// Copies an entry of one section into another section, under that section's key.
void take_over(const Config& from, Config& entry) {
  const Key* own = entry.key;
  entry = from;
  entry.key = own;
}

void settle_clips(const PathsOfFile& paths, Config& person) {
  std::vector<Config> settled;
  for (const Config& clip : person["clips"].items) {
    std::vector<std::string> files{clip["clip"].text()};
    if (is_pattern(files[0])) {
      if (clip["name"].given) clip["name"].fail("is given for a pattern", "leave it out: each file has its own");
      files = found_files(clip["clip"], paths.folder);
    }
    for (const std::string& file : files) {
      Config& one = settled.emplace_back(clip);
      set_text(file, one["clip"]);
      if (!one["name"].given) set_text(clip_name(one, files), one["name"]);
      if (is_file(file)) set_path(paths, one["clip"]);
      for (const std::string& key : body_keys_of_clips)
        if (!one[key].given) take_over(person["body"][key], one[key]);
    }
  }
  person["clips"].items = std::move(settled);
}

void settle_wear(const PathsOfFile& paths, Config& wear) {
  std::string name;
  for (Config& garment : wear["garments"].items) {
    if (garment["on"].given) garment["on"].fail("is given in training", "leave it out: the person wears it");
    const Config& what = garment[garment["file"].given ? "file" : garment["cut"].given ? "cut" : "outfit"];
    name += (name.empty() ? "" : "_") + fs::path(what.text()).stem().string();
    if (garment["file"].given) set_path(paths, garment["file"]);
  }
  if (name.empty()) wear["garments"].fail("is empty", "name at least one garment");
  if (!wear["name"].given) set_text(name, wear["name"]);
}

void check_names(const std::vector<Config>& items) {
  std::set<std::string> names;
  for (const Config& item : items)
    if (!names.insert(item["name"].text()).second)
      item.fail("has the name `" + item["name"].text() + "` of another",
                "take each once, or give it a `name` of its own");
}

// Visits all entries that name a file.
template <class Visit>
void visit_files(std::vector<Config>& people, const Visit& visit) {
  const auto look = [&](Config& entry) {
    if (entry.given && is_file(entry.text())) visit(entry);
  };
  for (Config& person : people) {
    look(person["body"]["model"]);
    for (Config& clip : person["clips"].items) look(clip["clip"]);
    for (Config& wear : person["wear"].items)
      for (Config& garment : wear["garments"].items) look(garment["file"]);
  }
}

bool names_any(const std::vector<std::string>& patterns, const std::string& name) {
  return std::ranges::any_of(patterns, [&](const std::string& pattern) { return matches(pattern, name); });
}

const Section& person_clip_section() {
  static const Section section = [] {
    Section made{
        "person_clip",
        "A clip of a person, with the keys that `body` of a scene has for it. What is left out is as the "
        "person's `body` says.",
        {text("name",
              "Name of the clip. Default: the file as it is named here, without its extension, or with it "
              "where a pattern finds files that differ in it alone."),
         weight_key("the clip"),
         needed(text("clip",
                     "A procedural clip, or a .bvh, AMASS .npz, .glb or .gltf file, relative to this file. `*` "
                     "stands for any characters, folders included: all such files of clips are taken."))},
        "clip"};
    for (const Key& key : body_section().keys)
      if (std::ranges::find(body_keys_of_clips, key.name) != body_keys_of_clips.end()) made.keys.push_back(key);
    return made;
  }();
  return section;
}

const Section& wear_section() {
  static const Section table{"wear",
                             "A garment, or an outfit of them.",
                             {text("name", "Name of it. Default: those of its garments."), weight_key("it"),
                              needed(sections("garments", garment_section(), "",
                                              "What is worn, from the body outward, as `garment` of a scene."))}};
  return table;
}

}  // namespace

std::string split_name(Split split) {
  return split == Split::training ? "training" : split == Split::validation ? "validation" : "test";
}

const Options<SplitOptions>& split_options() {
  using O = SplitOptions;
  static const Options<O> table(
      "split",
      "What of `people` is held out: names of people, of what they wear, or of clips. `*` stands for any characters. "
      "The program's own garments and clips have their own split (configs/outfits.yaml, configs/clips.yaml).",
      {path("file", &O::file, "YAML file with the lists `validation` and `test`, relative to this file."),
       texts("validation", &O::validation, "Names that are held out for choosing between networks."),
       texts("test", &O::test, "Names that are held out for the last evaluation.")},
      "file");
  return table;
}

const Section& person_section() {
  static const Section table{
      "person",
      "One who wears garments and moves. Every garment is seen with every clip.",
      {text("name", "Name of the person. Default: person0, person1, ..."), weight_key("the person"),
       needed(section(body_section(), "", "The body, as `body` of a scene. A `clip` here is the only one.")),
       sections("clips", person_clip_section(), "[]", "How it moves. Default: the `clip` of the body."),
       needed(sections("wear", wear_section(), "", "What it wears: one of these at a time."))}};
  return table;
}

std::string PathsOfFile::seen(const Config& entry) const {
  const fs::path named = expanded_path(entry, entry.text(), {});
  if (named.is_absolute()) return named.lexically_normal().string();
  const fs::path whole = folder.empty() ? fs::current_path() : fs::absolute(folder);
  return (whole / named).lexically_normal().lexically_proximate(from).string();
}

void settle_people(const PathsOfFile& paths, std::vector<Config>& people) {
  for (std::size_t k = 0; k < people.size(); ++k) {
    Config& person = people[k];
    if (!person["name"].given) set_text(fmt::format("person{}", k), person["name"]);
    Config& body = person["body"];
    if (is_file(body["model"].text())) set_path(paths, body["model"]);
    if (body["clip"].given) {
      if (!person["clips"].items.empty())
        body["clip"].fail("is given beside `clips`", "move it, with its keys, into the list");
      Config clip = empty_section(person_clip_section());
      for (Config& entry : clip.entries) entry.given = false;
      clip.path = body.path + ".clip";
      clip.where = body["clip"].where;
      clip["clip"].where = body["clip"].where;
      clip["weight"].numbers = {1};
      set_text(body["clip"].text(), clip["clip"]);
      body["clip"].words.clear();
      body["clip"].given = false;
      person["clips"].items = {clip};
    }
    settle_clips(paths, person);
    if (person["clips"].items.empty())
      person.fail("has no clip", "name some under `clips`, such as `[walk, moves/*.npz]`");
    for (Config& wear : person["wear"].items) settle_wear(paths, wear);
    if (person["wear"].items.empty()) person["wear"].fail("is empty", "name at least one `{garments: [FILE]}`");
    check_names(person["wear"].items);
    check_names(person["clips"].items);
  }
  check_names(people);
}

void settle_split(const fs::path& folder, const Config& at, SplitOptions& split) {
  if (split.file.empty()) return;
  static const Section lists{"split", "", {text("description", ""), texts("validation", ""), texts("test", "")}};
  const Config config = read_config(existing_path(at, split.file, folder), lists);
  const auto add = [&](const char* key, std::vector<std::string>& names) {
    names.insert(names.end(), config[key].words.begin(), config[key].words.end());
  };
  add("validation", split.validation);
  add("test", split.test);
  split.file.clear();
}

Split split_of(const SplitOptions& split, const std::string& name) {
  if (names_any(split.test, name)) return Split::test;
  return names_any(split.validation, name) ? Split::validation : Split::training;
}

Split split_of_clip(const SplitOptions& split, const Config& clip) {
  const Split said = split_of(split, clip["name"].text());
  if (said != Split::training || is_file(clip["clip"].text())) return said;
  for (const ClipEntry& entry : read_clip_split(config_folder() / "clips.yaml"))
    if (entry.name == clip["clip"].text() && entry.validation) return Split::validation;
  return said;
}

Split split_of_wear(const SplitOptions& split, const Config& wear, const fs::path& folder) {
  const Split said = split_of(split, wear["name"].text());
  if (said != Split::training) return said;
  const Wardrobe wardrobe = read_wardrobe(config_near(folder, "outfits.yaml"));
  for (const Config& garment : wear["garments"].items) {
    if (garment["cut"].given && std::ranges::count(wardrobe.validation, garment["cut"].text()) > 0)
      return Split::validation;
    for (const Outfit& outfit : wardrobe.outfits)
      if (garment["outfit"].given && outfit.name == garment["outfit"].text() && outfit.validation)
        return Split::validation;
  }
  return said;
}

void check_split(const std::vector<Config>& people, const SplitOptions& split, const std::string& where) {
  std::vector<std::string> names;
  for (const Config& person : people) {
    names.push_back(person["name"].text());
    for (const char* list : {"wear", "clips"})
      for (const Config& item : person[list].items) names.push_back(item["name"].text());
  }
  for (const auto* patterns : {&split.validation, &split.test})
    for (const std::string& pattern : *patterns)
      if (std::ranges::none_of(names, [&](const std::string& name) { return matches(pattern, name); }))
        throw Error("`" + pattern + "` names nothing of `people`", where + ": samples.split",
                    names.empty()
                        ? "the split is of `people`: there are none"
                        : "some of the names: " +
                              joined({names.begin(), names.begin() + std::min<std::ptrdiff_t>(12, std::ssize(names))}) +
                              suggestion(pattern, names));
}

Config performing(const Config& body, const Config& clip) {
  Config section = body;
  take_over(clip["clip"], section["clip"]);
  for (const std::string& key : body_keys_of_clips) take_over(clip[key], section[key]);
  return section;
}

std::vector<InputFile> files_of(const std::vector<Config>& people, const fs::path& folder) {
  std::vector<std::string> absolute, relative;
  std::vector<Config> own = people;
  visit_files(own, [&](const Config& entry) {
    (fs::path(entry.text()).is_absolute() ? absolute : relative).push_back(entry.text());
  });
  std::vector<InputFile> files = hashed_files(relative, folder);
  for (InputFile& file : hashed_files(absolute, {})) files.push_back(std::move(file));
  return files;
}

std::vector<Config> with_absolute_paths(std::vector<Config> people, const fs::path& folder) {
  visit_files(people, [&](Config& entry) { entry.words = {(folder / entry.text()).lexically_normal().string()}; });
  return people;
}

std::vector<Config> travelling(std::vector<Config> people) {
  visit_files(people, [](Config& entry) {
    const fs::path path(entry.text());
    entry.words = {(path.parent_path().filename() / path.filename()).string()};
  });
  return people;
}

}  // namespace selvedge
