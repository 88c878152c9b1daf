#include <catch2/catch.hpp>

#include "pipeline/bodies/body_outward.hpp"
#include "pipeline/bodies/skin_places.hpp"
#include "pipeline/formats/mesh_io.hpp"
#include "pipeline/scene/setup.hpp"
#include "tests/pipeline/files.hpp"
#include "tests/pipeline/loose_box.hpp"

namespace selvedge::test_welded_obstacles {

namespace {

Obstacle read_obstacle(const fake::Folder& folder, const std::string& obstacle) {
  const Setup setup = read_setup(fake::write(folder, "scene.yaml",
                                             "cloths: [{rectangle: {size: [0.2, 0.2], resolution: 3}}]\n"
                                             "obstacles: [{" +
                                                 obstacle + "}]\nrun: {frames: 1}\n"));
  return setup.scene.obstacles[0];
}

}  // namespace

TEST_CASE("obstacles: seams of a mesh are closed, and its vertices stay in their order", "[welded_obstacles]") {
  const fake::Folder folder("welded_obstacles");
  fake::write(folder, "box.obj", fake::loose_box(0));
  fake::write(folder, "open.obj", fake::loose_box(0.01));
  const Obstacle box = read_obstacle(folder, "mesh: box.obj");
  CHECK(is_closed(box.surface));
  CHECK(box.surface.vertex_count == 24);
  CHECK(box.surface.triangles.rows() == 12);
  CHECK_FALSE(is_closed(read_obstacle(folder, "mesh: open.obj").surface));
  // A seam that an export has rounded is one all the same.
  fake::write(folder, "rounded.obj", fake::loose_box(1e-4));
  CHECK(is_closed(read_obstacle(folder, "mesh: rounded.obj").surface));
  CHECK(is_closed(read_obstacle(folder, "sequence: {files: [box.obj, rounded.obj], fps: 30}").surface));
  // What opens in any frame is open in all.
  CHECK(is_closed(read_obstacle(folder, "sequence: {files: [box.obj, box.obj], fps: 30}").surface));
  CHECK_FALSE(is_closed(read_obstacle(folder, "sequence: {files: [box.obj, open.obj], fps: 30}").surface));
}

TEST_CASE("bodies: vertices at one place that move alike are one", "[welded_obstacles]") {
  SkinnedSurface skin;
  skin.rest = Points::Zero(4, 3);
  skin.rest(3, 0) = 1;
  skin.weights.resize(4, 2);
  for (int v = 0; v < 4; ++v) {
    skin.weights.insert(v, 0) = v == 2 ? 0.4 : 0.5;
    skin.weights.insert(v, 1) = v == 2 ? 0.6 : 0.5;
  }
  CHECK(same_places(skin) == std::vector<int>{0, 0, 2, 3});
  skin.shape_directions = Eigen::MatrixXd::Zero(12, 1);
  CHECK(same_places(skin) == std::vector<int>{0, 0, 2, 3});
  skin.shape_directions(4, 0) = 0.01;  // of vertex 1
  CHECK(same_places(skin) == std::vector<int>{0, 1, 2, 3});
}

TEST_CASE("bodies: borders that are near each other are closed as those of files", "[welded_obstacles]") {
  struct Case {
    const char* what;
    double gap;             // of the lid [m]; edges are 0.1 long
    double lid_weight = 1;  // of the first joint
    double lid_moves = 0;   // by the shape [m]
    bool closed = true;
  };
  const fake::Folder folder("welded_bodies");
  for (const Case& one : {Case{"exact", 0}, Case{"rounded", 1e-4}, Case{"rounded, other weights", 1e-4, 0.5},
                          Case{"exact, other weights", 0, 0}, Case{"exact, moved alike", 0, 1, 1e-9},
                          Case{"open", 0.01, 1, 0, false}, Case{"opened by the shape", 0, 1, 0.01, false}}) {
    INFO(one.what);
    const Mesh mesh = read_mesh(fake::write(folder, "box.obj", fake::loose_box(one.gap)));
    BodyModel body;
    body.skin.rest = mesh.x;
    body.skin.triangles = mesh.triangles;
    const auto n = static_cast<int>(mesh.x.rows());
    body.skin.shape_directions = Eigen::MatrixXd::Zero(3 * n, 1);
    body.skin.weights.resize(n, 2);
    for (int v = 0; v < n; ++v) {
      const bool lid = v >= 12 && v < 16;
      body.skin.weights.insert(v, 0) = lid ? one.lid_weight : 1;
      body.skin.weights.insert(v, 1) = lid ? 1 - one.lid_weight : 0;
      if (lid) body.skin.shape_directions(3 * v + 1, 0) = one.lid_moves;
    }
    CHECK(is_closed(closed_surface(body).surface) == one.closed);
    std::vector<std::string> warnings;
    turn_outward("box", body, warnings);
    CHECK(warnings.empty() == one.closed);
  }
}

}  // namespace selvedge::test_welded_obstacles
