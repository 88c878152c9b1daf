#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "collision/audit/audit.hpp"
#include "collision/audit/audit_inside.hpp"
#include "collision/exact/inside.hpp"
#include "collision/exact/triangle_pair.hpp"
#include "tests/collision/brute_force.hpp"
#include "tests/collision/tangles.hpp"
#include "tests/threads.hpp"

namespace selvedge::test_audit {

using testing::Pairs;
using testing::shake;

namespace {

struct Mesh {
  Surface surface;
  Points x;
};

// n x n squares of side `length`, corner k of the grid at origin + i u + j v.
Mesh grid(int n, const Vec3& origin, const Vec3& u, const Vec3& v) {
  Points x((n + 1) * (n + 1), 3);
  Triangles triangles(2 * n * n, 3);
  for (int i = 0, t = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j) {
      const int a = i * (n + 1) + j;
      x.row(a) = (origin + i * u + j * v).transpose();
      if (i == n || j == n) continue;
      triangles.row(t++) << a, a + 1, a + n + 1;
      triangles.row(t++) << a + 1, a + n + 2, a + n + 1;
    }
  return {make_surface((n + 1) * (n + 1), triangles), x};
}

Mesh together(const Mesh& a, const Mesh& b) {
  const Eigen::Index na = a.x.rows(), ta = a.surface.triangles.rows();
  Points x(na + b.x.rows(), 3);
  x << a.x, b.x;
  Triangles triangles(ta + b.surface.triangles.rows(), 3);
  triangles.topRows(ta) = a.surface.triangles;
  triangles.bottomRows(triangles.rows() - ta) = b.surface.triangles.array() + static_cast<int>(na);
  return {make_surface(static_cast<int>(x.rows()), triangles), x};
}

// Surface of the cube [0, n]^3, every lattice square of it two triangles, without doubled vertices.
Mesh lattice_cube(int n) {
  std::vector<Vec3> points;
  const auto index = [&points](const Vec3& p) {
    const auto at = std::find(points.begin(), points.end(), p);
    if (at == points.end()) return points.push_back(p), static_cast<int>(points.size()) - 1;
    return static_cast<int>(at - points.begin());
  };
  std::vector<std::array<int, 3>> faces;
  for (int axis = 0; axis < 3; ++axis)
    for (int side : {0, n})
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          const auto corner = [&](int di, int dj) {
            Vec3 p;
            p[axis] = side;
            p[(axis + 1) % 3] = i + di;
            p[(axis + 2) % 3] = j + dj;
            return index(p);
          };
          const int a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
          faces.push_back(side ? std::array{a, b, c} : std::array{a, c, b});
          faces.push_back(side ? std::array{a, c, d} : std::array{a, d, c});
        }
  Mesh mesh;
  Triangles triangles(static_cast<int>(faces.size()), 3);
  for (int t = 0; t < triangles.rows(); ++t) triangles.row(t) << faces[t][0], faces[t][1], faces[t][2];
  mesh.x.resize(static_cast<int>(points.size()), 3);
  for (int v = 0; v < mesh.x.rows(); ++v) mesh.x.row(v) = points[v].transpose();
  mesh.surface = make_surface(static_cast<int>(points.size()), triangles);
  return mesh;
}

Mesh ball(int n, double radius) {
  Mesh mesh = lattice_cube(n);
  for (int v = 0; v < mesh.x.rows(); ++v)
    mesh.x.row(v) = radius * (row(mesh.x, v) - Vec3::Constant(0.5 * n)).normalized().transpose();
  return mesh;
}

// By the solver's test: the audit asks another.
Pairs brute_self(const Mesh& mesh) { return testing::brute_self(mesh, triangles_meet); }
Pairs brute_cross(const Mesh& a, const Mesh& b) { return testing::brute_cross(a, b, triangles_meet); }

Audit audit(const Mesh& cloth, std::vector<const Mesh*> bodies = {}, bool self = true) {
  std::vector<AuditBody> obstacles;
  for (const Mesh* body : bodies) obstacles.push_back({&body->surface, &body->x});
  return selvedge::audit(cloth.surface, cloth.x, obstacles, self);
}

double min_gap(const Mesh& cloth, std::vector<const Mesh*> bodies, double horizon) {
  std::vector<AuditBody> obstacles;
  for (const Mesh* body : bodies) obstacles.push_back({&body->surface, &body->x});
  return selvedge::min_gap(cloth.surface, cloth.x, obstacles, horizon);
}

const Vec3 ex(1, 0, 0), ey(0, 1, 0), ez(0, 0, 1);

}  // namespace

TEST_CASE("audit: two crossing sheets, as one cloth and as cloth and obstacle", "[audit]") {
  // The upright sheet crosses a single row of squares: its triangles left and right of every lattice line of the row.
  const Mesh flat = grid(8, Vec3::Zero(), ex, ez), upright = grid(8, {3.5, -3.75, 0.125}, ey, 0.5 * ez);
  const Audit as_one = audit(together(flat, upright));
  CHECK(as_one.self_pairs == brute_self(together(flat, upright)));
  CHECK(as_one.self_pairs.size() >= 16);
  CHECK(as_one.vertex_pairs.empty());
  CHECK(as_one.intersecting_pairs() == static_cast<int>(as_one.self_pairs.size()));

  const Audit as_two = audit(flat, {&upright});
  CHECK(as_two.obstacle_pairs == brute_cross(flat, upright));
  CHECK(as_two.obstacle_pairs.size() == as_one.self_pairs.size());
  CHECK(as_two.self_pairs.empty());
  CHECK(as_two.inside_vertices == 0);
  CHECK(audit(together(flat, upright), {}, false).intersecting_pairs() == 0);
  CHECK(min_gap(flat, {&upright}, 0.1) == 0);
}

TEST_CASE("audit: sheets that touch edge to edge intersect, also where space is cut along the touching edges",
          "[audit]") {
  const Mesh left = grid(8, {-8, 0, 0}, ex, ez), right = grid(8, Vec3::Zero(), ex, ez);
  const Audit found = audit(together(left, right));
  CHECK(found.self_pairs == brute_self(together(left, right)));
  CHECK(found.self_pairs.size() >= 16);
}

TEST_CASE("audit: obstacle triangles are numbered on end", "[audit]") {
  const Mesh cloth = grid(1, Vec3::Zero(), ex, ez), beside = grid(2, {5, 0, 5}, ex, ez);
  const Mesh through = grid(1, {0.25, -0.5, 0.25}, ey, 0.1 * ez);
  const Audit found = audit(cloth, {&beside, &through});
  CHECK(found.obstacle_pairs == Pairs{{0, 8}, {0, 9}});
}

TEST_CASE("audit: crumpled sheets agree with brute force", "[audit]") {
  for (unsigned seed = 0; seed < 4; ++seed) {
    Mesh cloth = grid(14, Vec3::Zero(), ex, ez), body = grid(5, {0.3, 0.1, 0.2}, 2.3 * ex, 2.3 * ez);
    shake(cloth.x, 0.9, seed);
    shake(body.x, 0.3, seed + 10);
    const Audit found = audit(cloth, {&body});
    CHECK(found.self_pairs == brute_self(cloth));
    CHECK(found.obstacle_pairs == brute_cross(cloth, body));
    CHECK(found.self_pairs.size() > 10);
    CHECK(found.obstacle_pairs.size() > 10);
  }
}

TEST_CASE("audit: few large triangles against many small ones", "[audit]") {
  Mesh cloth = grid(40, {-1, 0.02, -1}, 0.05 * ex, 0.05 * ez);
  const Mesh ground = grid(1, {-50, 0, -50}, 100 * ex, 100 * ez);
  CHECK(audit(cloth, {&ground}).intersecting_pairs() == 0);
  CHECK(min_gap(cloth, {&ground}, 0.1) == Approx(0.02));
  shake(cloth.x, 0.021, 1);
  CHECK(audit(cloth, {&ground}).obstacle_pairs == brute_cross(cloth, ground));
}

TEST_CASE("audit: a folded cloth is clean until its layers pass through each other", "[audit]") {
  Mesh cloth = grid(20, Vec3::Zero(), 0.05 * ex, 0.05 * ez);
  for (int v = 0; v < cloth.x.rows(); ++v)
    if (cloth.x(v, 0) > 0.5) cloth.x.row(v) << 1 - cloth.x(v, 0), 0.01, cloth.x(v, 2);
  CHECK(audit(cloth).intersecting_pairs() == 0);
  CHECK(audit(cloth).vertex_pairs.empty());
  cloth.x(cloth.x.rows() - 1, 1) = -0.01;
  const Audit found = audit(cloth);
  CHECK(found.intersecting_pairs() > 0);
  CHECK(found.self_pairs == brute_self(cloth));
}

TEST_CASE("audit: triangles with a common vertex count only if they cross", "[audit]") {
  Triangles triangles(2, 3);
  triangles << 0, 1, 2, 0, 3, 4;
  Mesh mesh{make_surface(5, triangles), Points(5, 3)};
  mesh.x << 0, 0, 0, 2, 0, -1, 2, 0, 1, 1, -1, 0, 1, 1, 0;
  CHECK(audit(mesh).vertex_pairs == Pairs{{0, 1}});
  CHECK(audit(mesh).intersecting_pairs() == 0);
  mesh.x.row(3) << -1, -1, 0;
  mesh.x.row(4) << -1, 1, 0;
  CHECK(audit(mesh).vertex_pairs.empty());
}

TEST_CASE("audit: a cloth inside a closed body", "[audit]") {
  const Mesh body = ball(8, 1), within = ball(4, 0.5), around = ball(4, 2);
  REQUIRE(is_closed(body.surface));
  CHECK(audit(within, {&body}).inside_vertices == within.x.rows());
  CHECK(audit(within, {&body}).intersecting_pairs() == 0);
  CHECK(audit(around, {&body}).inside_vertices == 0);
  // Through the second body of two: the vertices outside must not be counted with those inside.
  const Mesh through = grid(8, {-4, 0.1, -4}, ex, ez), apart = grid(20, {9, 9, 9}, ex, ez);
  CHECK(audit(through, {&body}).inside_vertices == 1);
  CHECK(audit(through, {&apart, &body}).inside_vertices == 1);
  Mesh open = body;
  open.surface = make_surface(body.surface.vertex_count, body.surface.triangles.bottomRows(100));
  CHECK(audit(within, {&open}).inside_vertices == 0);
}

TEST_CASE("audit: the inside of a lattice cube is exact for points level with its vertices and edges", "[audit]") {
  const int n = 4;
  const Mesh cube = lattice_cube(n);
  REQUIRE(is_closed(cube.surface));
  std::vector<Vec3> points;
  for (double a = -1; a <= n + 1; a += 0.5)
    for (double b = -1; b <= n + 1; b += 0.5)
      for (double c = -1; c <= n + 1; c += 0.5) points.emplace_back(a, b, c);
  Points queries(static_cast<int>(points.size()), 3);
  for (int i = 0; i < queries.rows(); ++i) queries.row(i) = points[i].transpose();
  const std::vector<char> result = inside(cube.surface, cube.x, queries);
  for (int i = 0; i < queries.rows(); ++i) {
    const bool expected = points[i].minCoeff() > 0 && points[i].maxCoeff() < n;
    REQUIRE(static_cast<bool>(result[i]) == expected);
  }
}

TEST_CASE("audit: on a triangle is not inside, whatever is left of the triangle", "[audit]") {
  // Two cubes, and in the first or between them two opposite triangles on few lattice points, so that many of these are
  // segments or points.
  std::mt19937 random(6);
  std::uniform_int_distribution<int> at(1, 4);
  Mesh second = lattice_cube(5);
  second.x.col(0).array() += 12;
  const Mesh cubes = together(lattice_cube(5), second);
  const int n = cubes.surface.vertex_count, m = static_cast<int>(cubes.surface.triangles.rows());
  Triangles triangles(m + 2, 3), strip(62, 3);
  triangles << cubes.surface.triangles, Triangles::Zero(2, 3);
  triangles.row(m) << n, n + 1, n + 2;
  triangles.row(m + 1) << n, n + 2, n + 1;
  for (int i = 0; i < 62; ++i) strip.row(i) << i, i + 1, i + 2;
  const Surface body = make_surface(n + 3, triangles), cloth = make_surface(64, strip);
  const std::vector<char> each_for_itself(62, 1);
  int on = 0, wrong = 0, differ = 0;
  for (int round = 0; round < 400; ++round) {
    const int between = round % 2 * 6;
    Points points(64, 3), x(n + 3, 3);
    for (int i = 0; i < 64; ++i) points.row(i) << 1 + i % 4 + between, 1 + i / 4 % 4, 1 + i / 16;
    x.topRows(n) = cubes.x;
    for (int k = 0; k < 3; ++k) x.row(n + k) << at(random) + between, at(random), at(random);
    if (round % 3 == 0) x.row(n + 2) = x.row(n) + (round % 4 / 2) * (x.row(n + 1) - x.row(n));
    const std::vector<char> result = inside(body, x, points);
    differ += inside_body(cloth, points, each_for_itself, body, x) != result;
    for (int i = 0; i < 64; ++i) {
      const Vec3 p = row(points, i);
      const bool meets = triangles_meet({p, p, p}, {row(x, n), row(x, n + 1), row(x, n + 2)});
      on += meets;
      wrong += (result[i] != 0) != (between == 0 && !meets);
    }
  }
  CHECK(wrong == 0);
  CHECK(differ == 0);
  CHECK(on > 1000);
}

TEST_CASE("audit: what is inside, by the audit's test and by the solver's", "[audit]") {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> place(-3, 3);
  int some = 0, mixed = 0;
  for (int round = 0; round < 60; ++round) {
    // Bodies on a lattice that the cloth's vertices share; round ones, far from the origin; and crumpled ones, which
    // pass through themselves.
    Mesh body = round % 3 == 0 ? lattice_cube(4) : ball(6, 2), cloth = grid(6, {-1, 2, -1}, ex, ez);
    const Vec3 shift = round % 2 ? Vec3(1e7, -1e6, 1e5) : Vec3::Zero();
    if (round % 3 == 2) shake(body.x, 0.7, round);
    if (round % 5) shake(cloth.x, 0.1 * (round % 5), round);
    if (round % 5) cloth.x.rowwise() += 0.5 * Vec3(place(random), place(random), place(random)).transpose();
    if (round % 4 == 1) cloth = ball(3, 0.2 * (round % 7));
    body.x.rowwise() += shift.transpose();
    cloth.x.rowwise() += shift.transpose();
    const std::vector<char> solver = inside(body.surface, body.x, cloth.x);
    std::vector<char> meets(cloth.surface.triangles.rows(), 0);
    for (const auto& [a, c] : audit(cloth, {&body}).obstacle_pairs) meets[a] = 1;
    REQUIRE(inside_body(cloth.surface, cloth.x, meets, body.surface, body.x) == solver);
    // Each vertex for itself.
    std::fill(meets.begin(), meets.end(), 1);
    REQUIRE(inside_body(cloth.surface, cloth.x, meets, body.surface, body.x) == solver);
    const auto count = std::count(solver.begin(), solver.end(), 1);
    some += count > 0;
    mixed += count > 0 && count < static_cast<int>(solver.size());
  }
  CHECK(some > 20);
  CHECK(mixed > 15);
}

TEST_CASE("audit: inside of two parts that overlap is inside, and in a cavity is not", "[audit]") {
  Mesh second = lattice_cube(6);
  second.x.rowwise() += Vec3(2, 1, 1.5).transpose();
  const Mesh overlap = together(lattice_cube(6), second);
  Mesh hole = lattice_cube(2);
  hole.x.rowwise() += Vec3(2, 2, 2).transpose();
  hole.surface.triangles.col(1).swap(hole.surface.triangles.col(2));
  const Mesh room =
      together(lattice_cube(6), {make_surface(hole.surface.vertex_count, hole.surface.triangles), hole.x});
  const Mesh cloth = grid(2, {2.3, 2.4, 2.6}, 0.4 * ex, 0.5 * ez);
  CHECK(audit(cloth, {&overlap}).obstacle_pairs.empty());
  CHECK(audit(cloth, {&overlap}).inside_vertices == 9);
  CHECK(audit(cloth, {&room}).obstacle_pairs.empty());
  CHECK(audit(cloth, {&room}).inside_vertices == 0);
}

TEST_CASE("audit: undefined coordinates are counted and left out", "[audit]") {
  const Mesh flat = grid(8, Vec3::Zero(), ex, ez);
  Mesh both = together(flat, grid(8, {3.5, -3.75, 0.125}, ey, 0.5 * ez));
  const std::size_t clean = audit(both).self_pairs.size();
  both.x(0, 1) = std::numeric_limits<double>::quiet_NaN();
  both.x(8, 2) = std::numeric_limits<double>::infinity();
  Mesh body = ball(4, 0.5);
  body.x(3, 0) = std::numeric_limits<double>::quiet_NaN();
  const Audit found = audit(both, {&body});
  CHECK(found.nonfinite == 3);
  CHECK(found.self_pairs.size() == clean);  // the two corners lie far from the crossing
  Mesh around = ball(4, 50);
  CHECK(audit(flat, {&around}).inside_vertices == flat.x.rows());
  around.x(3, 0) = std::numeric_limits<double>::quiet_NaN();
  CHECK(audit(flat, {&around}).inside_vertices == 0);
}

TEST_CASE("audit: smallest gap", "[audit]") {
  const Mesh flat = grid(6, Vec3::Zero(), ex, ez), above = grid(6, {0.3, 0.25, 0.4}, ex, ez);
  CHECK(min_gap(together(flat, above), {}, 1) == Approx(0.25));
  CHECK(min_gap(flat, {&above}, 0.5) == Approx(0.25));
  CHECK(min_gap(flat, {&above}, 0.2) == std::numeric_limits<double>::infinity());
  // Within a flat unit grid the nearest triangles without a common vertex lie the length of half a diagonal apart.
  CHECK(min_gap(flat, {}, 2) == Approx(std::sqrt(0.5)));
}

TEST_CASE("audit: nothing to audit", "[audit]") {
  const Mesh nothing{make_surface(0, Triangles(0, 3)), Points(0, 3)};
  const Mesh body = ball(4, 1);
  CHECK(audit(nothing, {&body}).intersecting_pairs() == 0);
  CHECK(audit(body, {&nothing}).inside_vertices == 0);
  CHECK(min_gap(nothing, {}, 1) == std::numeric_limits<double>::infinity());
}

TEST_CASE("audit: the same for any number of threads", "[audit][threads]") {
  Mesh cloth = grid(30, Vec3::Zero(), ex, ez), body = ball(8, 6);
  shake(cloth.x, 0.6, 5);
  std::vector<Audit> found;
  std::vector<double> gaps;
  const Mesh apart = grid(30, {0.1, 0.31, 0.2}, ex, ez);
  for (int n : {1, 2, 3}) {
    with_threads(n, [&] {
      found.push_back(audit(cloth, {&body}));
      gaps.push_back(min_gap(apart, {&body}, 1));
    });
  }
  for (int i : {1, 2}) {
    CHECK(found[i].self_pairs == found[0].self_pairs);
    CHECK(found[i].vertex_pairs == found[0].vertex_pairs);
    CHECK(found[i].obstacle_pairs == found[0].obstacle_pairs);
    CHECK(found[i].inside_vertices == found[0].inside_vertices);
    CHECK(gaps[i] == gaps[0]);
  }
  CHECK(found[0].inside_vertices > 0);
}

}  // namespace selvedge::test_audit
