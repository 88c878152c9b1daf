#include "collision/contact/contact_normal.hpp"
#include "tests/physics/meshes.hpp"
#include "tests/physics/worlds.hpp"

namespace selvedge::test_frictionless {

using testing::World;

namespace {

// Stiff cards of 9 by 6 cm without friction, one on the other above a level floor of quads of 5 cm.
World stack(int count, double thickness) {
  Material card;
  card.density = 0.3;
  card.lame_mu = 1.15e4;
  card.lame_lambda = 9.9e3;
  card.bending = 1e-3;
  World w;
  Points x(0, 3);
  for (int c = 0; c < count; ++c) {
    meshes::Mesh mesh = meshes::grid(6, 4, 0.09, 0.06, meshes::Pattern::alternating);
    mesh.points.rowwise() += Eigen::RowVector3d(-0.043, 1.1 * thickness * (c + 1), 0.032);
    meshes::add_cloth(w.scene, mesh, card);
    Points more(x.rows() + mesh.points.rows(), 3);
    more << x, mesh.points;
    x = more;
  }
  w.state = first_state(w.scene, x);
  w.drive = at_rest(w.scene, w.state);
  testing::Sheet floor = testing::sheet(10, 0.5, 0);
  add_obstacle(w, floor);
  w.scene.contact = {.thickness = thickness, .friction = 0, .self_friction = 0};
  return w;
}

}  // namespace

TEST_CASE("without friction a level floor pushes nothing aside: a stack keeps its middle", "[frictionless]") {
  for (const double thickness : {0.35e-3, 2e-3}) {
    const World w = stack(3, thickness);
    const testing::Run r = testing::run(w, 30);
    const Vec3 drift = (r.state.x - w.state.x).colwise().mean().transpose();
    INFO("thickness " << thickness << ": drift " << 1e3 * drift.transpose() << " mm");
    CHECK(r.contacts > 0);
    CHECK(r.pairs == 0);
    CHECK(std::hypot(drift.x(), drift.z()) < 2e-5);  // [m]; 1e-3 where normals are those between closest points
  }
}

TEST_CASE("contact normal: that of a floor over its edges and corners, whatever crosses them", "[frictionless]") {
  const testing::Sheet floor = testing::sheet(2, 1, 0);
  // An edge that rises over the floor's middle edge, and a tilted face over its middle corner.
  testing::Sheet cloth{Points(6, 3), Triangles(2, 3)};
  cloth.x << -0.2, 0.001, 0.26, 0.2, 0.05, 0.24, 0, 0.4, 0.25, -0.1, 0.001, -0.1, 0.12, 0.03, -0.1, 0, 0.02, 0.15;
  cloth.triangles << 0, 1, 2, 3, 4, 5;
  const Surface sheet = make_surface(6, cloth.triangles),
                body = make_surface(static_cast<int>(floor.x.rows()), floor.triangles);
  const ContactWorld world = make_contact_world(sheet, {&body}, true);
  const Points nodes = gather_nodes(cloth.x, {floor.x});
  const auto between = [&](const NodePair& pair, const Closest& near) {
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < 4; ++i) sum += near.weights[i] * row(nodes, pair.nodes[static_cast<std::size_t>(i)]);
    return sum;
  };
  for (const NodePair& pair :
       {NodePair{PairKind::edge_edge, {0, 1, 6 + 4, 6 + 7}}, NodePair{PairKind::vertex_face, {6 + 4, 3, 4, 5}}}) {
    const Closest near = closest(pair, nodes);
    const Vec3 way = between(pair, near), normal = contact_normal(world, pair, near.weights, way, nodes);
    const double up = pair.kind == PairKind::edge_edge ? 1 : -1;  // from the second primitive toward the first
    INFO("between " << way.transpose() << ", normal " << normal.transpose());
    CHECK(std::abs(way.normalized().y()) < 0.999);
    CHECK((normal - up * Vec3::UnitY()).norm() < 1e-12);
  }
}

TEST_CASE("contact normal: over a ridge it stays what it is within the cone of its faces", "[frictionless]") {
  Points x(8, 3);  // a roof along z, and an edge across its ridge that leans a little
  x << 0, 0, -1, 0, 0, 1, -1, -1, 0, 1, -1, 0, -0.3, 0.01, 0.1, 0.3, 0.05, -0.1, 0, 0.5, 0, 9, 9, 9;
  Triangles roof(2, 3), cloth(1, 3);
  roof << 0, 1, 2, 1, 0, 3;
  cloth << 0, 1, 2;
  const Surface body = make_surface(4, roof), sheet = make_surface(3, cloth);
  const ContactWorld world = make_contact_world(sheet, {&body}, true);
  const Points nodes = gather_nodes(x.middleRows(4, 3), {x.topRows(4)});
  const NodePair pair{PairKind::edge_edge, {0, 1, 3, 4}};
  const Closest near = closest(pair, nodes);
  Vec3 way = Vec3::Zero();
  for (int i = 0; i < 4; ++i) way += near.weights[i] * row(nodes, pair.nodes[static_cast<std::size_t>(i)]);
  CHECK((contact_normal(world, pair, near.weights, way, nodes) - way.normalized()).norm() < 1e-12);
}

}  // namespace selvedge::test_frictionless
