#include <catch2/catch.hpp>

#include <algorithm>

#include "collision/geometry/error.hpp"
#include "pipeline/cells/do_cells.hpp"
#include "pipeline/drapes/drape_run.hpp"
#include "pipeline/drapes/make_drapes.hpp"
#include "pipeline/drapes/train_drapes.hpp"
#include "pipeline/obstacles/setup_paths.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::test_train_drapes {

using fake::Folder;

namespace {

DatasetRequest tiny_data(const Folder& folder) {
  DatasetRequest request;
  request.config = config_folder() / "data" / "drape_tiny.yaml";
  request.out = folder.path / "data";
  return request;
}

TrainRequest tiny_run(const Folder& folder, const std::string& out) {
  TrainRequest request;
  request.config = config_folder() / "training" / "refu_tiny.yaml";
  request.overrides = {"drapes=" + (folder.path / "data").string()};
  request.out = folder.path / out;
  return request;
}

}  // namespace

TEST_CASE("drapes: a set by cells has the bits of the command's", "[drapes][cells]") {
  const Folder folder("drape_cells");
  DatasetRequest request = tiny_data(folder);
  const CellList list = dataset_cells(request);
  CHECK(list.names == std::vector<std::string>{"path_0000", "path_0001", "path_0002", "path_0003"});
  const std::filesystem::path out = folder.path / "cells";
  for (const std::size_t k : {3, 0, 1}) REQUIRE(do_cell(dataset_cells(request), k, out, {}));
  CHECK(gather_cells(list, out).missing == std::vector<std::string>{"path_0002"});
  CHECK_THROWS_AS(read_drape_set(out), Error);
  REQUIRE(do_cell(list, 2, out, {}));
  CHECK(gather_cells(list, out).complete());
  REQUIRE(make_dataset(request).finished);
  const DrapeSet cells = read_drape_set(out), command = read_drape_set(request.out);
  REQUIRE(cells.training.size() == command.training.size());
  for (std::size_t k = 0; k < cells.training.size(); ++k) CHECK(cells.training[k].x == command.training[k].x);
  CHECK(fake::whole(out / "config.yaml") == fake::whole(request.out / "config.yaml"));
  CHECK(std::filesystem::exists(out / "drapes.csv"));
}

TEST_CASE("drapes: from a simulated set to the table, stopped and resumed on the way", "[drapes]") {
  const Folder folder("train_drapes");
  const DatasetSummary data = make_dataset(tiny_data(folder));
  REQUIRE(data.finished);
  REQUIRE(data.training >= 3);
  REQUIRE(data.test >= 1);
  CHECK(make_dataset(tiny_data(folder)).training == data.training);  // nothing is made again
  DatasetRequest other = tiny_data(folder);
  other.overrides = {"seed=5"};
  CHECK_THROWS_AS(make_dataset(other), Error);

  const DrapeTrainSummary whole = train_drapes(tiny_run(folder, "whole"));
  REQUIRE(whole.finished);
  int asked = 0;
  TrainRequest stopped = tiny_run(folder, "stopped");
  stopped.stop = [&] { return ++asked == 25; };
  CHECK(!train_drapes(stopped).finished);
  stopped.stop = {};
  stopped.resume = true;
  const DrapeTrainSummary resumed = train_drapes(stopped);
  REQUIRE(resumed.finished);
  REQUIRE(resumed.table.size() == whole.table.size());
  for (std::size_t k = 0; k < whole.table.size(); ++k) {
    CHECK(resumed.table[k].name == whole.table[k].name);
    CHECK(resumed.table[k].error_by_drape == whole.table[k].error_by_drape);
  }
  const auto row = [&](const std::string& name) {
    const auto found = std::ranges::find(whole.table, name, &DrapeTableRow::name);
    REQUIRE(found != whole.table.end());
    return *found;
  };
  CHECK(row("control, naive").inside.mean <= row("control").inside.mean);
  CHECK(row("learned").alpha >= 1);
  CHECK(row("hybrid").pushed.models == data.test);
  const std::string csv = fake::whole(folder.path / "whole" / "table.csv");
  CHECK(csv.starts_with("row,models,mpve_mm"));
  CHECK(csv.find("\n\"control, naive\"," + std::to_string(data.test)) != std::string::npos);

  // What the folder holds measures as the run did.
  const DrapeRun opened = open_drape_run(folder.path / "whole");
  DrapeLessons lessons = make_drape_lessons(opened.options.drapes, opened.options.validation_paths, true);
  use_network(opened.distance, lessons);
  const std::vector<MeasuredMethod> methods = measured_methods(opened);
  REQUIRE(methods.size() == whole.table.size());
  for (std::size_t k = 0; k < methods.size(); ++k)
    CHECK(measure_row(methods[k].method, *methods[k].model, opened.options, lessons).error_by_drape ==
          whole.table[k].error_by_drape);
  std::filesystem::remove(folder.path / "whole" / "learned.h5");
  CHECK_THROWS_AS(open_drape_run(folder.path / "whole"), Error);
}

TEST_CASE("drapes: a graph network whose rows begin from scratch, and poses of clips on shared bodies", "[drapes]") {
  const Folder folder("train_drapes_gcnn");
  DatasetRequest request = tiny_data(folder);
  request.overrides = {"clips=[walk]", "test_clips=[twist]", "shapes=2"};
  const DatasetSummary data = make_dataset(request);
  REQUIRE(data.finished);
  const DrapeSet set = read_drape_set(folder.path / "data");
  REQUIRE(set.training.size() == 2);
  REQUIRE(set.test.size() == 2);
  CHECK(set.training[0].shape == set.test[0].shape);
  CHECK(set.training[0].shape != set.training[1].shape);

  TrainRequest run = tiny_run(folder, "gcnn");
  for (const char* more : {"rows=[control]", "from_scratch=true", "backbone.kind=gcnn", "backbone.mesh.levels=2",
                           "backbone.mesh.channels=2", "backbone.mesh.kernels=2"})
    run.overrides.emplace_back(more);
  const DrapeTrainSummary made = train_drapes(run);
  REQUIRE(made.finished);
  const DrapeRun opened = open_drape_run(folder.path / "gcnn");
  REQUIRE(opened.backbone.drape.mesh.size() == 3);
  // Without a layer a row from scratch is the backbone once more.
  CHECK(made.table[0].error_by_drape == made.table[1].error_by_drape);
}

}  // namespace selvedge::test_train_drapes
