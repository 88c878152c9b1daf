#include "collision/search/quiet.hpp"

#include <algorithm>
#include <cmath>

namespace selvedge {
namespace {

constexpr int least_leaves = 8;

// The number of leaves below each node.
std::vector<int> leaf_counts(const Bvh& tree) {
  std::vector<int> count(tree.nodes.size(), 1);
  for (int n = static_cast<int>(tree.nodes.size()) - 1; n >= 0; --n)
    if (const int child = tree.nodes[n].child; child >= 0) count[n] = count[child] + count[child + 1];
  return count;
}

// Edges that have more than two triangles, or two that run along them in the same direction.
std::vector<char> irregular_edges(const Surface& s) {
  std::vector<char> triangles(s.edges.rows(), 0), forward(s.edges.rows(), 0), bad(s.edges.rows(), 0);
  for (int t = 0; t < s.triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k) {
      const int e = s.triangle_edges(t, k);
      const bool ahead = s.triangles(t, k) == s.edges(e, 0);
      if (triangles[e] >= 2 || (triangles[e] == 1 && (forward[e] != 0) == ahead)) bad[e] = 1;
      triangles[e] = static_cast<char>(std::min(triangles[e] + 1, 2));
      forward[e] = ahead;
    }
  return bad;
}

// Looks at one node after another. Marks hold the node's number, so that they need not be cleared.
struct PartFinder {
  const Surface& s;
  const Bvh& tree;
  const std::vector<int>& leaf_of;  // by triangle
  const std::vector<char>& irregular;
  std::vector<int> seen_vertex, seen_triangle, from_vertex, next;

  bool within(const QuietParts::Part& part, int t) const {
    return t >= 0 && leaf_of[t] >= part.first_leaf && leaf_of[t] < part.first_leaf + part.leaves;
  }
  // Triangles that can be reached from the first one over edges within the part.
  int reachable(const QuietParts::Part& part) {
    std::vector<int> stack{tree.leaves[part.first_leaf].item[0]};
    seen_triangle[stack.back()] = part.node;
    int count = 0;
    while (!stack.empty()) {
      const int t = stack.back();
      stack.pop_back();
      ++count;
      for (int k = 0; k < 3; ++k)
        if (const int other = s.across(s.triangle_edges(t, k), t);
            within(part, other) && seen_triangle[other] != part.node) {
          seen_triangle[other] = part.node;
          stack.push_back(other);
        }
    }
    return count;
  }

  // Fills in the boundary; false if the part is no disk.
  bool is_disk(QuietParts::Part& part) {
    int faces = 0, vertices = 0, half_edges = 0, boundary = 0, start = -1;
    for (int l = part.first_leaf; l < part.first_leaf + part.leaves; ++l)
      for (const int t : tree.leaves[l].item) {
        if (t < 0) continue;
        ++faces;
        for (int k = 0; k < 3; ++k) {
          const int v = s.triangles(t, k);
          if (irregular[s.triangle_edges(t, k)]) return false;
          vertices += seen_vertex[v] != part.node;
          seen_vertex[v] = part.node;
          if (within(part, s.across(s.triangle_edges(t, k), t))) {
            ++half_edges;
            continue;
          }
          from_vertex[v] = part.node;
          next[v] = s.triangles(t, (k + 1) % 3);
          start = v;
          ++boundary;
        }
      }
    if (start < 0 || vertices - (half_edges / 2 + boundary) + faces != 1 || reachable(part) != faces) return false;
    for (int v = start; part.loop.empty() || v != start; v = next[v]) {
      if (from_vertex[v] != part.node || static_cast<int>(part.loop.size()) == boundary) return false;
      part.loop.push_back(v);
    }
    return static_cast<int>(part.loop.size()) == boundary;
  }
};

// True only if the segments pq and ab, which share no end, are apart.
bool surely_apart(const Vec2& p, const Vec2& q, const Vec2& a, const Vec2& b, double slack) {
  const auto beside = [slack](const Vec2& from, const Vec2& to, const Vec2& c, const Vec2& d) {
    const double at_c = cross(to - from, c - from), at_d = cross(to - from, d - from);
    return std::min(at_c, at_d) > slack || std::max(at_c, at_d) < -slack;
  };
  return beside(p, q, a, b) || beside(a, b, p, q);
}

// Normals of the triangles in the order of the leaves, as long as twice their area, and their sums below each node.
// Returns more than the square of the longest edge.
double sum_normals(const Surface& s, const Points& x, const Bvh& tree, QuietParts& parts) {
  parts.normals.resize(tree.item_count);
  parts.node_normals.resize(tree.nodes.size());
  std::vector<double> longest(tree.leaves.size(), 0);
  const int leaves = static_cast<int>(tree.leaves.size());
#pragma omp parallel for schedule(static)
  for (int l = 0; l < leaves; ++l)
    for (int i = 0; i < Bvh::leaf_size && tree.leaves[l].item[i] >= 0; ++i) {
      const int* v = s.triangles.data() + 3 * tree.leaves[l].item[i];
      const Vec3 a = row(x, v[1]) - row(x, v[0]), b = row(x, v[2]) - row(x, v[0]);
      parts.normals[l * Bvh::leaf_size + i] = a.cross(b);
      longest[l] = std::max(longest[l], a.squaredNorm() + b.squaredNorm());
    }
  for (int n = static_cast<int>(tree.nodes.size()) - 1; n >= 0; --n) {
    const Bvh::Node& node = tree.nodes[n];
    Vec3& sum = parts.node_normals[n] = Vec3::Zero();
    if (node.child >= 0)
      sum = parts.node_normals[node.child] + parts.node_normals[node.child + 1];
    else
      for (int i = node.first * Bvh::leaf_size; i < std::min((node.first + 1) * Bvh::leaf_size, tree.item_count); ++i)
        sum += parts.normals[i];
  }
  return *std::max_element(longest.begin(), longest.end());
}

bool is_quiet(const QuietParts& parts, const QuietParts::Part& part, const Points& x, double longest) {
  const Vec3& axis = parts.node_normals[part.node];
  Vec3::Index least;
  axis.cwiseAbs().minCoeff(&least);
  const Vec3 u = axis.cross(Vec3::Unit(least)).normalized(), w = axis.cross(u).normalized(), view = u.cross(w);
  // A triangle keeps its orientation if normal . view > 0; both are wrong by some 1e-15 of the edges' squares.
  const auto begin = parts.normals.begin() + part.first_leaf * Bvh::leaf_size;
  const auto end = std::min(begin + part.leaves * Bvh::leaf_size, parts.normals.end());
  if (!std::all_of(begin, end, [&](const Vec3& n) { return n.dot(view) > 1e-10 * longest; })) return false;

  const Vec3 origin = row(x, part.loop.front());
  std::vector<Vec2> polygon;
  polygon.reserve(part.loop.size());
  double reach = 0;
  for (const int v : part.loop) {
    const Vec3 p = row(x, v) - origin;
    reach = std::max(reach, p.cwiseAbs().sum());
    polygon.emplace_back(u.dot(p), w.dot(p));
  }
  return surely_simple(polygon, 1e-15 * reach);
}

// Marks the largest quiet parts below a node.
void mark_below(const Points& x, const Bvh& tree, double longest, int node, QuietParts& parts) {
  std::vector<int> stack{node};
  while (!stack.empty()) {
    const int n = stack.back(), child = tree.nodes[n].child;
    stack.pop_back();
    if (child < 0) continue;
    if (const int part = parts.part_of[n]; part >= 0 && is_quiet(parts, parts.parts[part], x, longest)) {
      parts.quiet[n] = 1;
      continue;
    }
    stack.push_back(child + 1);
    stack.push_back(child);
  }
}

}  // namespace

void find_parts(const Surface& surface, const Bvh& tree, QuietParts& parts) {
  const std::vector<int> leaves = leaf_counts(tree);
  const std::vector<char> irregular = irregular_edges(surface);
  std::vector<int> leaf_of(surface.triangles.rows());
  for (std::size_t l = 0; l < tree.leaves.size(); ++l)
    for (const int t : tree.leaves[l].item)
      if (t >= 0) leaf_of[t] = static_cast<int>(l);
  std::vector<QuietParts::Part> found;
  for (std::size_t n = 0; n < tree.nodes.size(); ++n)
    if (leaves[n] >= least_leaves) found.push_back({static_cast<int>(n), tree.nodes[n].first, leaves[n], {}});
  const int count = static_cast<int>(found.size());
  std::vector<char> disk(found.size(), 0);
#pragma omp parallel
  {
    const std::vector<int> none(surface.vertex_count, -1);
    PartFinder finder{surface, tree, leaf_of, irregular, none, std::vector<int>(surface.triangles.rows(), -1),
                      none,    none};
#pragma omp for schedule(dynamic)
    for (int i = 0; i < count; ++i) disk[i] = finder.is_disk(found[i]);
  }
  parts.parts.clear();
  parts.part_of.assign(tree.nodes.size(), -1);
  for (int i = 0; i < count; ++i)
    if (disk[i]) {
      parts.part_of[found[i].node] = static_cast<int>(parts.parts.size());
      parts.parts.push_back(std::move(found[i]));
    }
}

void mark_quiet(const Surface& surface, const Points& x, const Bvh& tree, QuietParts& parts) {
  parts.quiet.assign(tree.nodes.size(), 0);
  if (parts.parts.empty()) return;
  const double longest = sum_normals(surface, x, tree, parts);
  std::vector<int> open;
  std::vector<char> below_quiet(tree.nodes.size(), 0);
  for (const int n : tree.top) {
    const int part = parts.part_of[n];
    const bool quiet = below_quiet[n] || (part >= 0 && is_quiet(parts, parts.parts[part], x, longest));
    parts.quiet[n] = below_quiet[tree.nodes[n].child] = below_quiet[tree.nodes[n].child + 1] = quiet;
  }
  for (const Bvh::Block& block : tree.blocks)
    if (!below_quiet[block.root]) open.push_back(block.root);
  const int count = static_cast<int>(open.size());
#pragma omp parallel for schedule(dynamic)
  for (int i = 0; i < count; ++i) mark_below(x, tree, longest, open[i], parts);
}

bool surely_simple(const std::vector<Vec2>& polygon, double margin) {
  struct Segment {
    double lo, hi;  // along x
    int index;
  };
  const int count = static_cast<int>(polygon.size());
  if (count < 3) return false;
  const auto at = [&](int i) -> const Vec2& { return polygon[i < count ? i : i - count]; };
  Vec2 lo = polygon[0], hi = polygon[0];
  std::vector<Segment> segments;
  segments.reserve(count);
  for (int i = 0; i < count; ++i) {
    lo = lo.cwiseMin(at(i));
    hi = hi.cwiseMax(at(i));
    segments.push_back({std::min(at(i).x(), at(i + 1).x()), std::max(at(i).x(), at(i + 1).x()), i});
  }
  // A cross product of two differences, each up to `span` and wrong by 2 margin a coordinate.
  const double span = (hi - lo).maxCoeff(), slack = 16 * margin * span + 2e-15 * span * span;
  for (int i = 0; i < count; ++i) {
    const Vec2 into = at(i + 1) - at(i), out = at(i + 2) - at(i + 1);
    if (!(std::abs(cross(into, out)) > slack || into.dot(out) > slack)) return false;
  }
  std::sort(segments.begin(), segments.end(), [](const Segment& a, const Segment& b) { return a.lo < b.lo; });
  for (int i = 0; i < count; ++i) {
    const Vec2 &p = at(segments[i].index), &q = at(segments[i].index + 1);
    const double y_lo = std::min(p.y(), q.y()) - 4 * margin, y_hi = std::max(p.y(), q.y()) + 4 * margin;
    for (int j = i + 1; j < count && segments[j].lo <= segments[i].hi + 4 * margin; ++j) {
      const Vec2 &a = at(segments[j].index), &b = at(segments[j].index + 1);
      if (std::max(a.y(), b.y()) < y_lo || std::min(a.y(), b.y()) > y_hi) continue;
      const int apart = std::abs(segments[i].index - segments[j].index);
      if (apart == 1 || apart == count - 1) continue;  // consecutive segments were checked above
      if (!surely_apart(p, q, a, b, slack)) return false;
    }
  }
  return true;
}

}  // namespace selvedge
