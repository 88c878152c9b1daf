#include "pipeline/compare/repulsion_report.hpp"

#include <catch2/catch.hpp>

#include "pipeline/compare/compare.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::test_repulsion_report {

using Catch::Matchers::Contains;

namespace {

DrapeTableRow row(const std::string& name, double mpve, double vfcp, double cfmp, double half_width, int models) {
  DrapeTableRow made;
  made.name = name;
  made.vertex_error = {mpve, half_width, models};
  made.inside = {vfcp, 0, models};
  made.free = {cfmp, 0, models};
  return made;
}

// Two garments of 10 and 30 test models; only the first has the layer by a network.
std::vector<MeasuredDrapes> two_garments() {
  MeasuredDrapes small{"small", {}}, large{"large", {}};
  small.test = 10;
  small.dropped["not at rest"] = 3;
  small.rows = {row("backbone", 8, 0.60, 40, 0.4, 10), row("learned", 6, 0.24, 60, 0.4, 10),
                row("hybrid", 5, 0.1, 70, 0.1, 10)};
  small.rows[0].energy_by_drape = {0, 2e-6, 4e-6};
  small.rows[1].energy_by_drape = {0, 0, 0};
  large.test = 30;
  large.rows = {row("backbone", 4, 0.60, 20, 0.8, 30), row("learned", 2, 0.24, 40, 0.8, 30)};
  return {small, large};
}

}  // namespace

TEST_CASE("repulsion report: means over garments are weighted by their models, and know who has the row",
          "[repulsion_report]") {
  const std::vector<MeasuredDrapes> all = two_garments();
  const MeanOverGarments learned = mean_over_garments(all, "learned", &DrapeTableRow::vertex_error);
  CHECK(learned.garments == 2);
  CHECK(learned.value.models == 40);
  CHECK(learned.value.mean == Approx(3));
  CHECK(learned.backbone.mean == Approx(5));
  CHECK(learned.value.half_width == Approx(std::hypot(0.4 * 10, 0.8 * 30) / 40));
  const MeanOverGarments hybrid = mean_over_garments(all, "hybrid", &DrapeTableRow::vertex_error);
  CHECK(hybrid.garments == 1);
  CHECK(hybrid.value.mean == Approx(5));
  CHECK(hybrid.backbone.mean == Approx(8));  // of the garments that have it
  std::vector<MeasuredDrapes> uncounted = all;
  uncounted[0].counted = false;
  CHECK(mean_over_garments(uncounted, "learned", &DrapeTableRow::vertex_error).value.mean == Approx(2));
}

TEST_CASE("repulsion report: trends follow from the rows, and what is not there says why", "[repulsion_report]") {
  std::vector<MeasuredDrapes> all = two_garments();
  all.push_back({"shirt", "there is no trained run (out/shirt)"});
  const std::string text = repulsion_tables(all);
  CHECK_THAT(text, Contains("-60.0 %"));  // the paper prints -97.5 % of the same numbers
  CHECK_THAT(text, Contains("left out: there is no trained run (out/shirt)"));
  CHECK_THAT(text, Contains("left out: the run has no row `collision_loss`"));
  CHECK_THAT(text, Contains("left out: no run of a graph network has come to its end"));
  CHECK_THAT(text, Contains("left out: no run of drapes along clips has come to its end"));
  CHECK_THAT(text, Contains("3 not at rest"));
  for (int table = 1; table <= 9; ++table) CHECK_THAT(text, Contains("Table " + std::to_string(table) + ":"));
}

TEST_CASE("repulsion report: figures of what was measured, and none of what was not", "[repulsion_report]") {
  std::vector<MeasuredDrapes> all = two_garments();
  const std::string without = repulsion_figures(all);
  CHECK_THAT(without, Contains("Figure 6, small"));
  CHECK_THAT(without, !Contains("Figure 6, large") && !Contains("Figure 8") && !Contains("Figure 9"));
  all[0].rows[2].ratio_and_alpha = {{0.3, 2.5}, {0.4, 1.5}, {9.0, 0.25}};
  all[0].from_training = {5, 1, 2, 3, 4};
  all[0].rows[1].inside_by_drape = {5, 0, 0, 0, 0};
  const std::string with = repulsion_figures(all);
  CHECK_THAT(with,
             Contains("Figure 8, small: mean scale of 3 pushed vertices (hybrid)") && Contains("Figure 9, small"));
}

TEST_CASE("compare: trainings that are not there are left out, and the report is made", "[repulsion_report]") {
  const fake::Folder folder("repulsion_report");
  CompareRequest request;
  request.file = fake::write(folder, "refu.yaml",
                             "drapes: [{name: shirt, run: " + (folder.path / "nowhere").string() +
                                 "}, {name: mesh, run: elsewhere, of: gcnn}]\nsettings: [{name: none}]\n");
  request.out = folder.path / "out";
  const CompareResult result = compare(request);
  CHECK(result.finished);
  CHECK_THAT(result.repulsion, Contains("nowhere: there is no trained run"));
  CHECK_THAT(fake::whole(request.out / "compare.html"), Contains("Repulsive layer"));
  CHECK(fake::whole(request.out / "repulsion.txt") == result.repulsion);
}

}  // namespace selvedge::test_repulsion_report
