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

// What a dipole adds at a point, if that is far enough away.
bool add_if_far(const DipoleTree::Dipole& dipole, const Vec3& at, double far, double& sum) {
  const Vec3 to = dipole.centre - at;
  const double square = to.squaredNorm(), reach = far * dipole.radius;
  if (!(square > reach * reach)) return false;
  sum += dipole.moment.dot(to) / (square * std::sqrt(square));
  return true;
}

struct DipoleSum {
  double area = 0;
  Vec3 centre = Vec3::Zero(), moment = Vec3::Zero();
};

void add_triangle(const std::array<Vec3, 3>& t, DipoleSum& sum) {
  const Vec3 normal = 0.5 * (t[1] - t[0]).cross(t[2] - t[0]);
  const double area = normal.norm();
  sum.area += area;
  sum.centre += area / 3 * (t[0] + t[1] + t[2]);
  sum.moment += normal;
}

// Sums of a node from those of what is below it; children stand behind their parents.
std::vector<DipoleSum> sums_of(const DipoleTree& tree) {
  std::vector<DipoleSum> sums(tree.bvh.nodes.size());
  for (std::size_t i = sums.size(); i-- > 0;) {
    const int child = tree.bvh.nodes[i].child;
    if (child < 0) {
      for (const int item : tree.bvh.leaves[~child].item)
        if (item >= 0) add_triangle(tree.corners[item], sums[i]);
      continue;
    }
    for (const int c : {child, child + 1}) {
      sums[i].area += sums[c].area;
      sums[i].centre += sums[c].centre;
      sums[i].moment += sums[c].moment;
    }
  }
  return sums;
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
    for (const Vec3& at : corner) dipole.radius = std::max(dipole.radius, (at - dipole.centre).norm());
  }
  tree.bvh = build_bvh(boxes);
  if (faces.empty()) return tree;
  const std::vector<DipoleSum> sums = sums_of(tree);
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const Box& box = tree.bvh.nodes[i].box;
    DipoleTree::Dipole dipole;
    dipole.centre = sums[i].area > 0 ? Vec3(sums[i].centre / sums[i].area)
                                     : 0.5 * Vec3(box.lo[0] + box.hi[0], box.lo[1] + box.hi[1], box.lo[2] + box.hi[2]);
    dipole.moment = sums[i].moment / (4 * std::numbers::pi);
    dipole.radius = farthest_corner(box, dipole.centre);
    tree.dipoles.push_back(dipole);
  }
  return tree;
}

double winding_number(const DipoleTree& tree, const Vec3& at, int left_out) {
  if (tree.faces.empty()) return 0;
  double far = 0, angle = 0;
  std::array<int, 128> stack;
  int size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const int node = stack[--size], child = tree.bvh.nodes[node].child;
    if (add_if_far(tree.dipoles[node], at, tree.far, far)) continue;
    if (child >= 0) {
      stack[size++] = child;
      stack[size++] = child + 1;
      continue;
    }
    for (const int item : tree.bvh.leaves[~child].item)
      if (item >= 0 && tree.faces[item] != left_out && !add_if_far(tree.of_faces[item], at, 2 * tree.far, far))
        angle += principal_angle(tree.corners[item], at);
  }
  return far + angle / (4 * std::numbers::pi);
}

}  // namespace selvedge
