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
  CHECK(unwelded_text({312}, "--weld") == "the seams are not welded: --weld joins 312 vertices");
  CHECK(unwelded_text({1}, "--weld") == "the seams are not welded: --weld joins 1 vertex");
  CHECK(unwelded_text({312, 0, true}, "--weld") ==
        "layers meet at their borders and are not joined: --weld joins 312 vertices, if they are sewn there");
}

TEST_CASE("weld: layers are told from panels by how their faces lie at the border", "[mesh_weld]") {
  struct Case {
    double angle;  // between two panels
    bool layered;
  };
  for (const Case& one : {Case{0.02, true}, Case{0.9, true}, Case{1.5, false}, Case{2, false}, Case{3.1, false}}) {
    INFO(one.angle);
    const Mesh mesh = book({0, one.angle});
    const Welding seams = weldable(mesh.x, mesh.triangles);
    CHECK(seams.joined == n);
    CHECK(seams.layered == one.layered);
  }
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

namespace {

// Cubes of side 1, each beside the one before, with a face in common. `split`: each face has vertices of its own, as
// flat shading needs them.
Mesh cubes_in_a_row(int count, bool split) {
  Triangles faces(12, 3);
  faces << 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5;
  Mesh mesh;
  const int each = split ? 24 : 8;
  mesh.x.resize(each * count, 3);
  mesh.triangles.resize(12 * count, 3);
  const auto corner = [&](int cube, int k) { return Eigen::RowVector3d(cube + (k & 1), k >> 1 & 1, k >> 2); };
  for (int cube = 0; cube < count; ++cube) {
    for (int k = 0; k < 8 && !split; ++k) mesh.x.row(8 * cube + k) = corner(cube, k);
    for (int t = 0; t < 12; ++t)
      for (int k = 0; k < 3; ++k) {
        const int side = faces(t, k), vertex = 4 * (t / 2) + (k == 0 ? 0 : t % 2 == 0 ? k : k + 1);
        const int own = t % 2 == 1 && k == 1 ? 4 * (t / 2) + 2 : t % 2 == 1 && k == 2 ? 4 * (t / 2) + 3 : vertex;
        mesh.triangles(12 * cube + t, k) = each * cube + (split ? own : side);
        if (split) mesh.x.row(24 * cube + own) = corner(cube, side);
      }
  }
  return mesh;
}

// All of one joint. `parts`: the number of each cube's.
Mesh joined_alike(Mesh mesh, const std::vector<int>& parts) {
  std::vector<Eigen::Triplet<double>> weights;
  std::vector<int> part;
  const int each = static_cast<int>(mesh.x.rows()) / static_cast<int>(parts.size());
  for (int v = 0; v < mesh.x.rows(); ++v) {
    weights.emplace_back(v, 0, 1.0);
    part.push_back(parts[static_cast<std::size_t>(v / each)]);
  }
  const auto rows = join_alike(weights, 1, part, mesh, "body.glb").rows();
  CHECK(rows == mesh.x.rows());
  return mesh;
}

}  // namespace

TEST_CASE("join_alike: closed pieces that touch stay apart, split ones are closed", "[mesh_weld]") {
  for (const bool split : {false, true}) {
    const Mesh one = joined_alike(cubes_in_a_row(1, split), {0});
    CHECK(one.x.rows() == 8);
    CHECK(is_closed(surface_of(one)));
    // Of one part each: neither the faces in common nor the seams of the other cubes matter.
    const Mesh three = joined_alike(cubes_in_a_row(3, split), {0, 1, 2});
    CHECK(three.x.rows() == 3 * 8);
    CHECK(three.triangles.rows() == 3 * 12);
    CHECK(is_closed(surface_of(three)));
    CHECK(surface_of(three).component_count == 3);
  }
  // Of one part: closed pieces need no parts.
  CHECK(is_closed(surface_of(joined_alike(cubes_in_a_row(2, false), {0, 0}))));
  // A cube whose faces are split between two parts is closed over both.
  Mesh halves = cubes_in_a_row(1, true);
  CHECK(is_closed(surface_of(joined_alike(halves, {0, 1}))));
}

TEST_CASE("join_alike: copies and vertices of no triangle become part of what lies there", "[mesh_weld]") {
  // Exporters repeat all vertices for each material, and draw both sides of a surface.
  Mesh twice = cubes_in_a_row(2, false);
  twice.x.bottomRows(8) = twice.x.topRows(8).eval();
  for (const bool turned : {false, true}) {
    if (turned) twice.triangles.bottomRows(12).col(1).swap(twice.triangles.bottomRows(12).col(2));
    const Mesh one = joined_alike(twice, {0, 1});
    CHECK(one.x.rows() == 8);
    CHECK(one.triangles.rows() == 12);
    CHECK(is_closed(surface_of(one)));
  }
  for (const bool lower : {false, true}) {
    Mesh bare = twice;
    bare.triangles = lower ? twice.triangles.bottomRows(12).eval() : twice.triangles.topRows(12).eval();
    const Mesh one = joined_alike(bare, {0, 1});
    CHECK(one.x.rows() == 8);
    CHECK(is_closed(surface_of(one)));
  }
}

TEST_CASE("join_alike: seams that an export has rounded are closed, and rings of other weights", "[mesh_weld]") {
  for (const double off : {1e-6, 1e-4, 8e-3}) {  // of an edge; a fiftieth of it is the most
    Mesh cube = cubes_in_a_row(1, true);
    for (Eigen::Index v = 0; v < cube.x.rows(); ++v) cube.x(v, v % 3) += v % 2 == 0 ? off : -off;
    INFO(off);
    CHECK(is_closed(surface_of(joined_alike(cube, {0}))));
  }
  // Two halves of a cube, of a joint each.
  Mesh halves = cubes_in_a_row(1, true);
  std::vector<Eigen::Triplet<double>> weights;
  for (int v = 0; v < halves.x.rows(); ++v) weights.emplace_back(v, v < 12 ? 0 : 1, 1.0);
  join_alike(weights, 2, std::vector<int>(24, 0), halves, "body.glb");
  CHECK(is_closed(surface_of(halves)));
  // Vertices with short edges are joined only where they are as near as ever.
  Mesh small = cubes_in_a_row(2, true);
  small.x.bottomRows(24) *= 0.01;
  for (int v = 24; v < 48; ++v) small.x(v, v % 3) += 2e-5 * v;
  const Mesh joined = joined_alike(small, {0, 1});
  CHECK(joined.x.rows() == 8 + 24);
}

}  // namespace selvedge::test_mesh_weld
