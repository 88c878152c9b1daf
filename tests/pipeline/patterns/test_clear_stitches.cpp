#include "pipeline/patterns/clear_stitches.hpp"

#include <fmt/format.h>
#include <catch2/catch.hpp>

#include "pipeline/shapes/primitives.hpp"

namespace selvedge::test_clear_stitches {

namespace {

// A front and a back, 10 cm wide and that high [cm], half a metre apart, their upper edges at `top` and sewn; the lower
// ones too where that is asked.
PatternMesh panels(double top, double height, bool lower_too) {
  const std::string lower = R"(,[{"panel":"front","edge":0},{"panel":"back","edge":3}])";
  const std::string text = fmt::format(
      R"({{"pattern":{{"panels":{{
  "front":{{"translation":[-5,{0},25],"rotation":[0,0,0],"vertices":[[0,0],[10,0],[10,{1}],[0,{1}]],"edges":[
    {{"endpoints":[0,1]}},{{"endpoints":[1,2]}},{{"endpoints":[2,3]}},{{"endpoints":[3,0]}}]}},
  "back":{{"translation":[-5,{0},-25],"rotation":[0,0,0],"vertices":[[0,0],[0,{1}],[10,{1}],[10,0]],"edges":[
    {{"endpoints":[0,1]}},{{"endpoints":[1,2]}},{{"endpoints":[2,3]}},{{"endpoints":[3,0]}}]}}}},
  "stitches":[[{{"panel":"front","edge":2}},{{"panel":"back","edge":1}}]{2}]}},
  "properties":{{"units_in_meter":100}}}})",
      top - height, height, lower_too ? lower : "");
  return pattern_mesh(pattern_of(text, "panels"), 0.05);
}

double least_height(const PatternMesh& mesh, const Points& x) {
  double least = 1;
  for (const auto& [a, b] : mesh.sewn) least = std::min(least, (x(a, 1) + x(b, 1)) / 2);
  return least;
}

}  // namespace

TEST_CASE("Panels whose stitches graze a body move out of its way, together and no farther than needed") {
  const Shape ball = make_sphere(0.16, 0.03);
  const PatternMesh mesh = panels(15, 10, false);
  const Points x = clear_of(mesh, ball.x, ball.triangles);
  CHECK(least_height(mesh, x) > 0.165);
  const Points moved = x - mesh.placed;
  CHECK((moved.rowwise() - moved.row(0)).cwiseAbs().maxCoeff() < 1e-12);
  CHECK(moved.row(0).norm() < 0.025);
}

TEST_CASE("Panels stay where their stitches run past the body, or deep through it") {
  const Shape ball = make_sphere(0.16, 0.03);
  for (const double top : {17.5, 10.0}) {
    const PatternMesh mesh = panels(top, 10, false);
    CHECK(clear_of(mesh, ball.x, ball.triangles) == mesh.placed);
  }
}

TEST_CASE("Panels stay where other stitches would come into the body") {
  const Shape ball = make_sphere(0.16, 0.03);
  const PatternMesh mesh = panels(15, 31.5, true);
  CHECK(clear_of(mesh, ball.x, ball.triangles) == mesh.placed);
}

}  // namespace selvedge::test_clear_stitches
