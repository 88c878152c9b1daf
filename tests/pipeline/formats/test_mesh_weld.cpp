#include "pipeline/formats/mesh_weld.hpp"

#include <catch2/catch.hpp>

#include <algorithm>

#include "collision/geometry/error.hpp"
#include "collision/geometry/surface.hpp"
#include "tests/pipeline/fake_run.hpp"

namespace selvedge::test_mesh_weld {

using Catch::Matchers::Contains;

namespace {

constexpr int n = 5;  // vertices along a side of a panel

// The square's corners with their diagonals turned, so that none cuts off a corner of the panel.
Triangles without_ears(Triangles faces) {
  for (const Eigen::Index t : {Eigen::Index(0), faces.rows() - 2}) {
    const int a = faces(t, 0), c = faces(t, 1), b = faces(t, 2), d = faces(t + 1, 2);
    faces.row(t) << a, c, d;
    faces.row(t + 1) << a, d, b;
  }
  return faces;
}

// Square panels of side 1 with vertices of their own, each turned about its border x = 0 by an angle.
Mesh book(const std::vector<double>& angles, double gap = 0) {
  Mesh mesh;
  const auto count = static_cast<Eigen::Index>(angles.size());
  const Points panel = fake::grid_points(n);
  const Triangles faces = fake::grid_triangles(n);
  mesh.x.resize(count * panel.rows(), 3);
  mesh.triangles.resize(count * faces.rows(), 3);
  for (Eigen::Index k = 0; k < count; ++k) {
    const double angle = angles[static_cast<std::size_t>(k)];
    for (Eigen::Index v = 0; v < panel.rows(); ++v) {
      const double along = panel(v, 0) + gap * static_cast<double>(k);
      mesh.x.row(k * panel.rows() + v) << along * std::cos(angle), along * std::sin(angle), panel(v, 2);
    }
    mesh.triangles.middleRows(k * faces.rows(), faces.rows()) = faces.array() + static_cast<int>(k * panel.rows());
  }
  return mesh;
}

Surface surface_of(const Mesh& mesh) { return make_surface(static_cast<int>(mesh.x.rows()), mesh.triangles); }

}  // namespace

TEST_CASE("weld: two panels become one along their common border", "[mesh_weld]") {
  Mesh mesh = book({0, 2});
  CHECK(weldable(mesh.x, mesh.triangles).joined == n);
  const Welding done = weld(mesh, "shirt.obj");
  CHECK(done.joined == n);
  CHECK(done.apart == 0);
  CHECK(mesh.warnings.empty());
  const Surface surface = surface_of(mesh);
  CHECK(surface.vertex_count == 2 * n * n - n);
  CHECK(surface.component_count == 1);
  CHECK(surface.nonmanifold_edges == 0);
  CHECK(weldable(mesh.x, mesh.triangles).joined == 0);
  CHECK(unwelded_text(312, "--weld") == "the seams are not welded: --weld joins 312 vertices");
  CHECK(unwelded_text(1, "--weld") == "the seams are not welded: --weld joins 1 vertex");
}

TEST_CASE("weld: the distance is a thousandth of an edge, or what is given", "[mesh_weld]") {
  const double edge = 1.0 / (n - 1);
  CHECK(weld_distance(book({0}).x, book({0}).triangles) == Approx(1e-3 * edge).epsilon(0.3));
  Mesh near = book({0, 3.1}, 0.5e-3 * edge), far = book({0, 3.1}, 5e-3 * edge), given = far;
  CHECK(weld(near, "a.obj").joined == n);
  CHECK(weld(far, "a.obj").joined == 0);
  CHECK(weld(given, "a.obj", 6e-3 * edge).joined == n);
  CHECK_THROWS_WITH(weld(far, "a.obj", edge), Contains("a.obj") && Contains("half"));
}

TEST_CASE("weld: what would not be a surface stays apart, and is counted", "[mesh_weld]") {
  // Three pages of a book: an edge would have three triangles.
  Mesh pages = book({0, 2, 4});
  const Welding done = weld(pages, "book.obj");
  CHECK(done.joined == 0);
  CHECK(done.apart == 2 * n);
  CHECK(surface_of(pages).component_count == 3);
  CHECK(surface_of(pages).nonmanifold_edges == 0);
  REQUIRE(pages.warnings.size() == 1);
  CHECK_THAT(pages.warnings[0], Contains("book.obj: 10 vertices at the places of others are not welded"));
  // Two panels that meet in a corner alone.
  Mesh corner = book({0, 2});
  corner.x.bottomRows(n * n).col(2).array() += 1;
  CHECK(weld(corner, "corner.obj").apart == 1);
  CHECK(surface_of(corner).component_count == 2);
  CHECK_THAT(corner.warnings.at(0), Contains("1 vertex at the place of another is not welded"));
}

TEST_CASE("weld: two layers that lie on each other are joined round the border and nowhere else", "[mesh_weld]") {
  // As a flat shirt has them: the second layer faces the other way.
  const auto layers = [](const Triangles& faces) {
    Mesh flat = book({0, 0});
    const Eigen::Index count = faces.rows();
    flat.triangles.topRows(count) = faces;
    flat.triangles.bottomRows(count) = faces.array() + n * n;
    for (Eigen::Index t = count; t < 2 * count; ++t) std::swap(flat.triangles(t, 1), flat.triangles(t, 2));
    return flat;
  };
  Mesh whole = layers(without_ears(fake::grid_triangles(n)));
  CHECK(weld(whole, "flat.obj").joined == 4 * (n - 1));
  CHECK(surface_of(whole).nonmanifold_edges == 0);
  CHECK(is_closed(surface_of(whole)));
  // Where one face is a corner of the panel, its third edge runs from border to border: joined at both ends, in both
  // layers, it would have four triangles. One end stays apart, with the two border edges there in each layer.
  Mesh ears = layers(fake::grid_triangles(n));
  const Welding done = weld(ears, "ears.obj");
  CHECK(done.joined == 4 * (n - 1) - 2);
  CHECK(done.apart == n * n - done.joined);
  const Surface surface = surface_of(ears);
  CHECK(surface.nonmanifold_edges == 0);
  CHECK(surface.component_count == 1);
  const std::vector<int> faces = face_counts(surface);
  CHECK(std::count(faces.begin(), faces.end(), 1) == 2 * 2 * 2);
}

}  // namespace selvedge::test_mesh_weld
