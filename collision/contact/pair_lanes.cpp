#include "collision/contact/pair_lanes.hpp"

#include <algorithm>
#include <cmath>

#include "collision/geometry/eight_lanes.hpp"

namespace selvedge {
namespace {

constexpr int corner_count = 4;
// Each is several times what the rounding of single precision can come to.
constexpr float slack_part = 1e-6F;                        // of the sums of products that a height is made of
constexpr float slack_least = 1e-37F;                      // what underflow may take from a height [m2]
constexpr double widened = 1 + 4e-6, narrowed = 1 - 4e-6;  // for lengths
// Lengths from which on squares and their products do not underflow.
constexpr float least_direction = 1e-20F;  // squared [m2, or m4 for a normal]
constexpr float most_reach = 1e9F;         // up to which they do not overflow [m]

struct EightPolygon {
  EightVec3 corner[corner_count];
};

[[gnu::always_inline]] inline Eight size(const Eight& a) { return a < 0 ? -a : a; }
[[gnu::always_inline]] inline Eight sum_of_sizes(const EightVec3& a) { return size(a.x) + size(a.y) + size(a.z); }
[[gnu::always_inline]] inline EightVec3 plus(const EightVec3& a, const Eight& s, const EightVec3& b) {
  return {a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}
[[gnu::always_inline]] inline EightVec3 choose(const EightBits& first, const EightVec3& a, const EightVec3& b) {
  return {first ? a.x : b.x, first ? a.y : b.y, first ? a.z : b.z};
}
[[gnu::always_inline]] inline EightPolygon polygon(const float (&corner)[corner_count][3][PairLanes::width]) {
  EightPolygon p;
  for (int k = 0; k < corner_count; ++k) __builtin_memcpy(&p.corner[k], corner[k], sizeof p.corner[k]);
  return p;
}

// The boundary's point nearest to the origin; roughly, since it only serves as a direction.
[[gnu::always_inline]] inline EightVec3 nearest_of_boundary(const EightPolygon& p) {
  EightVec3 nearest = p.corner[0];
  Eight least = dot(nearest, nearest);
  for (int k = 0; k < corner_count; ++k) {
    const EightVec3 edge = minus(p.corner[(k + 1) % corner_count], p.corner[k]);
    // 0 where the edge has no length
    const Eight along = smaller(larger(-dot(p.corner[k], edge) / dot(edge, edge), Eight{}), Eight{} + 1.0F);
    const EightVec3 point = plus(p.corner[k], along, edge);
    const Eight square = dot(point, point);
    nearest = choose(square < least, point, nearest);
    least = smaller(square, least);
  }
  return nearest;
}

[[gnu::always_inline]] inline EightVec3 normal_of(const EightPolygon& p) {
  const EightVec3 normal = cross(minus(p.corner[1], p.corner[0]), minus(p.corner[corner_count - 1], p.corner[0]));
  const EightVec3 other{-normal.x, -normal.y, -normal.z};
  return choose(dot(normal, p.corner[0]) < 0, other, normal);
}

// Undefined where a coordinate is.
[[gnu::always_inline]] inline Eight reach_of(const EightPolygon& p) {
  Eight reach{};
  for (const EightVec3& corner : p.corner) reach += sum_of_sizes(corner);
  return reach;
}

// A lower bound of the corners' heights along a direction, times the direction's length. `reach`: at least the sum of
// the sizes of a corner's coordinates, also of those that it was computed from.
[[gnu::always_inline]] inline Eight height_along(const EightVec3& direction, const EightPolygon& p,
                                                 const Eight& reach) {
  Eight least = dot(p.corner[0], direction);
  for (int k = 1; k < corner_count; ++k) least = smaller(dot(p.corner[k], direction), least);
  return least - (slack_part * reach * sum_of_sizes(direction) + slack_least);
}

[[gnu::always_inline]] inline Eight root(const Eight& value) {
  Eight result;
  for (int i = 0; i < PairLanes::width; ++i) result[i] = std::sqrt(value[i]);
  return result;
}

// The same as a length, or 0.
[[gnu::always_inline]] inline Eight distance_along(const EightVec3& direction, const EightPolygon& p,
                                                   const Eight& reach) {
  const Eight height = height_along(direction, p, reach), square = dot(direction, direction);
  const EightBits sound = (height > 0) & (square > least_direction) & (reach < most_reach);
  return sound ? static_cast<float>(narrowed) * height / root(square) : Eight{};
}

// The distance of a polygon is its least height along the direction to its nearest point: one of the boundary, or the
// foot of the normal. Whatever the direction, the least height is a lower bound.
[[gnu::always_inline]] inline void stays_away(const PairLanes& pairs, float distance, Eight& gaps, EightBits& bits) {
  const EightPolygon start = polygon(pairs.start), change = polygon(pairs.change);
  Eight most{};
  for (const EightVec3& corner : change.corner) most = larger(dot(corner, corner), most);
  const Eight reach = reach_of(start);
  gaps =
      larger(distance_along(nearest_of_boundary(start), start, reach), distance_along(normal_of(start), start, reach));
  bits = (gaps > distance + static_cast<float>(widened) * root(most)) & (reach_of(change) < most_reach);
}

// Motion is straight, so that what is above a plane at both ends is above it all the way. The direction is that of the
// middle.
[[gnu::always_inline]] inline void apart_all_the_way(const PairLanes& pairs, float distance, EightBits& bits) {
  const EightPolygon start = polygon(pairs.start), change = polygon(pairs.change);
  EightPolygon middle, end;
  for (int k = 0; k < corner_count; ++k) {
    middle.corner[k] = plus(start.corner[k], Eight{} + 0.5F, change.corner[k]);
    end.corner[k] = plus(start.corner[k], Eight{} + 1.0F, change.corner[k]);
  }
  const Eight reach = reach_of(start) + reach_of(change);
  const auto apart = [&](const EightVec3& along) __attribute__((always_inline)) {
    return smaller(distance_along(along, start, reach), distance_along(along, end, reach)) > distance;
  };
  bits = apart(nearest_of_boundary(middle)) | apart(normal_of(middle));
}

float widened_distance(double distance) { return static_cast<float>(widened * distance); }

unsigned stays_away_plain(const PairLanes& pairs, double distance, float* gaps) {
  Eight found;
  EightBits bits;
  stays_away(pairs, widened_distance(distance), found, bits);
  __builtin_memcpy(gaps, &found, sizeof found);
  return bits_plain(bits);
}
unsigned apart_plain(const PairLanes& pairs, double distance) {
  EightBits bits;
  apart_all_the_way(pairs, widened_distance(distance), bits);
  return bits_plain(bits);
}
constexpr PairKernels plain_kernels{stays_away_plain, apart_plain};

#if defined(__x86_64__)
[[gnu::target("avx2")]] unsigned stays_away_avx2(const PairLanes& pairs, double distance, float* gaps) {
  Eight found;
  EightBits bits;
  stays_away(pairs, widened_distance(distance), found, bits);
  __builtin_memcpy(gaps, &found, sizeof found);
  return bits_avx2(bits);
}
[[gnu::target("avx2")]] unsigned apart_avx2(const PairLanes& pairs, double distance) {
  EightBits bits;
  apart_all_the_way(pairs, widened_distance(distance), bits);
  return bits_avx2(bits);
}
constexpr PairKernels avx2_kernels{stays_away_avx2, apart_avx2};
#else
constexpr PairKernels avx2_kernels = plain_kernels;
#endif

}  // namespace

void PairLanes::set(int lane, const NodePair& pair, const Points& x0, const Points& displacements) {
  const auto& n = pair.nodes;
  const auto put = [&](int corner, int from, int to) {
    for (int k = 0; k < 3; ++k) {
      start[corner][k][lane] = static_cast<float>(x0(n[to], k) - x0(n[from], k));
      change[corner][k][lane] = static_cast<float>(displacements(n[to], k) - displacements(n[from], k));
    }
  };
  const bool face = pair.kind == PairKind::vertex_face;
  put(0, 0, face ? 1 : 2);
  put(1, 0, face ? 2 : 3);
  put(2, face ? 0 : 1, 3);
  put(3, face ? 0 : 1, face ? 3 : 2);
}

const PairKernels& pair_kernels() { return has_avx2() ? avx2_kernels : plain_kernels; }

}  // namespace selvedge
