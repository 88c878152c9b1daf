#pragma once

#include <array>
#include <cmath>
#include <random>

#include "collision/exact/moving_polygon.hpp"
#include "collision/geometry/points.hpp"

namespace selvedge::transversal {

// Random motions of a pair whose nodes are coplanar at a known time `root`, a multiple of 1/64, and not before (nor
// after, if there is no contact). At that time the pair touches inside the primitives, or misses and never touches. All
// coordinates are exact.
struct Query {
  PairKind kind;
  std::array<Vec3, 4> x0, x1;
  bool contact;
  double root;
};

using Random = std::mt19937_64;

inline int whole(Random& random, int lowest, int highest) {
  return std::uniform_int_distribution(lowest, highest)(random);
}

inline Vec3 whole_vector(Random& random, int size) {
  const int x = whole(random, -size, size), y = whole(random, -size, size), z = whole(random, -size, size);
  return {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
}

// A vertex at a combination of a face's corners in whole sixteenths: all parts are positive, or one is negative.
inline std::array<Vec3, 4> vertex_in_plane(Random& random, bool contact) {
  const Vec3 a = 16 * whole_vector(random, 8), b = 16 * whole_vector(random, 8), c = 16 * whole_vector(random, 8);
  const int i = contact ? whole(random, 1, 14) : whole(random, -12, -1);
  const int j = contact ? whole(random, 1, 15 - i) : whole(random, -4, 20);
  return {(i * a + j * b + (16 - i - j) * c) / 16, a, b, c};
}

// Two edges, each a multiple of a vector from their crossing, within both or beyond an end of the first.
inline std::array<Vec3, 4> crossing_edges(Random& random, bool contact) {
  const Vec3 crossing = whole_vector(random, 64), d = whole_vector(random, 8), e = whole_vector(random, 8);
  const int i = contact ? whole(random, 1, 15) : whole(random, 17, 24),
            j = whole(random, contact ? 1 : -4, contact ? 15 : 20);
  return {crossing - i * d, crossing + (16 - i) * d, crossing - j * e, crossing + (16 - j) * e};
}

// Coefficients of det[p, q, r] / s for p + s p', ..., whose constant part is zero; whole numbers, exact in double.
inline std::array<double, 3> other_roots(const std::array<Vec3, 4>& x, const std::array<Vec3, 4>& v) {
  const Vec3 p = x[1] - x[0], q = x[2] - x[0], r = x[3] - x[0], dp = v[1] - v[0], dq = v[2] - v[0], dr = v[3] - v[0];
  const auto det = [](const Vec3& a, const Vec3& b, const Vec3& c) { return a.dot(b.cross(c)); };
  return {det(dp, q, r) + det(p, dq, r) + det(p, q, dr), det(p, dq, dr) + det(dp, q, dr) + det(dp, dq, r),
          det(dp, dq, dr)};
}

// Whether c0 + c1 s + c2 s^2 has one sign over [lo, hi], by its Bernstein coefficients.
inline bool of_one_sign(const std::array<double, 3>& c, double lo, double hi) {
  const auto value = [&](double s) { return c[0] + s * c[1] + s * s * c[2]; };
  const double middle = c[0] + 0.5 * (lo + hi) * c[1] + lo * hi * c[2];
  return (value(lo) > 0 && middle > 0 && value(hi) > 0) || (value(lo) < 0 && middle < 0 && value(hi) < 0);
}

inline Query query(Random& random) {
  for (;;) {
    Query result;
    result.kind = random() % 2 ? PairKind::edge_edge : PairKind::vertex_face;
    result.contact = random() % 2;
    result.root = whole(random, 1, 63) / 64.0;
    const std::array<Vec3, 4> x = result.kind == PairKind::vertex_face ? vertex_in_plane(random, result.contact)
                                                                       : crossing_edges(random, result.contact);
    std::array<Vec3, 4> v;
    for (Vec3& velocity : v) velocity = whole_vector(random, 128);
    const double until = result.contact ? 0 : 1 - result.root;
    if (!of_one_sign(other_roots(x, v), -result.root, until)) continue;
    for (int k = 0; k < 4; ++k) {
      result.x0[k] = x[k] - result.root * v[k];
      result.x1[k] = x[k] + (1 - result.root) * v[k];
    }
    return result;
  }
}

// Changes units of positions and time, and moves far away, by powers of two and multiples of 1/64, so that all is
// exact.
inline Query scaled(Query q, int exponent, const Vec3& shift) {
  for (auto* x : {&q.x0, &q.x1})
    for (Vec3& node : *x)
      for (int axis = 0; axis < 3; ++axis) node[axis] = std::ldexp(node[axis] + shift[axis], exponent);
  return q;
}

}  // namespace selvedge::transversal
