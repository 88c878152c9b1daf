#include "pipeline/suites/work_file.hpp"

#include <algorithm>

#include "collision/geometry/error.hpp"
#include "pipeline/cells/shot_cells.hpp"
#include "pipeline/compare/compare.hpp"
#include "pipeline/config/config_tables.hpp"
#include "pipeline/config/config_text.hpp"
#include "pipeline/drapes/make_drapes.hpp"
#include "pipeline/obstacles/setup_paths.hpp"
#include "pipeline/suites/stability.hpp"
#include "pipeline/suites/stress.hpp"
#include "pipeline/suites/wardrobe.hpp"

namespace selvedge {
namespace {

using namespace table;

Key kind_key() { return needed(text("cells", "Kind of the work.")); }
Key description_key() { return text("description", "Free text for readers."); }

const Section& shot_section() {
  static const Section table{
      "shot",
      "",
      {needed(path("scene", "Scene file, relative to this file's folder.")),
       text("name", "Name of the shot. Default: that of the scene's file, with a number where another has it."),
       texts("set", "`key=value` overrides of the scene.")},
      "scene"};
  return table;
}

const Section& shots_section() {
  static const Section table{"shots",
                             "",
                             {kind_key(), description_key(), needed(sections("shots", shot_section(), "", "Shots.")),
                              texts("set", "`key=value` overrides of every shot's scene, before the shot's own."),
                              flag("pages", true, "True: each run gets the page that plays it.")}};
  return table;
}

const Section& wardrobe_section() {
  static const Section table{"wardrobe",
                             "",
                             {kind_key(), description_key(), texts("wear", "Garments and outfits. Default: all."),
                              texts("clips", "Procedural clips. Default: all."),
                              integer("frames", not_negative, "0", "Largest number of frames of a clip. 0: all."),
                              path("configs", "Folder of the configurations. Default: the program's.")}};
  return table;
}

const Section& stress_section() {
  static const Section table{"stress",
                             "",
                             {kind_key(), description_key(), texts("scenes", "Names of scenes. Default: all."),
                              integer("repeats", at_least_one, "10", "Number of runs of each scene."),
                              integer("seed", not_negative, "1", "Seed of the jitter in the first repeat."),
                              number("jitter", Unit::none, not_negative, "0.01",
                                     "Largest random displacement of start positions, in mean edge lengths."),
                              flag("short", false, "True: the short forms of the scenes are run."),
                              path("configs", "Folder of the scenes. Default: the program's.")}};
  return table;
}

const Section& compare_section() {
  static const Section table{
      "compare",
      "",
      {kind_key(), description_key(), needed(path("file", "Comparison file, relative to this file's folder.")),
       flag("short", false, "True: the short forms of the comparison and of its scenes are run."),
       texts("set", "`key=value` overrides of the comparison.")}};
  return table;
}

const Section& stability_section() {
  static const Section table{
      "stability",
      "",
      {kind_key(), description_key(), needed(path("suite", "Suite file, relative to this file's folder.")),
       texts("cases", "Names of cases. Default: all."), text("stepper", "Stepper, in place of the scenes' own."),
       path("weights", "Weight file of its network, relative to this file's folder."),
       flag("short", false, "True: only the runs that the suite marks as short are done.")}};
  return table;
}

// The file or folder that a value names, relative to the file's folder.
std::filesystem::path path_of(const Config& value, const std::filesystem::path& folder) {
  std::filesystem::path found = folder / value.text();
  if (!std::filesystem::exists(found))
    value.fail("names `" + value.text() + "`, which is not there", "paths are relative to the work file's folder");
  return found;
}
std::filesystem::path path_or(const Config& value, const std::filesystem::path& folder, std::filesystem::path other) {
  return value.given ? path_of(value, folder) : std::move(other);
}

CellList shots(const std::filesystem::path& file) {
  const Config config = read_config(file, shots_section());
  ShotRequest request;
  request.pages = config["pages"].flag();
  std::vector<std::string> names;
  for (const Config& item : config["shots"].items) {
    Shot shot{{}, path_of(item["scene"], file.parent_path()), config["set"].words};
    shot.overrides.insert(shot.overrides.end(), item["set"].words.begin(), item["set"].words.end());
    names.push_back(cell_name(item["name"].given ? item["name"].text() : shot.scene.stem().string()));
    const bool again = std::ranges::count(names, names.back()) > 1;
    if (again && item["name"].given) item["name"].fail("is the name of another shot", "give every shot its own");
    request.shots.push_back(std::move(shot));
  }
  if (request.shots.empty()) config["shots"].fail("is empty", "give at least one shot");
  number_equal_names(names);
  for (std::size_t k = 0; k < names.size(); ++k) request.shots[k].name = names[k];
  return shot_cells(request);
}

CellList wardrobe_work(const std::filesystem::path& file) {
  const Config config = read_config(file, wardrobe_section());
  WardrobeRequest request;
  request.configs = path_or(config["configs"], file.parent_path(), config_folder());
  request.wear = config["wear"].words;
  request.clips = config["clips"].words;
  request.most_frames = config["frames"].integer();
  return wardrobe_cells(request);
}

CellList stress_work(const std::filesystem::path& file) {
  const Config config = read_config(file, stress_section());
  StressRequest request;
  request.configs = path_or(config["configs"], file.parent_path(), config_folder() / "stress");
  request.scenes = config["scenes"].words;
  request.repeats = config["repeats"].integer();
  request.seed = static_cast<std::uint64_t>(config["seed"].number());
  request.jitter = config["jitter"].number();
  request.short_form = config["short"].flag();
  return stress_cells(request);
}

CellList compare_work(const std::filesystem::path& file) {
  const Config config = read_config(file, compare_section());
  CompareRequest request;
  request.file = path_of(config["file"], file.parent_path());
  request.short_form = config["short"].flag();
  request.overrides = config["set"].words;
  return compare_cells(request);
}

CellList stability_work(const std::filesystem::path& file) {
  const Config config = read_config(file, stability_section());
  StabilityRequest request;
  request.suite = path_of(config["suite"], file.parent_path());
  request.cases = config["cases"].words;
  if (config["stepper"].given) request.stepper = config["stepper"].text();
  if (config["weights"].given) request.weights = path_of(config["weights"], file.parent_path());
  request.short_form = config["short"].flag();
  return stability_cells(request);
}

struct WorkKind {
  const char* name;  // under `cells`
  CellList (*read)(const std::filesystem::path&);
};
constexpr WorkKind work_kinds[]{{"shots", shots},
                                {"wardrobe", wardrobe_work},
                                {"stress", stress_work},
                                {"compare", compare_work},
                                {"stability", stability_work}};

CellList read_work_file(const std::filesystem::path& file, const std::string& kind) {
  std::vector<std::string> known;
  for (const WorkKind& one : work_kinds) {
    if (one.name == kind) return one.read(file);
    known.emplace_back(one.name);
  }
  throw Error("`cells` is `" + kind + "`", file.string(), "one of " + joined(known) + suggestion(kind, known));
}

CellList read_by_keys(const std::filesystem::path& file) {
  const auto keys = top_keys(file, "work");
  const auto has = [&](const char* name) { return keys.contains(name); };
  if (has("cells")) return read_work_file(file, keys.at("cells"));
  if (has("settings")) {
    CompareRequest request;
    request.file = file;
    return compare_cells(request);
  }
  if (has("cases")) {
    StabilityRequest request;
    request.suite = file;
    return stability_cells(request);
  }
  if (has("poses") || has("garment")) {
    DatasetRequest request;
    request.config = file;
    return dataset_cells(request);
  }
  const bool scene = has("cloths");
  throw Error(scene ? "is a scene, which is one run" : "is no list of cells", file.string(),
              scene ? "name it in a work file that begins with `cells: shots`, or `selvedge simulate` it"
                    : "give a work file (`cells: shots`), a comparison (`settings`), a stability suite (`cases`) or a "
                      "data set of drapes (`garment`): docs/cells.md");
}

}  // namespace

CellList read_cells(const std::filesystem::path& file) {
  CellList list = read_by_keys(file);
  list.file = file;
  list.describe = [describe = list.describe, file](std::size_t k) {
    WorkCell cell = describe(k);
    if (std::ranges::find(cell.needs, file) == cell.needs.end()) cell.needs.insert(cell.needs.begin(), file);
    return cell;
  };
  return list;
}

}  // namespace selvedge
