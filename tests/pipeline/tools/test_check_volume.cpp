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

}  // namespace selvedge::test_check_volume
