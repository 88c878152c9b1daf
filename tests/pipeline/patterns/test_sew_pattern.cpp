#include "pipeline/patterns/sew_pattern.hpp"

#include <catch2/catch.hpp>

#include "collision/audit/audit.hpp"
#include "pipeline/shapes/primitives.hpp"

namespace selvedge::test_sew_pattern {

namespace {

// A front and a back of 40 cm by 10 cm, half a metre apart, with both sides sewn: a tube of 80 cm.
const std::string tube = R"({"pattern":{"panels":{
  "front":{"translation":[-20,8,25],"rotation":[0,0,0],"vertices":[[0,0],[40,0],[40,10],[0,10]],"edges":[
    {"endpoints":[0,1],"label":"hem"},{"endpoints":[1,2]},{"endpoints":[2,3]},{"endpoints":[3,0]}]},
  "back":{"translation":[-20,8,-25],"rotation":[0,0,0],"vertices":[[0,0],[0,10],[40,10],[40,0]],"edges":[
    {"endpoints":[0,1]},{"endpoints":[1,2]},{"endpoints":[2,3]},{"endpoints":[3,0],"label":"hem"}]}},
  "stitches":[[{"panel":"front","edge":1},{"panel":"back","edge":2}],
              [{"panel":"front","edge":3},{"panel":"back","edge":0}]]},
  "properties":{"units_in_meter":100}})";

}  // namespace

TEST_CASE("A tube is sewn round a ball and comes to rest on it") {
  // The tube fits it. On a ball of 16.5 cm its upper rim turns over or it slips off.
  const Shape ball = make_sphere(0.155, 0.03);
  const PatternMesh mesh = pattern_mesh(pattern_of(tube, "tube"), 0.05);
  int frames = 0;
  const SewnPattern sewn =
      sew_pattern(mesh, ball.x, ball.triangles, {}, [&](const SewingFrame& frame) { frames += frame.x != nullptr; });
  CHECK(frames >= sewn.closing_frames + sewn.draping_frames);
  REQUIRE_FALSE(sewn.rejected);
  CHECK(sewn.joined_by < 1e-4);
  CHECK(sewn.gaps.size() == mesh.sewn.size());
  CHECK(sewn.moving_share < 0.015);
  const Surface surface = make_surface(static_cast<int>(sewn.x.rows()), sewn.triangles);
  CHECK(surface.component_count == 1);
  CHECK(boundary_loops(surface).size() == 2);
  const Surface body = make_surface(static_cast<int>(ball.x.rows()), ball.triangles);
  const std::vector<AuditBody> bodies{{&body, &ball.x}};
  const Audit found = audit(surface, sewn.x, bodies);
  CHECK(found.intersecting_pairs() == 0);
  CHECK(found.inside_vertices == 0);
  // On the ball with its right side out: normals point away from the centre, also where the upper rim lies on the top.
  const Points normals = vertex_normals(surface, sewn.x);
  int outward = 0;
  for (Eigen::Index v = 0; v < sewn.x.rows(); ++v) {
    outward += normals.row(v).dot(sewn.x.row(v)) > 0;
    CHECK(std::abs(sewn.x(v, 1)) < 0.25);
  }
  CHECK(outward > 0.9 * static_cast<double>(sewn.x.rows()));
  // The rest shape is that of the panels.
  double area_at_rest = 0;
  for (const RestTriangle& triangle : sewn.rest) area_at_rest += area(triangle);
  CHECK(area_at_rest == Approx(0.08));
  for (const auto& [name, vertices] : sewn.groups)
    if (name == "hem") CHECK(vertices.size() == 16);
}

}  // namespace selvedge::test_sew_pattern
