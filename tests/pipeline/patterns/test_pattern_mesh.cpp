#include "pipeline/patterns/pattern_mesh.hpp"

#include <catch2/catch.hpp>
#include <random>
#include <set>

#include "collision/geometry/disjoint_sets.hpp"
#include "collision/geometry/error.hpp"
#include "pipeline/patterns/flip_mesh.hpp"
#include "pipeline/patterns/planar_mesh.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::test_pattern_mesh {

using Catch::Matchers::Contains;

namespace {

double outline_area(const std::vector<Vec2>& outline) {
  double twice = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vec2 &a = outline[i], &b = outline[(i + 1) % outline.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return twice / 2;
}

// Sound triangles that fill the outline, whose edges are all there, and no other edge between two of its points.
void check_mesh(const std::vector<Vec2>& outline, const PlanarMesh& mesh) {
  const int n = static_cast<int>(outline.size());
  double sum = 0;
  std::set<std::array<int, 2>> edges;
  for (Eigen::Index t = 0; t < mesh.triangles.rows(); ++t) {
    RestTriangle corners;
    for (int k = 0; k < 3; ++k) {
      corners.col(k) = mesh.points[static_cast<std::size_t>(mesh.triangles(t, k))];
      edges.insert({mesh.triangles(t, k), mesh.triangles(t, (k + 1) % 3)});
    }
    CHECK(area(corners) > 0);
    sum += area(corners);
  }
  CHECK(sum == Approx(outline_area(outline)).epsilon(1e-9));
  for (int i = 0; i < n; ++i) {
    CHECK(mesh.points[static_cast<std::size_t>(i)] == outline[static_cast<std::size_t>(i)]);
    CHECK(edges.contains({i, (i + 1) % n}));
  }
  for (const std::array<int, 2>& edge : edges)
    if (edge[0] < n && edge[1] < n) CHECK((edge[0] + 1) % n == edge[1]);
}

double least_angle(const PlanarMesh& mesh) {
  double least = 4;
  for (const auto& t : mesh.triangles.rowwise())
    least = std::min(
        least, smallest_angle(mesh.points[static_cast<std::size_t>(t(0))], mesh.points[static_cast<std::size_t>(t(1))],
                              mesh.points[static_cast<std::size_t>(t(2))]));
  return least;
}

std::vector<Vec2> cut(const std::vector<Vec2>& corners, double edge) {
  std::vector<Vec2> outline;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec2 &a = corners[i], &b = corners[(i + 1) % corners.size()];
    const int pieces = std::max(1, static_cast<int>(std::lround((b - a).norm() / edge)));
    for (int k = 0; k < pieces; ++k) outline.push_back(a + (b - a) * k / pieces);
  }
  return outline;
}

// Rectangles of 40 cm by 10 cm, seen from the front and from behind, with both sides sewn.
const std::string tube = R"({"pattern":{"panels":{
  "front":{"translation":[0,0,20],"rotation":[0,0,0],"vertices":[[0,0],[40,0],[40,10],[0,10]],"edges":[
    {"endpoints":[0,1],"label":"hem"},{"endpoints":[1,2]},{"endpoints":[2,3]},{"endpoints":[3,0]}]},
  "back":{"translation":[0,0,-20],"rotation":[0,0,0],"label":"rear","vertices":[[0,0],[0,10],[40,10],[40,0]],"edges":[
    {"endpoints":[0,1]},{"endpoints":[1,2]},{"endpoints":[2,3]},{"endpoints":[3,0],"label":"hem"}]}},
  "stitches":[[{"panel":"front","edge":1},{"panel":"back","edge":2}],
              [{"panel":"front","edge":3},{"panel":"back","edge":0}]]},
  "properties":{"units_in_meter":100}})";

Surface sewn_surface(const PatternMesh& mesh) {
  DisjointSets sets(static_cast<int>(mesh.placed.rows()));
  for (const auto& [a, b] : mesh.sewn) sets.join(a, b);
  const std::vector<int> numbers = sets.numbers();
  Triangles triangles = mesh.triangles;
  for (int& v : triangles.reshaped()) v = numbers[static_cast<std::size_t>(v)];
  return make_surface(sets.count(), triangles);
}

}  // namespace

TEST_CASE("A square is meshed with well-shaped triangles") {
  const std::vector<Vec2> outline = cut({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 0.05);
  const PlanarMesh mesh = planar_mesh(outline, 0.05);
  check_mesh(outline, mesh);
  CHECK(least_angle(mesh) > 0.44);  // 25 degrees
  // As many as equilateral triangles of that edge, within a tenth.
  CHECK(mesh.triangles.rows() == Approx(1 / (0.05 * 0.05 * std::sqrt(3.0) / 4)).epsilon(0.1));
}

TEST_CASE("Strips narrower than an edge, darts and notches are meshed") {
  for (const std::vector<Vec2>& corners :
       std::vector<std::vector<Vec2>>{{{0, 0}, {1, 0}, {1, 0.03}, {0, 0.03}},
                                      {{0, 0}, {0.4, 0}, {0.45, 0.4}, {0.5, 0}, {1, 0}, {1, 0.6}, {0, 0.6}},
                                      {{0, 0}, {1, 0}, {0.5, 0.02}},
                                      {{0, 0}, {1, 0}, {1, 1}, {0.9, 1}, {0.9, 0.1}, {0.1, 0.1}, {0.1, 1}, {0, 1}}}) {
    const std::vector<Vec2> outline = cut(corners, 0.05);
    check_mesh(outline, planar_mesh(outline, 0.05));
  }
}

TEST_CASE("Random star-shaped outlines are meshed") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> radius(0.2, 1);
  for (int trial = 0; trial < 40; ++trial) {
    std::vector<Vec2> corners;
    for (int k = 0; k < 12; ++k) {
      const double angle = 2 * 3.14159265358979 * k / 12;
      corners.push_back(radius(random) * Vec2(std::cos(angle), std::sin(angle)));
    }
    const std::vector<Vec2> outline = cut(corners, 0.12);
    check_mesh(outline, planar_mesh(outline, 0.12));
  }
}

TEST_CASE("Outlines that cross themselves or run clockwise are refused") {
  CHECK_THROWS_AS(planar_mesh({{0, 0}, {1, 1}, {1, 0}, {0, 1}}, 0.1), Error);
  CHECK_THROWS_AS(planar_mesh({{0, 0}, {0, 1}, {1, 1}, {1, 0}}, 0.1), Error);
  CHECK_THROWS_AS(planar_mesh({{0, 0}, {1, 0}}, 0.1), Error);
}

TEST_CASE("A front and a back become a tube with its right side out") {
  const PatternMesh mesh = pattern_mesh(pattern_of(tube, "tube"), 0.02);
  CHECK(mesh.sewn.size() == 12);  // 5 edges and 6 vertices on each side
  for (const auto& [a, b] : mesh.sewn) {
    CHECK(mesh.panel[static_cast<std::size_t>(a)] != mesh.panel[static_cast<std::size_t>(b)]);
    CHECK((row(mesh.placed, a) - row(mesh.placed, b)).norm() == Approx(0.4));
  }
  double sum = 0;
  for (const RestTriangle& triangle : mesh.rest) sum += area(triangle);
  CHECK(sum == Approx(0.08));
  for (const auto& t : mesh.triangles.rowwise()) {
    const Vec3 a = row(mesh.placed, t(0)), normal = (row(mesh.placed, t(1)) - a).cross(row(mesh.placed, t(2)) - a);
    CHECK(normal.z() * a.z() > 0);
  }
  const Surface surface = sewn_surface(mesh);
  CHECK(surface.component_count == 1);
  CHECK(surface.nonmanifold_edges == 0);
  CHECK(boundary_loops(surface).size() == 2);
  std::vector<std::string> names;
  for (const auto& [name, vertices] : mesh.groups) names.push_back(name);
  CHECK(names == std::vector<std::string>{"back", "front", "hem", "rear"});
}

TEST_CASE("Both edges of a seam get the vertices of the longer one") {
  std::string text = tube;
  text.replace(text.find("[40,10],[0,10]]"), 15, "[40,14],[0,10]]");
  const PatternMesh mesh = pattern_mesh(pattern_of(text, "tube"), 0.02);
  CHECK(mesh.sewn.size() == 8 + 6);
}

TEST_CASE("GarmentCode's patterns are cut and joined into one manifold piece") {
  const std::filesystem::path folder = fake::open_data() / "garmentcode";
  if (!std::filesystem::exists(folder)) {
    WARN("no open data: GarmentCode's patterns are not cut");
    return;
  }
  // Loops: hem, neck or face, and cuffs; of the overall two legs, neck and cuffs.
  const std::vector<std::pair<const char*, std::size_t>> patterns{
      {"shirt_mean", 4}, {"hoody_mean", 4}, {"js_mean_all", 5}};
  for (const auto& [name, loops] : patterns) {
    const PatternMesh mesh = pattern_mesh(read_pattern(folder / (std::string(name) + "_specification.json")), 0.03);
    const Surface surface = sewn_surface(mesh);
    CHECK(surface.component_count == 1);
    CHECK(surface.nonmanifold_edges == 0);
    CHECK(boundary_loops(surface).size() == loops);
  }
}

}  // namespace selvedge::test_pattern_mesh
