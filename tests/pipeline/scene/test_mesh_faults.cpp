#include "pipeline/formats/mesh_faults.hpp"

#include <catch2/catch.hpp>

#include "pipeline/scene/setup.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::test_mesh_faults {

using Catch::Matchers::Contains;
using fake::Folder;

namespace {

// Two quads in a row; the second has its corners in the order that is given, from 0.
std::string row_of_quads(const std::string& second) {
  return "v 0 0 0\nv 1 0 0\nv 1 0 -1\nv 0 0 -1\nv 2 0 0\nv 2 0 -1\nf 1 2 3 4\n" + second + "\n";
}

std::vector<std::string> warnings_of(const Folder& folder, const std::string& mesh, double lift = 0) {
  fake::write(folder, "row.obj", mesh);
  return read_setup(
             fake::write(folder, "scene.yaml",
                         "cloths: [{name: row, mesh: row.obj, translate: [0, " + std::to_string(lift) + ", 0]}]\n"))
      .warnings;
}

}  // namespace

TEST_CASE("folds: triangles that lie on their neighbours are told of where a scene reads them", "[mesh_faults]") {
  const Folder folder("folds");
  const auto folds = [](const std::vector<std::string>& all) {
    return std::ranges::count_if(all, [](const std::string& one) { return fake::has(one, "flat on each other"); });
  };
  CHECK(folds(warnings_of(folder, row_of_quads("f 2 5 6 3"))) == 0);
  const std::vector<std::string> all = warnings_of(folder, row_of_quads("f 2 6 5\nf 2 5 3"));
  REQUIRE(folds(all) == 1);
  CHECK_THAT(all.back(), Contains("cloth `row`: 1 pair of neighbouring triangles lies flat on each other") &&
                             Contains("give the corners of a face in their order"));
  // A face whose edges cross is read with its corners in order.
  for (const std::string second : {"f 2 6 5 3", "f 2 5 3 6"}) {
    INFO(second);
    const std::vector<std::string> told = warnings_of(folder, row_of_quads(second));
    CHECK(folds(told) == 0);
    REQUIRE(told.size() == 1);
    CHECK_THAT(told[0], Contains("the edges of 1 face cross; it is read with the corners in order"));
  }
}

TEST_CASE("folds: creases and triangles without area are none", "[mesh_faults]") {
  Points x(4, 3);
  Triangles fold(2, 3);
  fold << 0, 1, 2, 1, 0, 3;
  const auto at = [&](double degrees) {
    const double angle = degrees / 180 * 3.14159265358979;
    x << 0, 0, 0, 1, 0, 0, 0.5, 1, 0, 0.5, std::cos(angle), std::sin(angle);
    return mesh_faults(x, fold);
  };
  REQUIRE(at(0).size() == 1);
  CHECK_THAT(at(0)[0], Contains("at the edge of vertices 0 and 1"));
  CHECK(at(2).empty());
  CHECK(at(180).empty());
  fold.row(1) << 0, 1, 3;  // the other way round: the same fold
  CHECK(at(0).size() == 1);
  x.row(3) = x.row(1);
  CHECK(mesh_faults(x, fold).empty());
}

TEST_CASE("T-junctions: vertices on an edge of another triangle are counted where the cloth is open", "[mesh_faults]") {
  const Folder folder("junctions");
  // Beside the long edge of the first triangle two short ones, by their own vertices or by its.
  const std::string begin = "v 0 0 0\nv 0 0 1\nv -1 0 0.5\nf 1 2 3\nv 0 0 0.4\nv 1 0 0.4\n";
  for (const std::string rest : {"f 1 5 4\nf 4 5 2\n", "v 0 0 0\nv 0 0 1\nf 6 5 4\nf 4 5 7\n"}) {
    const std::vector<std::string> all = warnings_of(folder, begin + rest);
    REQUIRE_FALSE(all.empty());
    CHECK_THAT(all.back(), Contains("cloth `row`: 1 vertex lies on an edge of another triangle") &&
                               Contains("the first is 3") && Contains("split such edges"));
  }
  CHECK(warnings_of(folder, "v 0 0 0\nv 0 0 1\nv -1 0 0.5\nf 1 2 3\nv 1 0 0.4\nf 1 4 2\n").empty());
}

}  // namespace selvedge::test_mesh_faults
