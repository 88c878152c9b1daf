#include <catch2/catch.hpp>
#include <cstring>

#include "pipeline/exports/point_cache.hpp"
#include "pipeline/formats/mesh_io.hpp"
#include "pipeline/formats/read_point_cache.hpp"
#include "pipeline/scene/setup.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::test_read_point_cache {

using Catch::Matchers::Contains;
using fake::Folder;

namespace {

std::string word(std::int32_t value) { return {reinterpret_cast<const char*>(&value), 4}; }

std::string head(int points, int frames) {
  return std::string("POINTCACHE2\0", 12) + word(1) + word(points) + word(0) + word(0x3f800000) + word(frames);
}

std::string halves(const std::vector<std::uint16_t>& values) {
  return {reinterpret_cast<const char*>(values.data()), 2 * values.size()};
}

AnimatedSurfaces some_run() {
  AnimatedSurfaces run;
  run.fps = 24;
  run.frame_count = 5;
  run.surfaces.push_back({"sheet", Triangles::Zero(1, 3), 4});
  run.frame = [](int i) { return std::vector<PointsF>{PointsF::Constant(4, 3, 0.1f * static_cast<float>(i))}; };
  return run;
}

}  // namespace

TEST_CASE("Point caches that the exports write come back", "[read_point_cache]") {
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

TEST_CASE("Half floats of a .pc16 are read as IEEE 754 has them", "[read_point_cache]") {
  const Folder folder("pc16");
  const auto path = fake::write(folder, "a.pc16",
                                head(2, 2) + halves({0x3c00, 0xc000, 0x3555, 0x0001, 0x8000, 0x7bff,  //
                                                     0x0400, 0x83ff, 0x3800, 0x4248, 0xfbff, 0x0000}));
  const PointCache cache = read_point_cache(path);
  Points first(2, 3), second(2, 3);
  first << 1, -2, 1365.0 / 4096, std::ldexp(1, -24), 0, 65504;
  second << std::ldexp(1, -14), -1023 * std::ldexp(1, -24), 0.5, 3.140625, -65504, 0;
  REQUIRE(cache.frames.size() == 2);
  CHECK(cache.frames[0] == first);
  CHECK(cache.frames[1] == second);
}

TEST_CASE("What is wrong with a point cache is named", "[read_point_cache]") {
  const Folder folder("caches_wrong");
  const auto refused = [&](const std::string& name, const std::string& bytes, const std::string& words) {
    CHECK_THROWS_WITH(read_point_cache(fake::write(folder, name, bytes)), Contains(name) && Contains(words));
  };
  const std::string one = halves({0, 0, 0});
  refused("a.pc16", "", "POINTCACHE2");
  refused("a.pc16", "POINTCACHE2", "POINTCACHE2");
  refused("a.pc16", head(1, 1).substr(0, 20), "cut short");
  refused("a.pc16", head(1, 1) + one.substr(1), "has 37 bytes, 1 points in 1 frames take 38");
  refused("a.pc2", head(1, 1) + one, "take 44");
  refused("a.pc16", head(0, 1), "0 points");
  refused("a.pc16", head(1 << 30, 1 << 30), "take");
  refused("a.pc16", head(1, -1), "-1 frames");
  refused("a.pc16", head(1, 2) + one + halves({0, 0x7e00, 0}), "vertex 0 of frame 1");
  refused("a.pc16", head(1, 1) + halves({0x7c00, 0, 0}), "not finite");
  refused("a.mdd", "abc", "cut short");
  refused("a.mdd", std::string(8, '\xff'), "-1 frames");
  refused("a.abc", "", "no point cache");
  std::string version = head(1, 1) + one;
  version[12] = 2;
  refused("a.pc16", version, "version 2");
}

TEST_CASE("An obstacle follows a point cache on the faces of a mesh", "[read_point_cache]") {
  const Folder folder("cache_scene");
  Points x(4, 3);
  x << 0, 0, 0, 0, 0, 1, 1, 0, 0, 1, 0, 1;
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
  CHECK(setup.drive_at(2.5 / 24).obstacles[0].isApprox(Points::Constant(4, 3, 0.0025), 1e-6));
  CHECK(scene("cache: floor.mdd, mesh: floor.obj, fps: 12")
            .drive_at(1.0 / 12)
            .obstacles[0]
            .isApprox(Points::Constant(4, 3, 0.1), 1e-6));
  CHECK_THROWS_WITH(scene("cache: floor.mdd"), Contains("without a mesh"));
  CHECK_THROWS_WITH(scene("pattern: floor.obj, mesh: floor.obj"), Contains("without a point cache"));
  write_obj(folder.path / "other.obj", x.topRows(3), triangles.topRows(1));
  CHECK_THROWS_WITH(scene("cache: floor.mdd, mesh: other.obj"), Contains("4 vertices, its mesh has 3"));
}

}  // namespace selvedge::test_read_point_cache
