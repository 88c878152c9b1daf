#include <catch2/catch.hpp>

#include <cmath>

#include "pipeline/setup.hpp"

using namespace selvedge;

namespace {

std::filesystem::path config(const std::string& name) {
  return std::filesystem::path(SELVEDGE_SOURCE_DIR) / "configs" / name;
}

}  // namespace

TEST_CASE("Shipped scenes read without warnings", "[setup]") {
  for (const char* name : {"demo.yaml", "bench/hang.yaml", "bench/drop.yaml", "bench/tube.yaml"}) {
    INFO(name);
    const Setup setup = read_setup(config(name));
    CHECK(setup.warnings.empty());
    const Scene& scene = setup.scene;
    CHECK(scene.rest_triangle.size() == static_cast<std::size_t>(scene.surface.triangles.rows()));
    CHECK(setup.initial.x.rows() == scene.surface.vertex_count);
    CHECK(setup.initial.x.allFinite());
    CHECK(scene.surface.isolated_vertices == 0);
    CHECK(scene.surface.nonmanifold_edges == 0);
    const Drive drive = setup.drive_at(0.7);
    CHECK(drive.pins.rows() == static_cast<Eigen::Index>(scene.pins.size()));
    CHECK(drive.obstacles.size() == scene.obstacles.size());
    CHECK(drive.acceleration.y() == -9.81);
  }
}

TEST_CASE("The benchmark scenes have N x N vertices", "[setup]") {
  CHECK(read_setup(config("bench/hang.yaml"), {"cloths.0.rectangle.resolution=40"}).scene.surface.vertex_count == 1600);
  CHECK(read_setup(config("bench/drop.yaml"), {"cloths.0.rectangle.resolution=40"}).scene.surface.vertex_count == 1600);
  CHECK(read_setup(config("bench/tube.yaml"), {"cloths.sleeve.tube.resolution=40"}).scene.surface.vertex_count == 1600);
}
