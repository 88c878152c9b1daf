#include "collision/contact/search_part.hpp"

#include <algorithm>

namespace selvedge {
namespace {

// The boxes of vertices, edges and triangles from those of the vertices.
struct BoxesOf {
  const Surface& surface;
  const std::vector<Box>& boxes;

  Box vertex(int v) const { return boxes[v]; }
  Box edge(int e) const { return hull(boxes[surface.edges(e, 0)], boxes[surface.edges(e, 1)]); }
  Box triangle(int t) const {
    const auto corners = surface.triangles.row(t);
    return hull(boxes[corners[0]], boxes[corners[1]], boxes[corners[2]]);
  }
};

}  // namespace

void PrimitiveGroups::share_out(const Bvh& bvh, const Triangles& primitives, const std::vector<int>& owner) {
  groups.clear();
  begin.assign(1, 0);
  for (const Bvh::Leaf& leaf : bvh.leaves) {
    int used = Bvh::leaf_size;
    for (const int t : leaf.item)
      for (int k = 0; t >= 0 && k < 3; ++k) {
        const int item = primitives(t, k);
        if (owner[item] != t) continue;
        if (used == Bvh::leaf_size) {
          used = 0;
          std::ranges::fill(groups.emplace_back().item, -1);
        }
        groups.back().item[used++] = item;
      }
    begin.push_back(static_cast<int>(groups.size()));
  }
}

void SearchPart::move(const Points& x0, const Points& x1, double radius, bool ends) {
  const auto from = x0.middleRows(first_node, surface->vertex_count);
  const auto to = x1.middleRows(first_node, surface->vertex_count);
  const bool same_start = radius_ == radius && from_ == from;
  if (same_start && ends_ == ends && to_ == to) return;
  const bool knows_start = same_start && ends_;
  radius_ = radius;
  ends_ = ends;
  from_ = from;
  to_ = to;
  vertex_boxes(from_, to_, radius / 2, vertex_boxes_);
  triangle_boxes(*surface, vertex_boxes_, triangle_boxes_);
  if (update(tree, triangle_boxes_)) {
    vertices.share_out(tree.bvh, surface->triangles, surface->vertex_owner);
    edges.share_out(tree.bvh, surface->triangle_edges, surface->edge_owner);
  }
  filled_.assign(tree.bvh.leaves.size(), 0);
  node_ends.clear();
  if (!ends) return;
  if (!knows_start) vertex_boxes(from_, from_, radius / 2, start_);
  vertex_boxes(to_, to_, radius / 2, end_);
  vertices.ends.resize(vertices.groups.size());
  edges.ends.resize(edges.groups.size());
  face_ends.resize(tree.bvh.leaves.size());
  leaf_ends.assign(tree.bvh.leaves.size(), {empty_box, empty_box});
}

void SearchPart::fill_leaf(int leaf) {
  const BoxesOf all{*surface, vertex_boxes_};
  for (int g = vertices.begin[leaf]; g < vertices.begin[leaf + 1]; ++g)
    set_leaf_boxes(vertices.groups[g], [&](int v) { return all.vertex(v); });
  for (int g = edges.begin[leaf]; g < edges.begin[leaf + 1]; ++g)
    set_leaf_boxes(edges.groups[g], [&](int e) { return all.edge(e); });
  if (ends_) fill_ends(leaf);
  filled_[leaf] = 1;
}

void SearchPart::fill_ends(int leaf) {
  const BoxesOf start{*surface, start_}, end{*surface, end_};
  leaf_ends[leaf] = set_end_boxes(
      tree.bvh.leaves[leaf], [&](int t) { return start.triangle(t); }, [&](int t) { return end.triangle(t); }, leaf,
      face_ends);
  for (int g = vertices.begin[leaf]; g < vertices.begin[leaf + 1]; ++g)
    set_end_boxes(
        vertices.groups[g], [&](int v) { return start.vertex(v); }, [&](int v) { return end.vertex(v); }, g,
        vertices.ends);
  for (int g = edges.begin[leaf]; g < edges.begin[leaf + 1]; ++g)
    set_end_boxes(
        edges.groups[g], [&](int e) { return start.edge(e); }, [&](int e) { return end.edge(e); }, g, edges.ends);
}

void SearchPart::fill(const std::function<bool(int node)>& wanted) {
  std::vector<int> leaves;
  for (int n = 0; n < static_cast<int>(tree.bvh.nodes.size()); ++n) {
    const int child = tree.bvh.nodes[n].child;
    if (child >= 0 || filled_[~child]) continue;
    // A traversal of two trees with one leaf each does not test their boxes.
    if (tree.bvh.leaves.size() == 1 || wanted(n)) leaves.push_back(~child);
  }
  const int count = static_cast<int>(leaves.size());
#pragma omp parallel for schedule(static)
  for (int i = 0; i < count; ++i) fill_leaf(leaves[i]);
  if (ends_ && (count > 0 || node_ends.empty())) set_end_boxes(tree.bvh, leaf_ends, node_ends);
}

void SearchPart::mark(const std::vector<char>& nodes) {
  const Bvh& bvh = tree.bvh;
  const auto holds_marked = [&](const Bvh::Leaf& leaf) {
    return std::ranges::any_of(leaf.item, [&](int t) {
      if (t < 0) return false;
      const auto corners = surface->triangles.row(t);
      return std::any_of(corners.begin(), corners.end(), [&](int v) { return nodes[first_node + v] != 0; });
    });
  };
  marks.resize(bvh.nodes.size());
  for (std::size_t i = bvh.nodes.size(); i-- > 0;) {
    const int child = bvh.nodes[i].child;
    marks[i] = child < 0 ? holds_marked(bvh.leaves[~child]) : marks[child] || marks[child + 1];
  }
}

bool meets(const SearchPart& part, const Box& box, bool marked) {
  const Bvh& tree = part.tree.bvh;
  if (tree.item_count == 0) return false;
  int stack[64], size = 0;  // a tree of 2^31 leaves is 31 deep
  stack[size++] = 0;
  while (size > 0) {
    const int at = stack[--size];
    const Bvh::Node& node = tree.nodes[at];
    if ((marked && !part.marks[at]) || !overlap(node.box, box)) continue;
    if (node.child < 0) return true;
    stack[size++] = node.child;
    stack[size++] = node.child + 1;
  }
  return false;
}

}  // namespace selvedge
