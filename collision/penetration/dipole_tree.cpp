#include "collision/penetration/dipole_tree.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "collision/geometry/solid_angle.hpp"

namespace selvedge {
namespace {

// The principal value: 0 from within the triangle's plane.
double principal_angle(const std::array<Vec3, 3>& triangle, const Vec3& at) {
  const Vec3 a = triangle[0] - at, b = triangle[1] - at, c = triangle[2] - at;
  return a.dot(b.cross(c)) == 0 ? 0 : solid_angle(a, b, c);
}

double seen_from(const Vec3& moment, const Vec3& to) {
  const double square = to.squaredNorm();
  return moment.dot(to) / (square * std::sqrt(square));
}

// What a node adds at a point, if that is far enough away.
bool add_node(const DipoleTree::SpreadDipole& node, const Vec3& at, double& sum) {
  const Vec3 to = node.centre - at;
  const double x = to[0], y = to[1], z = to[2], square = x * x + y * y + z * z;
  if (!(square > node.reach_squared)) return false;
  const std::array<double, 6>& s = node.spread;
  const double spread = x * (s[0] * x + s[5] * y) + y * (s[1] * y + s[3] * z) + z * (s[2] * z + s[4] * x);
  const double nearness = 1 / square;
  sum += (node.moment.dot(to) + node.trace - 3 * nearness * spread) * (nearness * std::sqrt(nearness));
  return true;
}

// The same of a face.
bool add_face(const DipoleTree& tree, int item, const Vec3& at, double& sum) {
  const DipoleTree::Dipole& dipole = tree.of_faces[item];
  const Vec3 to = dipole.centre - at;
  const double square = to.squaredNorm();
  if (!(square > dipole.reach_squared)) return false;
  if (square > 4 * dipole.reach_squared) {
    sum += seen_from(dipole.moment, to);
    return true;
  }
  const auto& [a, b, c] = tree.corners[item];
  const Vec3 third = dipole.moment / 3;
  sum += seen_from(third, (a + b) / 2 - at) + seen_from(third, (b + c) / 2 - at) + seen_from(third, (c + a) / 2 - at);
  return true;
}

// About the origin of the surface.
struct DipoleSum {
  double area = 0;
  Vec3 centre = Vec3::Zero(), moment = Vec3::Zero();
  Mat3 spread = Mat3::Zero();
};

void add_triangle(const std::array<Vec3, 3>& t, const Vec3& origin, DipoleSum& sum) {
  const Vec3 normal = 0.5 * (t[1] - t[0]).cross(t[2] - t[0]);
  const double area = normal.norm();
  const Vec3 middle = (t[0] + t[1] + t[2]) / 3 - origin;
  sum.area += area;
  sum.centre += area * middle;
  sum.moment += normal;
  sum.spread += middle * normal.transpose();
}

// Sums of a node from those of what is below it; children stand behind their parents.
std::vector<DipoleSum> sums_of(const DipoleTree& tree, const Vec3& origin) {
  std::vector<DipoleSum> sums(tree.bvh.nodes.size());
  for (std::size_t i = sums.size(); i-- > 0;) {
    const int child = tree.bvh.nodes[i].child;
    if (child < 0) {
      for (const int item : tree.bvh.leaves[~child].item)
        if (item >= 0) add_triangle(tree.corners[item], origin, sums[i]);
      continue;
    }
    for (const int c : {child, child + 1}) {
      sums[i].area += sums[c].area;
      sums[i].centre += sums[c].centre;
      sums[i].moment += sums[c].moment;
      sums[i].spread += sums[c].spread;
    }
  }
  return sums;
}

void add_nodes(DipoleTree& tree) {
  const Vec3 origin = tree.corners.front()[0];
  const std::vector<DipoleSum> sums = sums_of(tree, origin);
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const Bvh::Node& node = tree.bvh.nodes[i];
    const Box& box = node.box;
    DipoleTree::SpreadDipole& dipole = tree.nodes.emplace_back();
    dipole.child = node.child;
    dipole.centre = sums[i].area > 0 ? Vec3(origin + sums[i].centre / sums[i].area)
                                     : 0.5 * Vec3(box.lo[0] + box.hi[0], box.lo[1] + box.hi[1], box.lo[2] + box.hi[2]);
    dipole.moment = sums[i].moment / (4 * std::numbers::pi);
    const double reach = tree.far * farthest_corner(box, dipole.centre);
    dipole.reach_squared = reach * reach;
    const Mat3 spread =
        (sums[i].spread - (dipole.centre - origin) * sums[i].moment.transpose()) / (4 * std::numbers::pi);
    dipole.trace = spread.trace();
    dipole.spread = {spread(0, 0),
                     spread(1, 1),
                     spread(2, 2),
                     spread(1, 2) + spread(2, 1),
                     spread(2, 0) + spread(0, 2),
                     spread(0, 1) + spread(1, 0)};
  }
}

}  // namespace

DipoleTree make_dipole_tree(const Surface& surface, const Points& x, const std::vector<int>& faces,
                            const std::vector<signed char>& turn, double far) {
  DipoleTree tree;
  tree.far = far;
  tree.faces = faces;
  std::vector<Box> boxes;
  for (const int t : faces) {
    const auto at = [&](int k) { return row(x, surface.triangles(t, k)); };
    tree.corners.push_back(turn[t] > 0 ? std::array{at(0), at(1), at(2)} : std::array{at(0), at(2), at(1)});
    Box box = empty_box;
    for (const Vec3& corner : tree.corners.back()) box = join(box, moving_point_box(corner, corner, 0));
    boxes.push_back(box);
  }
  for (const std::array<Vec3, 3>& corner : tree.corners) {
    DipoleTree::Dipole& dipole = tree.of_faces.emplace_back();
    dipole.centre = (corner[0] + corner[1] + corner[2]) / 3;
    dipole.moment = (corner[1] - corner[0]).cross(corner[2] - corner[0]) / (8 * std::numbers::pi);
    for (const Vec3& at : corner)
      dipole.reach_squared = std::max(dipole.reach_squared, far * far * (at - dipole.centre).squaredNorm());
  }
  tree.bvh = build_bvh(boxes);
  if (!faces.empty()) add_nodes(tree);
  return tree;
}

double winding_number(const DipoleTree& tree, const Vec3& at, int left_out) {
  if (tree.faces.empty()) return 0;
  double far = 0, angle = 0;
  std::array<int, 128> stack;
  int size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const DipoleTree::SpreadDipole& node = tree.nodes[stack[--size]];
    if (add_node(node, at, far)) continue;
    const int child = node.child;
    if (child >= 0) {
      stack[size++] = child;
      stack[size++] = child + 1;
      continue;
    }
    for (const int item : tree.bvh.leaves[~child].item)
      if (item >= 0 && tree.faces[item] != left_out && !add_face(tree, item, at, far))
        angle += principal_angle(tree.corners[item], at);
  }
  return far + angle / (4 * std::numbers::pi);
}

}  // namespace selvedge
