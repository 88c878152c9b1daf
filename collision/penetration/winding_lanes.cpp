#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "collision/geometry/eight_lanes.hpp"
#include "collision/geometry/parallel.hpp"
#include "collision/penetration/dipole_tree.hpp"

// Four points traverse the tree together, one in each lane. Each lane decides by itself where a dipole replaces
// triangles, so that a point's result has the same bits whatever the other three points are.
namespace selvedge {
namespace {

constexpr int width = 4;
// Aligned for the reason that Eight is (eight_lanes.hpp).
using Lanes [[gnu::vector_size(32), gnu::aligned(32)]] = double;
using Marks [[gnu::vector_size(32), gnu::aligned(32)]] = long long;  // all bits of a lane, or none

struct LaneVec3 {
  Lanes x, y, z;
};

[[gnu::always_inline]] inline LaneVec3 from_to(const LaneVec3& from, const Vec3& to) {
  return {to[0] - from.x, to[1] - from.y, to[2] - from.z};
}
[[gnu::always_inline]] inline Lanes dot(const LaneVec3& a, const LaneVec3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
[[gnu::always_inline]] inline Lanes dot(const Vec3& a, const LaneVec3& b) {
  return a[0] * b.x + a[1] * b.y + a[2] * b.z;
}
[[gnu::always_inline]] inline Lanes root(const Lanes& value) {
  Lanes result;
  for (int i = 0; i < width; ++i) result[i] = std::sqrt(value[i]);
  return result;
}
[[gnu::always_inline]] inline bool any(const Marks& marks) { return (marks[0] | marks[1] | marks[2] | marks[3]) != 0; }

// The points, the sums of far dipoles, and the solid angles of near triangles.
struct Group {
  LaneVec3 at;
  Marks left_out;
  Lanes far;
  // The angle so far is `angle` + 2 arg(turn), with the turn's real part above 0.
  Lanes angle, turn_real, turn_imaginary;
};

// Adds a node to the lanes that are far enough from it, and takes these out of `open`.
[[gnu::always_inline]] inline void add_node(const DipoleTree::SpreadDipole& node, Group& group, Marks& open) {
  const LaneVec3 to = from_to(group.at, node.centre);
  const Lanes square = dot(to, to);
  const Marks far = open & (square > node.reach_squared);
  if (!any(far)) return;
  open &= ~far;
  const std::array<double, 6>& s = node.spread;
  const Lanes spread =
      to.x * (s[0] * to.x + s[5] * to.y) + to.y * (s[1] * to.y + s[3] * to.z) + to.z * (s[2] * to.z + s[4] * to.x);
  const Lanes nearness = 1 / square;
  const Lanes seen = (dot(node.moment, to) + node.trace - 3 * nearness * spread) * (nearness * root(nearness));
  group.far += far ? seen : Lanes{};
}

[[gnu::always_inline]] inline Lanes seen_from(const Vec3& moment, const LaneVec3& to) {
  const Lanes square = dot(to, to);
  return dot(moment, to) / (square * root(square));
}

// Half the solid angle is the argument of (real, imaginary) (van Oosterom and Strackee 1983). Arguments are summed by
// complex products, since an arc tangent costs more than all else; it is taken only where the product leaves the right
// half plane.
[[gnu::always_inline]] inline void turn_by(const Lanes& real, const Lanes& imaginary, const Marks& open, Group& group) {
  const Marks right = open & (real > 0), others = open & ~right;
  const Lanes product = group.turn_real * real - group.turn_imaginary * imaginary,
              cross = group.turn_real * imaginary + group.turn_imaginary * real;
  const Lanes size = (product < 0 ? -product : product) + (cross < 0 ? -cross : cross);
  group.turn_real = right ? product / size : group.turn_real;
  group.turn_imaginary = right ? cross / size : group.turn_imaginary;
  const Marks full = right & ~(group.turn_real > 0);
  if (!any(others | full)) return;
  for (int i = 0; i < width; ++i) {
    if (others[i]) group.angle[i] += 2 * std::atan2(imaginary[i], real[i]);
    if (!full[i]) continue;
    group.angle[i] += 2 * std::atan2(group.turn_imaginary[i], group.turn_real[i]);
    group.turn_real[i] = 1;
    group.turn_imaginary[i] = 0;
  }
}

// Adds the solid angle of a triangle; 0 from a point in its plane, which is the principal value.
[[gnu::always_inline]] inline void add_triangle(const std::array<Vec3, 3>& corners, const Marks& near, Group& group) {
  const LaneVec3 a = from_to(group.at, corners[0]), b = from_to(group.at, corners[1]),
                 c = from_to(group.at, corners[2]);
  const LaneVec3 normal{b.y * c.z - b.z * c.y, b.z * c.x - b.x * c.z, b.x * c.y - b.y * c.x};
  const Lanes volume = dot(a, normal), la = root(dot(a, a)), lb = root(dot(b, b)), lc = root(dot(c, c));
  const Lanes real = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
  turn_by(real, volume, near & (volume != 0), group);
}

// Adds a face: as a dipole if far away, nearer as three at the middles of its edges, and exactly if close by.
[[gnu::always_inline]] inline void add_face(const DipoleTree& tree, int item, const Marks& marked, Group& group) {
  const Marks open = marked & (group.left_out != static_cast<long long>(tree.faces[item]));
  const DipoleTree::Dipole& dipole = tree.of_faces[item];
  const std::array<Vec3, 3>& corners = tree.corners[item];
  const LaneVec3 to = from_to(group.at, dipole.centre);
  const Lanes square = dot(to, to);
  const Marks beyond = open & (square > dipole.reach_squared), far = beyond & (square > 4 * dipole.reach_squared);
  const Marks between = beyond & ~far, near = open & ~beyond;
  if (any(far)) group.far += far ? seen_from(dipole.moment, to) : Lanes{};
  if (any(between)) {
    const Vec3 third = dipole.moment / 3;
    Lanes seen{};
    for (int k = 0; k < 3; ++k) seen += seen_from(third, from_to(group.at, (corners[k] + corners[(k + 1) % 3]) / 2));
    group.far += between ? seen : Lanes{};
  }
  if (any(near)) add_triangle(corners, near, group);
}

static_assert(alignof(Group) == 32);

struct Visit {
  Marks open;
  int node;
};

[[gnu::always_inline]] inline void go_down(const DipoleTree& tree, Group& group) {
  std::array<Visit, 128> stack;
  int size = 0;
  stack[size++] = {~Marks{}, 0};
  while (size > 0) {
    Visit visit = stack[--size];
    const DipoleTree::SpreadDipole& node = tree.nodes[visit.node];
    add_node(node, group, visit.open);
    if (!any(visit.open)) continue;
    if (node.child >= 0) {
      stack[size++] = {visit.open, node.child};
      stack[size++] = {visit.open, node.child + 1};
      continue;
    }
    for (const int item : tree.bvh.leaves[~node.child].item)
      if (item >= 0) add_face(tree, item, visit.open, group);
  }
}

void go_down_plain(const DipoleTree& tree, Group& group) { go_down(tree, group); }
#if defined(__x86_64__)
[[gnu::target("avx2")]] void go_down_avx2(const DipoleTree& tree, Group& group) { go_down(tree, group); }
#else
constexpr auto go_down_avx2 = go_down_plain;
#endif

}  // namespace

std::vector<double> winding_numbers(const DipoleTree& tree, std::span<const WindingPoint> points) {
  std::vector<double> result(points.size(), 0);
  if (tree.faces.empty()) return result;
  const auto down = has_avx2() ? go_down_avx2 : go_down_plain;
  const int count = static_cast<int>(points.size());
  parallel_for(chunks_of(count, width), 4, [&](int chunk) {
    Group group{{}, {}, {}, {}, Lanes{} + 1, {}};
    for (int i = 0; i < width; ++i) {  // unused lanes copy the last point
      const WindingPoint& point = points[std::min(chunk * width + i, count - 1)];
      group.at.x[i] = point.at[0];
      group.at.y[i] = point.at[1];
      group.at.z[i] = point.at[2];
      group.left_out[i] = point.left_out;
    }
    down(tree, group);
    for (int i = 0; i < width && chunk * width + i < count; ++i) {
      const double angle = group.angle[i] + 2 * std::atan2(group.turn_imaginary[i], group.turn_real[i]);
      result[chunk * width + i] = group.far[i] + angle / (4 * std::numbers::pi);
    }
  });
  return result;
}

}  // namespace selvedge
