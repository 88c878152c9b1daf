#include "learned/graph/cloth_pairs.hpp"

#include <algorithm>
#include <cmath>

namespace selvedge {
namespace {

// The first corner if it is nearer than both others. Else the nearer of these, or the third if they tie.
int nearest_of(const int* corner, const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const double to_a = (p - a).squaredNorm(), to_b = (p - b).squaredNorm(), to_c = (p - c).squaredNorm();
  if (to_a < to_b && to_a < to_c) return corner[0];
  return to_b < to_c ? corner[1] : corner[2];
}

void add_if_close(const Surface& surface, const Points& x, int vertex, int face, double radius,
                  std::vector<ClothPair>& found) {
  const int* corner = surface.triangles.data() + 3 * face;
  if (corner[0] == vertex || corner[1] == vertex || corner[2] == vertex) return;
  const Vec3 p = row(x, vertex), a = row(x, corner[0]), b = row(x, corner[1]), c = row(x, corner[2]);
  const Foot foot = foot_on(p, a, b, c);
  const double height = std::abs(foot.height);
  if (foot.inside && height <= radius) found.push_back({vertex, face, nearest_of(corner, p, a, b, c), 0, height});
}

auto place_of(const ClothPair& pair) { return std::pair(pair.vertex, pair.face); }

void sort_by_place(std::vector<ClothPair>& pairs) {
  std::sort(pairs.begin(), pairs.end(), [](const auto& a, const auto& b) { return place_of(a) < place_of(b); });
}

}  // namespace

SheetView refreshed_sheet(const Surface& surface, const Points& x, ClothSearch& search) {
  triangle_boxes(surface, x, x, 0, search.boxes);
  const Bvh& tree = search.faces.bvh;
  if (update(search.faces, search.boxes) || search.parts.part_of.size() != tree.nodes.size())
    find_parts(surface, tree, search.parts);
  mark_quiet(surface, x, tree, search.parts);
  return {&surface, &x, &tree, &search.parts.quiet};
}

std::vector<ClothPair> find_cloth_pairs(const Surface& surface, const Points& x, const std::vector<int>& vertices,
                                        double radius, ClothSearch& search) {
  const Points at = x(vertices, Eigen::all);
  vertex_boxes(at, at, 0, search.boxes);
  update(search.vertices, search.boxes);
  if (vertices.empty()) return {};
  prism_boxes(surface, x, radius, search.vertices.bvh.nodes[0].box, search.boxes);
  update(search.prisms, search.boxes);
  const Bvh& tree = search.prisms.bvh;
  make_frames(surface, x, tree, search.frames);
  std::vector<ClothPair> pairs;
  const BvhTraversal traversal{search.vertices.bvh, tree, false};
  gather(traversal, search.lists, pairs, [&](NodeWork w, std::vector<ClothPair>& found) {
    const Bvh::Leaf &from = traversal.leaf_a(w), &to = traversal.leaf_b(w);
    const FrameLeaf& frame = search.frames[static_cast<std::size_t>(~tree.nodes[static_cast<std::size_t>(w.b)].child)];
    int looked = 0;
    for (unsigned some = overlaps(from, tree.nodes[static_cast<std::size_t>(w.b)].box); some != 0; some &= some - 1) {
      const int place = std::countr_zero(some), v = vertices[static_cast<std::size_t>(from.item[place])];
      unsigned bits = overlaps(to, box_of(from, place));
      looked += std::popcount(bits);
      if (bits != 0) bits &= may_project(frame, row(x, v), static_cast<float>(radius));
      for (; bits != 0; bits &= bits - 1) add_if_close(surface, x, v, to.item[std::countr_zero(bits)], radius, found);
    }
    return looked;
  });
  sort_by_place(pairs);
  return pairs;
}

int keep_nearest_pairs(std::vector<ClothPair>& pairs, std::size_t most) {
  if (pairs.size() <= most) return 0;
  const int left_out = static_cast<int>(pairs.size() - most);
  std::sort(pairs.begin(), pairs.end(), [](const ClothPair& a, const ClothPair& b) {
    return std::pair(a.height, place_of(a)) < std::pair(b.height, place_of(b));
  });
  pairs.resize(most);
  sort_by_place(pairs);
  return left_out;
}

}  // namespace selvedge
