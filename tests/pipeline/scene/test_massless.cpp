#include <catch2/catch.hpp>

#include <sstream>

#include "pipeline/scene/make_stepper.hpp"
#include "tests/frame.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::test_massless {
using Catch::Matchers::Contains;

namespace {

constexpr int side = 7;

// A sheet of squares of 5 cm, the triangles in `more` beside it.
std::string sheet(const std::string& more_vertices, const std::string& more_faces) {
  std::ostringstream text;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) text << "v " << 0.05 * j << " 0.5 " << 0.05 * i << "\n";
  text << more_vertices;
  for (int i = 0; i + 1 < side; ++i)
    for (int j = 0; j + 1 < side; ++j) {
      const int a = i * side + j + 1;
      text << "f " << a << " " << a + side << " " << a + 1 << "\nf " << a + 1 << " " << a + side << " " << a + side + 1
           << "\n";
    }
  return text.str() + more_faces;
}

bool warned(const Setup& setup, const std::string& words) {
  return std::ranges::any_of(setup.warnings,
                             [&](const std::string& line) { return line.find(words) != std::string::npos; });
}

Setup with_mesh(const fake::Folder& folder, const std::string& obj, const std::string& more = "") {
  fake::write(folder, "a.obj", obj);
  return read_setup(fake::write(folder, "scene.yaml", "cloths: [{mesh: a.obj, material: cotton" + more + "}]\n"));
}

Points after(const Setup& setup, int frames) {
  const std::unique_ptr<Stepper> stepper = make_stepper(setup);
  State state = setup.initial, next;
  for (int f = 0; f < frames; ++f) {
    const double dt = 1 / setup.run.fps;
    REQUIRE(testing::frame(setup.scene, *stepper, state, setup.drive_at(state.time + dt), dt, next).status ==
            StepStatus::accepted);
    std::swap(state, next);
  }
  return state.x;
}

}  // namespace

TEST_CASE("What has no mass holds nothing and follows what it was joined to", "[massless]") {
  const fake::Folder folder("massless");
  const Setup plain = with_mesh(folder, sheet("", ""));
  // Vertex 50 lies on the edge of vertices 8 and 9, of a triangle without area; 51 beside it, of a fan of two; 52 is in
  // no triangle.
  const Setup faulty = with_mesh(folder, sheet("v 0.02 0.5 0.05\nv 0.03 0.5 0.05\nv 1 1 1\n", "f 8 50 9\nf 50 51 9\n"));
  CHECK(warned(faulty, "2 triangles of zero rest area are left out, and 2 vertices without mass follow"));
  CHECK(warned(faulty, "1 vertex without mass is held in place, and holds nothing"));
  CHECK(faulty.scene.surface.triangles == plain.scene.surface.triangles);
  REQUIRE(faulty.followers.size() == 2);

  const Points with = after(faulty, 10), without = after(plain, 10);
  CHECK(without.col(1).maxCoeff() < 0.1);  // half a metre in a third of a second
  CHECK(with.topRows(side * side) == without);
  CHECK((with.row(49) - (0.6 * with.row(7) + 0.4 * with.row(8))).norm() < 1e-12);
  CHECK((with.row(50) - (0.4 * with.row(7) + 0.6 * with.row(8))).norm() < 1e-12);
  CHECK(with.row(51) == Eigen::RowVector3d(1, 1, 1));
}

TEST_CASE("A triangle without area along the rim meets nothing of the sheet that it lies on", "[massless]") {
  const fake::Folder folder("massless_rim");
  const Setup plain = with_mesh(folder, sheet("", "")), faulty = with_mesh(folder, sheet("", "f 1 2 3\n"));
  CHECK(warned(faulty, "1 triangle of zero rest area is left out"));
  CHECK_FALSE(warned(faulty, "without mass"));
  CHECK(faulty.scene.surface.triangles == plain.scene.surface.triangles);
  CHECK(after(faulty, 3) == after(plain, 3));
  // Inside the sheet, where two triangles have an edge in three parts, it closes the gap.
  const Setup filler = with_mesh(folder,
                                 "v 0 0.5 0\nv 0.1 0.5 0\nv 0.2 0.5 0\nv 0.1 0.5 0.1\nv 0.1 0.5 -0.1\n"
                                 "f 1 4 2\nf 2 4 3\nf 1 3 5\nf 1 2 3\n");
  CHECK(filler.scene.surface.triangles.rows() == 4);
}

TEST_CASE("A cloth of which no triangle has an area is an error", "[massless]") {
  const fake::Folder folder("massless_all");
  CHECK_THROWS_WITH(with_mesh(folder, "v 0 0 0\nv 0.1 0 0\nv 0.3 0 0\nf 1 2 3\n"),
                    Catch::Contains("has no triangle with an area in its rest shape"));
}

TEST_CASE("A pin holds a vertex without mass, and the cloth falls all the same", "[massless]") {
  const fake::Folder folder("massless_pin");
  const Setup setup = with_mesh(folder, sheet("v 0.02 0.5 0.05\n", "f 8 50 9\n"), ", pins: [{vertices: [49]}]");
  CHECK(setup.followers.empty());
  const Points x = after(setup, 10);
  CHECK(x.row(49) == Eigen::RowVector3d(0.02, 0.5, 0.05));
  CHECK(x.topRows(side * side).col(1).maxCoeff() < 0.1);
}

TEST_CASE("Polygons with points on straight edges have no vertices without mass", "[massless]") {
  const fake::Folder folder("massless_ngon");
  const Setup setup = with_mesh(folder,
                                "v 0 0.5 0\nv 0.1 0.5 0\nv 0.2 0.5 0\nv 0.2 0.5 0.1\nv 0.2 0.5 0.2\nv 0.1 0.5 0.2\n"
                                "v 0 0.5 0.2\nv 0 0.5 0.1\nf 1 8 7 6 5 4 3 2\n");
  CHECK(setup.scene.pins.empty());
  CHECK(setup.warnings.empty());
  CHECK(after(setup, 10).col(1).maxCoeff() < 0.1);
}

}  // namespace selvedge::test_massless
