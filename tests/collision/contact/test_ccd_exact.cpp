#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <random>

#include "collision/contact/ccd.hpp"
#include "collision/contact/exact_contact.hpp"
#include "tests/collision/ccd_reference.hpp"
#include "tests/collision/transversal_queries.hpp"

namespace selvedge::test_ccd_exact {

using reference::Four;

namespace {

struct Tally {
  int queries = 0, contacts = 0, missed = 0, spurious = 0, late = 0;
  double earliness = 0, earliest = 0;
};

void add(Tally& tally, const transversal::Query& q) {
  const auto time = time_of_contact(q.kind, q.x0, q.x1, 0);
  ++tally.queries;
  tally.contacts += q.contact;
  tally.missed += q.contact && !time;
  tally.spurious += time && !q.contact;
  if (!q.contact || !time) return;
  tally.late += *time > q.root;
  tally.earliness += q.root - *time;
  tally.earliest = std::max(tally.earliest, q.root - *time);
}

void check(const Tally& t) {
  INFO(t.queries << " queries, " << t.contacts << " contacts, early by " << t.earliness / t.contacts << " in the mean, "
                 << t.earliest << " at most");
  CHECK(t.contacts > t.queries / 10);
  CHECK(t.contacts < t.queries - t.queries / 10);
  CHECK(t.missed == 0);
  CHECK(t.spurious == 0);
  CHECK(t.late == 0);
  CHECK(t.earliness < 1e-3 * t.contacts);
  CHECK(t.earliest <= 0x1p-29);
}

Tally random_transversal(int count, std::uint64_t seed) {
  transversal::Random random(seed);
  Tally tally;
  for (int i = 0; i < count; ++i) add(tally, transversal::query(random));
  return tally;
}

// Coarse lattices, where touching, coplanar, parallel and standing pairs are the rule.
struct Pair {
  PairKind kind;
  Four x0, x1;
};

Pair lattice_pair(std::mt19937& random, int round) {
  const int size = 1 + round % 3, style = round % 4;
  std::uniform_int_distribution<int> at(-size, size);
  const auto point = [&](bool planar) {
    const int x = at(random), y = at(random), z = planar ? 0 : at(random);
    return Vec3(x, y, z);
  };
  Pair p{round / 7 % 2 ? PairKind::edge_edge : PairKind::vertex_face, {}, {}};
  // Or nearly so: on a lattice finer by 8 or 16 bits, up to the last one.
  const bool special = style == 1 || style == 2 || round % 11 * (round % 13) * (round % 17) * (round % 19) == 0;
  const int finer = special ? 0 : 8 * (round / 4 % 3);
  for (auto* x : {&p.x0, &p.x1})
    for (Vec3& node : *x) {
      node = std::ldexp(1.0, finer) * point(style == 1);
      if (finer > 0) node += point(false);
    }
  for (int k = 0; k < 4 && style == 2; ++k)
    if (at(random) > 0) p.x1[k] = p.x0[k];
  const Vec3 shift = point(false);
  for (int k = 0; k < 4 && round % 11 == 0; ++k) p.x1[k] = p.x0[k] + shift;
  for (auto* x : {&p.x0, &p.x1}) {
    if (round % 13 == 0) (*x)[3] = (*x)[2] + (*x)[1] - (*x)[0];
    if (round % 17 == 0) (*x)[3] = (*x)[2];
    if (round % 19 == 0) (*x)[1] = (*x)[0];
  }
  return p;
}

int disagreements(int rounds, unsigned seed) {
  std::mt19937 random(seed);
  int wrong = 0, contacts = 0;
  for (int round = 0; round < rounds; ++round) {
    const Pair p = lattice_pair(random, round);
    const auto time = time_of_contact(p.kind, p.x0, p.x1, 0);
    const auto truth = reference::first_contact(p.kind, p.x0, p.x1);
    const bool right =
        time.has_value() == truth.has_value() && (!truth || reference::is_just_before(*time, *truth, 2e-9));
    if (!right) UNSCOPED_INFO("seed " << seed << ", round " << round << ": " << time.value_or(-1));
    wrong += !right;
    contacts += truth.has_value();
  }
  CHECK(contacts > rounds / 5);
  CHECK(contacts < rounds - rounds / 5);
  return wrong;
}

Four scaled(Four x, double factor, const Vec3& shift = Vec3::Zero()) {
  for (Vec3& node : x) node = factor * (node + shift);
  return x;
}

constexpr double infinity = std::numeric_limits<double>::infinity();
const Four over_face{Vec3(0, 1, 0), Vec3(-2, 0, -2), Vec3(-2, 0, 3), Vec3(3, 0, -2)};
const Four crossed{Vec3(-1, 1, 0), Vec3(1, 1, 0), Vec3(0, 0, -1), Vec3(0, 0, 1)};

}  // namespace

TEST_CASE("ccd: random transversal motions with rational times", "[ccd]") { check(random_transversal(20000, 1)); }

TEST_CASE("ccd: a million random transversal motions with rational times", "[.long][ccd-million]") {
  const Tally tally = random_transversal(1000000, 2);
  WARN(tally.contacts << " contacts, early by " << tally.earliness / tally.contacts << " in the mean, "
                      << tally.earliest << " at most");
  check(tally);
}

TEST_CASE("ccd: transversal motions at any scale and far from the origin", "[ccd]") {
  transversal::Random random(3);
  for (int exponent : {-1000, -300, -40, 40, 300, 1000}) {
    Tally tally;
    for (int i = 0; i < 500; ++i) {
      const auto q = transversal::query(random);
      const auto moved = transversal::scaled(q, exponent, Vec3::Zero());
      add(tally, moved);
      // Scaling by a power of two changes no bit but the exponents'.
      REQUIRE(time_of_contact(q.kind, q.x0, q.x1, 0) == time_of_contact(q.kind, moved.x0, moved.x1, 0));
    }
    INFO("2^" << exponent);
    check(tally);
  }
  for (double far : {0x1p20, 0x1p37}) {
    Tally tally;
    for (int i = 0; i < 500; ++i)
      add(tally, transversal::scaled(transversal::query(random), i % 3 * 40 - 40, Vec3(far, -far, 0.5 * far)));
    INFO("from " << far);
    check(tally);
  }
}

TEST_CASE("ccd: agrees with algebra on lattices", "[ccd]") { CHECK(disagreements(1500, 1) == 0); }

TEST_CASE("ccd: agrees with algebra on many lattices", "[.long][ccd-lattices]") {
  for (unsigned seed = 2; seed < 22; ++seed) CHECK(disagreements(5000, seed) == 0);
}

TEST_CASE("ccd: the order of corners, edges and axes and the place do not matter to a contact", "[ccd]") {
  std::mt19937 random(4);
  int contacts = 0;
  for (int round = 0; round < 3000; ++round) {
    const Pair p = lattice_pair(random, round);
    const bool contact = time_of_contact(p.kind, p.x0, p.x1, 0).has_value();
    contacts += contact;
    const auto same = [&](const Four& x0, const Four& x1) {
      REQUIRE(time_of_contact(p.kind, x0, x1, 0).has_value() == contact);
    };
    same(p.x1, p.x0);
    const Vec3 far(0x1p40, -0x1p38, 3);
    same(scaled(p.x0, 0x1p-30, far), scaled(p.x1, 0x1p-30, far));
    const auto permuted = [](const Four& x, const std::array<int, 4>& order) {
      return Four{x[order[0]], x[order[1]], x[order[2]], x[order[3]]};
    };
    for (const auto& order : p.kind == PairKind::vertex_face
                                 ? std::vector<std::array<int, 4>>{{0, 2, 1, 3}, {0, 2, 3, 1}, {0, 3, 2, 1}}
                                 : std::vector<std::array<int, 4>>{{1, 0, 2, 3}, {0, 1, 3, 2}, {2, 3, 0, 1}})
      same(permuted(p.x0, order), permuted(p.x1, order));
    Four y0, y1;
    for (int k = 0; k < 4; ++k) {
      y0[k] = Vec3(p.x0[k].z(), -p.x0[k].x(), p.x0[k].y());
      y1[k] = Vec3(p.x1[k].z(), -p.x1[k].x(), p.x1[k].y());
    }
    same(y0, y1);
  }
  CHECK(contacts > 500);
}

TEST_CASE("ccd: touching starts, ends and standing pairs are decided to the last digit", "[ccd]") {
  const double above = std::numeric_limits<double>::denorm_min();
  for (double scale : {1e-12, 1.0, 1e12}) {
    Four touching = scaled(over_face, scale), hovering = touching, high = touching;
    touching[0].y() = 0;
    hovering[0].y() = above;
    const auto time = [](const Four& x0, const Four& x1) { return time_of_contact(PairKind::vertex_face, x0, x1, 0); };
    CHECK(time(touching, touching) == std::optional(0.0));
    CHECK(time(touching, high) == std::optional(0.0));
    CHECK_FALSE(time(hovering, hovering));
    CHECK_FALSE(time(hovering, high));
    CHECK_FALSE(time(high, hovering));
    REQUIRE(time(high, touching));
    CHECK(*time(high, touching) <= 1);
    CHECK(*time(high, touching) > 1 - 1e-11);
    // Over the face all along, one digit above it, and off its border in its plane.
    Four slid = hovering;
    slid[0].x() = -scale;
    CHECK_FALSE(time(hovering, slid));
    slid[0].y() = -above;
    CHECK(time(hovering, slid));
    Four outside = touching, closer = touching;
    outside[0].x() = -3 * scale;
    closer[0].x() = std::nextafter(-2 * scale, -infinity);
    CHECK_FALSE(time(outside, closer));
    CHECK_FALSE(time(outside, outside));
    closer[0].x() = -2 * scale;
    CHECK(time(outside, closer));
  }
}

TEST_CASE("ccd: parallel edges and degenerate primitives", "[ccd]") {
  const auto time = [](const Four& x0, const Four& x1) { return time_of_contact(PairKind::edge_edge, x0, x1, 0); };
  const Four apart{Vec3(0, 1, 0), Vec3(4, 1, 0), Vec3(1, 0, 0), Vec3(3, 0, 0)};
  Four through = apart, beside = apart, touching_end = apart;
  through[0].y() = through[1].y() = -1;
  beside[0] = Vec3(3.5, -1, 0), beside[1] = Vec3(7.5, -1, 0);
  CHECK(time(apart, through).value_or(-1) == Approx(0.5).epsilon(1e-11));
  CHECK(time(apart, beside));  // at one half from 1.75 on
  beside[0].x() = 10, beside[1].x() = 14;
  CHECK_FALSE(time(apart, beside));
  touching_end[0] = Vec3(6, -1, 0), touching_end[1] = Vec3(10, -1, 0);  // ends meet at one half
  CHECK(time(apart, touching_end).value_or(-1) == Approx(0.5).epsilon(1e-11));
  CHECK(time(apart, touching_end).value_or(1) <= 0.5);

  // Edges and faces that are points or lines, moving through each other.
  const Vec3 a(1, 2, 3), b(3, 2, 1), middle(2, 2, 2), off(2, 2, 2 + 0x1p-50);
  CHECK(time({a, a, b, b}, {b, b, a, a}).value_or(-1) == Approx(0.5).epsilon(1e-11));
  CHECK_FALSE(time({a, a, b, b}, {b, b, a, a + Vec3(0, 0, 0x1p-40)}) == std::optional(1.0));
  const auto face = [](const Four& x0, const Four& x1) { return time_of_contact(PairKind::vertex_face, x0, x1, 0); };
  CHECK(face({middle, a, b, b}, {middle, a, b, b}) == std::optional(0.0));
  CHECK_FALSE(face({off, a, b, b}, {off, a, b, b}));
  CHECK(face({off, a, b, b}, {middle - off + middle, a, b, b}).value_or(-1) == Approx(0.5).epsilon(1e-11));
  CHECK_FALSE(face({off, a, b, b}, {off + Vec3(0, 1, 0), a, b, b}));
}

TEST_CASE("ccd: a distance above zero is never undercut, by exact arithmetic", "[ccd]") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> part(0, 1);
  // Gap at a time of nodes in motion along y, less the separation: all doubles as they are.
  const auto gap_sign = [](double y0, double y1, double time, double separation) {
    const int length = std::min({lowest_exponent(y0), lowest_exponent(y1), lowest_exponent(separation)});
    const int moment = std::min(lowest_exponent(time), 0);
    const ExactInteger after(time, moment), one(1, moment);
    return (ExactInteger(y0, length) * (one - after) + ExactInteger(y1, length) * after -
            ExactInteger(separation, length) * one)
        .sign();
  };
  int reported = 0;
  for (double scale : {1e-12, 1e-6, 1e-3, 1.0, 1e3, 1e12})
    for (int i = 0; i < 2000; ++i) {
      const double high = scale * (0.1 + part(random)), separation = high * part(random) * 0.99;
      const double end = scale * (2 * part(random) - 1);
      const bool edges = i % 2;
      Four x0 = scaled(edges ? crossed : over_face, scale), x1 = x0;
      for (int k = 0; k < (edges ? 2 : 1); ++k) {
        x0[k].y() = high;
        x1[k].y() = end;
        x1[k].x() += 0.1 * scale * part(random);
      }
      const auto time = time_of_contact(edges ? PairKind::edge_edge : PairKind::vertex_face, x0, x1, separation);
      if (!time) {
        REQUIRE(end > separation);
        continue;
      }
      ++reported;
      REQUIRE(gap_sign(high, end, *time, separation) >= 0);
      if (*time < 1) REQUIRE(gap_sign(high, end, std::min(1.0, *time + 1e-12), separation) <= 0);
    }
  CHECK(reported > 4000);
}

TEST_CASE("ccd: a slanted face is never approached farther, by exact arithmetic", "[ccd]") {
  transversal::Random random(6);
  std::uniform_real_distribution<double> part(0, 1);
  int reported = 0, tight = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 a = transversal::whole_vector(random, 50), b = transversal::whole_vector(random, 50),
               c = transversal::whole_vector(random, 50), normal = (b - a).cross(c - a), middle = (a + b + c) / 3;
    if (normal.norm() < 500) continue;
    const Vec3 aside(part(random), part(random), part(random));
    const Four x0{middle + (1 + part(random)) * normal.normalized(), a, b, c};
    const Four x1{middle + (part(random) - 0.5) * normal.normalized() + 0.1 * aside, a, b, c};
    const double separation = i % 3 == 0 ? 0 : part(random);
    const auto time = time_of_contact(PairKind::vertex_face, x0, x1, separation);
    if (!time) continue;
    ++reported;
    // (normal . (v(t) - a))^2 against (separation |normal|)^2, in units of 2^length and its square.
    int length = lowest_exponent(separation);
    for (int axis = 0; axis < 3; ++axis)
      length = std::min({length, lowest_exponent(x0[0][axis]), lowest_exponent(x1[0][axis]), 0});
    const auto excess = [&](double at) {
      const int moment = std::min(lowest_exponent(at), 0);
      const ExactInteger after(at, moment), one(1, moment), before = one - after;
      ExactInteger height, normal2;
      for (int axis = 0; axis < 3; ++axis) {
        const ExactInteger n(normal[axis], 0);
        height = height + n * (ExactInteger(x0[0][axis], length) * before + ExactInteger(x1[0][axis], length) * after -
                               ExactInteger(a[axis], length) * one);
        normal2 = normal2 + n * n;
      }
      const ExactInteger least = ExactInteger(separation, length) * one;
      return height.sign() > 0 ? (height * height - least * least * normal2).sign() : height.sign() - 1;
    };
    REQUIRE(excess(*time) >= (separation > 0 ? 0 : -1));
    tight += excess(std::min(1.0, *time + 1e-9)) <= 0;
  }
  CHECK(reported > 5000);
  CHECK(tight > reported - reported / 100);
}

TEST_CASE("ccd: what is capped counts as contact", "[ccd]") {
  Four x0 = over_face, x1 = over_face;
  x0[0].x() = -3, x1[0].x() = 4;
  x0[0].y() = x1[0].y() = 0x1p-60;
  CHECK_FALSE(time_of_contact(PairKind::vertex_face, x0, x1, 0));
  const MovingPolygon polygon = moving_polygon(PairKind::vertex_face, x0, x1);
  int intervals = 0;
  const auto capped = exact_contact(PairKind::vertex_face, x0, x1, polygon, 0, 1, intervals);
  REQUIRE(capped);
  CHECK(capped->time == 0);
  CHECK_FALSE(capped->certain);
  intervals = 1;
  CHECK_FALSE(exact_contact(PairKind::vertex_face, x0, x1, polygon, 0.5, 1, intervals));
  CHECK(intervals == 0);
  const auto hasty = time_of_contact(PairKind::edge_edge, crossed, scaled(crossed, -1), 0, 1);
  REQUIRE(hasty);
  CHECK(*hasty <= 0.5);
}

TEST_CASE("ccd: coordinates beyond what differences can hold", "[ccd]") {
  constexpr double huge = std::numeric_limits<double>::max();
  Four x0 = scaled(over_face, huge / 4), x1 = x0;
  x0[0].y() = huge, x1[0].y() = -huge;
  x0[1].y() = x0[2].y() = x0[3].y() = x1[1].y() = x1[2].y() = x1[3].y() = -huge / 2;
  const auto time = time_of_contact(PairKind::vertex_face, x0, x1, 0);
  CHECK(time.value_or(-1) == Approx(0.75).epsilon(1e-11));
  CHECK(time.value_or(1) <= 0.75);
  CHECK(time_of_contact(PairKind::vertex_face, x0, x1, huge / 8).value_or(-1) == Approx(0.6875).epsilon(1e-11));
  x1[0].y() = huge / 2;
  CHECK_FALSE(time_of_contact(PairKind::vertex_face, x0, x1, 0));
}

}  // namespace selvedge::test_ccd_exact
