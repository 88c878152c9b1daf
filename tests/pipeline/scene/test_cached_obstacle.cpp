#include <catch2/catch.hpp>

#include "pipeline/exports/point_cache.hpp"
#include "pipeline/formats/mesh_io.hpp"
#include "pipeline/formats/read_point_cache.hpp"
#include "pipeline/scene/setup.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::test_cached_obstacle {

using Catch::Matchers::Contains;
using fake::Folder;

namespace {

Points corners() {
  Points x(4, 3);
  x << 0, 0, 0, 0, 0, 1, 1, 0, 0, 1, 0, 1;
  return x;
}

// Four corners that rise along all axes.
Points moved(double by) { return corners().array() + by; }

AnimatedSurfaces some_run() {
  AnimatedSurfaces run;
  run.fps = 24;
  run.frame_count = 5;
  run.surfaces.push_back({"sheet", Triangles::Zero(1, 3), 4});
  run.frame = [](int i) { return std::vector<PointsF>{moved(0.1 * i).cast<float>()}; };
  return run;
}

}  // namespace

TEST_CASE("Point caches that the exports write come back", "[setup]") {
  const Folder folder("caches");
  const AnimatedSurfaces run = some_run();
  write_pc2(folder.path / "a.pc2", run, 0);
  write_mdd(folder.path / "a.mdd", run, 0);
  for (const char* name : {"a.pc2", "a.mdd"}) {
    const PointCache cache = read_point_cache(folder.path / name);
    CHECK(cache.fps == Approx(std::string(name) == "a.mdd" ? 24 : 0).epsilon(1e-6));
    REQUIRE(cache.frames.size() == 5);
    for (int f = 0; f < 5; ++f) CHECK(cache.frames[static_cast<std::size_t>(f)] == run.frame(f)[0].cast<double>());
  }
}

TEST_CASE("An obstacle follows a point cache on the faces of a mesh", "[setup]") {
  const Folder folder("cache_scene");
  const Points x = corners();
  Triangles triangles(2, 3);
  triangles << 0, 1, 2, 2, 1, 3;
  write_obj(folder.path / "floor.obj", x, triangles);
  write_mdd(folder.path / "floor.mdd", some_run(), 0);
  const auto scene = [&](const std::string& sequence) {
    return read_setup(fake::write(folder, "scene.yaml",
                                  "cloths:\n  - {rectangle: {size: [0.3, 0.3], resolution: 3}, translate: [0, 3, 0]}\n"
                                  "obstacles:\n  - sequence: {" +
                                      sequence + "}\n"));
  };
  const Setup setup = scene("cache: floor.mdd, mesh: floor.obj, unit: cm");
  CHECK(setup.scene.obstacles[0].surface.triangles == triangles);
  CHECK(setup.drive_at(2.5 / 24).obstacles[0].isApprox(0.01 * moved(0.25), 1e-6));
  CHECK(scene("cache: floor.mdd, mesh: floor.obj, fps: 12").drive_at(1.0 / 12).obstacles[0].isApprox(moved(0.1), 1e-6));
  CHECK_THROWS_WITH(scene("cache: floor.mdd"), Contains("without a mesh"));
  CHECK_THROWS_WITH(scene("pattern: floor.obj, mesh: floor.obj"), Contains("without a point cache"));
  write_obj(folder.path / "other.obj", x.topRows(3), triangles.topRows(1));
  CHECK_THROWS_WITH(scene("cache: floor.mdd, mesh: other.obj"), Contains("4 vertices, its mesh has 3"));
}

}  // namespace selvedge::test_cached_obstacle
