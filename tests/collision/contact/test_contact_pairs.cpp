#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "collision/contact/contact_pairs.hpp"
#include "tests/collision/sheets.hpp"

namespace selvedge::test_contact_pairs {

using testing::join;
using testing::Sheet;
using testing::sheet;

namespace {

double distance(const NodePair& pair, const Points& x) { return std::sqrt(closest(pair, x).squared_distance); }

std::vector<NodePair> every_pair(const Surface& s) {
  std::vector<NodePair> all;
  for (int v = 0; v < s.vertex_count; ++v)
    for (int t = 0; t < s.triangles.rows(); ++t) {
      const auto f = s.triangles.row(t);
      if (v != f(0) && v != f(1) && v != f(2)) all.push_back({PairKind::vertex_face, {v, f(0), f(1), f(2)}});
    }
  for (int a = 0; a < s.edges.rows(); ++a)
    for (int b = 0; b < a; ++b) {
      const int a0 = s.edges(a, 0), a1 = s.edges(a, 1), b0 = s.edges(b, 0), b1 = s.edges(b, 1);
      if (a0 != b0 && a0 != b1 && a1 != b0 && a1 != b1) all.push_back({PairKind::edge_edge, {a0, a1, b0, b1}});
    }
  return all;
}

NodePair canonical(NodePair p) {
  auto& n = p.nodes;
  if (p.kind == PairKind::edge_edge && std::pair(n[2], n[3]) < std::pair(n[0], n[1])) {
    std::swap(n[0], n[2]);
    std::swap(n[1], n[3]);
  }
  return p;
}

}  // namespace

TEST_CASE("contact pairs: none that comes near on its way is missed, none is listed twice", "[contact_pairs]") {
  auto cloth = join(sheet(5, 1, 0), sheet(4, 1, 0.1));
  const Surface surface = make_surface(static_cast<int>(cloth.x.rows()), cloth.triangles);
  const ContactWorld world = make_contact_world(surface, {}, true);
  std::mt19937 random(7);
  std::normal_distribution<double> normal(0, 0.15);
  PairSearch search(world);
  std::vector<NodePair> found;
  const double radius = 0.05;
  for (int trial = 0; trial < 5; ++trial) {
    Points x0 = cloth.x, x1 = cloth.x;
    for (Eigen::Index i = 0; i < x0.size(); ++i) {
      x0.data()[i] += 0.3 * normal(random);
      x1.data()[i] += normal(random);
    }
    search.find(x0, x1, radius, found);
    std::set<NodePair> listed;
    for (const NodePair& pair : found) CHECK(listed.insert(canonical(pair)).second);
    int near = 0;
    for (const NodePair& pair : every_pair(surface))
      for (int k = 0; k <= 8; ++k)
        if (distance(pair, x0 + k / 8.0 * (x1 - x0)) < radius) {
          ++near;
          CHECK(listed.count(canonical(pair)) == 1);
          break;
        }
    CHECK(near > 50);
  }
}

TEST_CASE("contact pairs: what flies far together is not paired for it", "[contact_pairs]") {
  const auto cloth = sheet(12, 1, 0);
  const Surface surface = make_surface(static_cast<int>(cloth.x.rows()), cloth.triangles);
  const ContactWorld world = make_contact_world(surface, {}, true);
  PairSearch search(world);
  std::vector<NodePair> still, flying;
  search.find(cloth.x, cloth.x, 0.02, still);
  const Points there = cloth.x.rowwise() + Eigen::RowVector3d(1.3, -0.9, 2);
  search.find(cloth.x, there, 0.02, flying);
  CHECK(flying.size() <= still.size());
  CHECK_FALSE(flying.empty());
}

TEST_CASE("contact pairs: the same pairs whatever came before", "[contact_pairs]") {
  const auto cloth = sheet(6, 1, 0.02);
  const auto ground = sheet(3, 2, 0);
  const Surface cloth_surface = make_surface(static_cast<int>(cloth.x.rows()), cloth.triangles);
  const Surface ground_surface = make_surface(static_cast<int>(ground.x.rows()), ground.triangles);
  const ContactWorld world = make_contact_world(cloth_surface, {&ground_surface}, true);
  CHECK(world.obstacle_of(0) == -1);
  CHECK(world.obstacle_of(cloth_surface.vertex_count) == 0);
  const Points nodes = gather_nodes(cloth.x, {ground.x});
  Points moved = nodes;
  moved.topRows(20).array() += 0.3;
  std::vector<NodePair> fresh, used;
  PairSearch first(world), second(world);
  first.find(nodes, nodes, 0.04, fresh);
  second.find(moved, nodes, 0.04, used);
  second.find(moved, moved, 0.04, used);
  second.find(nodes, nodes, 0.04, used);
  std::sort(fresh.begin(), fresh.end());
  std::sort(used.begin(), used.end());
  CHECK(fresh == used);
  CHECK(std::any_of(fresh.begin(), fresh.end(), [&](const NodePair& p) { return !world.is_cloth(p.nodes[3]); }));
}

TEST_CASE("contact pairs: a search for marked nodes finds what has one, and nothing else", "[contact_pairs]") {
  const auto cloth = sheet(9, 1, 0.02), ground = sheet(5, 1.5, 0);
  const Surface cloth_surface = make_surface(static_cast<int>(cloth.x.rows()), cloth.triangles);
  const Surface ground_surface = make_surface(static_cast<int>(ground.x.rows()), ground.triangles);
  const ContactWorld world = make_contact_world(cloth_surface, {&ground_surface}, true);
  const Points from = gather_nodes(cloth.x, {ground.x});
  // Still, and in a motion so long that boxes at both ends take part.
  const int marked_node = GENERATE(0, 37, 99, 105);  // corners and the inside of the cloth, and the ground
  const double way = GENERATE(0.0, 0.3);
  const Points to = from.rowwise() + Eigen::RowVector3d(way, 0, 0.5 * way);
  std::vector<char> marks(static_cast<std::size_t>(from.rows()), 0);
  marks[marked_node] = 1;
  PairSearch whole(world), search(world);
  std::vector<NodePair> all, some, then_all;
  whole.find(from, to, 0.04, all);
  search.find(from, to, 0.04, some, marks);  // fills in boxes near the marked node alone
  search.find(from, to, 0.04, then_all);
  std::sort(then_all.begin(), then_all.end());
  std::sort(all.begin(), all.end());
  CHECK(then_all == all);
  std::erase_if(all,
                [&](const NodePair& pair) { return std::ranges::find(pair.nodes, marked_node) == pair.nodes.end(); });
  std::sort(some.begin(), some.end());
  CHECK(all.size() > 3);
  CHECK(some == all);
}

TEST_CASE("contact pairs: none with an obstacle is missed wherever the cloth goes over it", "[contact_pairs]") {
  const auto cloth = sheet(3, 0.3, 0);
  Sheet ground = sheet(20, 3, 0);  // a tree of many leaves, of which the cloth is near a few
  for (Eigen::Index v = 0; v < ground.x.rows(); ++v) ground.x(v, 1) = 0.05 * std::sin(7.0 * static_cast<double>(v));
  const Surface cloth_surface = make_surface(static_cast<int>(cloth.x.rows()), cloth.triangles);
  const Surface ground_surface = make_surface(static_cast<int>(ground.x.rows()), ground.triangles);
  const ContactWorld world = make_contact_world(cloth_surface, {&ground_surface}, true);
  const auto n = cloth.x.rows();
  const double radius = 0.04;
  PairSearch kept(world);
  const double ground_way = GENERATE(0.0, 0.2);  // it stands still, so that its boxes are kept, or not
  std::vector<NodePair> away;
  Points high = gather_nodes(cloth.x, {ground.x});
  high.topRows(n).col(1).array() += 5;
  const Points on = high.rowwise() + Eigen::RowVector3d(1, 0, 0);
  kept.find(high, on, radius, away);
  CHECK(std::ranges::all_of(away, [&](const NodePair& pair) { return world.is_cloth(pair.nodes[3]); }));
  for (int place = 0; place < 6; ++place) {
    Points from = gather_nodes(cloth.x, {ground.x}), to = from;
    const double a = 0.3 * (place % 3) * place, b = place % 2 ? 0.35 : 0.0;  // boxes at both ends where it goes far
    from.topRows(n).rowwise() += Eigen::RowVector3d(std::cos(a), 0.1, std::sin(a));
    to.topRows(n) = from.topRows(n).rowwise() + Eigen::RowVector3d(b, -0.08, b);
    to.bottomRows(ground.x.rows()).col(0).array() += ground_way;
    std::vector<NodePair> found, fresh;
    kept.find(from, to, radius, found);
    PairSearch(world).find(from, to, radius, fresh);
    std::ranges::sort(fresh);
    std::ranges::sort(found);
    CHECK(found == fresh);
    int near = 0;
    for (int v = 0; v < n; ++v)
      for (const auto& f : ground_surface.triangles.rowwise()) {
        const int first = world.first_node[0];
        const NodePair pair{PairKind::vertex_face, {v, f[0] + first, f[1] + first, f[2] + first}};
        if ((from.row(v) - from.row(pair.nodes[1])).norm() > 0.9) continue;
        const auto gap = [&](double t) {
          std::array<Vec3, 4> x;
          for (int i = 0; i < 4; ++i) x[i] = (1 - t) * row(from, pair.nodes[i]) + t * row(to, pair.nodes[i]);
          return std::sqrt(closest(pair.kind, x).squared_distance);
        };
        bool comes_near = false;
        for (int k = 0; k <= 8; ++k) comes_near = comes_near || gap(k / 8.0) < radius;
        if (!comes_near) continue;
        ++near;
        CHECK(std::ranges::binary_search(found, pair));
      }
    CHECK(near > 10);
  }
}

}  // namespace selvedge::test_contact_pairs
