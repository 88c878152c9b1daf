#include "collision/penetration/dipole_tree.hpp"

#include <array>
#include <numbers>

#include "collision/geometry/parallel.hpp"

namespace selvedge {
namespace {

// Sums about a common origin.
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

// The sums of each node from those of its children, which come after their parents.
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
  tree.of_faces.resize(faces.size());
  tree.corners.resize(faces.size());
  std::vector<Box> boxes(faces.size(), empty_box);
  parallel_for(static_cast<int>(faces.size()), 512, [&](int i) {
    const int t = faces[i];
    const auto corner = [&](int k) { return row(x, surface.triangles(t, k)); };
    tree.corners[i] =
        turn[t] > 0 ? std::array{corner(0), corner(1), corner(2)} : std::array{corner(0), corner(2), corner(1)};
    const auto& [a, b, c] = tree.corners[i];
    DipoleTree::Dipole& dipole = tree.of_faces[i];
    dipole.centre = (a + b + c) / 3;
    dipole.moment = (b - a).cross(c - a) / (8 * std::numbers::pi);
    for (const Vec3& at : tree.corners[i]) {
      dipole.reach_squared = std::max(dipole.reach_squared, far * far * (at - dipole.centre).squaredNorm());
      boxes[i] = join(boxes[i], moving_point_box(at, at, 0));
    }
  });
  tree.bvh = build_bvh(boxes);
  if (!faces.empty()) add_nodes(tree);
  return tree;
}

}  // namespace selvedge
