#include "pipeline/patterns/stand_round.hpp"

#include <catch2/catch.hpp>

#include "collision/geometry/error.hpp"
#include "pipeline/shapes/primitives.hpp"

namespace selvedge::test_stand_round {

using Catch::Matchers::Contains;

namespace {

// A front and a back of 40 cm by 30 cm, half a metre apart, from 1 m up.
PatternMesh panels() {
  return pattern_mesh(pattern_of(R"({"pattern":{"panels":{
  "front":{"translation":[-20,100,25],"rotation":[0,0,0],"vertices":[[0,0],[40,0],[40,30],[0,30]],"edges":[
    {"endpoints":[0,1]},{"endpoints":[1,2]},{"endpoints":[2,3]},{"endpoints":[3,0]}]},
  "back":{"translation":[-20,100,-25],"rotation":[0,0,0],"vertices":[[0,0],[0,30],[40,30],[40,0]],"edges":[
    {"endpoints":[0,1]},{"endpoints":[1,2]},{"endpoints":[2,3]},{"endpoints":[3,0]}]}},
  "stitches":[[{"panel":"front","edge":1},{"panel":"back","edge":2}]]},
  "properties":{"units_in_meter":100}})",
                                 "panels"),
                      0.1);
}

// A figure of 1.7 m whose soles are at that height.
Points figure(double soles, double x = 0, double z = 0, double scale = 1) {
  const Points capsule = make_capsule(0.15, 1.4, 0.05).x;
  return (scale * (capsule.rowwise() + Eigen::RowVector3d(0, 0.85, 0))).rowwise() + Eigen::RowVector3d(x, soles, z);
}

}  // namespace

TEST_CASE("Panels that do not stand round the body are refused with where both are", "[stand_round]") {
  const PatternMesh mesh = panels();
  CHECK_NOTHROW(check_stands_round(mesh, figure(0), "p.json"));
  CHECK_NOTHROW(check_stands_round(mesh, figure(0.1, 0.1), "p.json"));
  const auto refused = [&](const Points& body, const std::string& words) {
    CHECK_THROWS_WITH(check_stands_round(mesh, body, "p.json"), Contains("p.json") &&
                                                                    Contains("do not stand round the body") &&
                                                                    Contains(words) && Contains("units_in_meter"));
  };
  refused(figure(-0.94), "their heights are 1.00 m to 1.30 m, the body's -0.94 m to 0.76 m");
  refused(figure(0, 0, 0, 0.3), "the body's 0.00 m to 0.51 m");
  refused(figure(0, 0, 0, 100), "the body at x from");
  refused(figure(0, 1), "x from -0.20 m to 0.20 m");
  refused(figure(0, 0, 0.6), "the body at x from -0.15 m to 0.15 m");
  Points lying = figure(0);
  lying.col(1).swap(lying.col(2));
  refused(lying, "the body's -0.15 m to 0.15 m");
}

TEST_CASE("A body that reaches below the floor is how far below it", "[stand_round]") {
  CHECK(below_floor(figure(-0.94)) == Approx(0.94));
  CHECK(below_floor(figure(0)) == 0);
  CHECK(below_floor(figure(-0.005)) == 0);
  CHECK(below_floor(figure(0.7)) == 0);  // a bust on a stand
}

TEST_CASE("A pattern without a unit is refused for that", "[pattern]") {
  for (const char* end : {R"("properties":{}})", R"("parameters":{}})", R"("properties":{"units_in_meter":null}})"})
    CHECK_THROWS_WITH(pattern_of(R"({"pattern":{"panels":{
  "front":{"translation":[0,0,0],"rotation":[0,0,0],"vertices":[[0,0],[40,0],[40,30]],"edges":[
    {"endpoints":[0,1]},{"endpoints":[1,2]},{"endpoints":[2,0]}]}}},)" +
                                     std::string(end),
                                 "p.json"),
                      Contains("p.json") && Contains("no `units_in_meter`") && Contains("100"));
}

}  // namespace selvedge::test_stand_round
