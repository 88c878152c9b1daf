#include <catch2/catch.hpp>

#include "collision/geometry/distance.hpp"
#include "tests/learned/graph_scenes.hpp"

namespace selvedge::test_graph_pairs {

using namespace selvedge::fake;

namespace {

// Crumpled layers that pass through each other.
Mesh crumpled(unsigned seed) {
  Mesh mesh = grid(9, 11);
  add(mesh, grid(9, 11), {0.003, 0.012, 0.004});
  jitter(mesh.x, 0.012, seed);
  return mesh;
}

// By the definition: solves for the projection in a basis of the face's plane.
std::vector<std::pair<int, int>> pairs_by_definition(const Surface& surface, const Points& x, double radius) {
  std::vector<std::pair<int, int>> found;
  for (int v = 0; v < surface.vertex_count; ++v)
    for (int f = 0; f < static_cast<int>(surface.triangles.rows()); ++f) {
      const auto corner = surface.triangles.row(f);
      if (corner[0] == v || corner[1] == v || corner[2] == v) continue;
      Eigen::Matrix<double, 3, 2> basis;
      basis << row(x, corner[1]) - row(x, corner[0]), row(x, corner[2]) - row(x, corner[0]);
      const Vec3 d = row(x, v) - row(x, corner[0]);
      const Vec2 w = (basis.transpose() * basis).inverse() * (basis.transpose() * d);
      const double height = (d - basis * w).norm();
      if (w[0] >= 0 && w[1] >= 0 && w.sum() <= 1 && height <= radius) found.emplace_back(v, f);
    }
  return found;
}

// Two flat layers; the lower one rises through the upper one in a ring and is below it again in the middle.
Mesh ring_through_sheet() {
  const int n = 41;
  Mesh mesh = grid(n, n);
  Mesh lower = grid(n, n);
  for (auto p : lower.x.rowwise()) {
    const double r = std::hypot(p[0] - 0.4, p[2] - 0.4);
    p[1] = r > 0.1 && r < 0.25 ? 0.011 : -0.0103;
  }
  add(mesh, lower, {0.0031, 0, 0.0023});
  return mesh;
}

double radius_at(const Points& x, int v) { return std::hypot(x(v, 0) - 0.4, x(v, 2) - 0.4); }

}  // namespace

TEST_CASE("graph pairs: cloth with cloth are those of the definition", "[graph]") {
  for (unsigned seed = 0; seed < 4; ++seed) {
    const Mesh mesh = crumpled(seed);
    const Surface surface = surface_of(mesh);
    std::vector<int> all(static_cast<std::size_t>(surface.vertex_count));
    for (std::size_t v = 0; v < all.size(); ++v) all[v] = static_cast<int>(v);
    ClothSearch search;
    for (const double radius : {0.004, 0.03}) {
      std::vector<std::pair<int, int>> ours;
      for (const ClothPair& pair : find_cloth_pairs(surface, mesh.x, all, radius, search)) {
        ours.emplace_back(pair.vertex, pair.face);
        for (int k = 0; k < 3; ++k) {
          const Vec3 p = row(mesh.x, pair.vertex);
          CHECK((row(mesh.x, pair.nearest) - p).norm() <= (row(mesh.x, surface.triangles(pair.face, k)) - p).norm());
        }
      }
      CHECK((ours == pairs_by_definition(surface, mesh.x, radius)));
      CHECK(ours.size() > 20);
    }
  }
}

TEST_CASE("graph pairs: far from the origin, and with triangles without area", "[graph]") {
  Mesh mesh = crumpled(3);
  mesh.x.rowwise() += Eigen::RowVector3d(900, -700, 500);
  mesh.x.row(40) = mesh.x.row(41);  // two triangles are lines
  const Surface surface = surface_of(mesh);
  std::vector<int> some{0, 17, 40, 41, 99, 150};
  ClothSearch search;
  std::vector<std::pair<int, int>> ours, wanted;
  for (const ClothPair& pair : find_cloth_pairs(surface, mesh.x, some, 0.03, search))
    ours.emplace_back(pair.vertex, pair.face);
  for (const auto& pair : pairs_by_definition(surface, mesh.x, 0.03))
    if (std::ranges::find(some, pair.first) != some.end()) wanted.push_back(pair);
  CHECK((ours == wanted));
}

TEST_CASE("graph pairs: cloth with body by brute force", "[graph]") {
  Mesh body = grid(12, 12, 0.03), cloth = grid(14, 9);
  jitter(body.x, 0.02, 1);
  jitter(cloth.x, 0.03, 2);
  World made = world(cloth, body);
  made.scene.body_types[70] = omitted_body_vertex;
  for (const BodyPartner partner : {BodyPartner::nearest_vertex, BodyPartner::nearest_face}) {
    FeatureOptions options = hood_features();
    options.body_partner = partner;
    BodySearch search;
    const std::vector<BodyPair> found = find_body_pairs(made.scene, options, cloth.x, body.x, search);
    std::vector<int> near;
    for (int v = 0; v < made.scene.cloth.vertex_count; ++v) {
      double least = HUGE_VAL;
      const bool vertices = partner == BodyPartner::nearest_vertex;
      for (int i = 0; i < (vertices ? 144 : static_cast<int>(body.triangles.rows())); ++i) {
        const auto corner = body.triangles.row(vertices ? 0 : i);
        least = std::min(least, vertices ? (row(body.x, i) - row(cloth.x, v)).squaredNorm()
                                         : point_triangle(row(cloth.x, v), row(body.x, corner[0]),
                                                          row(body.x, corner[1]), row(body.x, corner[2]))
                                               .squared_distance);
      }
      if (least > 0.03 * 0.03) continue;
      REQUIRE(near.size() < found.size());
      const BodyPair& pair = found[near.size()];
      CHECK(pair.cloth == v);
      if (vertices) CHECK((row(body.x, pair.vertex) - row(cloth.x, v)).squaredNorm() == least);
      near.push_back(v);
    }
    CHECK(near.size() == found.size());
    CHECK(near.size() > 20);
    CHECK(near.size() < 126);
  }
}

TEST_CASE("graph pairs: contours are the same with a kept tree and its quiet parts", "[graph]") {
  ClothSearch kept;
  Mesh mesh = ring_through_sheet();
  add(mesh, grid(41, 41), {0, 3, 0});  // where nothing else is: parts of it are quiet
  const Surface surface = surface_of(mesh);
  for (unsigned frame = 0; frame < 3; ++frame) {
    jitter(mesh.x, 0.001 * frame, frame);
    const SheetView known = refreshed_sheet(surface, mesh.x, kept), bare{&surface, &mesh.x};
    const Segments ours = find_segments(std::span(&known, 1)), wanted = find_segments(std::span(&bare, 1));
    CHECK((std::ranges::count(*known.quiet, 1) > 0 || frame > 0));
    CHECK((ours.crossings == wanted.crossings));
    REQUIRE(ours.segments.size() == wanted.segments.size());
    for (std::size_t i = 0; i < ours.segments.size(); ++i) {
      CHECK(ours.segments[i].triangle == wanted.segments[i].triangle);
      CHECK(ours.segments[i].end == wanted.segments[i].end);
    }
    CHECK(ours.segments.size() > 100);
  }
}

TEST_CASE("graph pairs: inside a contour they attract, and one that is nested counts for nothing", "[graph]") {
  const Mesh mesh = ring_through_sheet();
  const World made = world(mesh);
  const PairClasses released = made_graph(made, contourcraft_features()).report.cloth_pairs;
  CHECK(released.contours == 2);
  CHECK(released.nested == 2);
  CHECK(released.enclosed_vertices > 600);
  CHECK(released.attraction.size() > 300);
  CHECK(released.repulsion.size() > 1000);
  for (const ClothPair& pair : released.attraction) CHECK(radius_at(mesh.x, pair.vertex) < 0.29);
  for (const ClothPair& pair : released.repulsion) CHECK(radius_at(mesh.x, pair.vertex) > 0.22);

  FeatureOptions options = contourcraft_features();
  options.contours = ContourRule::all_repel;
  const PairClasses plain = made_graph(made, options).report.cloth_pairs;
  CHECK(plain.attraction.empty());
  CHECK(plain.repulsion.size() ==
        released.attraction.size() + released.repulsion.size() + static_cast<std::size_t>(released.without_contour));

  options.contours = ContourRule::all_vertices;  // pairs that straddle the contour attract too, and none is left out
  const PairClasses paper = made_graph(made, options).report.cloth_pairs;
  CHECK(paper.attraction.size() > released.attraction.size());
  CHECK(paper.attraction.size() + paper.repulsion.size() == plain.repulsion.size());
  CHECK(paper.without_contour == 0);
}

}  // namespace selvedge::test_graph_pairs
