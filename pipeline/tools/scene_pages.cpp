#include "pipeline/tools/scene_pages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "pipeline/config/section_tree.hpp"
#include "pipeline/scene/config_scene.hpp"

namespace selvedge {
namespace {

// A user's task, with the sections and keys that it needs. All other keys are the expert's.
struct Task {
  std::string title;
  std::vector<std::pair<std::string, std::string>> sections;  // name, keys
};

const std::vector<Task>& tasks() {
  static const std::vector<Task> all{
      {"The file", {{"scene", "description cloths springs obstacles gravity wind contact run solver output"}}},
      {"Cloths",
       {{"cloth", "name rectangle mesh garment scale rotate translate start material rest seams pins"},
        {"rectangle", "size resolution edge"},
        {"mesh", "file unit"},
        {"material", "name file density youngs_modulus poisson bending thickness stiffness_damping"},
        {"rest", "from flat"},
        {"pin", "vertices box group motion follow"},
        {"box_region", "min max"},
        {"motion", "keyframes"},
        {"keyframe", "time translate rotate"},
        {"seam", "from to pair file"},
        {"seam_side", "vertices box group"},
        {"spring", "from to pair rest_length stiffness"},
        {"selection", "cloth vertices box group"}}},
      {"Garments", {{"garment", "file unit cut over outfit form on pins"}, {"start", "from seconds"}}},
      {"Obstacles and bodies",
       {{"obstacle", "name plane sphere box mesh sequence body scale rotate translate motion"},
        {"plane", "size edge"},
        {"sphere", "radius edge"},
        {"box", "size edge"},
        {"sequence", "pattern cache mesh fps unit"},
        {"body", "model shape clip blend_in room"}}},
      {"Air and contact",
       {{"wind", "velocity keyframes drag"},
        {"wind_key", "time velocity"},
        {"contact", "thickness friction self_friction self"}}},
      {"The run",
       {{"run", "frames fps quality substeps stepper contact_forces learned hybrid refu"},
        {"learned", "weights device"},
        {"hybrid", "mode stop_when_slow"},
        {"refu", "on alpha weights"},
        {"solver", "integrator velocity_tolerance"},
        {"output", "folder"}}}};
  return all;
}

bool has_word(const std::string& words, const std::string& word) {
  std::istringstream stream(words);
  for (std::string one; stream >> one;)
    if (one == word) return true;
  return false;
}

const std::string* user_keys(const Section& section) {
  for (const Task& task : tasks())
    for (const auto& [name, keys] : task.sections)
      if (name == section.name) return &keys;
  return nullptr;
}

KeyTier tier_of(const Section& section, const Key& key) {
  const std::string* keys = user_keys(section);
  return keys && has_word(*keys, key.name) ? KeyTier::user : KeyTier::expert;
}

bool has_keys(const Section& section, KeyTier tier) {
  return std::ranges::any_of(section.keys, [&](const Key& key) { return tier_of(section, key) == tier; });
}

// Sections with chapters on a tier's page. Sections without a key are the expert's.
std::vector<const Section*> sections_of(KeyTier tier) {
  std::vector<const Section*> chosen;
  for (const Section* section : sections_below(scene_section()))
    if (section->keys.empty() ? tier == KeyTier::expert : has_keys(*section, tier)) chosen.push_back(section);
  return chosen;
}

KeyPage page_of(KeyTier tier) {
  return {[tier](const Section& section, const Key& key) { return tier_of(section, key) == tier; },
          [tier](const Section& section) -> std::string {
            const bool user = user_keys(section) != nullptr;
            if (tier == KeyTier::user) return user ? "" : "expert.md";
            return user ? "scene.md" : "";
          }};
}

}  // namespace

std::string scene_reference(KeyTier tier) {
  std::string text;
  const std::vector<const Section*> sections = sections_of(tier);
  if (tier == KeyTier::expert) {
    for (const Section* section : sections) text += section_chapter(*section, page_of(tier));
    return text;
  }
  for (const Task& task : tasks()) {
    text += "## " + task.title + ": keys\n\n";
    for (const auto& [name, keys] : task.sections)
      for (const Section* section : sections)
        if (section->name == name) {
          text += section_chapter(*section, page_of(tier));
          if (has_keys(*section, KeyTier::expert)) text += "[More keys](expert.md#" + name + ")\n\n";
        }
  }
  return text;
}

std::string scene_keys_text(KeyTier tier) {
  std::string text;
  for (const Section* section : sections_of(tier)) {
    text += section->name + "\n";
    for (const Key& key : section->keys) {
      if (tier_of(*section, key) != tier) continue;
      std::string facts = unit_symbol(key.unit);
      if (!key.otherwise.empty()) facts += (facts.empty() ? "" : ", ") + key.otherwise;
      text += fmt::format("  {:<20} {:<24} {}\n", key.name, facts, key.about);
    }
  }
  return text;
}

int scene_key_count(KeyTier tier) {
  int count = 0;
  for (const Section* section : sections_below(scene_section()))
    count += static_cast<int>(
        std::ranges::count_if(section->keys, [&](const Key& key) { return tier_of(*section, key) == tier; }));
  return count;
}

}  // namespace selvedge
