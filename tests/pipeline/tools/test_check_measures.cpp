#include "pipeline/tools/check_measures.hpp"

#include <catch2/catch.hpp>

#include <cmath>

#include "pipeline/tools/check.hpp"
#include "tests/pipeline/fake_run.hpp"

namespace selvedge::test_check_measures {
namespace {

using fake::Folder;

// Frames of a sheet that falls, against g of the caller's.
std::filesystem::path fallen(const Folder& folder, const std::string& name, double g, const Points& body) {
  Setup setup = fake::setup(3);
  setup.initial.obstacles[0] = body;
  setup.drive_at = [g, body](double) {
    Drive drive;
    drive.acceleration = {0, -g, 0};
    drive.obstacles = {body, fake::tetrahedron_points(3, 0)};
    return drive;
  };
  fake::FallingStepper stepper;
  fake::run(setup, stepper, folder.path / name);
  return folder.path / name / "run.h5";
}

}  // namespace

TEST_CASE("check: measures against a reference that falls half as fast, by hand", "[check]") {
  const Folder folder("check_measures");
  const Points far = fake::tetrahedron_points(0, -50);
  const auto run = fallen(folder, "run", 9, far), slow = fallen(folder, "slow", 4.5, far);
  const auto same = measures_against(run, run), values = measures_against(run, slow);
  CHECK(same.at("l2_mm") == 0);
  CHECK(same.at("e3d") == 0);
  // A step falls g dt^2 (1, 3, 6) in all: half of 10 mm times these, on average over the frames.
  CHECK(values.at("l2_mm") == Approx(5 * 10.0 / 3).epsilon(1e-4));
  CHECK(values.at("static_share") == 0);
  CHECK(values.at("pairs_mean") == 0);
  CHECK(values.at("depth") == 0);
  CHECK(values.at("collision_free_frames") == 100);
  CheckRequest request;
  request.file = run;
  request.against = slow;
  CHECK(check(request).measures == values);
}

TEST_CASE("check: the depth of a vertex in a body, and frames that are not free of it", "[check]") {
  const Folder folder("check_depth");
  Points around = fake::tetrahedron_points(-0.02, -0.05);
  around.col(2).array() -= 0.02;  // the sheet's corner lies 0.01 / sqrt(3) m below the slanted face
  const auto run = fallen(folder, "run", 0, around);
  const auto values = measures_against(run, run);
  CHECK(values.at("depth") == Approx(0.01 / std::sqrt(3.0)).epsilon(1e-4));
  CHECK(values.at("collision_free_frames") == 0);
  CHECK(values.at("static_share") == 100);
}

}  // namespace selvedge::test_check_measures
