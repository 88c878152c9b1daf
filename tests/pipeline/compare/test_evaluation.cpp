#include "pipeline/compare/evaluation.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "pipeline/compare/sequences.hpp"
#include "pipeline/host/write_file.hpp"
#include "tests/pipeline/files.hpp"
#include "tests/source_root.hpp"

namespace selvedge::test_evaluation {
namespace {

CompareRow sequence(const std::string& scene, const std::string& setting, std::vector<int> pairs, bool tangled) {
  CompareRow row;
  row.scene = scene;
  row.setting = setting;
  row.outfit = "summer";
  row.tangled = tangled;
  row.ms = 10;
  double sum = 0;
  for (std::size_t f = 1; f < pairs.size(); ++f) sum += pairs[f];
  row.measures = {{"pairs_mean", sum / static_cast<double>(pairs.size() - 1)}, {"finished", 1}, {"kinetic", 2}};
  row.pairs_by_frame = std::move(pairs);
  return row;
}

}  // namespace

TEST_CASE("evaluation: the ratio of pairs is paired, and apart where its interval leaves out 1", "[evaluation]") {
  // Sequences differ by far more than rows do: only pairing can tell these rows apart.
  const std::vector<double> baseline{9, 99, 999, 9999, 19, 199};
  std::vector<double> half, same{10, 95, 1010, 9900, 18, 205};
  for (const double pairs : baseline) half.push_back((pairs + 1) / 2 - 1);
  const PairedRatio halved = paired_ratio(half, baseline, 2000);
  CHECK(halved.ratio == Approx(0.5));
  CHECK(halved.low == Approx(0.5));
  CHECK(halved.high == Approx(0.5));
  CHECK(halved.apart());
  const PairedRatio alike = paired_ratio(same, baseline, 2000);
  CHECK(alike.low < 1);
  CHECK(alike.high > 1);
  CHECK_FALSE(alike.apart());
  CHECK(alike.low == paired_ratio(same, baseline, 2000).low);
  CHECK_FALSE(paired_ratio({5}, {50}, 2000).apart());  // one sequence says nothing of the others
  CHECK(paired_ratio({unknown, 1}, {1, 3}, 2000).sequences == 1);
}

TEST_CASE("evaluation: a bootstrap interval of two values by hand", "[evaluation]") {
  // Logarithms 0 and log 4: means of two draws are 0, log 2, log 4 with probabilities 1/4, 1/2, 1/4.
  const PairedRatio ratio = paired_ratio({0, 3}, {0, 0}, 4000);
  CHECK(ratio.ratio == Approx(2));
  CHECK(ratio.low == Approx(1));
  CHECK(ratio.high == Approx(4));
}

TEST_CASE("evaluation: speeds are of the machine that has timed most sequences", "[evaluation][cells]") {
  Comparison comparison;
  comparison.settings.push_back({"conventional", {}, {}, {}});
  comparison.evaluation.baseline = "conventional";
  std::vector<CompareRow> rows;
  for (const char* scene : {"a", "b", "c"}) rows.push_back(sequence(scene, "conventional", {0, 0}, false));
  rows[0].machine = "slow";
  rows[0].ms = 1000;
  rows[1].machine = rows[2].machine = "quick";
  const Evaluation found = evaluated(comparison, {}, rows);
  CHECK(found.machine == "quick");
  CHECK(found.timed_elsewhere == 1);
  CHECK(found.rows.at(0).frames_a_second == Approx(100));
  CHECK(found.rows.at(0).sequences == 3);  // of everything but times
  CHECK(found.speeds.at(0).second.at(0).second == Approx(100));
  CHECK(evaluation_text(found).find("are of quick; times of 1 sequences") != std::string::npos);
  rows[0].machine = "quick";
  CHECK(evaluation_text(evaluated(comparison, {}, rows)).find("quick") == std::string::npos);
}

TEST_CASE("evaluation: tables by hand", "[evaluation]") {
  Comparison comparison;
  for (const char* name : {"conventional", "hood", "absent"}) comparison.settings.push_back({name, {}, {}, {}});
  comparison.evaluation.baseline = "conventional";
  comparison.evaluation.left_frames = 2;
  std::vector<CompareRow> rows{
      sequence("a", "conventional", {20, 10, 0}, true), sequence("a", "hood", {20, 15, 5}, true),
      sequence("b", "conventional", {0, 0, 0}, false), sequence("b", "hood", {0, 2, 4}, false)};
  rows[1].measures["kinetic"] = 1;
  rows[1].measures["strain"] = 0.03;
  rows[3].measures["strain"] = 0.05;
  rows[1].measures["body_pairs_mean"] = 400;
  rows[3].measures["body_pairs_mean"] = 100;
  CompareRow absent;
  absent.scene = "a";
  absent.setting = "absent";
  absent.outfit = "summer";
  absent.trouble = "left out: there is no weight file";
  rows.push_back(absent);
  CompareFloor floor;
  floor.scene = "a";
  floor.vertices = 900;
  const Evaluation found = evaluated(comparison, {floor}, rows);
  CHECK(found.outfits == std::vector<std::string>{"summer"});
  CHECK(found.vertices == std::vector<int>{900});
  CHECK(found.tangled == 1);
  REQUIRE(found.rows.size() == 3);
  CHECK(found.rows[0].pairs == Approx(2.5));  // (5 + 0) / 2
  CHECK(found.rows[1].pairs == Approx(6.5));  // (10 + 3) / 2
  CHECK(found.rows[1].body_pairs == Approx(250));
  CHECK(found.rows[1].left == std::vector<double>{1, 0.75, 0.25});
  CHECK(found.rows[1].at_0 == 20);
  CHECK(std::isnan(found.rows[1].at_50));
  CHECK(found.rows[1].frames_a_second == Approx(100));
  CHECK(found.rows[1].kinetic_ratio == Approx(std::sqrt(0.5)));
  CHECK(found.rows[2].sequences == 0);
  REQUIRE(found.ratios.size() == 1);
  CHECK(found.ratios[0].ratio == Approx(std::sqrt(6.0 / 11 / 4)));  // (5+1)/(10+1) and (0+1)/(3+1)
  CHECK(found.shown == "a");
  CHECK(evaluation_text(found).find("no weight file") != std::string::npos);
  const auto json = nlohmann::json::parse(evaluation_json(found));
  CHECK(json["rows"][1]["pairs_of_outfit"][0] == 6.5);
  CHECK(json["rows"][1]["body_pairs"] == 250);
  CHECK(json["rows"][1]["strain_of_outfit"][0]["mean"].get<double>() == Approx(0.04));
  CHECK(evaluation_text(found).find("4.00 (-)") != std::string::npos);
  CHECK(json["by_frame"]["hood"][1] == 15);
}

TEST_CASE("evaluation: columns stand below each other beside a long name", "[evaluation]") {
  Comparison comparison;
  std::vector<CompareRow> rows;
  for (const char* name : {"hood", "contourcraft_shown_share"}) {
    comparison.settings.push_back({name, {}, {}, {}});
    rows.push_back(sequence("a", name, {1, 1}, false));
  }
  comparison.evaluation.baseline = "hood";
  const std::string text = evaluation_text(evaluated(comparison, {}, rows));
  std::map<std::string, std::vector<std::size_t>> ends;  // of the row's line in each table
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    for (const char* name : {"  hood ", "  contourcraft_shown_share "})
      if (line.starts_with(name) && line.find(" over ") == std::string::npos)
        ends[name].push_back(line.find_last_not_of(' '));
  CHECK(ends["  hood "].size() >= 3);
  CHECK(ends["  hood "] == ends["  contourcraft_shown_share "]);
}

TEST_CASE("evaluation: bodies of tangled starts are not those with which a bare network was trained", "[evaluation]") {
  const std::filesystem::path configs = source_root() / "configs";
  const auto with_seed = [&](const std::string& seed) {
    Comparison comparison = read_comparison(configs / "evaluation" / "contourcraft.yaml", true,
                                            {"sequences.seed=" + seed, "sequences.count=2", "sequences.tangled=2"});
    add_sequences(comparison);
    return comparison.scenes.size();
  };
  CHECK_THROWS_WITH(with_seed("1"), Catch::Contains("bodies of its training") && Catch::Contains("sequences.seed"));
  CHECK(with_seed("2811") == 2);
}

TEST_CASE("evaluation: a tangled start is searched once, and then read from the cache", "[evaluation][cells]") {
  const fake::Folder cache("tangled_cache");
  const char* before = std::getenv("XDG_CACHE_HOME");
  const std::string restored = before ? before : "";
  setenv("XDG_CACHE_HOME", cache.path.c_str(), 1);
  Comparison comparison;
  comparison.file = source_root() / "configs" / "compare" / "tangled.yaml";
  SequenceOptions& sequences = comparison.sequences;
  sequences.file = "../evaluation/sequence.yaml";
  sequences.outfits = {"summer"};
  sequences.clips = {"walk_turning"};
  sequences.count = sequences.tangled = 1;
  sequences.frames = 10;
  add_sequences(comparison);
  REQUIRE(comparison.scenes.size() == 1);
  const CompareScene named = comparison.scenes[0];
  CHECK(named.name == "summer_tangled_0");
  CHECK_FALSE(std::filesystem::exists(cache.path / "selvedge"));  // nothing was made or searched

  TangledSearch search, none;
  const auto found = [&](const std::string& program, TangledSearch& by) {
    CompareScene scene = named;
    find_start(comparison, program, nullptr, by, scene);
    CHECK_FALSE(scene.sequence);
    return scene.overrides;
  };
  const std::vector<std::string> overrides = found("program", search);
  CHECK(overrides.size() == named.overrides.size() + 3);
  CHECK(search.makers.size() == 1);
  CHECK(found("program", none) == overrides);
  CHECK(none.makers.empty());
  std::vector<std::filesystem::path> kept;
  for (const auto& entry : std::filesystem::directory_iterator(cache.path / "selvedge" / "tangled"))
    kept.push_back(entry.path());
  REQUIRE(kept.size() == 1);
  CHECK(found("other program", search) == overrides);  // searched again, and kept in its place
  CHECK(fake::whole(kept[0]).starts_with("other program "));
  write_file(kept[0], "something else\n");
  CHECK(found("program", search) == overrides);
  before ? setenv("XDG_CACHE_HOME", restored.c_str(), 1) : unsetenv("XDG_CACHE_HOME");
}

}  // namespace selvedge::test_evaluation
