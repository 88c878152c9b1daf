#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>

#include "collision/geometry/error.hpp"
#include "learned/network/weights_hdf5.hpp"
#include "pipeline/cells/do_cells.hpp"
#include "pipeline/compare/compare.hpp"
#include "pipeline/compare/compare_plots.hpp"
#include "pipeline/compare/compare_run.hpp"
#include "tests/learned/learned_scenes.hpp"
#include "tests/pipeline/files.hpp"
#include "tests/source_root.hpp"

namespace selvedge::test_compare_rows {

using Catch::Matchers::Contains;
using fake::Folder;

namespace {

const std::filesystem::path configs = source_root() / "configs";

const CompareRow& row_named(const CompareResult& result, const std::string& setting) {
  const auto found = std::ranges::find(result.rows, setting, &CompareRow::setting);
  REQUIRE(found != result.rows.end());
  return *found;
}

}  // namespace

TEST_CASE("compare: the short suite takes all kinds of steppers, and says what it leaves out", "[compare]") {
  const Folder folder("compare_rows");
  CompareRequest request;
  request.file = configs / "compare" / "short.yaml";
  request.out = folder.path;
  request.overrides = {"weights_folder=" + (folder.path / "none").string(), "keep_runs=1"};
  const CompareResult result = compare(request);
  CHECK(result.finished);
  const CompareRow& conventional = row_named(result, "conventional");
  CHECK(conventional.trouble.empty());
  for (const char* name : {"temporal_1", "algebraic_1", "algebraic_end", "l2_mm", "e3d", "strain_99", "hood_total",
                           "grad_norm", "excess", "residual", "static_share", "collision_percent", "high_share"}) {
    INFO(name);
    CHECK(conventional.measures.contains(name));
  }
  CHECK(conventional.measures.at("excess") >= 0);
  CHECK(conventional.measures.at("temporal_1") < conventional.temporal);
  CHECK(conventional.measures.at("finished") == 1);
  CHECK(conventional.pairs_by_frame == std::vector<int>(7, 0));
  CHECK_THAT(row_named(result, "skinning").trouble, Contains("this program has no stepper `skinning`"));
  CHECK_THAT(row_named(result, "hood").trouble, Contains("left out: there is no weight file"));
  const std::string page = fake::whole(folder.path / "compare.html");
  CHECK_THAT(page, Contains("<svg") && Contains("What was left out") && Contains("no weight file"));
  CHECK_THAT(fake::whole(folder.path / "compare.csv"), Contains(",grad_norm,"));
  CHECK_THAT(trouble_of_bare_run(cell_folder(folder.path, "hang") / "row_0.h5"), Contains("made by `conventional`"));
}

TEST_CASE("compare: a bare run is pushed out of a body in the frame alone in which it settles", "[compare]") {
  const Folder folder("compare_bare");
  const Scene scene = fake::scene();
  const auto trouble = [&](int pushed_frame) {
    const std::filesystem::path file = folder.path / ("pushed_" + std::to_string(pushed_frame) + ".h5");
    TrajectoryWriter writer(file, trajectory_info(scene, "", "learned", 30));
    for (int i = 0; i < 4; ++i) {
      Frame frame = fake::frame(scene, 0);
      frame.report = {};
      frame.report.status = StepStatus::accepted;
      frame.report.by = "learned";
      frame.report.collision.pushed_out = i == pushed_frame ? 3 : 0;
      writer.append(frame);
    }
    writer.close();
    return trouble_of_bare_run(file);
  };
  CHECK(trouble(1).empty());
  CHECK_THAT(trouble(2), Contains("frame 2 was pushed out of the body"));
}

TEST_CASE("compare: a stepper that this program lacks and keys of the comparison", "[compare]") {
  const Folder folder("compare_lacks");
  fake::write(folder, "hanging.yaml",
              "cloths: [{rectangle: {size: [0.5, 0.5], resolution: 4}, pins: [{group: [top]}]}]\nrun: {frames: 2}\n");
  CompareRequest request;
  request.file = fake::write(folder, "comparison.yaml",
                             "scenes: [{file: hanging.yaml, states: 0}]\nrepeats: 1\njudged_frames: 0\n"
                             "settings: [{name: a}, {name: b, stepper: of_nobody}]\n");
  request.out = folder.path / "out";
  const CompareResult result = compare(request);
  CHECK_THAT(row_named(result, "b").trouble, Contains("this program has no stepper `of_nobody`"));
  CHECK(std::isnan(row_named(result, "a").temporal));  // no references were asked for
  CHECK(row_named(result, "a").ms > 0);
  CHECK_FALSE(row_named(result, "a").front);
  CHECK(fake::whole(request.out / "compare.json").find("\"reproduced\": null") != std::string::npos);  // of b
  request.overrides = {"repats=2"};
  CHECK_THROWS_WITH(compare(request), Contains("repeats"));
  request.overrides = {"evaluation.baseline=c"};
  CHECK_THROWS_WITH(compare(request), Contains("which is no setting"));
}

TEST_CASE("compare: the suites are what the issue asks for", "[compare]") {
  const Comparison standard = read_comparison(configs / "compare" / "standard.yaml", false);
  CHECK(standard.scenes.size() >= 12);
  for (const char* name : {"hang", "drop", "wind", "through_itself", "large", "winter_kick"})
    CHECK(std::ranges::find(standard.scenes, name, &CompareScene::name) != standard.scenes.end());
  const auto large = std::ranges::find(standard.scenes, "large", &CompareScene::name);
  CHECK(read_compared(*large, false, {}).scene.surface.vertex_count >= 20000);
}

TEST_CASE("compare: a hybrid row counts where it uses its proposals", "[compare]") {
  const auto row = [](const char* setting, double ms, double error) {
    CompareRow made;
    made.scene = "one";
    made.setting = setting;
    made.ms = ms;
    made.temporal = error;
    made.floor = 1e-4;
    return made;
  };
  std::vector<CompareRow> rows{row("conventional", 20, 2e-3), row("hybrid", 10, 1e-3)};
  for (const double share : {0.29, 0.3}) {
    rows[1].measures["proposal_share"] = share;
    rank(rows);
    INFO(share);
    CHECK(rows[1].front == (share >= 0.3));
    CHECK(rows[1].ranked == rows[1].front);
    CHECK(rows[0].front == (share < 0.3));
  }
  CompareResult result;
  result.floors.resize(1);
  result.floors.front().scene = "one";
  result.rows = rows;
  CHECK_THAT(compare_table(result), Contains("share") && Contains("0.30"));
}

TEST_CASE("compare: a row that exceeds its limits ends, and stays with what was measured", "[compare]") {
  const Folder folder("compare_limits");
  std::string scene = "run: {frames: 5}\ncloths:\n";  // a lattice of held sheets, each through all of the other way
  for (int k = 0; k < 5; ++k) {
    const std::string sheet = "rectangle: {size: [1, 1], resolution: 2}, pins: [{group: [boundary]}]";
    const std::string at = std::to_string(0.07 * k);
    scene += "  - {name: flat" + std::to_string(k) + ", " + sheet + ", translate: [0, " + at + ", 0]}\n";
    scene += "  - {name: upright" + std::to_string(k) + ", " + sheet + ", rotate: [90, 0, 0], translate: [0, 0, " + at +
             "]}\n";
  }
  fake::write(folder, "lattice.yaml", scene);
  CompareRequest request;
  request.file = fake::write(folder, "comparison.yaml",
                             "scenes: [{file: lattice.yaml, states: 0}]\nrepeats: 1\njudged_frames: 0\n"
                             "settings: [{name: conventional, stepper: conventional}]\n");
  request.out = folder.path / "out";
  const CompareRow whole = row_named(compare(request), "conventional");
  CHECK(whole.trouble.empty());
  REQUIRE(whole.pairs_by_frame.size() == 6);
  REQUIRE(whole.pairs > 20);  // triangles

  // Pairs are counted where a run leaves contact of cloth with itself out, too.
  request.overrides = {"settings=[{name: blind, stepper: conventional, set: [contact.self=false]}]"};
  const CompareRow blind = row_named(compare(request), "blind");
  REQUIRE(blind.pairs_by_frame.size() == 6);
  CHECK(blind.pairs_by_frame[0] == whole.pairs_by_frame[0]);
  CHECK(blind.pairs > 20);

  request.overrides = {"limits.pairs=1"};
  const CompareResult result = compare(request);
  const CompareRow& dense = row_named(result, "conventional");
  CHECK_THAT(dense.trouble, Contains("ended by `limits` after frame 1 of 5") && Contains("more than 1 a triangle"));
  CHECK(dense.pairs_by_frame == std::vector<int>{whole.pairs_by_frame[0], whole.pairs_by_frame[1]});
  CHECK(dense.ms > 0);
  CHECK(dense.measures.at("finished") == 0);
  CHECK_THAT(compare_table(result), Contains(dense.trouble));

  request.overrides = {"limits.seconds=1e-9"};
  const CompareRow slow = row_named(compare(request), "conventional");  // not even a frame
  CHECK_THAT(slow.trouble, Contains("ended by `limits` after frame 0 of 5: not done in 1e-09 s"));
  CHECK(std::isnan(slow.ms));
  CHECK(slow.measures.at("finished") == 0);
}

TEST_CASE("compare: a finished scene of which a part is lost or cut off is measured anew", "[compare]") {
  const Folder folder("compare_lost_part");
  CompareRequest request;
  request.file = configs / "compare" / "short.yaml";
  request.out = folder.path;
  request.overrides = {"settings=[{name: carried, stepper: carried}]"};
  const CompareRow first = row_named(compare(request), "carried");
  for (const std::string part : {"floor.json", "errors_0.json", "run_0_0.json"}) {
    const auto file = cell_folder(folder.path, "hang") / part;
    const std::string whole = fake::whole(file);
    for (const std::size_t length : {whole.size() / 2, std::size_t(0)}) {
      std::ofstream(file) << whole.substr(0, length);
      std::ostringstream log;
      request.log = &log;
      const CompareRow again = row_named(compare(request), "carried");
      CHECK_THAT(log.str(), !Contains("hang: kept from before"));
      CHECK(again.temporal == first.temporal);
      CHECK(again.floor == first.floor);
      CHECK(again.ms > 0);
      CHECK(fake::whole(file).size() > whole.size() / 2);
    }
  }
  std::ostringstream log;
  request.log = &log;
  compare(request);
  CHECK_THAT(log.str(), Contains("hang: kept from before"));
}

TEST_CASE("compare: the limit of time holds for a row's frames from the common states", "[compare]") {
  const Folder folder("compare_limit_of_time");
  CompareRequest request;
  request.file = configs / "compare" / "short.yaml";
  request.out = folder.path;
  request.overrides = {"settings=[{name: conventional, stepper: conventional}]", "limits.seconds=1e-9"};
  const CompareRow row = row_named(compare(request), "conventional");
  CHECK(std::isnan(row.temporal));
  CHECK(row.floor > 0);  // references have no limit
  CHECK_THAT(fake::whole(cell_folder(folder.path, "hang") / "errors_0.json"),
             Contains("from a common state: ended by `limits` after frame 0 of 2"));
}

TEST_CASE("compare: the limit of pairs counts them by the triangle, and none after the last frame", "[compare]") {
  StepReport report;
  report.audit.emplace();
  report.audit->self_pairs.assign(20, {0, 1});
  Scene scene;
  scene.surface = make_surface(6, (Triangles(2, 3) << 0, 1, 2, 3, 4, 5).finished());
  const Points apart = (Points(6, 3) << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1, 0, 1, 1).finished();
  RowWatch watch({.pairs = 10}, scene);
  CHECK(watch.goes_on(report, apart));
  CHECK(watch.trouble(3, 8).empty());
  report.audit->self_pairs.push_back({0, 1});
  CHECK_FALSE(watch.goes_on(report, apart));
  CHECK(watch.trouble(8, 8).empty());
  CHECK(watch.trouble(4, 8) == "ended by `limits` after frame 4 of 8: 21 intersecting pairs, more than 10 a triangle");
  RowWatch any({.pairs = 0}, scene);
  CHECK(any.goes_on(report, apart));
  CHECK_FALSE(any.stop_flag());
}

TEST_CASE("compare: the limit of pairs holds for runs whose own audit leaves cloth with itself out", "[compare]") {
  constexpr int count = 12;  // triangles, in turn level and upright, each level one through every upright one
  Scene scene;
  Triangles triangles(count, 3);
  Points x(3 * count, 3);
  for (int t = 0; t < count; ++t) {
    triangles.row(t) << 3 * t, 3 * t + 1, 3 * t + 2;
    const double at = 0.01 * t;
    if (t < count / 2)
      x.middleRows(3 * t, 3) << -1, at, -1, 1, at, -1, 0, at, 2;
    else
      x.middleRows(3 * t, 3) << at, -1, 0, at, 1, -0.1, at, 1, 0.1;
  }
  scene.surface = make_surface(3 * count, triangles);
  REQUIRE(pairs_of_cloth(scene.surface, x) == 36);
  StepReport report;
  report.audit.emplace();
  scene.contact.self = false;
  RowWatch watch({.pairs = 2}, scene);
  CHECK_FALSE(watch.goes_on(report, x));
  CHECK_THAT(watch.trouble(1, 8), Contains("36 intersecting pairs, more than 2 a triangle"));
  scene.contact.self = true;
  CHECK(RowWatch({.pairs = 2}, scene).goes_on(report, x));  // what its audit says
}

TEST_CASE("compare: a row that did not come to its end is on no front", "[compare]") {
  std::vector<CompareRow> rows(2);
  for (CompareRow& row : rows) {
    row.scene = "one";
    row.ms = row.temporal = 1;
    row.floor = 0.1;
  }
  rows[0].ms = 0.5;
  rows[0].measures["finished"] = 0;
  rank(rows);
  CHECK_FALSE(rows[0].front);
  CHECK_FALSE(rows[0].ranked);
  CHECK(rows[1].front);  // nor does it put others off
}

TEST_CASE("plots: a row is marked as on the page", "[compare]") {
  const Folder folder("compare_plots");
  CompareResult result;
  result.floors.resize(1);
  result.floors.front().scene = "one";
  result.floors.front().steps = 1e-4;
  for (const char* name : {"fast", "slow", "crossing", "passing", "rejected"}) {
    CompareRow& row = result.rows.emplace_back();
    row.scene = "one";
    row.setting = name;
    row.ms = 10.0 * static_cast<double>(result.rows.size());
    row.temporal = 1e-3;
    row.floor = 1e-4;
    row.pairs = 0;
  }
  result.rows[2].pairs = 3;
  result.rows[3].passed_through = 1;
  result.rows[4].trouble = "rejects a step";
  rank(result.rows);
  const PlotMark marks[]{PlotMark::front, PlotMark::plain, PlotMark::unclean, PlotMark::unclean, PlotMark::failed};
  for (std::size_t k = 0; k < 5; ++k) {
    INFO(result.rows[k].setting);
    CHECK(mark_of(result.rows[k], 1e-3) == marks[k]);
  }
  CHECK(mark_of(result.rows[1], std::nan("")) == PlotMark::failed);
  CHECK_THAT(plot_comparison(result, folder.path), Contains("one_temporal.svg"));
  const std::string svg = fake::whole(folder.path / "one_temporal.svg");
  CHECK_THAT(svg, Contains(">fast</text>") && Contains("class='front'") && Contains("class='unclean'") &&
                      Contains("class='failed'") && Contains("class='floor'"));
  CHECK_FALSE(std::filesystem::exists(folder.path / "one_algebraic.svg"));  // no row has such an error
}

TEST_CASE("compare: rows of networks step once a frame, and what failed is said on the page", "[compare]") {
  const Folder folder("compare_networks");
  for (const bool spoiled : {false, true}) {
    fake::NarrowNetwork network = fake::narrow_network("small");
    if (spoiled)
      weight_arrays(network.architecture, network.weights)[0].data[0] = std::numeric_limits<float>::quiet_NaN();
    write_weight_file(folder.path / (spoiled ? "spoiled.h5" : "w.h5"),
                      {network.architecture, network.weights, "", {}, ""});
  }
  fake::write(folder, "hanging.yaml",
              "cloths: [{rectangle: {size: [0.5, 0.5], resolution: 4}, pins: [{group: [top]}]}]\nrun: {frames: 2}\n");
  CompareRequest request;
  request.file = fake::write(folder, "comparison.yaml",
                             "scenes: [{name: hanging, file: hanging.yaml, states: 0}]\nrepeats: 1\njudged_frames: 0\n"
                             "settings: [{name: a, stepper: learned, weights: w.h5}, {name: b, stepper: learned, "
                             "weights: spoiled.h5}, {name: c, stepper: learned, weights: w.h5, set: [run.fps=60]}, "
                             "{name: d, weights: w.h5}, {name: e, set: [run.fps=60]}]\n");
  request.out = folder.path / "out";
  const CompareResult result = compare(request);
  CHECK(row_named(result, "a").dt == Approx(1.0 / 30));
  CHECK_THAT(row_named(result, "c").trouble, Contains("60 frames a second; cure: give fps: 30"));
  CHECK_THAT(row_named(result, "d").trouble, Contains("`weights` has no part in the stepper `conventional`"));
  CHECK_THAT(row_named(result, "e").trouble, Contains("makes 60 frames a second, and the scene 30"));
  CHECK_THAT(fake::whole(request.out / "compare.html"), Contains("<li>b: hanging: rejects a step after frame 0"));
}

}  // namespace selvedge::test_compare_rows
