#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "pipeline/tools/check.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::test_check_volume {

TEST_CASE("check --volume: two cubes enclose what is known of them") {
  const std::filesystem::path file = fake::open_data() / "meshes" / "two-cubes-intersecting.ply";
  if (!std::filesystem::exists(file)) {
    WARN("skipped: the open meshes are not there");
    return;
  }
  CheckRequest request;
  request.file = file;
  CHECK_FALSE(check(request).volume);
  request.volume = true;
  const CheckReport report = check(request);
  REQUIRE(report.volume);
  REQUIRE(report.volume->volume_by_frame.size() == 1);
  CHECK(report.volume->volume_by_frame[0] == Approx(0.0273).epsilon(0.002));
  CHECK(report.volume->loss_by_frame[0] == Approx(6 * 3e4 * report.volume->volume_by_frame[0]));
  CHECK(report.volume->unassigned == 0);
  const auto json = nlohmann::json::parse(check_json(report));
  CHECK(json.at("volume").at("mean_loss") == report.volume->mean_loss());
  CHECK(check_text(report).find("enclosed volume") != std::string::npos);
}

TEST_CASE("check --volume: flat pieces that cross, their boundaries closed, enclose nothing and are counted") {
  const fake::Folder folder("check_volume");
  const auto file = fake::write(
      folder, "sheets.obj", "v 0 0 0\nv 1 0 0\nv 0 0 1\nv 0.2 -1 0.2\nv 0.2 1 0.2\nv 0.2 0 0.9\nf 1 2 3\nf 4 5 6\n");
  CheckRequest request;
  request.file = file;
  request.volume = true;
  const CheckReport report = check(request);
  REQUIRE(report.volume);
  CHECK(report.volume->closed_holes == 2);
  CHECK(report.volume->contours == 1);
  CHECK(report.volume->enclosed == 1);
  CHECK(report.volume->volume_by_frame[0] == Approx(0).margin(1e-15));
}

TEST_CASE("check --volume: a fan that goes through its own clean garment at rest is known") {
  // A tube of square rings whose upper hem is rolled outwards and down on one side: no cloth crosses, but the fan
  // across that hem goes through the wall.
  const auto ring = [](double half, double left, double right) {
    Points x(4, 3);
    x << -half, left, -half, half, right, -half, half, right, half, -half, left, half;
    return x;
  };
  Points x(16, 3);
  x << ring(0.1, 0, 0), ring(0.1, 0.3, 0.3), ring(0.12, 0.3, 0.3), ring(0.14, 0.05, 0.3);
  Triangles triangles(24, 3);
  int t = 0;
  for (int k = 0; k < 3; ++k)
    for (int j = 0; j < 4; ++j) {
      const int a = 4 * k + j, b = 4 * k + (j + 1) % 4;
      triangles.row(t++) << a, b, b + 4;
      triangles.row(t++) << a, b + 4, a + 4;
    }
  const VolumeCheck rolled(make_surface(16, triangles));
  CHECK(rolled.of_fans(x) > 0);
  x.bottomRows(4) = ring(0.14, 0.32, 0.32);
  CHECK(rolled.of_fans(x) == 0);
}

}  // namespace selvedge::test_check_volume
