#include <catch2/catch.hpp>

#include "pipeline/formats/mesh_io.hpp"
#include "pipeline/run/run_scene.hpp"
#include "pipeline/scene/make_stepper.hpp"
#include "pipeline/scene/setup.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::test_run_folder {

using Catch::Matchers::Contains;

namespace {

void run(const Setup& setup, const std::filesystem::path& out) {
  RunRequest request;
  request.out = out;
  run_scene(setup, *prepare(setup), *make_stepper(setup), request);
}

}  // namespace

TEST_CASE("A run's configuration finds the files that its scene names, from wherever the run lies", "[run_folder]") {
  namespace fs = std::filesystem;
  const fake::Folder folder("run_folder");
  const fs::path scenes = folder.path / "it's here" / "scenes", out = folder.path / "out" / "first";
  fs::create_directories(scenes / "meshes");
  Points x(4, 3);
  x << 0, 1, 0, 0, 1, 1, 1, 1, 0, 1, 1, 1;
  Triangles triangles(2, 3);
  triangles << 0, 1, 2, 2, 1, 3;
  write_obj(scenes / "meshes" / "sheet.obj", x, triangles);
  std::ofstream(scenes / "scene.yaml") << "cloths:\n  - mesh: meshes/sheet.obj\nrun: {frames: 1}\n";
  const Setup first = read_setup(scenes / "scene.yaml");
  run(first, out);

  const Setup again = read_setup(out / "config.yaml");
  CHECK(again.initial.x == first.initial.x);
  run(again, folder.path / "second");
  CHECK(read_setup(folder.path / "second" / "config.yaml").initial.x == x);

  // What stays together may move.
  const fs::path moved = folder.path / "moved";
  fs::create_directories(moved);
  fs::rename(folder.path / "it's here", moved / "it's here");
  fs::rename(folder.path / "out", moved / "out");
  CHECK(read_setup(moved / "out" / "first" / "config.yaml").initial.x == x);
  fs::rename(moved / "it's here", folder.path / "gone");
  CHECK_THROWS_WITH(read_setup(moved / "out" / "first" / "config.yaml"),
                    Contains("config.yaml") && Contains("missing folder") && Contains("it's here"));
}

}  // namespace selvedge::test_run_folder
