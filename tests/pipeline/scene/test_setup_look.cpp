#include <catch2/catch.hpp>

#include "pipeline/scene/setup.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::test_setup_look {

using fake::Folder;

namespace {

// Two quadrangles whose common edge is there twice.
const std::string panels =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
    "f 1/1 2/2 3/3 4/4\nf 5/1 6/2 7/3 8/4\n";

Setup read(const Folder& folder, const std::string& cloth) {
  fake::write(folder, "panels.obj", panels);
  return read_setup(fake::write(folder, "scene.yaml", "cloths: [" + cloth + "]\nrun: {frames: 2}\n"));
}

}  // namespace

TEST_CASE("a scene keeps the look of its meshes, also of welded and sewn ones, for the trajectory", "[scene][look]") {
  const Folder folder("setup_look");
  const std::string mesh = "{name: panels, mesh: {file: panels.obj";
  CHECK(read(folder, "{rectangle: {size: [1, 1], edge: 0.5}}").looks.empty());
  CHECK(read(folder, mesh + "}}").looks[0].vertex == std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7});
  const Setup welded = read(folder, mesh + ", weld: true}}, {name: sheet, rectangle: {size: [1, 1], edge: 0.5}}");
  REQUIRE(welded.looks.size() == 2);
  CHECK(welded.scene.cloths[1].first_vertex == 6);
  CHECK(welded.looks[0].vertex == std::vector<int>{0, 1, 2, 3, 1, 4, 5, 2});
  CHECK(welded.looks[0].corners == std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7});
  CHECK(welded.looks[1].empty());
  const Setup sewn = read(folder, mesh + "}, seams: [{from: {vertices: [1, 2]}, to: {vertices: [4, 7]}}]}");
  CHECK(sewn.scene.surface.vertex_count == 6);
  CHECK(sewn.looks[0].vertex == std::vector<int>{0, 1, 2, 3, 1, 4, 5, 2});

  fake::FallingStepper stepper;
  fake::run(welded, stepper, folder.path / "out");
  const std::vector<Look> looks = TrajectoryReader(folder.path / "out" / "run.h5").looks();
  REQUIRE(looks.size() == 2);
  CHECK(looks[0].vertex == welded.looks[0].vertex);
  CHECK(looks[0].uv == welded.looks[0].uv);
  CHECK(looks[1].empty());
}

}  // namespace selvedge::test_setup_look
