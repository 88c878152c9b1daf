#include <catch2/catch.hpp>

#include <fmt/format.h>

#include "pipeline/bodies/skin_places.hpp"
#include "pipeline/scene/setup.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::test_welded_obstacles {

namespace {

// A box of four-sided faces that share no vertex in the file; `gap` is how far its lid is off [m].
std::string loose_box(double gap) {
  std::string vertices, faces;
  int count = 0;
  for (int axis = 0; axis < 3; ++axis)
    for (const int side : {0, 1}) {
      for (const auto& [u, v] : {std::pair(0, 0), std::pair(1, 0), std::pair(1, 1), std::pair(0, 1)}) {
        Vec3 p;
        p[axis] = side;
        p[(axis + 1) % 3] = side ? u : v;
        p[(axis + 2) % 3] = side ? v : u;
        p *= 0.1;
        if (axis == 1 && side) p.y() += gap;
        vertices += fmt::format("v {} {} {}\n", p.x(), p.y(), p.z());
      }
      faces += fmt::format("f {} {} {} {}\n", count + 1, count + 2, count + 3, count + 4);
      count += 4;
    }
  return vertices + faces;
}

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
  fake::write(folder, "box.obj", loose_box(0));
  fake::write(folder, "open.obj", loose_box(0.01));
  const Obstacle box = read_obstacle(folder, "mesh: box.obj");
  CHECK(is_closed(box.surface));
  CHECK(box.surface.vertex_count == 24);
  CHECK(box.surface.triangles.rows() == 12);
  CHECK_FALSE(is_closed(read_obstacle(folder, "mesh: open.obj").surface));
  // A seam that an export has rounded is one all the same.
  fake::write(folder, "rounded.obj", loose_box(1e-4));
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

}  // namespace selvedge::test_welded_obstacles
