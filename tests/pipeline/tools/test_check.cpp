#include <catch2/catch.hpp>
#include <fstream>
#include <nlohmann/json.hpp>

#include "collision/geometry/error.hpp"
#include "collision/search/obstacle.hpp"
#include "pipeline/tools/check.hpp"
#include "tests/pipeline/fake_run.hpp"

namespace selvedge::test_check {

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

TEST_CASE("seams that are not welded are told with the number that welding joins") {
  const fake::Folder folder("check_seams");
  write_text(folder.path / "panels.obj", "v 0 0 0\nv 1 0 0\nv 0 0 1\nv 1 0 0\nv 1 0 1\nv 0 0 1\nf 1 3 2\nf 4 6 5\n");
  const CheckReport mesh = check({folder.path / "panels.obj", {}, {}});
  REQUIRE(mesh.warnings.size() == 1);
  CHECK(mesh.warnings[0].find("the seams are not welded") == 0);
  CHECK(mesh.warnings[0].find("joins 2 vertices") != std::string::npos);
}

TEST_CASE("cloths of other programs may have triangles in common with the next cloth") {
  const fake::Folder folder("check_common");
  const Scene scene = fake::scene();
  TrajectoryInfo info = trajectory_info(scene, "", "conventional", 30);
  info.cloth_names = {"upper", "lower"};
  info.cloth_first_vertex = {0, 10, 25};
  info.cloth_first_triangle = {0, 16, 32};  // of which the last eight of `upper` reach into `lower`
  info.rest.row(9) = info.rest.row(0);      // in no triangle of `upper` alone with an edge in common
  {
    TrajectoryWriter writer(folder.path / "run.h5", info);
    writer.append(fake::frame(scene, 0));
    writer.close();
  }
  const CheckReport report = check({folder.path / "run.h5", {}, {}});
  CHECK(report.frames() == 1);
  CHECK(report.warnings.empty());
}

TEST_CASE("the folder of a run is checked as its trajectory is") {
  const fake::Folder folder("check_folder");
  fake::FallingStepper stepper;
  fake::run(fake::setup(3), stepper, folder.path / "run");
  const CheckReport of_file = check({folder.path / "run" / "run.h5", {}, {}});
  const CheckReport of_folder = check({folder.path / "run", {}, {}, folder.path / "run"});
  CHECK(of_folder.trajectory);
  CHECK(of_folder.pairs_by_frame == of_file.pairs_by_frame);
  CHECK(of_folder.frames() == 4);
  CHECK(of_folder.measures.at("l2_mm") == 0);
}

TEST_CASE("a mesh is checked against a body") {
  const fake::Folder folder("check_body");
  write_text(folder.path / "cloth.obj", "v 0.01 0.01 0.01\nv 0.02 0.01 0.01\nv 0.01 0.01 0.02\nf 1 2 3\n");
  write_text(folder.path / "body.obj",
             "v 0 0 0\nv 0.1 0 0\nv 0 0 0.1\nv 0 0.1 0\nf 1 2 3\nf 1 4 2\nf 2 4 3\nf 1 3 4\n");
  const CheckReport report = check({folder.path / "cloth.obj", {}, {folder.path / "body.obj"}});
  REQUIRE(report.bodies == 1);
  CHECK(check_text(report).find("1 frame, 3 vertices, 1 triangle, 1 body\n") != std::string::npos);
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

TEST_CASE("FCL's result stands beside the audit's") {
  const fake::Folder folder("check_fcl");
  write_text(folder.path / "crossing.obj", crossing);
  write_text(folder.path / "apart.obj", apart);
  write_text(folder.path / "body.obj",
             "v 0 0.2 0\nv 0.1 0.2 0\nv 0 0.2 0.1\nv 0 0.3 0\nf 1 2 3\nf 1 4 2\nf 2 4 3\nf 1 3 4\n");
  CheckRequest request{folder.path / "crossing.obj", {}, {}};
  request.audit = "fcl";
  if (!obstacle_available()) {
    WARN("skipped: this build has no FCL");
    REQUIRE_THROWS_AS(check(request), Error);
    return;
  }
  const CheckReport dirty = check(request);
  REQUIRE(dirty.fcl);
  CHECK(dirty.fcl->pairs_by_frame == std::vector<int>{1});
  CHECK(dirty.fcl->disagreements.empty());
  CHECK(check_text(dirty).find("FCL") != std::string::npos);
  CHECK(nlohmann::json::parse(check_json(dirty))["fcl"]["intersecting_pairs_by_frame"][0] == 1);

  request.file = folder.path / "apart.obj";
  request.bodies = {folder.path / "body.obj"};
  const CheckReport touched = check(request);
  CHECK(touched.worst_pairs > 0);
  CHECK(touched.fcl->pairs_by_frame[0] == touched.worst_pairs);
  CHECK(touched.fcl->frames_against_body == 1);
  CHECK(touched.fcl->beyond_rounding == 0);
  request.bodies.clear();
  CHECK(check(request).fcl->frames_against_body == 0);
  CHECK(is_clean(check(request)));
  request.audit = "own";
  CHECK_FALSE(check(request).fcl);
}

TEST_CASE("a pair on which FCL and exact signs differ is named, with how near it is") {
  // A wrong audit stands in for the disagreement: the sheets cross by a lot, and lie a lot apart.
  if (!obstacle_available()) {
    WARN("skipped: this build has no FCL");
    return;
  }
  Triangles triangles(2, 3);
  triangles << 0, 1, 2, 3, 4, 5;
  Points x(6, 3);
  x << 0, 0, 0, 1, 0, 0, 0, 0, 1, 0.2, -1, 0.2, 0.2, 1, 0.2, 0.2, 0, 0.9;
  const Surface surface = make_surface(6, triangles);
  Opinion opinion;
  add_opinion(surface, x, {}, Audit{}, 3, opinion);
  REQUIRE(opinion.disagreements.size() == 1);
  const Disagreement& d = opinion.disagreements[0];
  CHECK((d.frame == 3 && d.first == 0 && d.second == 1 && !d.ours && d.beyond));
  CHECK(d.margin == Approx(0.2).margin(0.2));
  CHECK(opinion.beyond_rounding == 1);
  CheckReport report;
  report.fcl = opinion;
  CHECK_FALSE(is_clean(report));
  CHECK(opinion_text(opinion).find("triangle 0 and triangle 1") != std::string::npos);

  CHECK(separation({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}, {Vec3(0, 0, 2), Vec3(1, 0, 2), Vec3(0, 1, 3)}) ==
        Approx(2));
  CHECK(separation({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}, {Vec3(3, 0, 0), Vec3(4, 0, 0), Vec3(3, 1, 0)}) ==
        Approx(2));
}

TEST_CASE("FCL and exact signs may differ on cloth that touches a body within rounding, and nowhere else") {
  if (!obstacle_available()) {
    WARN("skipped: this build has no FCL");
    return;
  }
  Triangles triangle(1, 3);
  triangle << 0, 1, 2;
  const Surface surface = make_surface(3, triangle);
  Points cloth(3, 3), body(3, 3);
  cloth << 0, 0, 0, 1, 0, 0, 0, 0, 1;
  body << 0.2, -1, 0.2, 0.2, 1, 0.2, 0.2, 0, 0.9;
  const std::vector<std::pair<int, int>> meets{{0, 0}}, none;
  const AuditBody solid{&surface, &body};
  const auto agrees = [&](const auto& ours) { return agrees_on_bodies(surface, cloth, {&solid, 1}, ours); };
  CHECK(agrees(meets));
  CHECK_FALSE(agrees(none));
  body.col(1).array() += 1;  // an edge of the body ends on the cloth
  CHECK(agrees(meets));
  CHECK(agrees(none));
  body.col(1).array() += 1e-3;
  CHECK_FALSE(agrees(meets));
  CHECK(agrees(none));
}

}  // namespace selvedge::test_check
