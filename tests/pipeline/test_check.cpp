#include <catch2/catch.hpp>
#include <fstream>
#include <nlohmann/json.hpp>

#include "collision/error.hpp"
#include "pipeline/check.hpp"
#include "tests/pipeline/fake_run.hpp"

using namespace selvedge;

namespace {

void write_text(const std::filesystem::path& path, const std::string& text) { std::ofstream(path) << text; }

// Two unit triangles in the planes y = 0 and x = 0.2, which cross.
const char* crossing = "v 0 0 0\nv 1 0 0\nv 0 0 1\nv 0.2 -1 0.2\nv 0.2 1 0.2\nv 0.2 0 0.9\nf 1 2 3\nf 4 5 6\n";
const char* apart = "v 0 0 0\nv 1 0 0\nv 0 0 1\nv 0 0.25 0\nv 1 0.25 0\nv 0 0.25 1\nf 1 2 3\nf 4 5 6\n";
const char* stretched = "v 0 0 0\nv 2 0 0\nv 0 0 1\nv 0 0.25 0\nv 1 0.25 0\nv 0 0.25 1\nf 1 2 3\nf 4 5 6\n";

}  // namespace

TEST_CASE("a mesh is checked for crossings, gaps and stretch") {
  const fake::Folder folder("check_mesh");
  write_text(folder.path / "crossing.obj", crossing);
  write_text(folder.path / "apart.obj", apart);
  write_text(folder.path / "stretched.obj", stretched);

  const CheckReport dirty = check({folder.path / "crossing.obj", {}, {}});
  REQUIRE(dirty.worst_pairs == 1);
  REQUIRE(dirty.min_gap == 0);
  REQUIRE_FALSE(is_clean(dirty));

  CheckRequest request{folder.path / "apart.obj", {}, {}};
  REQUIRE(std::isinf(check(request).min_gap));
  request.horizon = 1;
  const CheckReport clean = check(request);
  REQUIRE(clean.min_gap == Approx(0.25));
  REQUIRE_FALSE(clean.max_stretch);
  REQUIRE(is_clean(clean));

  const CheckReport longer = check({folder.path / "stretched.obj", folder.path / "apart.obj", {}});
  REQUIRE(*longer.max_stretch == Approx(2));
  REQUIRE(*longer.min_stretch == Approx(1));
}

TEST_CASE("a mesh is checked against a body") {
  const fake::Folder folder("check_body");
  write_text(folder.path / "cloth.obj", "v 0.01 0.01 0.01\nv 0.02 0.01 0.01\nv 0.01 0.01 0.02\nf 1 2 3\n");
  write_text(folder.path / "body.obj",
             "v 0 0 0\nv 0.1 0 0\nv 0 0 0.1\nv 0 0.1 0\nf 1 2 3\nf 1 4 2\nf 2 4 3\nf 1 3 4\n");
  const CheckReport report = check({folder.path / "cloth.obj", {}, {folder.path / "body.obj"}});
  REQUIRE(report.bodies == 1);
  REQUIRE(report.inside_vertices == 3);
  REQUIRE_FALSE(is_clean(report));
}

TEST_CASE("the report in JSON has the promised keys") {
  const fake::Folder folder("check_json");
  write_text(folder.path / "crossing.obj", crossing);
  const auto json = nlohmann::json::parse(check_json(check({folder.path / "crossing.obj", {}, {}})));
  for (const char* key : {"frames", "intersecting_pairs", "intersecting_pairs_by_frame", "vertex_sharing_pairs",
                          "min_gap", "max_stretch", "nonfinite", "degenerate_triangles", "inside_vertices"})
    REQUIRE(json.contains(key));
  REQUIRE(json["frames"] == 1);
  REQUIRE(json["intersecting_pairs"] == 1);
  REQUIRE(json["intersecting_pairs_by_frame"] == nlohmann::json::array({1}));
  REQUIRE(json["max_stretch"].is_null());
}

TEST_CASE("a trajectory is judged by its positions, not by what it says of itself") {
  const fake::Folder folder("check_trajectory");
  const Scene scene = fake::scene();
  {
    TrajectoryWriter writer(folder.path / "run.h5", trajectory_info(scene, "", "conventional", 30));
    for (int i = 0; i < 3; ++i) {
      Frame frame = fake::frame(scene, i);
      frame.self_pairs = 99;
      frame.max_stretch = 99;
      if (i == 1) frame.obstacles[1] = fake::tetrahedron_points(0.5, -0.05).cast<float>();
      if (i == 2) frame.x.col(0) *= 1.5f;
      writer.append(frame);
    }
    writer.close();
  }
  const CheckReport report = check({folder.path / "run.h5", {}, {}});
  REQUIRE(report.trajectory);
  REQUIRE(report.frames() == 3);
  REQUIRE(report.pairs_by_frame[0] == 0);
  REQUIRE(report.pairs_by_frame[1] > 0);
  REQUIRE(report.pairs_by_frame[2] == 0);
  REQUIRE(report.worst_pairs == report.pairs_by_frame[1]);
  REQUIRE(report.worst_frame == 1);
  REQUIRE(*report.max_stretch == Approx(1.5));
}

TEST_CASE("values that are not finite are counted") {
  const fake::Folder folder("check_nan");
  const Scene scene = fake::scene();
  {
    TrajectoryWriter writer(folder.path / "run.h5", trajectory_info(scene, "", "conventional", 30));
    Frame frame = fake::frame(scene, 0);
    frame.x(3, 1) = std::numeric_limits<float>::quiet_NaN();
    frame.x(4, 0) = std::numeric_limits<float>::infinity();
    writer.append(frame);
    writer.close();
  }
  const CheckReport report = check({folder.path / "run.h5", {}, {}});
  REQUIRE(report.nonfinite == 2);
  REQUIRE_FALSE(is_clean(report));
}

TEST_CASE("a rest mesh of other faces is refused") {
  const fake::Folder folder("check_rest");
  write_text(folder.path / "a.obj", apart);
  write_text(folder.path / "b.obj", "v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\n");
  REQUIRE_THROWS_AS(check({folder.path / "a.obj", folder.path / "b.obj", {}}), Error);
}
