#include <algorithm>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "collision/geometry/error.hpp"
#include "pipeline/cells/do_cells.hpp"
#include "pipeline/obstacles/setup_paths.hpp"
#include "pipeline/run/prepare.hpp"
#include "pipeline/scene/make_stepper.hpp"
#include "pipeline/suites/stability.hpp"
#include "pipeline/suites/stress.hpp"
#include "pipeline/suites/wardrobe.hpp"
#include "pipeline/suites/work_file.hpp"
#include "tests/pipeline/files.hpp"
#include "tests/source_root.hpp"

namespace selvedge::test_work_file {

using Catch::Matchers::Contains;
using fake::Folder;
namespace fs = std::filesystem;

namespace {

const char* hanging =
    "cloths: [{name: sheet, rectangle: {size: [0.2, 0.2], resolution: 5}, translate: [0, 1, 0], "
    "pins: [{group: top}]}]\n"
    "run: {frames: 3}\n"
    "outcome: [{name: it hangs, outside: {max: [9, 9, 9]}}]\n";

const char* two_shots =
    "cells: shots\n"
    "set: [run.frames=4]\n"
    "shots:\n"
    "  - hanging.yaml\n"
    "  - {name: denim, scene: hanging.yaml, set: [cloths.sheet.material=denim, run.frames=2]}\n";

void do_all(const CellList& list, const fs::path& out) {
  for (std::size_t k = list.names.size(); k-- > 0;) {
    CellList alone = list;  // a cell may not lean on those before it
    REQUIRE(do_cell(alone, k, out, {}));
  }
}

// A table's rows without what depends on the clock.
nlohmann::json without_times(const std::string& text, const std::string& rows) {
  nlohmann::json json = nlohmann::json::parse(text);
  for (nlohmann::json& row : json[rows])
    for (const char* name : {"seconds", "milliseconds"}) row.erase(name);
  json.erase("seconds");
  return json;
}

}  // namespace

TEST_CASE("cells: shots are simulated with their overrides, each as it would be alone", "[cells]") {
  const Folder folder("work_shots");
  fake::write(folder, "hanging.yaml", hanging);
  const fs::path file = fake::write(folder, "shots.yaml", two_shots);
  const CellList list = read_cells(file);
  CHECK(list.kind == "shots");
  CHECK(list.names == std::vector<std::string>{"hanging", "denim"});
  const WorkCell cell = list.describe(1);
  CHECK(cell.name == "denim");
  CHECK(cell.needs.at(0) == file);
  CHECK(fs::equivalent(cell.needs.at(1), folder.path / "hanging.yaml"));
  CHECK(cell.seconds > 0);
  const fs::path out = folder.path / "out";
  REQUIRE(do_cell(list, 1, out, {}));
  CHECK(gather_cells(read_cells(file), out).missing == std::vector<std::string>{"hanging"});
  do_all(list, out);
  const GatheredCells gathered = gather_cells(read_cells(file), out);
  CHECK(gathered.complete());
  CHECK(gathered.tables.passed);
  CHECK_THAT(gathered.tables.text, Contains("denim") && Contains("2 of 2 shots are clean"));
  const auto rows = nlohmann::json::parse(fake::whole(out / "shots.json"))["shots"];
  CHECK(rows[0]["frames"] == 4);
  CHECK(rows[1]["frames"] == 2);
  for (const char* name : {"run.h5", "summary.json", "cell.json"}) CHECK(fs::exists(cell_folder(out, "denim") / name));

  const Setup setup = read_setup(folder.path / "hanging.yaml", {"cloths.sheet.material=denim", "run.frames=2"});
  RunRequest run;
  run.out = folder.path / "alone";
  const RunSummary summary = run_scene(setup, *prepare(setup), *make_stepper(setup), run);
  CHECK(gathered.records[1].result.positions == summary.positions_hash);
  CHECK(gathered.records[1].result.positions != gathered.records[0].result.positions);
}

TEST_CASE("cells: a shot that is stopped after a frame is missing, and then the same as never stopped", "[cells]") {
  const Folder folder("work_stopped");
  fake::write(folder, "hanging.yaml", hanging);
  const CellList list = read_cells(fake::write(folder, "shots.yaml", two_shots));
  CellWatch watch;
  int asked = 0;
  watch.stop = [&] { return ++asked > 2; };
  CHECK_FALSE(do_cell(list, 0, folder.path / "a", watch));
  CHECK(asked > 2);
  CHECK(gather_cells(list, folder.path / "a").missing.size() == 2);
  const auto after = do_cell(list, 0, folder.path / "a", {}), never = do_cell(list, 0, folder.path / "b", {});
  REQUIRE((after && never));
  CHECK(after->record.result.positions == never->record.result.positions);
}

TEST_CASE("cells: a scene that has changed makes its result one of other settings, a moved one does not", "[cells]") {
  const Folder folder("work_changed"), moved("work_moved");
  fake::write(folder, "hanging.yaml", hanging);
  const CellList list = read_cells(fake::write(folder, "shots.yaml", two_shots));
  const std::string before = list.key(0);
  CHECK(before == read_cells(folder.path / "shots.yaml").key(0));
  fake::write(moved, "hanging.yaml", hanging);
  CHECK(before == read_cells(fake::write(moved, "shots.yaml", two_shots)).key(0));
  fake::write(folder, "hanging.yaml", std::string(hanging) + "wind: {velocity: [1, 0, 0]}\n");
  CHECK(before != read_cells(folder.path / "shots.yaml").key(0));
}

TEST_CASE("cells: a cell needs the materials and outfits that its scene finds by name", "[cells]") {
  const Folder folder("work_near");
  fs::create_directories(folder.path / "materials");
  fs::create_directories(folder.path / "scenes");
  fake::write(folder, "materials/mine.yaml", "density: 0.3\n");
  fake::write(folder, "scenes/hanging.yaml", hanging);
  const CellList list = read_cells(
      fake::write(folder, "shots.yaml",
                  "cells: shots\nshots: [{scene: scenes/hanging.yaml, set: [cloths.sheet.material=mine]}]\n"));
  const std::string before = list.key(0);
  const std::vector<fs::path> needs = list.describe(0).needs;
  const fs::path material = (folder.path / "materials" / "mine.yaml").lexically_normal();
  CHECK(std::ranges::find(needs, material) != needs.end());
  fake::write(folder, "materials/mine.yaml", "density: 0.4\n");
  CHECK(read_cells(folder.path / "shots.yaml").key(0) != before);
  // The program's own are not among them.
  for (const fs::path& need : read_cells(config_folder() / "work" / "shots.yaml").describe(0).needs)
    CHECK(need.parent_path().filename() != "materials");
}

TEST_CASE("cells: files that a scene names are part of its key, wherever they lie", "[cells]") {
  const Folder folder("work_mesh"), moved("work_mesh_moved");
  const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\n";
  const auto key_with = [](const Folder& in, const std::string& mesh) {
    const fs::path file = fake::write(in, "sheet.obj", mesh);
    fake::write(in, "scene.yaml", "cloths: [{mesh: " + file.string() + "}]\nrun: {frames: 1}\n");
    return read_cells(fake::write(in, "shots.yaml", "cells: shots\nshots: [scene.yaml]\n"));
  };
  const CellList list = key_with(folder, triangle);
  const std::string before = list.key(0);
  CHECK(list.describe(0).needs.size() == 3);
  CHECK(before == key_with(moved, triangle).key(0));
  CHECK(before != key_with(folder, triangle + "\n").key(0));
}

TEST_CASE("cells: a stress suite by cells gives the table of the command", "[cells][stress]") {
  const Folder folder("work_stress");
  fs::create_directories(folder.path / "scenes");
  fake::write(folder, "scenes/good.yaml", hanging);
  fake::write(folder, "scenes/bad.yaml",
              std::string(hanging).replace(std::string(hanging).rfind("9, 9, 9"), 7, "9, 0, 9"));
  const fs::path file = fake::write(folder, "stress.yaml", "{cells: stress, configs: scenes, repeats: 2, seed: 4}\n");
  const CellList list = read_cells(file);
  CHECK(list.names == std::vector<std::string>{"bad.repeat_0", "bad.repeat_1", "good.repeat_0", "good.repeat_1"});
  const fs::path out = folder.path / "cells";
  do_all(list, out);
  const GatheredCells gathered = gather_cells(list, out);
  CHECK_FALSE(gathered.tables.passed);
  StressRequest request;
  request.configs = folder.path / "scenes";
  request.repeats = 2;
  request.seed = 4;
  request.out = folder.path / "command";
  stress(request);
  CHECK(without_times(fake::whole(out / "stress.json"), "repeats") ==
        without_times(fake::whole(request.out / "stress.json"), "repeats"));
  for (const fs::path& each : {out, request.out}) {
    CHECK(fs::exists(each / "bad" / "repeat_1" / "view.html"));
    CHECK(fs::exists(each / "good" / "repeat_0" / "view.html"));
    CHECK_FALSE(fs::exists(each / "good" / "repeat_1"));
  }
  for (std::size_t k = 0; k < 4; ++k) {
    const auto here = find_cell(list, k, out), there = find_cell(list, k, request.out);
    REQUIRE(there.state == CellState::there);
    CHECK(here.record.result.positions == there.record.result.positions);
  }
}

TEST_CASE("cells: a stability suite by cells gives the table of the command", "[cells][stability]") {
  const Folder folder("work_stability");
  fake::write(folder, "scene.yaml", hanging);
  const fs::path file = fake::write(folder, "suite.yaml",
                                    "limits: {newton: 1}\ncases: [{name: my case, scene: scene.yaml, runs: [free, "
                                    "{name: long, set: [run.frames=5]}]}]");
  const CellList list = read_cells(file);
  CHECK(list.kind == "stability");
  CHECK(list.names == std::vector<std::string>{"my_case_0", "my_case_1"});
  const fs::path out = folder.path / "cells";
  do_all(list, out);
  gather_cells(list, out);
  StabilityRequest request;
  request.suite = file;
  request.out = folder.path / "command";
  const std::vector<StabilityRow> rows = stability(request);
  CHECK(without_times(fake::whole(out / "stability.json"), "runs") ==
        without_times(fake::whole(request.out / "stability.json"), "runs"));
  CHECK(stability(request).at(1).kept);
  CHECK(fake::whole(request.out / "stability.md") == stability_markdown(rows));
  CHECK(fs::exists(out / "my_case_1" / "view.html"));
}

TEST_CASE("cells: the wardrobe's cells are its rows, clip by clip", "[cells][wardrobe]") {
  const CellList list = read_cells(config_folder() / "work" / "wardrobe.yaml");
  CHECK(list.kind == "wardrobe");
  CHECK(list.names.size() > 500);
  CHECK(list.names[0].substr(list.names[0].find('.')) == list.names[1].substr(list.names[1].find('.')));
  CHECK(read_cells(config_folder() / "work" / "wardrobe.yaml").names == list.names);
  CHECK(list.describe(0).needs.size() == 5);
}

TEST_CASE("cells: a row of the wardrobe alone is the row of the command", "[cells][wardrobe]") {
  const Folder folder("work_wardrobe");
  const CellList list = read_cells(
      fake::write(folder, "w.yaml", "{cells: wardrobe, wear: [skirt_short, shorts], clips: walk, frames: 1}\n"));
  CHECK(list.names == std::vector<std::string>{"shorts.walk", "skirt_short.walk"});
  REQUIRE(do_cell(list, 1, folder.path / "out", {}));
  const GatheredCells alone = gather_cells(list, folder.path / "out");
  CHECK(alone.missing == std::vector<std::string>{"shorts.walk"});
  CHECK(fs::exists(folder.path / "out" / "skirt_short" / "walk" / "view.html"));
  WardrobeRequest request;
  request.configs = config_folder();
  request.wear = {"skirt_short", "shorts"};
  request.clips = {"walk"};
  request.most_frames = 1;
  request.out = folder.path / "command";
  const std::vector<WardrobeRow> rows = wardrobe(request);
  REQUIRE(rows.size() == 2);
  const auto there = find_cell(list, 1, request.out);
  REQUIRE(there.state == CellState::there);
  CHECK(there.record.result.positions == alone.records.at(0).result.positions);
  CHECK(rows[1].max_stretch == nlohmann::json::parse(alone.records[0].result.row)["max_stretch"]);
}

TEST_CASE("cells: the shipped work files are read", "[cells]") {
  for (const fs::directory_entry& entry : fs::directory_iterator(config_folder() / "work")) {
    INFO(entry.path());
    CHECK_FALSE(read_cells(entry.path()).names.empty());
  }
  const CellList comparison = read_cells(config_folder() / "compare" / "short.yaml");
  CHECK(comparison.kind == "compare");
  CHECK(read_cells(config_folder() / "stability.yaml").kind == "stability");
  const CellList drapes = read_cells(config_folder() / "data" / "drape_tiny.yaml");
  CHECK(drapes.kind == "dataset");
  CHECK(drapes.names.at(0) == "path_0000");
}

TEST_CASE("docs/cells.md has a row for each kind of work file", "[cells]") {
  const Folder folder("work_kinds");
  std::string refusal;
  try {
    read_cells(fake::write(folder, "a.yaml", "cells: unknown\n"));
  } catch (const Error& error) {
    refusal = error.what();
  }
  REQUIRE(fake::has(refusal, "one of "));
  std::istringstream kinds(refusal.substr(refusal.find("one of ") + 7));
  const std::string page = fake::whole(source_root() / "docs" / "cells.md");
  int count = 0;
  for (std::string kind; std::getline(kinds >> std::ws, kind, ','); ++count) {
    INFO(kind);
    CHECK(fake::has(page, "| `" + kind + "` | `"));
  }
  CHECK(count >= 5);
}

TEST_CASE("cells: a file that is no work says what would be one", "[cells]") {
  const Folder folder("work_wrong");
  const auto refused = [&](const std::string& text) { read_cells(fake::write(folder, "a.yaml", text)); };
  CHECK_THROWS_WITH(refused(hanging), Contains("is a scene") && Contains("cells: shots"));
  CHECK_THROWS_WITH(refused("samples: {}\n"), Contains("is no list of cells") && Contains("docs/cells.md"));
  CHECK_THROWS_WITH(refused("cells: shot\n"), Contains("did you mean `shots`"));
  CHECK_THROWS_WITH(refused("cells: [a\n"), Contains("a.yaml:") && Contains("is not YAML"));
  CHECK_THROWS_WITH(refused("- a\n"), Contains("a.yaml") && Contains("list of `key: value`"));
  CHECK_THROWS_WITH(refused("cells: shots\nshots: []\n"), Contains("at least one shot"));
  CHECK_THROWS_WITH(refused("cells: shots\nshots: [nowhere.yaml]\n"), Contains("a.yaml:2") && Contains("nowhere.yaml"));
  CHECK_THROWS_WITH(refused("cells: stress\nrepeat: 3\n"), Contains("repeats"));
  CHECK_THROWS_WITH(refused("cells: stress\nscenes: knott\n"), Contains("no scene `knott`"));
  CHECK_THROWS_WITH(refused("cells: wardrobe\nclips: [wlak]\n"), Contains("wlak"));
  fake::write(folder, "hanging.yaml", hanging);
  CHECK_THROWS_WITH(refused("cells: shots\nshots: [{scene: hanging.yaml, name: a}, {scene: hanging.yaml, name: a}]\n"),
                    Contains("name of another shot"));
}

}  // namespace selvedge::test_work_file
