#include <catch2/catch.hpp>

#include <nlohmann/json.hpp>

#include "collision/geometry/error.hpp"
#include "pipeline/formats/mesh_io.hpp"
#include "pipeline/tools/push_mesh.hpp"
#include "tests/collision/solids.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::test_push_mesh {

using testing::Solid;

namespace {

// A lumpy body that sticks out of a ball-shaped garment; the truth is a larger ball.
struct LumpyFiles {
  fake::Folder folder{"push_mesh"};
  PushRequest request;

  LumpyFiles() {
    const Solid body = testing::blob(12), garment = testing::ball(14);
    request.file = folder.path / "garment.obj";
    request.body = folder.path / "body.obj";
    request.truth = folder.path / "truth.obj";
    write_mesh(request.file, garment.x, garment.surface.triangles);
    write_mesh(request.body, body.x, body.surface.triangles);
    write_mesh(*request.truth, 1.4 * garment.x, garment.surface.triangles);
  }
};

}  // namespace

TEST_CASE("garment errors: each measure counts what it says", "[push]") {
  // A cube, and one triangle in three places.
  const Solid cube = testing::block({-1, -1, -1}, {1, 1, 1}, 1);
  DistanceField body(cube.surface);
  body.move_to(cube.x);
  Triangles one(1, 3);
  one << 0, 1, 2;
  const Surface garment = make_surface(3, one);
  Points beside(3, 3), tip_inside(3, 3), over_edge(3, 3);
  beside << 2, 0, 0, 3, 0, 0, 2, 1, 0;
  tip_inside << 0.75, 0.1, 0.2, 2, 0.1, 0.3, 2, 0.5, 0.3;  // its tip goes through the face x = 1
  // Over the cube's edge x = z = 1 with no vertex inside: one of its edges goes through the face x = 1, where the cut
  // ends on an edge of the cube.
  over_edge << 1.1, -3, 0.8, 1.1, 0.3, 0.8, -3, -3, 1.6;
  GarmentErrors clean = garment_errors(body, garment, beside, {&tip_inside, nullptr});
  CHECK(clean.collision_free);
  CHECK(clean.pairs == 0);
  CHECK(clean.vertices_inside == 0);
  CHECK(*clean.vertex_error == Approx(1e3 * (beside - tip_inside).rowwise().norm().mean()));
  CHECK_FALSE(clean.overshoot);

  const GarmentErrors tip = garment_errors(body, garment, tip_inside, {nullptr, nullptr});
  CHECK_FALSE(tip.collision_free);
  CHECK(tip.vertices_inside == Approx(100.0 / 3));
  CHECK(tip.energy == Approx(0.25 * 0.25));
  CHECK(tip.vertex_face == 1);
  CHECK(tip.judges_agree);
  CHECK_FALSE(tip.vertex_error);

  const GarmentErrors crossing = garment_errors(body, garment, over_edge, {nullptr, nullptr});
  CHECK_FALSE(crossing.collision_free);
  CHECK(crossing.vertices_inside == 0);
  CHECK(crossing.pairs > 0);
  CHECK(crossing.edge_edge == 1);

  Points moved = tip_inside;
  moved(0, 0) = 1.002;
  const GarmentErrors after = garment_errors(body, garment, moved, {&moved, &tip_inside});
  CHECK(*after.overshoot == Approx(2));
  CHECK(*after.laplacian_error == Approx(0).margin(1e-9));
  CHECK_THROWS_AS(garment_errors(body, garment, cube.x, {}), Error);
}

TEST_CASE("garment errors: means over models have an interval", "[push]") {
  const std::vector<double> values{1, 2, 3, 4};
  const MeanOverModels made = mean_over_models(values);
  CHECK(made.mean == Approx(2.5));
  CHECK(made.half_width == Approx(1.96 * std::sqrt(5.0 / 3 / 4)));
  CHECK(mean_over_models({}).models == 0);
}

TEST_CASE("push: every way takes vertices out, and what is written is what is measured", "[push]") {
  LumpyFiles files;
  files.request.out = files.folder.path / "out.obj";
  const PushReport layer = push_mesh(files.request);
  CHECK(layer.before.vertices_inside > 5);
  CHECK(layer.after.vertices_inside == 0);
  CHECK(layer.pushed > 20);
  CHECK(layer.body_closed);
  CHECK(read_mesh(*files.request.out).x.isApprox(read_mesh(files.request.file).x) == false);

  files.request.edge_pass = 3;
  files.request.margin = 1e-3;
  const PushReport passed = push_mesh(files.request);
  CHECK(passed.after.pairs < layer.after.pairs);
  files.request.method = "smooth";
  files.request.edge_pass = 0;
  const PushReport smooth = push_mesh(files.request);
  CHECK(smooth.after.vertices_inside < smooth.before.vertices_inside);
  files.request.method = "none";
  CHECK(push_mesh(files.request).after.pairs == layer.before.pairs);

  const auto json = nlohmann::json::parse(push_json(layer));
  CHECK(json["after"]["vfcp_percent"] == 0);
  CHECK(json["before"]["mpve_mm"].get<double>() == Approx(400).epsilon(0.01));
  CHECK(push_text(layer).find("CFMP") != std::string::npos);

  files.request.method = "pull";
  CHECK_THROWS_AS(push_mesh(files.request), Error);
  files.request.method = "layer";
  files.request.truth = files.request.body;
  CHECK_THROWS_AS(push_mesh(files.request), Error);
}

}  // namespace selvedge::test_push_mesh
