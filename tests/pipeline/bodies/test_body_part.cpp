#include "pipeline/bodies/body_part.hpp"

#include <catch2/catch.hpp>

namespace selvedge::test_body_part {

using Catch::Matchers::Contains;

namespace {

// Three triangles apart, of the groups skin, joints and none.
Mesh three_triangles() {
  Mesh mesh;
  mesh.x = Points::Random(9, 3);
  mesh.triangles.resize(3, 3);
  mesh.triangles << 0, 1, 2, 3, 4, 5, 6, 7, 8;
  mesh.groups = {{"skin", {0, 1, 2}}, {"joints", {3, 4, 5}}};
  return mesh;
}

std::vector<int> vertices(const Mesh& mesh, const NameChoice& choice) {
  return body_part(mesh, "body.obj", choice).vertices;
}

}  // namespace

TEST_CASE("body part: groups that are chosen become the body", "[body_part]") {
  Mesh mesh = three_triangles();
  CHECK(vertices(mesh, {}).size() == 9);
  CHECK(vertices(mesh, {{"skin"}, {}}) == std::vector<int>{0, 1, 2});
  CHECK(vertices(mesh, {{}, {"joints"}}) == std::vector<int>{0, 1, 2, 6, 7, 8});
  CHECK(vertices(mesh, {{"skin", "joints"}, {"skin"}}) == std::vector<int>{3, 4, 5});
  CHECK_THROWS_WITH(vertices(mesh, {{"skni"}, {}}), Contains("`skni`") && Contains("skin") && Contains("body.obj"));
  CHECK_THROWS_WITH(vertices(mesh, {{"skin"}, {"skin"}}), Contains("no faces"));
  const BodyPart part = body_part(mesh, "body.obj", {{}, {"skin"}});
  CHECK(body_without_rig(mesh, part, "body.obj").meshes == NamedVertices{{"joints", {0, 1, 2}}});
  // A group that holds others does not hide them.
  mesh.groups.insert(mesh.groups.begin(), {"all", {0, 1, 2, 3, 4, 5}});
  CHECK(vertices(mesh, {{"joints"}, {}}) == std::vector<int>{3, 4, 5});
  mesh.groups.erase(mesh.groups.begin());
  mesh.groups[1].first = "body";
  CHECK(vertices(mesh, {}) == std::vector<int>{3, 4, 5});
  CHECK(vertices(mesh, {{"skin"}, {}}) == std::vector<int>{0, 1, 2});
}

}  // namespace selvedge::test_body_part
