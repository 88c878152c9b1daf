#include "pipeline/compare/training_sequences.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "collision/geometry/error.hpp"
#include "learned/network/weights_hdf5.hpp"
#include "pipeline/obstacles/setup_paths.hpp"
#include "pipeline/scene/config_scene.hpp"
#include "pipeline/training/trained_on.hpp"

namespace selvedge {
namespace {

// Lines of a list's item.
std::string item_yaml(const std::string& section) {
  std::string text = "\n- ";
  for (const char c : section) {
    text += c;
    if (c == '\n') text += "  ";
  }
  return text;
}

// The scene's first cloth, once for each garment, as YAML of the list.
std::string cloths_yaml(const Config& scene, const std::vector<Config>& garments) {
  std::string list;
  for (const Config& garment : garments) {
    Config cloth = scene["cloths"].items.front();
    Config& entry = cloth["garment"];
    const Key* key = entry.key;
    entry = garment;
    entry.key = key;
    list += item_yaml(to_yaml(cloth));
  }
  return list;
}

std::string file_name(std::string name) {
  std::ranges::replace(name, '/', '_');
  return name;
}

// A scene, and which of its parts are held out.
struct TrainingSequence {
  CompareScene scene;
  HeldOut held;
};

struct TrainingSequences {
  const Comparison& comparison;
  const Config scene;
  const TrainingOptions options;
  Split wanted;
  std::vector<TrainedPerson> contents = contents_of(options.samples);

  // An outfit of the training file's own outfits.yaml is found from that folder alone.
  bool needs_folder(const Config& wear) const {
    return std::ranges::any_of(wear["garments"].items, [](const Config& garment) { return garment["outfit"].given; }) &&
           config_near(options.samples.folder, "outfits.yaml") != config_folder() / "outfits.yaml";
  }
  CompareScene made(const Config& person, const Config& wear, const Config& clip) const {
    CompareScene made;
    made.file = comparison.file.parent_path() / comparison.sequences.file;
    made.outfit = person["name"].text() + "_" + wear["name"].text();
    made.name = file_name(made.outfit + "_" + clip["name"].text());
    made.states = 0;
    made.overrides = {"cloths=" + cloths_yaml(scene, wear["garments"].items),
                      "obstacles.person.body=\n" + to_yaml(performing(person["body"], clip)),
                      fmt::format("run.frames={}", comparison.sequences.frames)};
    if (needs_folder(wear)) made.overrides.push_back("folder=" + quoted_yaml(options.samples.folder.string()));
    return made;
  }
  std::vector<TrainingSequence> all() const {
    std::vector<TrainingSequence> found;
    const SampleOptions& samples = options.samples;
    const std::vector<Config> people = with_absolute_paths(samples.people, samples.folder);
    for (std::size_t p = 0; p < people.size(); ++p) {
      const Config &person = people[p], &all_wear = person["wear"], &all_clips = person["clips"];
      const Split of_person = split_of(samples.split, person["name"].text());
      for (std::size_t w = 0; w < all_wear.items.size(); ++w)
        for (std::size_t c = 0; c < all_clips.items.size(); ++c) {
          const Config &wear = all_wear.items[w], &clip = all_clips.items[c];
          const Split of_wear = split_of_wear(samples.split, wear, samples.folder),
                      of_clip = split_of_clip(samples.split, clip);
          if (std::max({of_person, of_wear, of_clip}) != wanted) continue;
          const TrainedPerson& whole = contents[p];
          found.push_back({made(person, wear, clip),
                           {{whole.name, whole.body, {whole.wear[w]}, {whole.clips[c]}},
                            of_person != Split::training,
                            of_wear != Split::training,
                            of_clip != Split::training}});
        }
    }
    return found;
  }
};

// The weights of a setting's network in a scene; empty: it runs none, or its file is not there.
std::filesystem::path weights_of(const CompareSetting& setting, const CompareScene& scene, const Kinds& kinds) {
  std::vector<std::string> overrides = scene.overrides;
  overrides.insert(overrides.end(), setting.overrides.begin(), setting.overrides.end());
  const auto table = scene_table(kinds);  // which the configuration refers to
  const Config config = read_config(scene.file, table->scene, overrides);
  const Config& run = config["run"];
  const std::vector<std::string>& named = run["learned"]["weights"].words;
  if (named.empty() || named[0].empty() || kinds.find(run["stepper"].text())->network == NetworkUse::none) return {};
  const std::filesystem::path path = files_folder(config, scene.file) / named[0];
  std::error_code ignored;
  return std::filesystem::is_regular_file(path, ignored) ? path : std::filesystem::path();
}

// What is held out of these sequences, for people.
std::string held_out_text(const std::vector<TrainingSequence>& sequences) {
  std::vector<std::string> names;
  const auto add = [&](bool is_held_out, const std::string& what) {
    if (is_held_out && std::ranges::find(names, what) == names.end()) names.push_back(what);
  };
  for (const TrainingSequence& one : sequences) {
    add(one.held.person, "person " + one.held.who.name);
    add(one.held.wear, "worn " + one.held.who.wear[0].name);
    add(one.held.clip, "clip " + one.held.who.clips[0].name);
  }
  return names.empty() ? "nothing" : joined(names);
}

// A line a setting that runs a network: what its weights were trained on. Throws Error where that is held out.
std::string check_trained(const Comparison& comparison, const std::vector<TrainingSequence>& sequences) {
  std::string text;
  for (const CompareSetting& setting : comparison.settings) {
    const std::filesystem::path weights = weights_of(setting, sequences.front().scene, comparison.kinds);
    if (weights.empty()) continue;
    const std::string row = fmt::format("row `{}`: {}", setting.name, weights.filename().string()),
                      record = read_weight_file(weights).trained_on;
    if (record.empty()) {
      text += "\nwarning: " + row + " has no record of its training data, which may include what is held out here";
      continue;
    }
    const TrainedOn on = read_trained_on(record, weights.string() + ": trained_on");
    for (const TrainingSequence& one : sequences)
      if (const std::string seen = seen_in_training(on, one.held); !seen.empty())
        throw Error(fmt::format("the weights of the row `{}` were trained on {}, which is held out here: {}",
                                setting.name, seen, trained_on_text(on)),
                    weights.string(),
                    "train with the `split` of " + comparison.sequences.training + ", or take the row out");
    text += "\n" + row + " was trained on " + trained_on_text(on);
    if (!on.whole) text += "\nwarning: " + row + " began with weights that have no record of their training data";
  }
  return text;
}

Split split_named(const std::string& name) {
  for (const Split split : {Split::validation, Split::test})
    if (name == split_name(split)) return split;
  return Split::training;
}

}  // namespace

void add_training_sequences(Comparison& comparison) {
  const SequenceOptions& sequences = comparison.sequences;
  const std::filesystem::path folder = comparison.file.parent_path(), training = folder / sequences.training;
  if (sequences.file.empty())
    throw Error("lacks its scene file", "`sequences`",
                "give a scene with one garment on a body `person`, such as configs/evaluation/garment.yaml");
  const TrainingSequences from{comparison, read_config(folder / sequences.file, scene_section()),
                               read_training(training), split_named(sequences.split)};
  if (from.scene["cloths"].items.empty())
    throw Error("has no cloth", (folder / sequences.file).string(), "give it one with a `garment`");
  const std::vector<TrainingSequence> all = from.all();
  if (all.empty())
    throw Error("has nothing of the split `" + sequences.split + "`", training.string(),
                "name clips or garments of `people` under `samples.split`, or ask for another split");
  const std::size_t there = all.size(),
                    taken = sequences.count > 0 ? std::min(there, static_cast<std::size_t>(sequences.count)) : there;
  std::vector<TrainingSequence> some;
  for (std::size_t k = 0; k < taken; ++k) some.push_back(all[k * there / taken]);
  for (const TrainingSequence& one : some) comparison.scenes.push_back(one.scene);
  comparison.split_text = fmt::format("sequences: {} of {} of the split `{}` of {}; held out: {}", taken, there,
                                      sequences.split, training.string(), held_out_text(some)) +
                          check_trained(comparison, some);
}

}  // namespace selvedge
