#include <catch2/catch.hpp>

#include <algorithm>
#include <limits>
#include <set>

#include "collision/audit/audit_motion.hpp"
#include "tests/collision/tangles.hpp"
#include "tests/threads.hpp"

namespace selvedge::test_audit_motion {

using testing::grid_surface;
using testing::Tangle;
using testing::tangles;

namespace {

__extension__ using Wide = __int128;
using Poly = std::vector<Wide>;  // coefficients of 1, t, t^2, ... ; whole numbers throughout
using PolyVec = std::array<Poly, 3>;

Poly operator+(const Poly& a, const Poly& b) {
  Poly sum(std::max(a.size(), b.size()), 0);
  for (std::size_t i = 0; i < a.size(); ++i) sum[i] += a[i];
  for (std::size_t i = 0; i < b.size(); ++i) sum[i] += b[i];
  return sum;
}
Poly operator-(const Poly& a) {
  Poly negative = a;
  for (Wide& c : negative) c = -c;
  return negative;
}
Poly operator-(const Poly& a, const Poly& b) { return a + -b; }
Poly operator*(const Poly& a, const Poly& b) {
  Poly product(a.size() + b.size() - 1, 0);
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = 0; j < b.size(); ++j) product[i + j] += a[i] * b[j];
  return product;
}
PolyVec operator-(const PolyVec& a, const PolyVec& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Poly dot(const PolyVec& a, const PolyVec& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
PolyVec cross(const PolyVec& a, const PolyVec& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// Twelve times the Bernstein coefficients on [0, 1], degree at most 4.
Poly bernstein(const Poly& p) {
  const int n = static_cast<int>(p.size()) - 1;
  const auto choose = [](int m, int k) {
    Wide c = 1;
    for (int i = 0; i < k; ++i) c = c * (m - i) / (i + 1);
    return c;
  };
  Poly b(n + 1, 0);
  for (int i = 0; i <= n; ++i)
    for (int k = 0; k <= i; ++k) b[i] += 12 / choose(n, k) * choose(i, k) * p[k];
  return b;
}

// Halves of the interval, scaled by 2^degree.
std::array<Poly, 2> halves(Poly b) {
  const int n = static_cast<int>(b.size()) - 1;
  std::array<Poly, 2> parts{Poly(n + 1), Poly(n + 1)};
  for (int level = 0; level <= n; ++level) {
    parts[0][level] = b[0] << (n - level);
    parts[1][n - level] = b[n - level] << (n - level);
    for (int i = 0; i + level < n; ++i) b[i] = b[i] + b[i + 1];
  }
  return parts;
}

bool all_positive(const Poly& b) {
  return std::all_of(b.begin(), b.end(), [](Wide c) { return c > 0; });
}

enum class Verdict { apart, meets, unknown };

// Do the primitives meet while `volume`, which is zero where they lie in one plane, changes its sign, and all of
// `within` are positive? Exact; unknown where they only touch.
Verdict decide(const Poly& volume, const std::vector<Poly>& within, int depth) {
  if (all_positive(volume) || all_positive(-volume)) return Verdict::apart;
  if (std::any_of(within.begin(), within.end(), [](const Poly& p) { return all_positive(-p); })) return Verdict::apart;
  const bool crosses = (volume.front() > 0 && volume.back() < 0) || (volume.front() < 0 && volume.back() > 0);
  if (crosses && std::all_of(within.begin(), within.end(), all_positive)) return Verdict::meets;
  if (depth == 0) return Verdict::unknown;
  const auto volumes = halves(volume);
  std::array<std::vector<Poly>, 2> inner;
  for (const Poly& p : within) {
    const auto parts = halves(p);
    for (int h : {0, 1}) inner[h].push_back(parts[h]);
  }
  const Verdict early = decide(volumes[0], inner[0], depth - 1), late = decide(volumes[1], inner[1], depth - 1);
  if (early == Verdict::meets || late == Verdict::meets) return Verdict::meets;
  return early == Verdict::apart && late == Verdict::apart ? Verdict::apart : Verdict::unknown;
}

Verdict exact_verdict(const PassedPair& pair, const Points& x0, const Points& x1) {
  std::array<PolyVec, 4> x;
  for (int i = 0; i < 4; ++i)
    for (int k = 0; k < 3; ++k) {
      const auto from = static_cast<long>(x0(pair.nodes[i], k)), to = static_cast<long>(x1(pair.nodes[i], k));
      x[i][k] = {Wide(from), Wide(to - from)};
    }
  std::vector<Poly> within;
  Poly volume;
  if (pair.edges) {
    const PolyVec a = x[1] - x[0], b = x[3] - x[2], r = x[2] - x[0], n = cross(a, b);
    const Poly length = dot(n, n), along_a = dot(cross(r, b), n), along_b = dot(cross(r, a), n);
    volume = dot(n, r);
    within = {along_a, length - along_a, along_b, length - along_b};
  } else {
    const PolyVec n = cross(x[2] - x[1], x[3] - x[1]);
    volume = dot(n, x[0] - x[1]);
    for (int k = 0; k < 3; ++k) within.push_back(dot(n, cross(x[1 + (k + 1) % 3] - x[1 + k], x[0] - x[1 + k])));
  }
  for (Poly& p : within) p = bernstein(p);
  return decide(bernstein(volume), within, 12);
}

std::vector<PassedPair> every_pair(const Surface& s) {
  std::vector<PassedPair> all;
  for (int v = 0; v < s.vertex_count; ++v)
    for (int t = 0; t < s.triangles.rows(); ++t) {
      const auto f = s.triangles.row(t);
      if (v != f(0) && v != f(1) && v != f(2)) all.push_back({false, {v, f(0), f(1), f(2)}});
    }
  for (int a = 0; a < s.edges.rows(); ++a)
    for (int b = 0; b < a; ++b) {
      const int a0 = s.edges(a, 0), a1 = s.edges(a, 1), b0 = s.edges(b, 0), b1 = s.edges(b, 1);
      if (a0 != b0 && a0 != b1 && a1 != b0 && a1 != b1) all.push_back({true, {a0, a1, b0, b1}});
    }
  return all;
}

PassedPair canonical(PassedPair p) {
  auto& n = p.nodes;
  if (!p.edges) return p;
  if (n[1] < n[0]) std::swap(n[0], n[1]);
  if (n[3] < n[2]) std::swap(n[2], n[3]);
  if (std::pair(n[2], n[3]) < std::pair(n[0], n[1])) {
    std::swap(n[0], n[2]);
    std::swap(n[1], n[3]);
  }
  return p;
}

std::set<PassedPair> listed(const MotionAudit& audit) {
  std::set<PassedPair> all;
  for (const PassedPair& p : audit.passed) CHECK(all.insert(canonical(p)).second);
  return all;
}

MotionAudit audit_of(const Tangle& m, const Points& x1) { return audit_motion(m.surface, m.x, x1, {}); }

Points lattice(Eigen::Index count, int size, std::mt19937& random) {
  std::uniform_int_distribution<int> at(-size, size);
  Points x(count, 3);
  for (double& coordinate : x.reshaped()) coordinate = at(random);
  return x;
}

const auto flat = [](double u, double v) { return Vec3(u, 0, v); };

}  // namespace

TEST_CASE("audit of motion: whole-number meshes agree with exact polynomials", "[audit_motion]") {
  std::mt19937 random(11);
  int meet = 0, apart = 0, unknown = 0, missed = 0, cried_wolf = 0;
  for (int round = 0; round < 90; ++round) {
    Tangle m = grid_surface("grid", 2, 2, flat);
    // On coarse lattices most that is near is degenerate; on fine ones little is.
    const int size = round % 3 == 0 ? 2 : round % 3 == 1 ? 6 : 20;
    m.x = lattice(m.x.rows(), size, random);
    const Points x1 =
        round % 4 == 0 ? lattice(m.x.rows(), size, random) : Points(m.x + lattice(m.x.rows(), 1 + size / 4, random));
    const auto found = listed(audit_of(m, x1));
    for (const PassedPair& pair : every_pair(m.surface)) {
      const Verdict verdict = exact_verdict(pair, m.x, x1);
      const bool passed = found.count(canonical(pair)) == 1;
      meet += verdict == Verdict::meets;
      apart += verdict == Verdict::apart;
      unknown += verdict == Verdict::unknown;
      missed += verdict == Verdict::meets && !passed;
      cried_wolf += verdict == Verdict::apart && passed;
    }
  }
  CHECK(missed == 0);
  CHECK(cried_wolf == 0);
  CHECK(meet > 500);
  CHECK(apart > 5000);
  CHECK(unknown < apart);
}

TEST_CASE("audit of motion: what rests a little apart does not pass", "[audit_motion]") {
  for (const double gap : {1e-4, 1e-6, 1e-9}) {
    INFO(gap);
    // Two layers slide over each other, the upper one in waves, and both move along.
    const int n = 24;
    const auto layers = [&](double shift) {
      return [=](double u, double v) {
        const bool upper = u > 0.5;
        const double x = upper ? 1 - u + shift : u, wave = 0.01 * std::sin(9 * (x + 0.3 * v));
        return Vec3(x, 0.5 + 0.3 * x + wave + (upper ? gap : 0) + shift, v);
      };
    };
    // The crease of the folded sheet is left out: only rows away from it are near.
    Tangle lower = grid_surface("lower", n, n, [&](double u, double v) { return layers(0)(0.4 * u, v); });
    Tangle upper = grid_surface("upper", n, n, [&](double u, double v) { return layers(0)(1 - 0.4 * u, v); });
    const Points lower1 = lower.x.array() + 0.003, upper1 = upper.x.array() + 0.003;
    const MovingBody body{&lower.surface, &lower.x, &lower1};
    CHECK(audit_motion(upper.surface, upper.x, upper1, {&body, 1}).passed_through() == 0);
    // Pressed through by as much again, it does.
    Points through = upper1;
    through.col(1).array() -= 2 * gap;
    CHECK(audit_motion(upper.surface, upper.x, through, {&body, 1}).passed_through() > 0);
  }
}

TEST_CASE("audit of motion: a vertex through a face and back out leaves no state to see but is found",
          "[audit_motion]") {
  Triangles triangles(2, 3);
  triangles << 0, 1, 2, 3, 4, 5;
  Tangle m{"two", make_surface(6, triangles), Points(6, 3)};
  m.x << 0, 0, 0, 4, 0, 0, 0, 0, 4, 1, 1, 1, 1, 2, 1, 2, 2, 1;
  Points x1 = m.x;
  x1.bottomRows(3).col(1).array() -= 5;
  const MotionAudit audit = audit_of(m, x1);
  CHECK(listed(audit).count({false, {3, 0, 1, 2}}) == 1);
  CHECK(audit.passed_through() >= 2);
  x1.bottomRows(3).col(1).array() += 4.5;
  CHECK(audit_of(m, x1).passed_through() == 0);
}

TEST_CASE("audit of motion: rigid motion, rest and stretching of clean meshes pass nothing", "[audit_motion]") {
  for (const Tangle& m : tangles(9)) {
    if (m.name != "flat" && m.name != "flat and tilted" && m.name != "wavy" && m.name != "folded" &&
        m.name != "rising spiral" && m.name != "tube")
      continue;
    INFO(m.name);
    CHECK(audit_of(m, m.x).passed_through() == 0);
    CHECK(audit_of(m, m.x.array() + 0.7).passed_through() == 0);
    CHECK(audit_of(m, 1.5 * m.x).passed_through() == 0);
  }
}

TEST_CASE("audit of motion: bodies, their numbering, and no test of the cloth with itself", "[audit_motion]") {
  const Tangle cloth = grid_surface("cloth", 3, 3, [](double u, double v) { return Vec3(u, 0.1, v); });
  const Tangle beside = grid_surface("beside", 2, 2, [](double u, double v) { return Vec3(u + 5, 0, v); });
  const Tangle below =
      grid_surface("below", 2, 2, [](double u, double v) { return Vec3(2 * u - 0.52, 0, 2 * v - 0.53); });
  const Points risen = below.x.rowwise() + Vec3(0, 0.2, 0).transpose();
  const std::vector<MovingBody> still{{&beside.surface, &beside.x, &beside.x}, {&below.surface, &below.x, &below.x}};
  const std::vector<MovingBody> rising{{&beside.surface, &beside.x, &beside.x}, {&below.surface, &below.x, &risen}};
  CHECK(audit_motion(cloth.surface, cloth.x, cloth.x, still).passed_through() == 0);
  const MotionAudit audit = audit_motion(cloth.surface, cloth.x, cloth.x, rising);
  CHECK(audit.passed_through() >= 16);  // every vertex of the cloth, at least
  const int first = cloth.surface.vertex_count + beside.surface.vertex_count;
  for (const PassedPair& p : audit.passed) {
    CHECK(std::any_of(p.nodes.begin(), p.nodes.end(), [&](int n) { return n < cloth.surface.vertex_count; }));
    CHECK(std::any_of(p.nodes.begin(), p.nodes.end(), [&](int n) { return n >= first; }));
  }
  Tangle folded =
      grid_surface("folded", 6, 6, [](double u, double v) { return Vec3(std::min(u, 1 - u), 0.01 * u, v); });
  Points through = folded.x;
  through.col(1) *= -1;
  CHECK(audit_motion(folded.surface, folded.x, through, {}).passed_through() > 0);
  CHECK(audit_motion(folded.surface, folded.x, through, {}, false).passed_through() == 0);
}

TEST_CASE("audit of motion: undefined coordinates are counted and left out", "[audit_motion]") {
  Tangle m = grid_surface("grid", 4, 4, flat);
  Points x1 = m.x;
  x1(3, 1) = std::numeric_limits<double>::quiet_NaN();
  m.x(7, 0) = std::numeric_limits<double>::infinity();
  const MotionAudit audit = audit_of(m, x1);
  CHECK(audit.nonfinite == 2);
  CHECK(audit.passed_through() == 0);
  CHECK(audit_motion(make_surface(0, Triangles(0, 3)), Points(0, 3), Points(0, 3), {}).passed_through() == 0);
}

TEST_CASE("audit of motion: the same for any number of threads", "[audit_motion][threads]") {
  const Tangle m = tangles(12)[3];
  Points x1 = m.x;
  testing::shake(x1, 0.1, 9);
  std::vector<MotionAudit> found;
  for (int n : {1, 2, 3}) {
    with_threads(n, [&] { found.push_back(audit_of(m, x1)); });
  }
  CHECK(found[0].passed_through() > 0);
  CHECK(found[1].passed == found[0].passed);
  CHECK(found[2].passed == found[0].passed);
}

}  // namespace selvedge::test_audit_motion
