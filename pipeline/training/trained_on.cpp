#include "pipeline/training/trained_on.hpp"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "collision/geometry/error.hpp"
#include "pipeline/host/json_text.hpp"
#include "pipeline/host/kept_rows.hpp"
#include "pipeline/host/library_message.hpp"

namespace selvedge {
namespace {

// Hashes of names in configurations: of the bytes of a file, or of any other name itself.
struct Contents {
  std::map<std::string, std::uint64_t> files;

  std::uint64_t of(const std::string& named, std::uint64_t before = hash_of("")) const {
    const auto file = files.find(named);
    return file == files.end() ? hash_of(named + "\n", before)
                               : hash_of(fmt::format("{:016x}\n", file->second), before);
  }
  std::uint64_t of_wear(const Config& wear) const {
    std::uint64_t hash = hash_of("");
    for (const Config& garment : wear["garments"].items) {
      for (const char* key : {"file", "cut", "outfit"})
        if (garment[key].given) hash = of(garment[key].text(), hash);
      for (const std::string& under : garment["over"].words) hash = of(under, hash);
    }
    return hash;
  }
  std::uint64_t of_clip(const Config& clip) const {
    const std::uint64_t hash = of(clip["clip"].text());
    return clip["animation"].given ? of(clip["animation"].text(), hash) : hash;
  }
  std::uint64_t of_body(const Config& body) const {
    return hash_of(fmt::format("{}", fmt::join(body["shape"].numbers, " ")), of(body["model"].text()));
  }
};

Contents contents(const SampleOptions& samples) {
  Contents all;
  for (const InputFile& file : files_of(samples.people, samples.folder)) all.files[file.name] = file.hash;
  return all;
}

TrainedPerson mannequin(const SampleOptions& samples) {
  const Contents made;
  TrainedPerson person{"mannequin", hash_of("", made.of("mannequin")), {}, {}};
  for (const std::string& name : samples.garments) person.wear.push_back({name, made.of(name)});
  for (const std::string& name : training_clip_names(samples)) person.clips.push_back({name, made.of(name)});
  return person;
}

// The person with the wear and the clips of training, or with all.
TrainedPerson content_of(const Contents& all, const SampleOptions& samples, const Config& person, bool whole) {
  TrainedPerson one{person["name"].text(), all.of_body(person["body"]), {}, {}};
  for (const Config& wear : person["wear"].items)
    if (whole || split_of_wear(samples.split, wear, samples.folder) == Split::training)
      one.wear.push_back({wear["name"].text(), all.of_wear(wear)});
  for (const Config& clip : person["clips"].items)
    if (whole || split_of_clip(samples.split, clip) == Split::training)
      one.clips.push_back({clip["name"].text(), all.of_clip(clip)});
  return one;
}

std::string names_text(const std::vector<TrainedItem>& items) {
  constexpr std::size_t most = 12;
  std::vector<std::string> names;
  for (std::size_t k = 0; k < std::min(most, items.size()); ++k) names.push_back(items[k].name);
  return joined(names) + (items.size() > most ? fmt::format(" and {} more", items.size() - most) : "");
}

bool has(const std::vector<TrainedItem>& items, const TrainedItem& item) {
  return std::ranges::find(items, item.content, &TrainedItem::content) != items.end();
}

Json items_json(const std::vector<TrainedItem>& items) {
  Json list = Json::array();
  for (const TrainedItem& item : items) list.push_back({item.name, fmt::format("{:016x}", item.content)});
  return list;
}

std::uint64_t number_of(const Json& hash) { return std::stoull(hash.get<std::string>(), nullptr, 16); }

std::vector<TrainedItem> items_of(const Json& list) {
  std::vector<TrainedItem> items;
  for (const Json& item : list) items.push_back({item.at(0).get<std::string>(), number_of(item.at(1))});
  return items;
}

}  // namespace

std::vector<TrainedPerson> contents_of(const SampleOptions& samples) {
  const Contents all = contents(samples);
  std::vector<TrainedPerson> people;
  for (const Config& person : samples.people) people.push_back(content_of(all, samples, person, true));
  return people;
}

TrainedOn trained_on(const SampleOptions& samples) {
  TrainedOn on;
  if (has_mannequin(samples)) on.people.push_back(mannequin(samples));
  const Contents all = contents(samples);
  for (const Config& person : samples.people)
    if (split_of(samples.split, person["name"].text()) == Split::training)
      on.people.push_back(content_of(all, samples, person, false));
  return on;
}

void add_earlier(const std::string& record, const std::string& where, TrainedOn& on) {
  if (record.empty()) {
    on.whole = false;
    return;
  }
  const TrainedOn earlier = read_trained_on(record, where);
  on.people.insert(on.people.end(), earlier.people.begin(), earlier.people.end());
  on.whole = on.whole && earlier.whole;
}

std::string trained_on_json(const TrainedOn& on) {
  Json people = Json::array();
  for (const TrainedPerson& person : on.people)
    people.push_back({{"name", person.name},
                      {"body", fmt::format("{:016x}", person.body)},
                      {"wear", items_json(person.wear)},
                      {"clips", items_json(person.clips)}});
  const Json record{{"people", people}, {"whole", on.whole}};
  return json_line(record);
}

TrainedOn read_trained_on(const std::string& json, const std::string& where) {
  try {
    const Json record = parse_json(json);
    TrainedOn on;
    on.whole = record.at("whole").get<bool>();
    for (const Json& person : record.at("people"))
      on.people.push_back({person.at("name").get<std::string>(), number_of(person.at("body")),
                           items_of(person.at("wear")), items_of(person.at("clips"))});
    return on;
  } catch (const std::exception& problem) {
    throw Error(fmt::format("holds no record of what the network was trained on ({})", library_message(problem.what())),
                where, "train or copy the weights again");
  }
}

std::string trained_on_text(const TrainedOn& on) {
  std::vector<std::string> people;
  for (const TrainedPerson& person : on.people)
    people.push_back(
        fmt::format("`{}`: to wear {}; clips {}", person.name, names_text(person.wear), names_text(person.clips)));
  return fmt::format("{}", fmt::join(people, "; "));
}

std::string seen_in_training(const TrainedOn& on, const HeldOut& held) {
  const TrainedItem &wear = held.who.wear.at(0), &clip = held.who.clips.at(0);
  for (const TrainedPerson& person : on.people) {
    if (held.clip && has(person.clips, clip)) return "the clip `" + clip.name + "`";
    if (held.wear && has(person.wear, wear)) return "`" + wear.name + "`, which is worn";
    const bool same = person.name == held.who.name || (has(person.wear, wear) && has(person.clips, clip));
    if (held.person && person.body == held.who.body && same) return "the person `" + held.who.name + "`";
  }
  return "";
}

}  // namespace selvedge
