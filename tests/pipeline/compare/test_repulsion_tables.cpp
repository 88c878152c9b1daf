#include <catch2/catch.hpp>

#include <algorithm>

#include "pipeline/compare/compare.hpp"
#include "pipeline/drapes/make_drapes.hpp"
#include "pipeline/drapes/train_drapes.hpp"
#include "pipeline/host/csv_columns.hpp"
#include "pipeline/host/read_file.hpp"
#include "pipeline/obstacles/setup_paths.hpp"
#include "tests/pipeline/files.hpp"

// Coarse garments of 300 vertices, of stored seeds, go all the way: drapes, networks with every row, and the report
// with every table.
namespace selvedge::test_repulsion_tables {

using Catch::Matchers::Contains;
using fake::Folder;
using Overrides = std::vector<std::string>;

namespace {

void make_drapes(const Folder& folder, const std::string& set, const Overrides& overrides) {
  DatasetRequest request;
  request.config = config_folder() / "data" / "drape_small.yaml";
  request.overrides = overrides;
  request.out = folder.path / set;
  REQUIRE(make_dataset(request).finished);
}

DrapeTrainSummary train(const Folder& folder, const std::string& run, const std::string& set, Overrides overrides) {
  TrainRequest request;
  request.config = config_folder() / "training" / "refu_small.yaml";
  overrides.push_back("drapes=" + (folder.path / set).string());
  request.overrides = std::move(overrides);
  request.out = folder.path / run;
  DrapeTrainSummary made = train_drapes(request);
  REQUIRE(made.finished);
  return made;
}

const DrapeTableRow& row_of(const DrapeTrainSummary& made, const std::string& name) {
  const auto found = std::ranges::find(made.table, name, &DrapeTableRow::name);
  REQUIRE(found != made.table.end());
  return *found;
}

// A column's last value over its first.
double shrunk(const Folder& folder, const std::string& csv, const std::string& column) {
  const CsvColumns columns(read_file(folder.path / csv, "table"));
  return columns[column].back() / columns[column].front();
}

// What must hold of rows with accurate distances, whatever was trained how long.
void check_rows(const DrapeTrainSummary& made) {
  const DrapeTableRow& control = row_of(made, "control");
  CHECK(row_of(made, "backbone").inside.mean > 0);  // otherwise there is nothing to compare
  for (const DrapeTableRow& row : made.table) CHECK(row.judges_differ == 0);
  for (const char* name : {"control, naive", "fixed", "learned", "shared_latent", "distance_only", "neighbours"}) {
    INFO(name);
    const DrapeTableRow& row = row_of(made, name);
    CHECK(row.inside.mean == 0);
    CHECK(row.pushed.mean > 0);
    CHECK(row.vertex_error.mean < control.vertex_error.mean + 0.05);
  }
  for (const char* name : {"control, naive", "fixed", "learned", "neighbours"})
    CHECK(row_of(made, name).overshoot.mean < 2);  // pumping cloth outward is no solution
  CHECK(row_of(made, "control, smooth").inside.mean < control.inside.mean);
  for (const char* name : {"control, naive", "fixed", "learned", "neighbours", "hybrid"}) {
    INFO(name);
    const DrapeTableRow &one = row_of(made, name + std::string(", edges 1")),
                        &three = row_of(made, name + std::string(", edges 3"));
    CHECK(one.pairs.mean < 0.5 * row_of(made, name).pairs.mean);
    CHECK(three.free.mean >= one.free.mean);
    CHECK(one.vertex_error.mean < row_of(made, name).vertex_error.mean + 0.1);
  }
  CHECK(row_of(made, "hybrid").vertex_error.mean < row_of(made, "approximate").vertex_error.mean);
}

}  // namespace

TEST_CASE("repulsion tables: small garments are made, trained on and measured, and the report lacks nothing",
          "[repulsion_tables]") {
  const Folder folder("repulsion_tables");
  make_drapes(folder, "tank", {});
  make_drapes(folder, "shorts", {"garment=shorts", "training=4", "test=2"});
  for (const char* shapes : {"2", "3"})
    make_drapes(folder, std::string("clips_") + shapes,
                {"clips=[march]", "test_clips=[side_bends]", "poses=1", std::string("shapes=") + shapes});

  const DrapeTrainSummary tank = train(folder, "tank_run", "tank", {});
  check_rows(tank);
  CHECK(shrunk(folder, "tank_run/backbone.csv", "reconstruction") < 0.1);
  CHECK(shrunk(folder, "tank_run/distance.csv", "error_mm") < 0.3);

  const std::string network = "distance.weights=" + (folder.path / "tank_run" / "distance.h5").string();
  // A backbone that is trained less leaves vertices of training drapes inside, which scales can be learned from.
  const DrapeTrainSummary inside =
      train(folder, "inside_run", "tank", {network, "rows=[learned, neighbours]", "backbone.stage.steps=150"});
  for (const char* name : {"learned", "neighbours"}) CHECK(row_of(inside, name).alpha > 1.03);
  check_rows(train(folder, "shorts_run", "shorts", {network}));
  const DrapeTrainSummary graph =
      train(folder, "gcnn_run", "tank",
            {network, "rows=[learned, approximate, hybrid]", "from_scratch=true", "backbone.kind=gcnn",
             "backbone.layers=2", "backbone.mesh.levels=2", "backbone.mesh.channels=4", "backbone.mesh.kernels=3",
             "backbone.stage.steps=60", "layer.scale_rate=1"});
  CHECK(row_of(graph, "learned").inside.mean == 0);
  for (const char* clips : {"clips_2", "clips_3"})
    train(folder, clips + std::string("_run"), clips,
          {network, "rows=[control, learned, approximate]", "validation_paths=1"});

  std::string drapes;
  for (const auto& [name, use] : {std::pair{"tank", "garments"},
                                  {"shorts", "garments"},
                                  {"gcnn", "gcnn"},
                                  {"clips_2", "clips"},
                                  {"clips_3", "clips"}})
    drapes += fmt::format("  - {{name: {}, run: {}, of: {}}}\n", name,
                          (folder.path / (name + std::string("_run"))).string(), use);
  CompareRequest request;
  request.file = fake::write(folder, "report.yaml", "drapes:\n" + drapes + "settings: [{name: none}]\n");
  request.out = folder.path / "report";
  const std::string text = compare(request).repulsion;
  INFO(text);
  for (int table = 1; table <= 9; ++table) CHECK_THAT(text, Contains("Table " + std::to_string(table) + ":"));
  CHECK_THAT(text, !Contains("left out"));
  CHECK_THAT(text, Contains(fmt::format("{:.2f} +- {:.2f}", row_of(tank, "learned").vertex_error.mean,
                                        row_of(tank, "learned").vertex_error.half_width)));
  const std::string page = fake::whole(request.out / "compare.html");
  for (const char* figure : {"Figure 6, tank", "Figure 8, tank", "Figure 9, tank"}) CHECK_THAT(page, Contains(figure));
}

}  // namespace selvedge::test_repulsion_tables
