#include "collision/distance/wide_kernels.hpp"

#include "collision/geometry/eight_lanes.hpp"

namespace selvedge {
namespace {

[[gnu::always_inline]] inline Eight load_eight(const float* from) {
  Eight result;
  __builtin_memcpy(&result, from, sizeof result);
  return result;
}

// Squared distances of the point from eight boxes. The result is an argument, since clang cannot return wide vectors
// between functions of different instruction sets.
[[gnu::always_inline]] inline void test_boxes(const WideTree::Node& node, const float* at, Eight& sum) {
  sum = Eight{};
  for (int k = 0; k < 3; ++k) {
    const Eight below = load_eight(node.lo[k]) - at[k], above = at[k] - load_eight(node.hi[k]);
    const Eight outside = larger(larger(below, above), Eight{});
    sum += outside * outside;
  }
}

// Squared distance of a point from an edge. p: relative to the start of the edge.
[[gnu::always_inline]] inline Eight from_edge(const EightVec3& p, const EightVec3& edge, Eight length2) {
  const Eight s = smaller(larger(dot(p, edge) / length2, Eight{}), Eight{} + 1.0f);  // 0 where the edge has no length
  const EightVec3 rest{p.x - s * edge.x, p.y - s * edge.y, p.z - s * edge.z};
  return dot(rest, rest);
}

// Squared distances of the point from eight triangles; 0 for those without area.
[[gnu::always_inline]] inline void test_triangles(const WideTree::Leaf& leaf, const float* at, Eight& found) {
  EightVec3 corner[3], from[3];
  const EightVec3 p{Eight{} + at[0], Eight{} + at[1], Eight{} + at[2]};
  for (int c = 0; c < 3; ++c) {
    corner[c] = {load_eight(leaf.corner[c][0]), load_eight(leaf.corner[c][1]), load_eight(leaf.corner[c][2])};
    from[c] = minus(p, corner[c]);
  }
  const EightVec3 ab = minus(corner[1], corner[0]), bc = minus(corner[2], corner[1]), ca = minus(corner[0], corner[2]);
  const Eight ab2 = dot(ab, ab), bc2 = dot(bc, bc), ca2 = dot(ca, ca);
  const EightVec3 normal = cross(ca, ab);
  const Eight normal2 = dot(normal, normal), longest = larger(larger(ab2, bc2), ca2);
  const Eight edges =
      smaller(smaller(from_edge(from[0], ab, ab2), from_edge(from[1], bc, bc2)), from_edge(from[2], ca, ca2));
  const Eight side_a = dot(cross(ab, from[0]), normal), side_b = dot(cross(bc, from[1]), normal);
  const Eight side_c = dot(cross(ca, from[2]), normal), height = dot(from[0], normal);
  const Eight plane = height * height / normal2;
  const Eight squared = smaller(smaller(side_a, side_b), side_c) > 0.0f ? smaller(plane, edges) : edges;
  found = normal2 > 1e-3f * longest * longest ? squared : Eight{};
}

unsigned boxes_plain(const WideTree::Node& node, const float* at, float limit, float* squared) {
  Eight found;
  test_boxes(node, at, found);
  __builtin_memcpy(squared, &found, sizeof found);
  return bits_plain(found < limit);
}
unsigned triangles_plain(const WideTree::Leaf& leaf, const float* at, float limit, float* squared) {
  Eight found;
  test_triangles(leaf, at, found);
  __builtin_memcpy(squared, &found, sizeof found);
  return bits_plain(found < limit);
}

constexpr WideKernels plain_kernels{boxes_plain, triangles_plain};

#if defined(__x86_64__)
[[gnu::target("avx2")]] unsigned boxes_avx2(const WideTree::Node& node, const float* at, float limit, float* squared) {
  Eight found;
  test_boxes(node, at, found);
  __builtin_memcpy(squared, &found, sizeof found);
  return bits_avx2(found < limit);
}
[[gnu::target("avx2")]] unsigned triangles_avx2(const WideTree::Leaf& leaf, const float* at, float limit,
                                                float* squared) {
  Eight found;
  test_triangles(leaf, at, found);
  __builtin_memcpy(squared, &found, sizeof found);
  return bits_avx2(found < limit);
}
constexpr WideKernels avx2_kernels{boxes_avx2, triangles_avx2};
#else
constexpr WideKernels avx2_kernels = plain_kernels;
#endif

}  // namespace

const WideKernels& wide_kernels() { return has_avx2() ? avx2_kernels : plain_kernels; }

}  // namespace selvedge
