#include "pipeline/patterns/pattern.hpp"

#include <catch2/catch.hpp>

#include "collision/geometry/error.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::test_pattern {

using Catch::Matchers::Contains;

namespace {

// A square of 40 cm and a strip that is sewn to it, as GarmentCode writes them.
std::string file_with(const std::string& square_edges, const std::string& corners = "[[0,0],[40,0],[40,40],[0,40]]",
                      const std::string& stitches = R"([[{"panel":"square","edge":1},{"panel":"strip","edge":3}]])") {
  return R"({"pattern":{"panels":{
    "square":{"translation":[0,100,25],"rotation":[0,90,0],"label":"body","vertices":)" +
         corners + R"(,"edges":)" + square_edges + R"(},
    "strip":{"translation":[0,0,0],"rotation":[0,0,0],"vertices":[[0,0],[10,0],[10,40],[0,40]],
             "edges":[{"endpoints":[0,1],"label":"hem"},{"endpoints":[1,2]},{"endpoints":[2,3]},{"endpoints":[3,0]}]}},
    "stitches":)" +
         stitches + R"(},"properties":{"curvature_coords":"relative","units_in_meter":100}})";
}

const std::string straight = R"([{"endpoints":[0,1]},{"endpoints":[1,2]},{"endpoints":[2,3]},{"endpoints":[3,0]}])";

// The square's first edge with that curvature.
Pattern curved(const std::string& curvature) {
  return pattern_of(file_with(R"([{"endpoints":[0,1],"curvature":)" + curvature +
                              R"(},{"endpoints":[1,2]},{"endpoints":[2,3]},{"endpoints":[3,0]}])"),
                    "file");
}

std::string complaint(const std::string& text) {
  try {
    pattern_of(text, "file.json");
  } catch (const Error& error) {
    return error.what();
  }
  return "none";
}

}  // namespace

TEST_CASE("A pattern is read in metres, placed as Maya turns it") {
  const Pattern pattern = pattern_of(file_with(straight), "file");
  REQUIRE(pattern.panels.size() == 2);
  const Panel& square = pattern.panels[0];
  CHECK(square.name == "square");
  CHECK(square.label == "body");
  CHECK((square.corners[2] - Vec2(0.4, 0.4)).norm() < 1e-15);
  // A quarter turn about y takes x to -z.
  const Vec3 corner = square.rotation * Vec3(0.4, 0.4, 0) + square.translation;
  CHECK((corner - Vec3(0, 1.4, 0.25 - 0.4)).norm() < 1e-12);
  CHECK(pattern.panels[1].edges[0].label == "hem");
  REQUIRE(pattern.seams.size() == 1);
  CHECK(pattern.seams[0].sides[1].panel == 1);
  CHECK(pattern.seams[0].sides[1].edge == 3);
  CHECK_FALSE(pattern.seams[0].right_to_wrong);
}

TEST_CASE("Turns follow each other as Rz Ry Rx") {
  std::string text = file_with(straight);
  text.replace(text.find("[0,90,0]"), 8, "[90,90,0]");
  const Panel panel = pattern_of(text, "file").panels[0];
  CHECK((panel.rotation * Vec3(0, 1, 0) - Vec3(1, 0, 0)).norm() < 1e-12);  // Rx: y to z, Ry: z to x
}

TEST_CASE("Curves of edges are those of their definitions") {
  SECTION("quadratic, in both forms") {
    const Pattern now = curved(R"({"type":"quadratic","params":[[0.5,0.25]]})"), old = curved("[0.5,0.25]");
    // The control point lies a quarter of 40 cm left of the edge, the curve's middle half as far.
    const std::vector<Vec2> points = edge_points(now.panels[0], 0, 2);
    CHECK((points[1] - Vec2(0.2, 0.05)).norm() < 1e-9);
    CHECK(edge_length(now.panels[0], 0) == edge_length(old.panels[0], 0));
    // Arc length of y = 4 h x (1 - x) on a chord of 0.4 with h = 0.05.
    const double a = 4 * 0.05 / 0.4, s = std::sqrt(1 + a * a);
    CHECK(edge_length(now.panels[0], 0) == Approx(0.4 * (s / 2 + std::asinh(a) / (2 * a))).epsilon(1e-5));
  }
  SECTION("cubic") {
    const Pattern pattern = curved(R"({"type":"cubic","params":[[0.25,-0.2],[0.75,-0.2]]})");
    CHECK((edge_points(pattern.panels[0], 0, 2)[1] - Vec2(0.2, -0.06)).norm() < 1e-9);
  }
  SECTION("circle: a half circle bulges right where it turns left") {
    const Pattern left = curved(R"({"type":"circle","params":[20,0,1]})"),
                  right = curved(R"({"type":"circle","params":[25,0,0]})");
    CHECK((edge_points(left.panels[0], 0, 2)[1] - Vec2(0.2, -0.2)).norm() < 1e-6);
    CHECK(edge_length(left.panels[0], 0) == Approx(3.14159265358979 * 0.2).epsilon(1e-4));
    CHECK((edge_points(right.panels[0], 0, 2)[1] - Vec2(0.2, 0.1)).norm() < 1e-6);
  }
  SECTION("the longer arc of a circle") {
    const Pattern pattern = curved(R"({"type":"circle","params":[25,1,1]})");
    CHECK((edge_points(pattern.panels[0], 0, 2)[1] - Vec2(0.2, -0.4)).norm() < 1e-6);
  }
}

TEST_CASE("Places on an edge are equally far apart") {
  const Pattern pattern = curved(R"({"type":"cubic","params":[[0.1,-0.5],[0.3,-0.1]]})");
  const std::vector<Vec2> points = edge_points(pattern.panels[0], 0, 40);
  REQUIRE(points.size() == 41);
  for (std::size_t i = 1; i < points.size(); ++i)
    CHECK((points[i] - points[i - 1]).norm() == Approx(edge_length(pattern.panels[0], 0) / 40).epsilon(0.02));
}

TEST_CASE("Broken patterns get one error that names panel and edge") {
  const std::string square = "panel `square`, edge ";
  CHECK(complaint(file_with(straight)) == "none");
  const auto edges = [](const char* last) {
    return R"([{"endpoints":[0,1]},{"endpoints":[1,2]},{"endpoints":[2,3]},{"endpoints":)" + std::string(last) + "}]";
  };
  CHECK_THAT(complaint(file_with(edges("[3,2]"))), Contains(square + "3") && Contains("back to edge 2"));
  CHECK_THAT(complaint(file_with(R"([{"endpoints":[0,1]},{"endpoints":[1,2]},{"endpoints":[2,3]}])")),
             Contains(square + "2") && Contains("open"));
  CHECK_THAT(complaint(file_with(edges("[3,7]"))), Contains(square + "3") && Contains("vertex 7"));
  CHECK_THAT(complaint(file_with(straight, "[[0,0],[40,0],[40,0],[0,40]]")),
             Contains(square + "1") && Contains("no length"));
  CHECK_THAT(complaint(file_with(straight, "[[0,0],[40,40],[40,0],[0,40]]")),
             Contains(square + "0") && Contains("crosses edge 2"));
  CHECK_THAT(complaint(file_with(straight, "[[0,0],[40,0],[40,NaN],[0,40]]")),
             Contains(square + "1") && Contains("not finite"));
  CHECK_THAT(complaint(file_with(straight, "[[0,0],[40,0],[40,null],[0,40]]")), Contains(square + "1"));
  const auto stitched = [&](const char* side) {
    return complaint(file_with(straight, "[[0,0],[40,0],[40,40],[0,40]]",
                               R"([[{"panel":"square","edge":1},)" + std::string(side) + "]]"));
  };
  CHECK_THAT(stitched(R"({"panel":"stripe","edge":3})"),
             Contains("stitch 0") && Contains("edge 3 of the missing panel `stripe`") && Contains("strip"));
  CHECK_THAT(stitched(R"({"panel":"strip","edge":9})"), Contains("panel `strip`, edge 9 does not exist"));
  CHECK_THAT(stitched(R"({"panel":"square","edge":1})"), Contains(square + "1") && Contains("sew an edge once"));
  CHECK_THAT(complaint("{"), Catch::Matchers::StartsWith("file.json:1: is no JSON"));
  CHECK_THAT(complaint(R"({"pattern":{"panels":{}},"properties":{"units_in_meter":100}})"), Contains("no panels"));
  CHECK_THROWS_WITH(curved(R"({"type":"circle","params":[10,0,1]})"), Contains(square + "0") && Contains("radius"));
  CHECK_THROWS_WITH(curved(R"({"type":"cubik","params":[]})"), Contains(square + "0") && Contains("cubic"));
  CHECK_THROWS_WITH(curved(R"({"type":"quadratic","params":[[0.5,-1.5],[0,0]]})"), Contains(square + "0"));
  CHECK_THROWS_WITH(curved(R"({"type":"quadratic","params":[[0.5,3]]})"),
                    Contains(square + "0") && Contains("crosses"));
}

TEST_CASE("GarmentCode's patterns are read") {
  const std::filesystem::path folder = fake::open_data() / "garmentcode";
  if (!std::filesystem::exists(folder)) {
    WARN("no open data: GarmentCode's patterns are not read");
    return;
  }
  const auto counts = [&](const char* name) {
    const Pattern pattern = read_pattern(folder / (std::string(name) + "_specification.json"));
    CHECK(pattern.name == name);
    return std::pair(pattern.panels.size(), pattern.seams.size());
  };
  CHECK(counts("shirt_mean") == std::pair<std::size_t, std::size_t>(8, 18));
  CHECK(counts("hoody_mean") == std::pair<std::size_t, std::size_t>(6, 12));
  CHECK(counts("js_mean_all") == std::pair<std::size_t, std::size_t>(12, 57));
}

TEST_CASE("A pattern with numbers that are too large to be lengths is refused") {
  const auto far_corner = [](const std::string& x) {
    return complaint(file_with(straight, "[[0,0],[" + x + ",0],[40,40],[0,40]]"));
  };
  CHECK(far_corner("40") == "none");
  for (const char* x : {"1e9", "1e200", "-1e308"}) CHECK_THAT(far_corner(x), Contains("reaches farther than 1000 m"));
  CHECK_THAT(complaint(file_with(R"([{"endpoints":[0,1],"curvature":{"type":"circle","params":[1e200,0,1]}},
                                    {"endpoints":[1,2]},{"endpoints":[2,3]},{"endpoints":[3,0]}])")),
             Contains("reaches farther than 1000 m"));
  std::string text = file_with(straight);
  text.replace(text.find("[0,100,25]"), 10, "[0,1e300,0]");
  CHECK_THAT(complaint(text), Contains("is more than 1000 m from the body"));
}

}  // namespace selvedge::test_pattern
