#include "pipeline/compare/compare.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "collision/geometry/error.hpp"
#include "pipeline/cells/do_cells.hpp"
#include "pipeline/compare/algebraic_error.hpp"
#include "pipeline/compare/compare_reference.hpp"
#include "pipeline/host/machine_name.hpp"
#include "tests/pipeline/files.hpp"
#include "tests/source_root.hpp"

namespace selvedge::test_compare {

using Catch::Matchers::Contains;
using fake::Folder;

namespace {

const std::filesystem::path configs = source_root() / "configs" / "compare";

const std::string hanging =
    "cloths: [{rectangle: {size: [0.5, 0.5], resolution: 7}, translate: [0, 1, 0], pins: [{group: [top]}]}]\n"
    "run: {frames: 8}\n"
    "short_form: [run.frames=4]\n";

const std::string comparing =
    "scenes: [{file: hanging.yaml, states: 2, horizon: 3}]\n"
    "repeats: 2\n"
    "reference: [solver.integrator=bdf2, solver.velocity_tolerance=1e-6, solver.relative_tolerance=0, "
    "solver.max_newton=60]\n"
    "settings:\n"
    "  - name: coarse\n"
    "    set: [run.substeps=1]\n"
    "  - name: fine\n"
    "    set: [run.substeps=4]\n"
    "  - name: contours\n"
    "    set: [run.stepper=icm, run.substeps=4]\n"
    "short_form: [repeats=1, scenes.0.states=1, scenes.0.horizon=2]\n";

CompareRequest small_request(const Folder& folder, const std::string& comparison = comparing) {
  fake::write(folder, "hanging.yaml", hanging);
  CompareRequest request;
  request.file = fake::write(folder, "comparison.yaml", comparison);
  request.out = folder.path / "out";
  return request;
}

CompareRow row(double ms, double error, int pairs = 0) {
  CompareRow r;
  r.scene = std::string(1, 's');
  r.ms = ms;
  r.temporal = error;
  r.floor = 0.1;
  r.pairs = pairs;
  return r;
}

void same_errors(const CompareResult& a, const CompareResult& b) {
  REQUIRE(a.rows.size() == b.rows.size());
  for (std::size_t k = 0; k < a.rows.size(); ++k) {
    CHECK(a.rows[k].temporal == b.rows[k].temporal);
    CHECK((a.rows[k].algebraic == b.rows[k].algebraic || std::isnan(a.rows[k].algebraic)));
    CHECK(a.rows[k].decay == b.rows[k].decay);
    CHECK(a.rows[k].newton == b.rows[k].newton);
    CHECK(a.rows[k].pairs_by_frame == b.rows[k].pairs_by_frame);
    for (const auto& [name, value] : a.rows[k].measures)
      if (!name.starts_with("ms_")) CHECK(value == b.rows[k].measures.at(name));
  }
  CHECK(a.floors[0].steps == b.floors[0].steps);
  CHECK(a.floors[0].jittered == b.floors[0].jittered);
}

}  // namespace

TEST_CASE("The efficient front ends where the floor is, and leaves out what is not clean", "[compare]") {
  std::vector<CompareRow> rows{row(1, 2),    row(2, 1),         row(3, 1.5), row(4, 0.95),   row(5, 0.05),
                               row(6, 0.01), row(0.5, 0.01, 3), row(7, 0.2), row(8, unknown)};
  rank(rows);
  const auto fronts = [&](std::size_t k) { return rows[k].front; };
  CHECK(fronts(0));
  CHECK(fronts(1));
  CHECK_FALSE(fronts(2));       // slower and worse
  CHECK_FALSE(fronts(3));       // slower, and not better by the floor
  CHECK(fronts(4));             // the fastest below the floor
  CHECK_FALSE(rows[4].ranked);  // where it lies below is not known
  CHECK_FALSE(fronts(5));
  CHECK_FALSE(fronts(6));  // intersecting pairs
  CHECK_FALSE(rows[6].ranked);
  CHECK_FALSE(fronts(7));
  CHECK(rows[7].ranked);
  CHECK_FALSE(fronts(8));
  CHECK_FALSE(rows[8].ranked);

  rows = {row(1, 2), row(2, 3)};
  rows[1].scene = "other";
  rank(rows);
  CHECK(fronts(1));  // scenes are not compared
}

TEST_CASE("Names on a comparison's page are text, whatever is in them", "[compare]") {
  const Folder folder("compare_names");
  const std::string name = "'><script>\"&";
  CompareResult result;
  result.floors.emplace_back().scene = name;
  result.rows = {row(1, 2)};
  result.rows[0].scene = name;
  result.rows[0].setting = "<i>'";
  result.views = folder.path;
  fake::write(folder, name + ".html", "");
  const std::string page = compare_page(Comparison{}, result);
  CHECK_FALSE(fake::has(page, "<script"));
  CHECK_FALSE(fake::has(page, "<i>"));
  CHECK(
      fake::has(page, "<a href='views/%27%3E%3Cscript%3E%22%26.html'>&#39;&gt;&lt;script&gt;&quot;&amp; side by side"));
}

TEST_CASE("A comparison's names are names of files", "[compare]") {
  const Folder folder("compare_names");
  fake::write(folder, "hanging.yaml", hanging);
  for (const char* name : {"../up", "a/b", "\"a\\nb\""})
    CHECK_THROWS_WITH(read_comparison(fake::write(folder, "names.yaml",
                                                  "scenes: [{file: hanging.yaml, name: " + std::string(name) +
                                                      "}]\nsettings: [{name: a}]\n"),
                                      false),
                      Contains("scenes.0") && Contains("no file can have"));
}

TEST_CASE("A comparison measures errors, times and energy, and is not done twice", "[compare]") {
  const Folder folder("compare");
  CompareRequest request = small_request(folder);
  const CompareResult result = compare(request);
  REQUIRE(result.finished);
  REQUIRE(result.rows.size() == 3);
  const CompareFloor& floor = result.floors.at(0);
  CHECK(floor.vertices == 49);
  CHECK(floor.frames == 8);
  CHECK(floor.motion > 0.01);
  CHECK(floor.steps > 0);
  CHECK(floor.jittered > 0);
  CHECK(floor.floor() == std::max(floor.steps, floor.jittered));
  const CompareRow &coarse = result.rows[0], &fine = result.rows[1], &contours = result.rows[2];
  CHECK(coarse.temporal > 2 * fine.temporal);
  CHECK(fine.temporal > floor.steps);
  CHECK(contours.temporal == Approx(fine.temporal).epsilon(0.2));  // nothing crosses: another way to the same
  CHECK(coarse.decay > 1.2 * fine.decay);
  CHECK(coarse.algebraic > 0);
  CHECK(coarse.algebraic < 0.1);
  CHECK(coarse.algebraic_largest > coarse.algebraic);
  CHECK(std::isnan(contours.algebraic));
  CHECK(coarse.dt == Approx(1.0 / 30));
  CHECK(fine.dt == Approx(1.0 / 120));
  for (const CompareRow& r : result.rows) {
    CHECK(r.trouble == "");
    CHECK(r.ms > 0);
    CHECK(r.newton > 0);
    CHECK(r.pairs == 0);
    CHECK(r.reproduced);
  }
  CHECK_THAT(fake::whole(request.out / "compare.txt"), Contains("coarse") && Contains("hanging: 49 vertices"));
  CHECK_THAT(fake::whole(request.out / "compare.csv"), Contains("\"hanging\",\"fine\","));
  const auto json = nlohmann::json::parse(fake::whole(request.out / "compare.json"));
  CHECK(json["rows"][1]["temporal"] == fine.temporal);
  CHECK(json["rows"][2]["algebraic"].is_null());
  CHECK_THAT(fake::whole(request.out / "compare.h5"), Catch::Matchers::StartsWith("\x89HDF") && Contains("contours"));

  std::ostringstream log;
  request.log = &log;
  const CompareResult again = compare(request);
  same_errors(result, again);
  CHECK(again.rows[1].ms == fine.ms);  // kept
  CHECK_THAT(log.str(), Contains("kept from before") && !Contains("reference"));
  CompareRequest anew = request;
  anew.out = folder.path / "anew";
  same_errors(result, compare(anew));  // deterministic
  request.short_form = true;
  const CompareResult brief = compare(request);
  CHECK(brief.floors[0].frames == 4);
  CHECK(brief.rows[0].temporal != coarse.temporal);
}

TEST_CASE("A comparison by cells comes to the same as the command", "[compare][cells]") {
  const Folder folder("compare_cells");
  CompareRequest request = small_request(folder,
                                         "scenes:\n"
                                         "  - {file: hanging.yaml, states: 2, horizon: 3}\n"
                                         "  - {file: hanging.yaml, name: a way down, states: 0}\n" +
                                             comparing.substr(comparing.find("repeats")));
  const CellList list = compare_cells(request);
  CHECK(list.names == std::vector<std::string>{"hanging", "a_way_down"});
  CHECK(list.describe(0).seconds > list.describe(1).seconds);
  const std::filesystem::path out = folder.path / "cells";
  REQUIRE(do_cell(compare_cells(request), 1, out, {}));
  CHECK(gather_cells(compare_cells(request), out).missing == std::vector<std::string>{"hanging"});
  CHECK_THAT(fake::whole(out / "compare.txt"), !Contains("hanging:") && Contains("a way down:"));
  REQUIRE(do_cell(compare_cells(request), 0, out, {}));
  const GatheredCells gathered = gather_cells(compare_cells(request), out);
  REQUIRE(gathered.complete());
  const CompareResult result = compare(request);
  const auto json = nlohmann::json::parse(gathered.tables.json), other = nlohmann::json::parse(compare_json(result));
  CHECK(json["scenes"] == other["scenes"]);
  REQUIRE(json["rows"].size() == 6);
  for (std::size_t k = 0; k < 6; ++k) {
    INFO(k);
    for (const char* column : {"scene", "setting", "temporal", "algebraic", "ranked", "decay", "newton", "pairs"})
      CHECK(json["rows"][k][column] == other["rows"][k][column]);
    CHECK(json["rows"][k]["ms"] > 0);
    CHECK(json["rows"][k]["machine"] == machine_name());
  }
  for (std::size_t k = 0; k < 2; ++k)
    CHECK(find_cell(list, k, out).record.result.positions == find_cell(list, k, request.out).record.result.positions);
  for (const char* name : {"compare.csv", "compare.html", "compare.h5"}) CHECK(std::filesystem::exists(out / name));
}

TEST_CASE("Where scenes were timed on several machines, the table says on which", "[compare][cells]") {
  CompareResult result;
  for (const char* scene : {"one", "two"}) {
    result.floors.emplace_back().scene = scene;
    result.rows.push_back(row(1, 2));
    result.rows.back().scene = scene;
    result.rows.back().machine = "here";
  }
  CHECK_THAT(compare_table(result), !Contains("timed on"));
  result.rows[1].machine = "there";
  CHECK_THAT(compare_table(result), Contains("timed on here") && Contains("timed on there"));
  CHECK_THAT(compare_csv(result), Contains(",machine\n") && Contains("\"there\""));
}

TEST_CASE("A comparison that is stopped anywhere goes on and comes to the same", "[compare]") {
  const Folder folder("compare_stopped");
  CompareRequest request = small_request(folder);
  int calls = 0, stops = 0;
  request.stop = [&] { return ++calls % 40 == 0; };
  CompareResult result = compare(request);
  for (; !result.finished && stops < 50; ++stops) result = compare(request);
  REQUIRE(result.finished);
  CHECK(stops > 2);
  CompareRequest whole = small_request(folder);
  whole.out = folder.path / "whole";
  same_errors(result, compare(whole));
}

TEST_CASE("The algebraic error is small for a converged step of either integrator, and none for other potentials",
          "[compare]") {
  const Folder folder("compare_algebraic");
  const auto file = fake::write(folder, "hanging.yaml", hanging);
  const auto error = [&](std::vector<std::string> overrides) {
    const Setup setup = read_setup(file, overrides);
    State moving = setup.initial;
    moving.v.col(1).setConstant(-0.5);
    moving.v.col(0) = 0.3 * moving.x.col(2);
    for (const int pin : setup.scene.pins) moving.v.row(pin).setZero();
    return algebraic_error(setup, moving, 1.0 / 60);
  };
  const std::string tight = "solver.velocity_tolerance=1e-7", many = "solver.max_newton=60",
                    nothing = "solver.relative_tolerance=0", accurate = "solver.linear_tolerance=0.001";
  for (const char* const integrator : {"solver.integrator=implicit_euler", "solver.integrator=bdf2"}) {
    INFO(integrator);
    const auto converged = error({integrator, tight, many, nothing, accurate});
    const auto one_step = error({integrator, "solver.max_newton=1"});
    REQUIRE(converged);
    REQUIRE(one_step);
    CHECK(converged->reference_converged);
    CHECK(converged->error < 1e-5);
    CHECK(one_step->error > 10 * converged->error);
    CHECK(one_step->largest > one_step->error);
  }
  CHECK_FALSE(error({"run.stepper=icm"}));
}

TEST_CASE("A comparison that cannot be made says why", "[compare]") {
  const Folder folder("compare_wrong");
  const auto refused = [&](const std::string& comparison) { compare(small_request(folder, comparison)); };
  const std::string scene = "scenes: [{file: hanging.yaml, states: 2, horizon: 3}]\n";
  CHECK_THROWS_WITH(refused(scene), Contains("settings"));
  CHECK_THROWS_WITH(refused(scene + "settings: []\n"), Contains("settings") && Contains("empty"));
  CHECK_THROWS_WITH(refused(scene + "settings: [{name: a}, {name: a}]\n"), Contains("name `a`"));
  CHECK_THROWS_WITH(refused(scene + "settings: [{name: a, set: [run.sbsteps=3]}]\n"),
                    Contains(".yaml: setting `a` on scene `hanging`: --set run.sbsteps=3") && Contains("substeps"));
  CHECK_THROWS_WITH(refused(scene + "settings: [{name: a}]\nrepeat: 2\n"), Contains("repeats"));
  CHECK_THROWS_WITH(refused("scenes: [{file: hanging.yaml, horizon: 9}]\nsettings: [{name: a}]\n"),
                    Contains("horizon") && Contains("8 frames"));
  CHECK_THROWS_WITH(refused("scenes: [{file: nowhere.yaml}]\nsettings: [{name: a}]\n"),
                    Contains("comparison.yaml:1: `scenes.0.file` names the missing file"));
}

TEST_CASE("Errors inside of a comparison's sequences name its file", "[compare]") {
  const fake::Folder folder("compare_sequences");
  const auto complaint = [&](const std::string& sequences) -> std::string {
    CompareRequest request;
    request.file = fake::write(folder, "made.yaml", "sequences: {" + sequences + "}\nsettings: [{name: a}]\n");
    request.out = folder.path / "out";
    try {
      compare(request);
    } catch (const Error& error) {
      return error.where();
    }
    return {};
  };
  const std::string file = (folder.path / "made.yaml").string() + ": sequences: ";
  CHECK_THAT(complaint("file: a.yaml, count: 1, outfits: [winterr], clips: [walk]"), Catch::StartsWith(file));
  CHECK_THAT(complaint("file: a.yaml, count: 1"), Catch::StartsWith(file));
  CHECK_THAT(complaint("file: a.yaml, training: absent.yaml"), Catch::StartsWith(file));
  CHECK_THAT(complaint("file: a.yaml, count: 1, tangled: 1, outfits: [summer], clips: [wlak]"),
             Catch::StartsWith(file));
}

TEST_CASE("The comparison of the conventional stepper is of small scenes, and runs in its short form", "[compare]") {
  const std::filesystem::path file = configs / "conventional.yaml";
  const Comparison comparison = read_comparison(file, false);
  CHECK(comparison.scenes.size() == 3);
  CHECK(comparison.settings.size() >= 15);
  for (const CompareScene& scene : comparison.scenes) {
    INFO(scene.name);
    const Setup setup = read_compared(scene, false, {});
    CHECK(setup.warnings.empty());
    CHECK(setup.scene.surface.vertex_count >= 1000);
    CHECK(setup.scene.surface.vertex_count <= 2500);
    CHECK_FALSE(setup.short_form.empty());
  }
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  const Folder folder("compare_conventional");
  CompareRequest request;
  request.file = file;
  request.short_form = true;
  request.out = folder.path;
  const CompareResult result = compare(request);
  CHECK(result.finished);
  CHECK(result.rows.size() == 3 * comparison.settings.size());
  for (const CompareRow& r : result.rows) {
    INFO(r.scene << ", " << r.setting << ": " << r.trouble);
    CHECK((r.temporal > 0 || Contains("CHOLMOD").match(r.trouble)));
    CHECK(r.reproduced);
    if (r.setting != "icm") CHECK(r.pairs <= 0);
  }
  for (const CompareFloor& floor : result.floors)
    CHECK(std::any_of(result.rows.begin(), result.rows.end(),
                      [&](const CompareRow& r) { return r.scene == floor.scene && r.front; }));
#endif
}

}  // namespace selvedge::test_compare
