#include "pipeline/compare/training_sequences.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "collision/geometry/error.hpp"
#include "pipeline/scene/config_scene.hpp"
#include "pipeline/training/training_options.hpp"

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

struct TrainingSequences {
  const Comparison& comparison;
  const Config scene;
  const TrainingOptions options;
  Split wanted;

  CompareScene made(const Config& person, const Config& wear, const Config& clip) const {
    CompareScene made;
    made.file = comparison.file.parent_path() / comparison.sequences.file;
    made.outfit = person["name"].text() + "_" + wear["name"].text();
    made.name = file_name(made.outfit + "_" + clip["name"].text());
    made.states = 0;
    made.overrides = {"cloths=" + cloths_yaml(scene, wear["garments"].items),
                      "obstacles.person.body=\n" + to_yaml(performing(person["body"], clip)),
                      fmt::format("run.frames={}", comparison.sequences.frames)};
    return made;
  }
  std::vector<CompareScene> all() const {
    std::vector<CompareScene> scenes;
    const SplitOptions& split = options.samples.split;
    for (const Config& person : options.samples.people)
      for (const Config& wear : person["wear"].items)
        for (const Config& clip : person["clips"].items)
          if (std::max({split_of(split, person["name"].text()), split_of_wear(split, wear),
                        split_of_clip(split, clip)}) == wanted)
            scenes.push_back(made(person, wear, clip));
    return scenes;
  }
};

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
    throw Error("`sequences` lacks its scene file", comparison.file.string(),
                "give a scene with one garment on a body `person`, such as configs/evaluation/garment.yaml");
  const TrainingSequences from{comparison, read_config(folder / sequences.file, scene_section()),
                               read_training(training), split_named(sequences.split)};
  if (from.scene["cloths"].items.empty())
    throw Error("has no cloth", (folder / sequences.file).string(), "give it one with a `garment`");
  std::vector<CompareScene> all = from.all();
  if (all.empty())
    throw Error("has nothing of the split `" + sequences.split + "`", training.string(),
                "name clips or garments of `people` under `samples.split`, or ask for another split");
  const std::size_t there = all.size(),
                    taken = sequences.count > 0 ? std::min(there, static_cast<std::size_t>(sequences.count)) : there;
  for (std::size_t k = 0; k < taken; ++k) comparison.scenes.push_back(std::move(all[k * there / taken]));
  comparison.split_text =
      fmt::format("sequences: {} of {} of the split `{}` of {}", taken, there, sequences.split, training.string());
}

}  // namespace selvedge
