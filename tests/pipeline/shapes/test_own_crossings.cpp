#include "pipeline/shapes/own_crossings.hpp"

#include <catch2/catch.hpp>

#include <numeric>

#include "collision/geometry/same_places.hpp"

namespace selvedge::test_own_crossings {

namespace {

// Blocks of 24 vertices each, every face with its own four: seams along all edges.
struct Blocks {
  Points x{0, 3};
  Triangles triangles{0, 3};
  NamedVertices meshes;

  void add(const std::string& name, const Vec3& centre, double half) {
    const auto first = static_cast<int>(x.rows());
    x.conservativeResize(first + 24, 3);
    const auto begin = triangles.rows();
    triangles.conservativeResize(begin + 12, 3);
    for (int face = 0; face < 6; ++face) {
      const int axis = face / 2, v = first + 4 * face;
      const double side = face % 2 ? 1 : -1;
      for (int k = 0; k < 4; ++k) {
        Vec3 p;
        p[axis] = side;
        p[(axis + 1) % 3] = k % 2 ? 1 : -1;
        p[(axis + 2) % 3] = side * (k / 2 ? 1 : -1);
        x.row(v + k) = (centre + half * p).transpose();
      }
      triangles.row(begin + 2 * face) << v, v + 1, v + 2;
      triangles.row(begin + 2 * face + 1) << v + 1, v + 3, v + 2;
    }
    std::vector<int> all(24);
    std::iota(all.begin(), all.end(), first);
    meshes.emplace_back(name, all);
  }
  OwnCrossings crossings() const { return own_crossings(meshes, x, triangles, same_places(x)); }
};

}  // namespace

TEST_CASE("own crossings: pairs of a surface with itself are counted by mesh", "[own_crossings]") {
  Blocks blocks;
  blocks.add("left", {-0.05, 0, 0}, 0.06);
  blocks.add("right", {0.05, 0.011, 0.013}, 0.06);
  blocks.add("far", {1, 0, 0}, 0.06);
  const OwnCrossings found = blocks.crossings();
  REQUIRE(found.between.size() == 1);
  CHECK(found.between[0].a == "left");
  CHECK(found.between[0].b == "right");
  CHECK(found.pairs() > 4);
  std::vector<std::string> warnings;
  warn_of_crossings("two.glb", found, warnings);
  REQUIRE(warnings.size() == 1);
  CHECK_THAT(warnings[0], Catch::Contains("two.glb: crosses itself in " + std::to_string(found.pairs()) + " pairs") &&
                              Catch::Contains("`left` with `right`"));
  blocks.meshes.clear();
  CHECK(blocks.crossings().pairs() == found.pairs());
  CHECK_THAT(crossings_text(blocks.crossings()), !Catch::Contains("("));
}

TEST_CASE("own crossings: seams, and triangles that come again, are none", "[own_crossings]") {
  Blocks block;
  block.add("block", Vec3::Zero(), 0.06);
  CHECK(block.crossings().pairs() == 0);
  block.add("again", Vec3::Zero(), 0.06);
  CHECK(block.crossings().pairs() == 0);
  std::vector<std::string> warnings;
  warn_of_crossings("block.obj", block.crossings(), warnings);
  CHECK(warnings.empty());
}

}  // namespace selvedge::test_own_crossings
