#include "collision/search/nearest_face.hpp"

#include <algorithm>
#include <utility>

#include "collision/geometry/corners.hpp"
#include "collision/geometry/distance.hpp"

namespace selvedge {
namespace {

double squared_distance(const Box& box, const Vec3& p) {
  double sum = 0;
  for (int k = 0; k < 3; ++k) {
    const double out = std::max({static_cast<double>(box.lo[k]) - p[k], p[k] - static_cast<double>(box.hi[k]), 0.0});
    sum += out * out;
  }
  return sum;
}

void take_nearer(const Surface& surface, const Points& x, int t, const Vec3& p, NearestFace& nearest) {
  const int i = surface.triangles(t, 0), j = surface.triangles(t, 1), k = surface.triangles(t, 2);
  const Closest closest = point_triangle(p, row(x, i), row(x, j), row(x, k));
  if (closest.squared_distance < nearest.squared_distance)
    nearest = {t, closest.squared_distance, {-closest.weights[1], -closest.weights[2], -closest.weights[3]}};
}

}  // namespace

FaceTree make_face_tree(const Surface& surface, const Points& x, std::vector<int> faces) {
  std::vector<Box> boxes;
  for (const int t : faces) {
    const auto [a, b, c] = corners_of(surface, x, t);
    boxes.push_back(hull(moving_point_box(a, a, 0), moving_point_box(b, b, 0), moving_point_box(c, c, 0)));
  }
  return {&surface, &x, std::move(faces), build_bvh(boxes)};
}

NearestFace nearest_face(const FaceTree& tree, int own_vertex, const Vec3& p) {
  return nearest_face(tree, p, std::numeric_limits<double>::infinity(), [&](int t) {
    const auto corners = tree.surface->triangles.row(t);
    return corners[0] != own_vertex && corners[1] != own_vertex && corners[2] != own_vertex;
  });
}

NearestFace nearest_face(const FaceTree& tree, const Vec3& p, double within, const std::function<bool(int)>& counts) {
  NearestFace nearest;
  nearest.squared_distance = within * within;
  std::vector<int> stack;
  if (!tree.faces.empty()) stack.push_back(0);
  while (!stack.empty()) {
    const Bvh::Node& node = tree.bvh.nodes[stack.back()];
    stack.pop_back();
    if (squared_distance(node.box, p) >= nearest.squared_distance) continue;
    if (node.child >= 0) {
      const double first = squared_distance(tree.bvh.nodes[node.child].box, p);
      const double second = squared_distance(tree.bvh.nodes[node.child + 1].box, p);
      stack.push_back(first < second ? node.child + 1 : node.child);
      stack.push_back(first < second ? node.child : node.child + 1);
      continue;
    }
    for (const int item : tree.bvh.leaves[~node.child].item)
      if (item >= 0 && counts(tree.faces[item])) take_nearer(*tree.surface, *tree.x, tree.faces[item], p, nearest);
  }
  return nearest;
}

}  // namespace selvedge
