#include <catch2/catch.hpp>

#include <algorithm>
#include <limits>
#include <random>

#include "collision/search/bvh.hpp"
#include "tests/threads.hpp"

namespace selvedge::test_bvh {

using Pairs = std::vector<std::pair<int, int>>;

namespace {

struct Mesh {
  Surface surface;
  Points x;
};

Mesh soup(int count, std::mt19937& random) {
  std::uniform_real_distribution<double> place(-1, 1), size(-0.1, 0.1);
  Points x(3 * count, 3);
  Triangles triangles(count, 3);
  for (int t = 0; t < count; ++t) {
    const Vec3 centre(place(random), place(random), place(random));
    for (int k = 0; k < 3; ++k)
      x.row(3 * t + k) = (centre + Vec3(size(random), size(random), size(random))).transpose();
    triangles.row(t) << 3 * t, 3 * t + 1, 3 * t + 2;
  }
  return {make_surface(3 * count, triangles), x};
}

// n x n squares of a sheet folded in half along the middle.
Mesh folded_grid(int n) {
  Points x((n + 1) * (n + 1), 3);
  Triangles triangles(2 * n * n, 3);
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j) {
      const double along = static_cast<double>(i) / n;
      x.row(i * (n + 1) + j) << std::min(along, 1 - along), along < 0.5 ? 0 : 0.004, static_cast<double>(j) / n;
    }
  for (int i = 0, t = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const int a = i * (n + 1) + j;
      triangles.row(t++) << a, a + 1, a + n + 1;
      triangles.row(t++) << a + 1, a + n + 2, a + n + 1;
    }
  return {make_surface((n + 1) * (n + 1), triangles), x};
}

Pairs sorted(Pairs pairs) {
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

Pairs brute_self(const std::vector<Box>& boxes) {
  Pairs pairs;
  for (int i = 0; i < static_cast<int>(boxes.size()); ++i)
    for (int j = i + 1; j < static_cast<int>(boxes.size()); ++j)
      if (overlap(boxes[i], boxes[j])) pairs.emplace_back(i, j);
  return pairs;
}

Pairs brute_cross(const std::vector<Box>& a, const std::vector<Box>& b) {
  Pairs pairs;
  for (int i = 0; i < static_cast<int>(a.size()); ++i)
    for (int j = 0; j < static_cast<int>(b.size()); ++j)
      if (overlap(a[i], b[j])) pairs.emplace_back(i, j);
  return pairs;
}

void check_against_brute(const Bvh& a, const std::vector<Box>& boxes_a, const Bvh& b, const std::vector<Box>& boxes_b) {
  Pairs pairs{{7, 7}};
  self_pairs(a, pairs);
  CHECK(sorted(pairs) == brute_self(boxes_a));
  cross_pairs(a, b, pairs);
  CHECK(sorted(pairs) == brute_cross(boxes_a, boxes_b));
}

bool holds(const Box& outer, const Box& inner) {
  bool all = true;
  for (int axis = 0; axis < 3; ++axis) all &= outer.lo[axis] <= inner.lo[axis] && outer.hi[axis] >= inner.hi[axis];
  return all;
}

void check_order_and_boxes(const Bvh& tree, const std::vector<Box>& boxes) {
  std::vector<int> seen(tree.item_count, 0);
  int wrong = 0;
  for (int k = 0; k < static_cast<int>(tree.nodes.size()); ++k) {
    const Bvh::Node& node = tree.nodes[k];
    if (node.child < 0) {
      CHECK(~node.child == node.first);
      for (const int item : tree.leaves[~node.child].item) {
        if (item < 0) continue;
        ++seen[item];
        wrong += !holds(node.box, boxes[item]);
      }
      continue;
    }
    wrong += node.child <= k || tree.nodes[node.child].first != node.first;
    for (int child : {node.child, node.child + 1}) wrong += !holds(node.box, tree.nodes[child].box);
  }
  CHECK(wrong == 0);
  CHECK(std::all_of(seen.begin(), seen.end(), [](int times) { return times == 1; }));
}

}  // namespace

TEST_CASE("bvh: the tree finds the pairs that brute force finds, also after a refit", "[bvh]") {
  std::mt19937 random(3);
  for (Mesh mesh : {soup(400, random), folded_grid(20), soup(1, random), soup(2, random), soup(8, random),
                    soup(9, random), soup(33, random), soup(67, random), soup(1031, random)}) {
    const Mesh other = soup(300, random);
    std::vector<Box> boxes, other_boxes;
    triangle_boxes(mesh.surface, mesh.x, mesh.x, 0.003, boxes);
    triangle_boxes(other.surface, other.x, other.x, 0.003, other_boxes);
    Bvh tree = build_bvh(boxes);
    const Bvh other_tree = build_bvh(other_boxes);
    check_order_and_boxes(tree, boxes);
    check_against_brute(tree, boxes, other_tree, other_boxes);

    const double cost = bvh_cost(tree);
    std::uniform_real_distribution<double> push(-0.1, 0.1);
    Points moved = mesh.x;
    for (double& coordinate : moved.reshaped()) coordinate += push(random);
    triangle_boxes(mesh.surface, mesh.x, moved, 0.003, boxes);
    refit(tree, boxes);
    check_order_and_boxes(tree, boxes);
    check_against_brute(tree, boxes, other_tree, other_boxes);
    if (mesh.surface.triangles.rows() == 800) CHECK(bvh_cost(tree) > cost);
  }
}

TEST_CASE("bvh: coincident items, no items and undefined items", "[bvh]") {
  const std::vector<Box> same(50, Box{{0, 0, 0}, {1, 1, 1}});
  Pairs pairs;
  self_pairs(build_bvh(same), pairs);
  CHECK(pairs.size() == 50 * 49 / 2);
  self_pairs(build_bvh({}), pairs);
  CHECK(pairs.empty());
  cross_pairs(build_bvh({}), build_bvh(same), pairs);
  CHECK(pairs.empty());
  CHECK(bvh_cost(build_bvh({})) == 0);

  std::mt19937 random(4);
  Mesh mesh = soup(100, random);
  mesh.x(30, 1) = std::numeric_limits<double>::quiet_NaN();
  mesh.x(60, 0) = std::numeric_limits<double>::infinity();
  mesh.x(90, 2) = -1e300;
  std::vector<Box> boxes;
  triangle_boxes(mesh.surface, mesh.x, mesh.x, 0.05, boxes);
  self_pairs(build_bvh(boxes), pairs);
  CHECK(sorted(pairs) == brute_self(boxes));
  CHECK(std::none_of(pairs.begin(), pairs.end(), [](auto pair) { return pair.first == 10 || pair.second == 10; }));
}

TEST_CASE("bvh: boxes round outward", "[bvh]") {
  std::mt19937 random(5);
  const Mesh mesh = soup(200, random);
  const Points moved = mesh.x.array() * 1.1;
  for (double radius : {0.0, 1e-3}) {
    std::vector<Box> boxes;
    triangle_boxes(mesh.surface, mesh.x, moved, radius, boxes);
    int lost = 0, loose = 0;
    for (int t = 0; t < 200; ++t)
      for (int k = 0; k < 3; ++k) {
        double lo = 1e9, hi = -1e9;
        for (int corner = 0; corner < 3; ++corner)
          for (const Points* x : {&mesh.x, &moved}) {
            lo = std::min(lo, (*x)(mesh.surface.triangles(t, corner), k));
            hi = std::max(hi, (*x)(mesh.surface.triangles(t, corner), k));
          }
        lost += boxes[t].lo[k] > lo - radius || boxes[t].hi[k] < hi + radius;
        loose += boxes[t].lo[k] < lo - radius - 1e-6 || boxes[t].hi[k] > hi + radius + 1e-6;
      }
    CHECK(lost == 0);
    CHECK(loose == 0);
  }
}

TEST_CASE("bvh: the order of pairs does not depend on the number of threads", "[bvh][threads]") {
  std::mt19937 random(6);
  const Mesh mesh = folded_grid(40), other = soup(500, random);
  std::vector<Box> boxes, other_boxes;
  triangle_boxes(mesh.surface, mesh.x, mesh.x, 0.01, boxes);
  triangle_boxes(other.surface, other.x, other.x, 0.01, other_boxes);
  const Bvh tree = build_bvh(boxes), other_tree = build_bvh(other_boxes);
  std::vector<Pairs> self(3), cross(3);
  for (int n = 1; n <= 3; ++n) {
    with_threads(n, [&] {
      self_pairs(tree, self[n - 1]);
      cross_pairs(tree, other_tree, cross[n - 1]);
    });
  }
  CHECK(!self[0].empty());
  CHECK(!cross[0].empty());
  CHECK(self[0] == self[1]);
  CHECK(self[0] == self[2]);
  CHECK(cross[0] == cross[1]);
  CHECK(cross[0] == cross[2]);
}

}  // namespace selvedge::test_bvh
