#include "pipeline/garments/outfit.hpp"

#include <algorithm>
#include <span>

#include "pipeline/config/config_tables.hpp"
#include "pipeline/garments/garment_make.hpp"

namespace selvedge {
namespace {

using namespace table;

const Section& garment_section() {
  static const Section table{"garment",
                             "",
                             {needed(text("name", "of a garment by code")),
                              needed(word("split", {"training", "validation"}, "", "what it is for"))}};
  return table;
}

const Section& outfit_section() {
  static const Section table{"outfit",
                             "",
                             {needed(text("name", "")), needed(texts("garments", "from the body outward")),
                              needed(number("edge", Unit::length, positive, "", "of the full form")),
                              needed(number("small_edge", Unit::length, positive, "", "of the form for quick runs"))}};
  return table;
}

const Section& file_section() {
  static const Section table{
      "wardrobe",
      "The whole file.",
      {text("description", "for people"), needed(sections("garments", garment_section(), "", "all garments by code")),
       needed(sections("outfits", outfit_section(), "", "what is worn together"))}};
  return table;
}

bool has(const std::vector<std::string>& list, const std::string& name) {
  return std::find(list.begin(), list.end(), name) != list.end();
}

Outfit read_outfit(const Config& item, const Wardrobe& wardrobe) {
  const Config& garments = item["garments"];
  Outfit outfit{item["name"].text(), garments.words, item["edge"].number(), item["small_edge"].number()};
  for (const Outfit& other : wardrobe.outfits)
    if (other.name == outfit.name) item["name"].fail("comes twice: `" + outfit.name + "`", "name an outfit once");
  if (garments.words.empty()) garments.fail("is empty", "name at least one garment");
  outfit.validation = has(wardrobe.validation, garments.words.front());
  for (const std::string& name : garments.words) {
    const std::vector<std::string> known = garment_names();
    if (!has(known, name))
      garments.fail("names `" + name + "`", "garments: " + joined(known) + suggestion(name, known));
    if (!has(outfit.validation ? wardrobe.validation : wardrobe.training, name))
      garments.fail("mixes garments for training and for validation",
                    "take garments of one split: `" + name + "` is of the other than `" + garments.words.front() + "`");
  }
  return outfit;
}

}  // namespace

Wardrobe read_wardrobe(const std::filesystem::path& path) {
  const Config config = read_config(path, file_section());
  const std::vector<std::string> known = garment_names();
  Wardrobe wardrobe;
  for (const Config& item : config["garments"].items) {
    const std::string& name = item["name"].text();
    if (!has(known, name))
      item["name"].fail("is `" + name + "`", "garments: " + joined(known) + suggestion(name, known));
    if (has(wardrobe.training, name) || has(wardrobe.validation, name))
      item["name"].fail("comes twice: `" + name + "`", "name a garment once");
    (item["split"].text() == "validation" ? wardrobe.validation : wardrobe.training).push_back(name);
  }
  for (const std::string& name : known)
    if (!has(wardrobe.training, name) && !has(wardrobe.validation, name))
      config["garments"].fail("lacks `" + name + "`", "say what every garment is for");
  for (const Config& item : config["outfits"].items) wardrobe.outfits.push_back(read_outfit(item, wardrobe));
  return wardrobe;
}

std::vector<Garment> kept_outfit(const std::filesystem::path& folder, const Outfit& outfit, const BodyModel& mannequin,
                                 double edge) {
  std::vector<Garment> garments;
  for (std::size_t k = 0; k < outfit.garments.size(); ++k)
    garments.push_back(
        kept_garment(folder, outfit.garments[k], mannequin, {.edge = edge}, std::span(outfit.garments).first(k)));
  return garments;
}

std::vector<Garment> kept_layers(const std::filesystem::path& folder, const Outfit& outfit, const BodyModel& mannequin,
                                 double edge) {
  std::vector<Garment> garments;
  for (const std::string& name : outfit.garments)
    garments.push_back(kept_garment(folder, name, mannequin, {.edge = edge}));
  return garments;
}

}  // namespace selvedge
