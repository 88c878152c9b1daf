#include <catch2/catch.hpp>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "collision/geometry/error.hpp"
#include "pipeline/scene/setup.hpp"
#include "pipeline/suites/stress.hpp"
#include "tests/pipeline/files.hpp"
#include "tests/pipeline/short_stress.hpp"
#include "tests/source_root.hpp"

namespace selvedge::test_stress {

using Catch::Matchers::Contains;
using fake::Folder;

namespace {

const std::filesystem::path configs = source_root() / "configs" / "stress";

std::vector<std::string> scene_names() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(configs)) names.push_back(entry.path().stem());
  std::sort(names.begin(), names.end());
  return names;
}

// Hangs, and is there: or not, where it is asked to be elsewhere.
std::string scene(const std::string& highest) {
  return "cloths: [{rectangle: {resolution: 4}, translate: [0, 1, 0], pins: [{group: top}]}]\n"
         "run: {frames: 2}\n"
         "short_form: [run.frames=1]\n"
         "outcome: [{name: it hangs, outside: {max: [9, " +
         highest + ", 9]}}]\n";
}

}  // namespace

TEST_CASE("Stress scenes are large enough and state what must come true", "[stress]") {
  for (const std::string& name : scene_names()) {
    INFO(name);
    const Setup setup = read_setup(configs / (name + ".yaml"));
    CHECK(setup.warnings.empty());
    CHECK_FALSE(setup.outcomes.empty());
    CHECK_FALSE(setup.short_form.empty());
    CHECK(setup.scene.surface.vertex_count >= 4000);
    CHECK(setup.scene.contact.self);
    if (name != "layers") continue;
    CHECK(setup.scene.cloths.size() == 20);
    for (const Cloth& cloth : setup.scene.cloths) CHECK(cloth.vertex_count >= 400);
  }
}

TEST_CASE("Every stress scene is tested in its short form", "[stress]") {
  std::vector<std::string> tested = fake::stress_each_time;
  tested.insert(tested.end(), fake::stress_at_length.begin(), fake::stress_at_length.end());
  std::sort(tested.begin(), tested.end());
  CHECK(tested == scene_names());
}

TEST_CASE("Each repeat is judged by its outcome, and a finished one is not run again", "[stress]") {
  const Folder folder("stress");
  fake::write(folder, "good.yaml", scene("2"));
  fake::write(folder, "bad.yaml", scene("0.5"));
  StressRequest request;
  request.configs = folder.path;
  request.out = folder.path / "out";
  request.repeats = 2;
  const std::vector<StressRow> rows = stress(request);
  REQUIRE(rows.size() == 4);
  CHECK(rows[0].scene == "bad");
  CHECK_FALSE(rows[0].passed());
  CHECK_THAT(rows[0].failures[0], Contains("it hangs: no, 0.5 in frame 2, asked at most 0"));
  CHECK(rows[2].passed());
  CHECK(rows[2].frames == 2);
  CHECK(rows[2].seed != rows[3].seed);
  CHECK(rows[2].max_stretch != rows[3].max_stretch);
  CHECK(std::filesystem::exists(request.out / "good" / "repeat_0" / "view.html"));
  CHECK_FALSE(std::filesystem::exists(request.out / "good" / "repeat_1"));
  CHECK_THAT(fake::whole(request.out / "stress.txt"), Contains("good") && Contains("2 of 2 passed"));
  CHECK_THAT(fake::whole(request.out / "stress.csv"), Contains("it hangs: yes"));
  const auto json = nlohmann::json::parse(fake::whole(request.out / "stress.json"));
  CHECK(json["passed"] == false);
  CHECK(json["scenes"][1]["passed"] == true);
  CHECK(json["repeats"][0]["passed_through"] == 0);

  const std::vector<StressRow> again = stress(request);
  for (const StressRow& row : again) CHECK(row.kept);
  CHECK(again[0].failures == rows[0].failures);
  CHECK(again[3].max_stretch == rows[3].max_stretch);
  fake::write(folder, "good.yaml", scene("3"));
  request.scenes = {"good"};
  CHECK_FALSE(stress(request)[0].kept);  // another scene now
  request.short_form = true;
  CHECK(stress(request)[1].frames == 1);
}

TEST_CASE("What passed through is written, kept and read again", "[stress]") {
  StressRow row;
  row.passed_through = 7;
  CHECK(read_stress_row(stress_row_json(row)).value().passed_through == 7);
  CHECK_FALSE(read_stress_row("{}"));
  CHECK(nlohmann::json::parse(stress_json({row}))["repeats"][0]["passed_through"] == 7);
}

TEST_CASE("A stress suite that cannot be run says why", "[stress]") {
  const Folder folder("stress");
  fake::write(folder, "a.yaml", "cloths: [{rectangle: {resolution: 4}}]\n");
  StressRequest request;
  request.configs = folder.path;
  request.out = folder.path / "out";
  CHECK_THROWS_WITH(stress(request), Contains("states no `outcome`"));
  request.scenes = {"b"};
  CHECK_THROWS_WITH(stress(request), Contains("no scene `b`") && Contains("scenes: a"));
  request.configs = folder.path / "nowhere";
  CHECK_THROWS_WITH(stress(request), Contains("nowhere"));
  request.configs = folder.path;
  request.scenes.clear();
  fake::write(
      folder, "a.yaml",
      "cloths: [{name: a, rectangle: {resolution: 4}}, {name: b, rectangle: {resolution: 5}, rotate: [1, 0, 0]}]\n"
      "outcome: [{name: it, stretch: {}}]\n");
  CHECK_THROWS_WITH(stress(request), Contains("the start is not clean"));
}

TEST_CASE("Stress table: a name that is not UTF-8 is replaced in the CSV as in the JSON", "[stress]") {
  StressRow row;
  row.scene = "drop\xff";
  CHECK_THAT(stress_csv({row}), Contains("drop\xef\xbf\xbd"));
}

}  // namespace selvedge::test_stress
