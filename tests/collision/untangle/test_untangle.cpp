#include <catch2/catch.hpp>

#include <cmath>

#include "collision/audit/audit.hpp"
#include "collision/contour/find_contours.hpp"
#include "collision/untangle/input_shape.hpp"
#include "collision/untangle/separation.hpp"
#include "collision/untangle/untangle.hpp"
#include "tests/collision/sheets.hpp"

namespace selvedge::test_untangle {

using testing::bent;
using testing::flat;
using testing::round_tube;

namespace {

const Vec2 jitter(0.003, 0.003);

// Two layers; the inner one is pushed through the outer one over 30 % of its area (depth 0.04) or 32 % (0.05).
testing::Sheet outfit(double depth) {
  const auto inner = [depth](double x, double angle) {
    const double q = std::pow(x / 0.45, 2) + std::pow((angle - 3) / 1.7, 2);
    return 0.30 + depth * (q < 1 ? std::pow(1 - std::pow(q, 4), 2) : 0);
  };
  return testing::join(round_tube(24, 48, 0, inner), round_tube(24, 48, 0.37, [](double, double) { return 0.32; }));
}

// Of the first layer's triangles, as a share.
double area_outside(const testing::Sheet& mesh, double radius) {
  double outside = 0, all = 0;
  for (int t = 0; t < mesh.triangles.rows() / 2; ++t) {
    const Vec3 a = row(mesh.x, mesh.triangles(t, 0)), b = row(mesh.x, mesh.triangles(t, 1)),
               c = row(mesh.x, mesh.triangles(t, 2));
    const double area = (b - a).cross(c - a).norm();
    all += area;
    if (((a + b + c) / 3).tail<2>().norm() > radius) outside += area;
  }
  return outside / all;
}

struct UntangleOutcome {
  Surface surface;
  UntangleResult result;
  Audit audited;
};

// What every untangled cloth must keep to.
UntangleOutcome untangled(const testing::Sheet& mesh, const UntangleOptions& options = {}) {
  UntangleOutcome out{make_surface(static_cast<int>(mesh.x.rows()), mesh.triangles), {}, {}};
  out.result = untangle(out.surface, mesh.x, {}, options);
  out.audited = audit(out.surface, out.result.x, {});
  CHECK(out.audited.intersecting_pairs() == out.result.pairs_after);
  CHECK(static_cast<int>(out.audited.vertex_pairs.size()) == out.result.vertex_pairs_after);
  CHECK(audit(out.surface, mesh.x, {}).intersecting_pairs() == out.result.pairs_before);
  const StretchRange stretch = extreme_stretch(input_shape(out.surface, mesh.x), out.result.x);
  CHECK(stretch.least > 0.5);
  CHECK(stretch.largest < 2);
  CHECK(stretch.least == out.result.least_stretch);
  CHECK(out.result.far_move < 0.1);
  CHECK(out.result.mean_move < 2);
  return out;
}

void check_clean(const UntangleOutcome& out) {
  CHECK(out.result.pairs_before > 0);
  CHECK(out.result.pairs_after == 0);
  CHECK(out.result.vertex_pairs_after == 0);
  CHECK(out.result.left.empty());
}

}  // namespace

TEST_CASE("untangle: a clean cloth is left alone", "[untangle]") {
  const testing::Sheet two =
      testing::join(flat(8, jitter), bent(8, jitter, [](double a, double b) { return Vec3(a, 1e-6, b); }));
  const UntangleOutcome out = untangled(two);
  CHECK(out.result.x == two.x);
  CHECK(out.result.iterations == 0);
}

TEST_CASE("untangle: a bump through a sheet goes back through", "[untangle]") {
  const auto bump = [](double a, double b) { return Vec3(a, 0.3 * std::exp(-12 * (a * a + b * b)) - 0.1, b); };
  const testing::Sheet mesh = testing::join(flat(18, jitter), bent(20, jitter, bump));
  const UntangleOutcome out = untangled(mesh);
  check_clean(out);
  // On the right side: the whole of the bump's sheet below the other one where both are level.
  for (int v = 0; v < mesh.x.rows(); ++v)
    if (row(mesh.x, v).norm() > 0.9) CHECK((out.result.x.row(v) - mesh.x.row(v)).norm() < 0.02);
}

TEST_CASE("untangle: what is held stays, and the other side goes all of the way", "[untangle]") {
  const auto bump = [](double a, double b) { return Vec3(a, 0.3 * std::exp(-12 * (a * a + b * b)) - 0.1, b); };
  const testing::Sheet level = flat(18, jitter), mesh = testing::join(level, bent(20, jitter, bump));
  const Eigen::Index count = level.x.rows();
  CHECK(untangled(mesh).result.x.topRows(count) != level.x);
  UntangleOptions options;
  options.held.assign(static_cast<std::size_t>(mesh.x.rows()), 0);
  std::fill_n(options.held.begin(), count, 1);
  const UntangleOutcome out = untangled(mesh, options);
  check_clean(out);
  CHECK(out.result.x.topRows(count) == level.x);
}

TEST_CASE("untangle: two layers that change places on the way round, one held at its boundary", "[untangle]") {
  const testing::Sheet mesh = testing::tucked();
  UntangleOptions options;
  for (const bool hold : {false, true}) {
    if (hold) {
      options.held.assign(static_cast<std::size_t>(mesh.x.rows()), 0);
      for (int v = 24 * 48; v < 25 * 48; ++v) options.held[v] = 1;
    }
    const UntangleOutcome out = untangled(mesh, options);
    check_clean(out);
    CHECK(out.result.iterations < 20);
    if (hold) CHECK(out.result.x.middleRows(24 * 48, 48) == mesh.x.middleRows(24 * 48, 48));
  }
}

TEST_CASE("untangle: a layer pushed through another over 30 % of its area", "[untangle]") {
  for (double depth : {0.04, 0.05}) {
    const testing::Sheet mesh = outfit(depth);
    CHECK(area_outside(mesh, 0.32) > 0.29);
    const UntangleOutcome out = untangled(mesh);
    check_clean(out);
    // The inner layer is inside again.
    const int half = static_cast<int>(mesh.x.rows()) / 2;
    double inner = 0, outer = 0;
    for (int v = 0; v < half; ++v) {
      inner = std::max(inner, row(out.result.x, v).tail<2>().norm());
      outer = std::max(outer, row(out.result.x, half + v).tail<2>().norm());
    }
    CHECK(inner < outer);
  }
}

TEST_CASE("untangle: what is pushed back pushes no clean layer through a body", "[untangle]") {
  // Two layers between two plates, which stand still, with less room than the gap that all of them want; the upper
  // layer has a bump through the upper plate.
  const double room = 0.0005;
  const auto bump = [=](double a, double b) { return Vec3(a, 0.02 * std::exp(-12 * (a * a + b * b)) - room, b); };
  const testing::Sheet upper = bent(20, jitter, bump);
  const testing::Sheet lower = bent(19, jitter, [=](double a, double b) { return Vec3(a, -2 * room, b); });
  const testing::Sheet mesh = testing::join(upper, lower);
  const testing::Sheet plates = testing::join(testing::sheet(7, 2.2, 0), testing::sheet(9, 2.2, -3 * room));
  const Surface cloth = make_surface(static_cast<int>(mesh.x.rows()), mesh.triangles);
  const Surface body = make_surface(static_cast<int>(plates.x.rows()), plates.triangles);
  const std::array obstacles{SheetView{&body, &plates.x}};
  for (int iterations : {2, 3, 4, 10}) {
    INFO(iterations);
    UntangleOptions options;
    options.iterations = iterations;
    const UntangleResult result = untangle(cloth, mesh.x, obstacles, options);
    const Audit found = audit(cloth, result.x, std::array{AuditBody{&body, &plates.x}});
    CHECK(found.self_pairs.empty());
    int of_lower = 0;
    for (const auto& [t, face] : found.obstacle_pairs) of_lower += t >= upper.triangles.rows();
    CHECK(of_lower == 0);
    CHECK(found.obstacle_pairs.empty() == (iterations == 10));
  }
}

TEST_CASE("untangle: tube through tube, all the way round", "[untangle]") {
  const auto band = [](double x, double) { return 0.30 + 0.05 * std::exp(-std::pow(x / 0.22, 4)); };
  check_clean(untangled(
      testing::join(round_tube(20, 40, 0, band), round_tube(20, 40, 0.37, [](double, double) { return 0.32; }))));
}

TEST_CASE("untangle: tubes that lean into each other part without falling into each other again", "[untangle]") {
  const auto round = [](double, double) { return 0.2; };
  testing::Sheet across = round_tube(30, 28, 0.1, round);
  for (int v = 0; v < across.x.rows(); ++v) {
    const Vec3 p = row(across.x, v);
    across.x.row(v) << p.y() + 0.01, p.x() + 0.02, p.z() + 0.25;
  }
  check_clean(untangled(testing::join(round_tube(30, 28, 0, round), across)));
}

TEST_CASE("untangle: the order of layers decides where most of a layer is through", "[untangle]") {
  // 70 % of the inner tube is outside: without a hint the rest follows it, with one it comes back.
  const auto wide = [](double x, double) { return x > -0.2 ? 0.335 : 0.305; };
  const testing::Sheet mesh =
      testing::join(round_tube(20, 40, 0, wide), round_tube(20, 40, 0.37, [](double, double) { return 0.32; }));
  const auto mean_radius = [&](const Points& x, int first) {
    double sum = 0;
    const int half = static_cast<int>(x.rows()) / 2;
    for (int v = first; v < first + half; ++v) sum += row(x, v).tail<2>().norm() / half;
    return sum;
  };
  const int half = static_cast<int>(mesh.x.rows()) / 2;
  const UntangleOutcome plain = untangled(mesh);
  check_clean(plain);
  CHECK(mean_radius(plain.result.x, 0) > mean_radius(plain.result.x, half));
  UntangleOptions options;
  options.layers = {0, 1};
  const UntangleOutcome ordered = untangled(mesh, options);
  check_clean(ordered);
  CHECK(mean_radius(ordered.result.x, 0) < mean_radius(ordered.result.x, half));
}

TEST_CASE("untangle: a corner through a sheet, which encloses nothing on it", "[untangle]") {
  const auto upright = [](double a, double b) { return Vec3(0.6 * (a - b), 0.6 * (a + b) + 1.05, 0.1 + 0.05 * a); };
  check_clean(untangled(testing::join(flat(20, jitter), bent(16, jitter, upright))));
}

TEST_CASE("untangle: cloth goes out of a closed body that stands still", "[untangle]") {
  // A sphere of latitudes, and a sheet that cuts its top.
  const int n = 16, m = 32;
  testing::Sheet ball = round_tube(n, m, 0, [](double x, double) { return std::sqrt(std::max(0.0, 0.25 - x * x)); });
  testing::Sheet closed{Points((n - 1) * m + 2, 3), Triangles(2 * (n - 1) * m, 3)};
  closed.x.topRows((n - 1) * m) = ball.x.middleRows(m, (n - 1) * m);
  closed.x.row((n - 1) * m) << -0.5, 0, 0;
  closed.x.row((n - 1) * m + 1) << 0.5, 0, 0;
  int next = 0;
  for (int t = 0; t < ball.triangles.rows(); ++t) {
    std::array<int, 3> corner{};
    for (int k = 0; k < 3; ++k) {
      const int v = ball.triangles(t, k);
      corner[k] = v < m ? (n - 1) * m : v >= n * m ? (n - 1) * m + 1 : v - m;
    }
    if (corner[0] != corner[1] && corner[1] != corner[2] && corner[2] != corner[0])
      closed.triangles.row(next++) << corner[0], corner[1], corner[2];
  }
  REQUIRE(next == closed.triangles.rows());
  const Surface body = make_surface(static_cast<int>(closed.x.rows()), closed.triangles);
  REQUIRE(is_closed(body));
  const testing::Sheet cloth = bent(24, jitter, [](double a, double b) { return Vec3(0.01 * a, 0.42 + 0.02 * b, b); });
  testing::Sheet level = cloth;
  for (int v = 0; v < level.x.rows(); ++v) level.x(v, 0) = 2.0 * (v % 25) / 24 - 1;
  const Surface surface = make_surface(static_cast<int>(level.x.rows()), level.triangles);
  const std::array obstacles{SheetView{&body, &closed.x}};
  const UntangleResult result = untangle(surface, level.x, obstacles);
  const Audit before = audit(surface, level.x, std::array{AuditBody{&body, &closed.x}});
  const Audit after = audit(surface, result.x, std::array{AuditBody{&body, &closed.x}});
  CHECK(before.inside_vertices > 5);
  CHECK(after.inside_vertices == 0);
  CHECK(after.intersecting_pairs() == 0);
  CHECK(result.least_stretch > 0.5);
  CHECK(result.largest_stretch < 2);
  // Let through, it is clean where it is.
  UntangleOptions through;
  through.let_through.assign(static_cast<std::size_t>(level.x.rows()), 1);
  CHECK(untangle(surface, level.x, obstacles, through).iterations == 0);
}

TEST_CASE("untangle: what cannot be parted is named, and the rest is kept in shape", "[untangle]") {
  testing::Sheet across = round_tube(20, 12, 0.1, [](double, double) { return 0.06; });
  for (int v = 0; v < across.x.rows(); ++v) {
    const Vec3 p = row(across.x, v);
    across.x.row(v) << p.z() + 0.013, p.x(), p.y() + 0.017;
  }
  UntangleOptions options;
  options.iterations = 20;
  const UntangleOutcome out =
      untangled(testing::join(round_tube(30, 40, 0, [](double, double) { return 0.3; }), across), options);
  CHECK(out.result.pairs_after > 0);
  REQUIRE_FALSE(out.result.left.empty());
  int pairs = 0;
  for (const Remainder& left : out.result.left) {
    pairs += left.pairs;
    CHECK(left.reason.find("piece 0 with piece 1: ") != std::string::npos);
  }
  CHECK(pairs == out.result.pairs_after);
}

TEST_CASE("untangle: the same at another scale, and twice the same bits", "[untangle]") {
  testing::Sheet mesh = outfit(0.04);
  const UntangleOutcome one = untangled(mesh), two = untangled(mesh);
  CHECK(one.result.x == two.result.x);
  mesh.x *= 1024;
  const UntangleOutcome large = untangled(mesh);
  check_clean(large);
  CHECK((large.result.x / 1024 - one.result.x).cwiseAbs().maxCoeff() < 1e-9);
}

TEST_CASE("untangle: separations move the wrong side and keep to their step", "[untangle]") {
  const auto bump = [](double a, double b) { return Vec3(a, 0.3 * std::exp(-12 * (a * a + b * b)) - 0.1, b); };
  const testing::Sheet mesh = testing::join(flat(18, jitter), bent(20, jitter, bump));
  const Surface surface = make_surface(static_cast<int>(mesh.x.rows()), mesh.triangles);
  const std::array sheets{SheetView{&surface, &mesh.x}};
  const Segments found = find_segments(sheets);
  const std::vector<Contour> contours = find_contours(sheets, found);
  const std::vector<Region> regions = enclosed_regions(sheets, found, contours);
  const double gap = 0.001, step = 0.02;
  const std::vector<Separation> separations = part_contours(sheets, found, contours, regions, {gap, step});
  CHECK(separations.size() > found.crossings.size());
  for (const Separation& s : separations) {
    double value = 0, sum = 0;
    for (int i = 0; i < s.count; ++i) {
      value += s.weight[i] * s.direction.dot(row(mesh.x, s.vertex[i]));
      sum += s.weight[i];
    }
    CHECK(std::abs(sum) < 1e-12);
    CHECK(s.direction.norm() == Approx(1));
    CHECK(s.least <= std::max(gap, value + step) + 1e-12);
    // The bump (the second sheet) goes down.
    for (int i = 0; i < s.count; ++i)
      if (s.vertex[i] >= 19 * 19 && s.weight[i] == 1) CHECK(s.direction.y() < 0);
  }
}

}  // namespace selvedge::test_untangle
