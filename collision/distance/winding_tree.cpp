#include "collision/distance/winding_tree.hpp"

#include <cmath>
#include <numbers>

namespace selvedge {
namespace {

constexpr double far_away = 2.5;  // in radii of a node: beyond, it counts as a dipole
constexpr double unclear = 0.1;   // range round 1/2 in which a sum with dipoles does not decide

// Solid angle of the triangle with corners a, b, c relative to the viewer, positive if seen from behind, in [-2 pi, 2
// pi] (van Oosterom and Strackee 1983). On the triangle itself it is +-2 pi, and the sign means nothing.
double solid_angle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  return 2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

// The part of one triangle in the winding number.
double winding_of(const Surface& surface, const Points& x, int t, const Vec3& p) {
  const Vec3 a = row(x, surface.triangles(t, 0)) - p, b = row(x, surface.triangles(t, 1)) - p;
  const Vec3 c = row(x, surface.triangles(t, 2)) - p;
  return solid_angle(a, b, c) / (4 * std::numbers::pi);
}

WindingTree::Node node_of_leaf(const Bvh::Leaf& leaf, const Surface& surface, const Points& x, double& weight) {
  WindingTree::Node node{Vec3::Zero(), Vec3::Zero(), 0};
  weight = 0;
  for (const int t : leaf.item) {
    if (t < 0) continue;
    const Vec3 a = row(x, surface.triangles(t, 0)), b = row(x, surface.triangles(t, 1));
    const Vec3 c = row(x, surface.triangles(t, 2)), area = 0.5 * (b - a).cross(c - a);
    const double size = area.norm();
    node.area += area;
    node.centre += size / 3 * (a + b + c);
    weight += size;
  }
  return node;
}

}  // namespace

WindingTree make_winding_tree(const Bvh& tree, const Surface& surface, const Points& x) {
  WindingTree made;
  made.nodes.resize(tree.nodes.size());
  std::vector<double> weight(tree.nodes.size(), 0);
  for (int i = static_cast<int>(tree.nodes.size()) - 1; i >= 0; --i) {  // children come after their parents
    WindingTree::Node& node = made.nodes[i];
    const int child = tree.nodes[i].child;
    if (child < 0) {
      node = node_of_leaf(tree.leaves[~child], surface, x, weight[i]);
    } else {
      weight[i] = weight[child] + weight[child + 1];
      node.area = made.nodes[child].area + made.nodes[child + 1].area;
      node.centre = weight[child] * made.nodes[child].centre + weight[child + 1] * made.nodes[child + 1].centre;
    }
    const Box& box = tree.nodes[i].box;
    if (weight[i] > 0)
      node.centre /= weight[i];
    else
      for (int k = 0; k < 3; ++k) node.centre[k] = 0.5 * (static_cast<double>(box.lo[k]) + box.hi[k]);
    node.radius = farthest_corner(box, node.centre);
  }
  return made;
}

double exact_winding(const Surface& surface, const Points& x, const Vec3& p) {
  double sum = 0;
  for (int t = 0; t < surface.triangles.rows(); ++t) sum += winding_of(surface, x, t, p);
  return sum;
}

bool winds_round(const WindingTree& windings, const Bvh& tree, const Surface& surface, const Points& x, const Vec3& p) {
  double sum = 0;
  std::vector<int> stack{0};
  while (!stack.empty()) {
    const int i = stack.back();
    stack.pop_back();
    const WindingTree::Node& node = windings.nodes[i];
    const Vec3 away = node.centre - p;
    const double distance = away.norm();
    const int child = tree.nodes[i].child;
    if (distance > far_away * node.radius) {
      sum += node.area.dot(away) / (4 * std::numbers::pi * distance * distance * distance);
    } else if (child >= 0) {
      stack.push_back(child);
      stack.push_back(child + 1);
    } else {
      for (const int t : tree.leaves[~child].item)
        if (t >= 0) sum += winding_of(surface, x, t, p);
    }
  }
  if (std::abs(sum - 0.5) < unclear) sum = exact_winding(surface, x, p);
  return sum > 0.5;
}

}  // namespace selvedge
