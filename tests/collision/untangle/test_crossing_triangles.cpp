#include "collision/untangle/crossing_triangles.hpp"

#include <catch2/catch.hpp>

#include <set>

#include "collision/audit/audit.hpp"
#include "collision/untangle/find_exemption.hpp"
#include "tests/collision/sheets.hpp"

namespace selvedge::test_crossing_triangles {

using testing::Sheet;

namespace {

std::set<int> marked(const std::vector<char>& marks) {
  std::set<int> found;
  for (std::size_t t = 0; t < marks.size(); ++t)
    if (marks[t]) found.insert(static_cast<int>(t));
  return found;
}

std::set<int> crossing(const Sheet& cloth, const Sheet& obstacle, bool self) {
  const Surface surface = make_surface(static_cast<int>(cloth.x.rows()), cloth.triangles);
  const Surface other = make_surface(static_cast<int>(obstacle.x.rows()), obstacle.triangles);
  const ContactWorld world = make_contact_world(surface, {&other}, self);
  return marked(crossing_triangles(world, gather_nodes(cloth.x, {obstacle.x})));
}

std::set<int> audited(const Sheet& cloth, const Sheet& obstacle, bool self) {
  const Surface surface = make_surface(static_cast<int>(cloth.x.rows()), cloth.triangles);
  const Surface other = make_surface(static_cast<int>(obstacle.x.rows()), obstacle.triangles);
  const std::vector<AuditBody> bodies{{&other, &obstacle.x}};
  const Audit audit = selvedge::audit(surface, cloth.x, bodies, self);
  std::set<int> found;
  for (const auto* pairs : {&audit.self_pairs, &audit.vertex_pairs})
    for (const auto& [a, b] : *pairs) found.insert({a, b});
  for (const auto& [triangle, body] : audit.obstacle_pairs) found.insert(triangle);
  return found;
}

// A tetrahedron.
Sheet round_origin() {
  Sheet s{Points(4, 3), Triangles(4, 3)};
  s.x << 0, 3, 0, -3, -1, -3, 3, -1, -3, 0, -1, 3;
  s.triangles << 0, 2, 1, 0, 3, 2, 0, 1, 3, 1, 2, 3;
  return s;
}

}  // namespace

TEST_CASE("crossing triangles: those that the audit finds in a pair", "[crossing_triangles]") {
  // A sheet rolled through itself, and a wall through its middle.
  const Sheet rolled = testing::bent(14, {0.004, 0.003}, [](double a, double b) {
    const double angle = 3.6 * (a + 1), radius = 0.5 + 0.02 * std::sin(9 * a) + 0.03 * std::cos(7 * b);
    return Vec3(radius * std::cos(angle), radius * std::sin(angle), b + 0.01 * a);
  });
  const Sheet wall = testing::bent(5, {0.01, 0.01}, [](double a, double b) { return Vec3(a, b, 0.05 * a + 0.031); });
  for (const bool self : {true, false}) {
    const std::set<int> found = crossing(rolled, wall, self);
    CHECK(found == audited(rolled, wall, self));
    CHECK(found.size() > 20);
    CHECK(found.size() < static_cast<std::size_t>(rolled.triangles.rows()));
  }
  CHECK(crossing(rolled, wall, true) != crossing(rolled, wall, false));
}

TEST_CASE("crossing triangles: those with a vertex inside a closed obstacle, and those that only touch",
          "[crossing_triangles]") {
  // A small sheet wholly inside a tetrahedron crosses none of its faces.
  Sheet tetrahedron = round_origin();
  const Sheet small = testing::sheet(2, 0.2, 0);
  CHECK(crossing(small, tetrahedron, true).size() == 8);
  tetrahedron.triangles.conservativeResize(3, 3);  // open: it has no inside
  CHECK(crossing(small, tetrahedron, true).empty());
  Sheet above = testing::sheet(1, 0.5, 1);  // a triangle stands with its tip on the first triangle
  above.x.conservativeResize(7, 3);
  above.x.bottomRows(3) << -0.1, 1, -0.1, -0.2, 2, 0, 0.1, 2, 0;
  above.triangles.conservativeResize(3, 3);
  above.triangles.row(2) << 4, 5, 6;
  CHECK(crossing(above, tetrahedron, true) == std::set<int>{0, 2});
  CHECK(crossing(above, tetrahedron, false).empty());
}

TEST_CASE("crossing triangles: vertices in no triangle are inside nothing", "[crossing_triangles]") {
  const Sheet tetrahedron = round_origin();
  Sheet cloth = testing::sheet(2, 0.2, 10);
  const int count = static_cast<int>(cloth.x.rows());
  cloth.x.conservativeResize(count + 1, 3);
  cloth.x.bottomRows(1).setZero();
  CHECK(crossing(cloth, tetrahedron, true).empty());
  const Surface surface = make_surface(count + 1, cloth.triangles), body = make_surface(4, tetrahedron.triangles);
  const ContactWorld world = make_contact_world(surface, {&body}, true);
  CHECK_FALSE(find_exemption(world, gather_nodes(cloth.x, {tetrahedron.x})).any());
  cloth.x.col(1).setZero();
  CHECK(find_exemption(world, gather_nodes(cloth.x, {tetrahedron.x})).tangled_vertices() == count);
}

}  // namespace selvedge::test_crossing_triangles
