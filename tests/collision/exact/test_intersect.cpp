#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "collision/exact/exact_integer.hpp"
#include "collision/exact/orientation.hpp"
#include "collision/exact/triangle_pair.hpp"
#include "tests/collision/brute_force.hpp"
#include "tests/collision/tangles.hpp"

namespace selvedge::test_intersect {

namespace {

__extension__ using Wide = __int128;
using Whole = Eigen::Matrix<long, 3, 1>;
using WholeMatrix = std::vector<std::vector<Wide>>;  // rows, the right-hand side as last column

// Is the one solution of a system of whole numbers >= 0 in every unknown? False too if there is none or more than one.
// Fraction-free elimination (Bareiss), sharing nothing with the code under test.
bool nonnegative_solution(WholeMatrix m) {
  const int rows = static_cast<int>(m.size()), unknowns = static_cast<int>(m[0].size()) - 1;
  for (int k = 0; k < unknowns; ++k) {
    int pivot = k;
    while (pivot < rows && m[pivot][k] == 0) ++pivot;
    if (pivot == rows) return false;
    std::swap(m[pivot], m[k]);
    for (int r = 0; r < rows; ++r) {
      if (r == k) continue;
      const Wide factor = m[r][k];
      Wide common = 0;
      for (int c = 0; c <= unknowns; ++c) {
        m[r][c] = m[r][c] * m[k][k] - factor * m[k][c];
        Wide a = m[r][c] < 0 ? -m[r][c] : m[r][c];
        while (a != 0) std::swap(common, a), a %= common;
      }
      if (common > 1)
        for (Wide& entry : m[r]) entry /= common;
    }
  }
  for (int r = unknowns; r < rows; ++r)
    if (m[r][unknowns] != 0) return false;
  for (int k = 0; k < unknowns; ++k)
    if (m[k][k] > 0 ? m[k][unknowns] < 0 : m[k][unknowns] > 0) return false;
  return true;
}

// Is there x >= 0 with M x = r? If so, then one that uses linearly independent columns only: try all sets of columns.
bool feasible(const WholeMatrix& m) {
  const int columns = static_cast<int>(m[0].size()) - 1;
  for (int set = 1; set < (1 << columns); ++set) {
    WholeMatrix part;
    for (const auto& full : m) {
      std::vector<Wide> picked;
      for (int c = 0; c < columns; ++c)
        if (set >> c & 1) picked.push_back(full[c]);
      picked.push_back(full[columns]);
      part.push_back(picked);
    }
    if (part[0].size() <= part.size() + 1 && nonnegative_solution(part)) return true;
  }
  return false;
}

bool share_a_point(const std::array<Whole, 6>& p) {
  WholeMatrix m(5, std::vector<Wide>(7, 0));
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k < 3; ++k) m[k][i] = i < 3 ? p[i][k] : -p[i][k];
    m[i < 3 ? 3 : 4][i] = 1;
  }
  m[3][6] = m[4][6] = 1;
  return feasible(m);
}

// Do the cones of the triangles at s share more than s? Then they share a point with some coordinate +1 or -1.
bool share_more_than(const Whole& s, const std::array<Whole, 4>& p) {
  for (int axis = 0; axis < 3; ++axis)
    for (int value : {-1, 1}) {
      WholeMatrix m(4, std::vector<Wide>(5, 0));
      for (int i = 0; i < 4; ++i) {
        for (int k = 0; k < 3; ++k) m[k][i] = (i < 2 ? 1 : -1) * (p[i][k] - s[k]);
        if (i < 2) m[3][i] = m[axis][i];
      }
      m[3][4] = value;
      if (feasible(m)) return true;
    }
  return false;
}

Vec3 real(const Whole& p) { return p.cast<double>(); }

// Far from the origin, on another scale and with other digits, yet the same answer: all of this is exact in doubles.
Vec3 disguised(const Whole& p) { return (p.cast<double>() + Vec3(65536, -32768, 4096)) * 0x1p-30; }

// What both tests of a pair say; they must not differ.
bool meet(const testing::Corners& a, const testing::Corners& b) {
  const bool solver = triangles_meet(a, b);
  REQUIRE(testing::audit_sees_meet(a, b) == solver);
  return solver;
}

bool meet(const std::array<Whole, 6>& p, Vec3 (*as)(const Whole&), const std::array<int, 6>& order) {
  return meet({as(p[order[0]]), as(p[order[1]]), as(p[order[2]])}, {as(p[order[3]]), as(p[order[4]]), as(p[order[5]])});
}

int reference_orientation(const std::array<Whole, 4>& p) {
  Eigen::Matrix<long, 3, 3> m;
  for (int i = 0; i < 3; ++i) m.col(i) = p[i + 1] - p[0];
  const Wide det = Wide(m(0, 0)) * (Wide(m(1, 1)) * m(2, 2) - Wide(m(1, 2)) * m(2, 1)) -
                   Wide(m(0, 1)) * (Wide(m(1, 0)) * m(2, 2) - Wide(m(1, 2)) * m(2, 0)) +
                   Wide(m(0, 2)) * (Wide(m(1, 0)) * m(2, 1) - Wide(m(1, 1)) * m(2, 0));
  return (det > 0) - (det < 0);
}

}  // namespace

TEST_CASE("intersect: orientation in space is exact near coplanarity", "[intersect]") {
  std::mt19937_64 random(1);
  std::uniform_int_distribution<long> at(-(1L << 38), 1L << 38), nudge(-1, 1), factor(-3, 3);
  int zero = 0;
  for (int i = 0; i < 20000; ++i) {
    std::array<Whole, 4> p;
    for (int k = 0; k < 3; ++k) p[k] = Whole(at(random), at(random), at(random));
    p[3] = p[0] + factor(random) * (p[1] - p[0]) + factor(random) * (p[2] - p[0]);
    if (i % 2) p[3] += Whole(nudge(random), nudge(random), nudge(random));
    const int expected = reference_orientation(p);
    zero += expected == 0;
    REQUIRE(orient3d(real(p[0]), real(p[1]), real(p[2]), real(p[3])) == expected);
    REQUIRE(orient3d(real(p[1]), real(p[0]), real(p[2]), real(p[3])) == -expected);
    REQUIRE(orient3d(real(p[3]), real(p[2]), real(p[1]), real(p[0])) == expected);
  }
  CHECK(zero > 5000);
  CHECK(zero < 15000);
}

TEST_CASE("intersect: orientation in the plane is exact where the floating determinant fails", "[intersect]") {
  // The classical picture: points within 256 ulp of (0.5, 0.5) against the line through (12, 12) and (24, 24).
  const double ulp = 0x1p-53;
  for (int i = 0; i < 256; ++i)
    for (int j = 0; j < 256; ++j) {
      const Vec2 p(0.5 + i * ulp, 0.5 + j * ulp);
      REQUIRE(orient2d(p, {12, 12}, {24, 24}) == (j < i ? 1 : j > i ? -1 : 0) * -1);
    }
}

TEST_CASE("intersect: no underflow, no overflow", "[intersect]") {
  for (double scale : {5e-324, 1e-320, 1e-200, 1e-100, 1.0, 1e100, 1e200, 1e307}) {
    CHECK(orient3d(Vec3::Zero(), {scale, 0, 0}, {0, scale, 0}, {0, 0, scale}) == 1);
    CHECK(orient3d(Vec3::Zero(), {scale, 0, 0}, {0, scale, 0}, {scale, scale, 0}) == 0);
    CHECK(orient3d(Vec3::Zero(), {scale, 0, 0}, {0, 1e307, 0}, {1, 1, -5e-324}) == -1);
    CHECK(orient2d(Vec2::Zero(), {scale, 0}, {1, scale}) == 1);
    CHECK(orient2d({-scale, -scale}, {0, 0}, {scale, scale}) == 0);
    CHECK(meet({Vec3(-scale, 0, 0), Vec3(scale, 0, 0), Vec3(0, scale, 0)},
               {Vec3(0, 0, -scale), Vec3(0, 0, scale), Vec3(scale, 0, scale)}));
  }
}

TEST_CASE("intersect: products that underflow do not mislead the filter", "[intersect]") {
  // In units of the smallest double the three minors are 1.49, -0.51 and -0.51; rounded they are 1, -1 and -1.
  const double s = 0x1p-537;
  CHECK(orient3d(Vec3::Zero(), {s, 0, 1}, {0, 1.49 * s, 1}, {0.342 * s, 0.51 * s, 1}) == 1);
}

TEST_CASE("intersect: whole numbers of many digits add, subtract and multiply exactly", "[intersect]") {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> mantissa(-1, 1);
  std::uniform_int_distribution<int> exponent(-300, 300);
  constexpr int lowest = -300 - 53;
  const auto number = [&] { return std::ldexp(std::round(std::ldexp(mantissa(random), 53)), exponent(random) - 53); };
  int wrong = 0;
  for (int i = 0; i < 20000; ++i) {
    const double x = number(), y = number(), z = number();
    const ExactInteger a(x, lowest), b(y, lowest), c(z, lowest);
    wrong += ((a + b) - b - a).sign() != 0;
    wrong += ((a + b) * c - a * c - b * c).sign() != 0;
    wrong += (a * b * c - c * a * b).sign() != 0;
    wrong += (a - b).sign() != (x > y) - (x < y);
    wrong += (a * b).sign() != ((x > 0) - (x < 0)) * ((y > 0) - (y < 0));
  }
  CHECK(wrong == 0);
}

TEST_CASE("intersect: triangle pairs on small whole numbers agree with exact linear programming", "[intersect]") {
  std::mt19937 random(2);
  int meeting = 0, total = 0;
  for (int round = 0; round < 9000; ++round) {
    // Coarser and flatter lattices make touching, coplanar and degenerate pairs the rule.
    const int size = 1 + round % 5, depth = round % 3 == 0 ? 0 : round % 3 == 1 ? 1 : size;
    std::uniform_int_distribution<long> at(-size, size), deep(-depth, depth);
    std::array<Whole, 6> p;
    for (Whole& point : p) point = Whole(at(random), at(random), deep(random));
    for (Whole& point : p)
      for (int turn = round % 7 % 3; turn > 0; --turn) point = Whole(point[1], point[2], point[0]);
    if (round % 11 == 0) p[4] = p[1];
    if (round % 13 == 0) p[2] = p[1];
    if (round % 17 == 0) p[5] = p[4] = p[3];
    const bool expected = share_a_point(p);
    ++total;
    meeting += expected;
    for (const auto& order :
         {std::array{0, 1, 2, 3, 4, 5}, {3, 4, 5, 0, 1, 2}, {1, 0, 2, 4, 5, 3}, {5, 4, 3, 2, 0, 1}}) {
      REQUIRE(meet(p, real, order) == expected);
      REQUIRE(meet(p, disguised, order) == expected);
    }
  }
  CHECK(meeting > total / 5);
  CHECK(meeting < total * 4 / 5);
}

TEST_CASE("intersect: pairs with a common vertex agree with exact linear programming", "[intersect]") {
  std::mt19937 random(3);
  int crossing = 0, total = 0;
  for (int round = 0; round < 9000; ++round) {
    const int size = 1 + round % 4, depth = round % 3 == 0 ? 0 : round % 3 == 1 ? 1 : size;
    std::uniform_int_distribution<long> at(-size, size), deep(-depth, depth);
    Whole s(at(random), at(random), deep(random));
    std::array<Whole, 4> p;
    for (Whole& point : p) point = Whole(at(random), at(random), deep(random));
    if (round % 11 == 0) p[1] = p[0];
    if (round % 13 == 0) p[2] = s;
    if (round % 17 == 0) p[3] = p[2];
    const bool expected = share_more_than(s, p);
    ++total;
    crossing += expected;
    for (auto as : {real, disguised}) {
      REQUIRE(triangles_cross_at_vertex(as(s), as(p[0]), as(p[1]), as(p[2]), as(p[3])) == expected);
      REQUIRE(triangles_cross_at_vertex(as(s), as(p[3]), as(p[2]), as(p[0]), as(p[1])) == expected);
    }
  }
  CHECK(crossing > total / 5);
  CHECK(crossing < total * 4 / 5);
}

TEST_CASE("intersect: one unit in the last place decides", "[intersect]") {
  const testing::Corners face{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 0, 1)};
  const double above = std::numeric_limits<double>::denorm_min(), beyond = std::nextafter(0.5, 1);
  CHECK(meet(face, {Vec3(0.25, 0, 0.25), Vec3(0.3, 1, 0.2), Vec3(0.2, 1, 0.3)}));
  CHECK_FALSE(meet(face, {Vec3(0.25, above, 0.25), Vec3(0.3, 1, 0.2), Vec3(0.2, 1, 0.3)}));
  CHECK(meet(face, {Vec3(0.5, -1, 0.5), Vec3(0.5, 1, 0.5), Vec3(2, 0, 2)}));
  CHECK_FALSE(meet(face, {Vec3(0.5, -1, beyond), Vec3(0.5, 1, beyond), Vec3(2, 0, 2)}));
}

TEST_CASE("intersect: the audit's and the solver's test of a pair agree", "[intersect]") {
  std::mt19937 random(9);
  std::uniform_int_distribution<int> entry(-2, 2);
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  constexpr int count = 100000;
#else
  constexpr int count = 1000000;
#endif
  int meeting = 0, degenerate = 0, wrong = 0;
  for (int i = 0; i < count; ++i) {
    // Few points of a lattice, sheared out of the planes of the axes: many pairs touch, lie in one plane or have a
    // degenerate triangle.
    const int size = 1 + i % 3, depth = i % 4 == 0 ? 0 : i % 4 == 1 ? 1 : size;
    std::uniform_int_distribution<int> at(-size, size), deep(-depth, depth);
    Mat3 shear;
    for (double& e : shear.reshaped()) e = entry(random);
    testing::Corners a, b;
    for (testing::Corners* t : {&a, &b})
      for (Vec3& p : *t) p = shear * Vec3(at(random), at(random), deep(random));
    const bool solver = triangles_meet(a, b);
    meeting += solver;
    degenerate += (a[1] - a[0]).cross(a[2] - a[0]).isZero(0) || (b[1] - b[0]).cross(b[2] - b[0]).isZero(0);
    wrong += solver != testing::audit_sees_meet(a, b);
  }
  CHECK(wrong == 0);
  CHECK(meeting > count / 5);
  CHECK(meeting < count * 4 / 5);
  CHECK(degenerate > count / 6);
}

TEST_CASE("intersect: the two tests agree on every pair of surfaces that make trouble", "[intersect]") {
  int meeting = 0, pairs = 0, wrong = 0;
  for (const testing::Tangle& m : testing::tangles(7)) {
    const int count = static_cast<int>(m.surface.triangles.rows());
    std::vector<testing::Corners> t;
    for (int i = 0; i < count; ++i) t.push_back(testing::corners(m, i));
    for (int i = 0; i < count; ++i)
      for (int j = 0; j < i; ++j, ++pairs) {
        const bool solver = triangles_meet(t[i], t[j]);
        meeting += solver;
        wrong += solver != testing::audit_sees_meet(t[i], t[j]);
      }
  }
  CHECK(wrong == 0);
  CHECK(meeting > 10000);
  CHECK(pairs > 200000);
}

}  // namespace selvedge::test_intersect
