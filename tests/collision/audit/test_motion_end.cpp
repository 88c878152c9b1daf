#include <catch2/catch.hpp>

#include <random>

#include "collision/audit/audit.hpp"
#include "collision/audit/audit_memory.hpp"
#include "collision/audit/audit_motion.hpp"
#include "tests/collision/sheets.hpp"

namespace selvedge::test_motion_end {

namespace {

Points rounded(const Points& x) { return x.cast<float>().cast<double>(); }

bool same(const Audit& a, const Audit& b) {
  return a.self_pairs == b.self_pairs && a.vertex_pairs == b.vertex_pairs && a.obstacle_pairs == b.obstacle_pairs &&
         a.inside_vertices == b.inside_vertices && a.nonfinite == b.nonfinite;
}

// Two sheets over a floor far from the origin, where coordinates in float are a quarter of a micrometre apart.
struct FarAway {
  testing::Sheet sheets = testing::join(testing::sheet(5, 0.2, 0.004), testing::sheet(5, 0.2, 0.0));
  testing::Sheet under = testing::sheet(3, 0.4, -0.004);
  Surface cloth = make_surface(static_cast<int>(sheets.x.rows()), sheets.triangles), floor = under.surface();
  Points x = sheets.x.rowwise() + Eigen::RowVector3d(2.1, 2.3, 2.7),
         y = under.x.rowwise() + Eigen::RowVector3d(2.1, 2.3, 2.7);

  Audit state(const Points& at, AuditMemory* memory, bool self = true) const {
    const std::vector<AuditBody> bodies{{&floor, &y}};
    return audit(cloth, at, bodies, self, memory);
  }
  void move(const Points& from, AuditMemory& memory, bool self = true) const {
    const std::vector<MovingBody> bodies{{&floor, &y, &y}};
    audit_motion(cloth, from, x, bodies, self, &memory);
  }
};

}  // namespace

TEST_CASE("motion end: the state after a fast motion, rounded, is judged as without memory", "[audit_memory]") {
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  int pairs = 0, of_floor = 0, clean = 0, at_end = 0;
  for (int trial = 0; trial < 300; ++trial) {
    FarAway scene;
    scene.y = rounded(scene.y);
    AuditMemory memory;
    const Points from = scene.x;
    const double size = trial % 3 == 0 ? 1e-4 : trial % 3 == 1 ? 1.5e-3 : 4e-3;
    for (int v = 0; v < scene.x.rows(); ++v)
      scene.x.row(v) += Eigen::RowVector3d(0.05 + size * normal(random), size * normal(random), size * normal(random));
    scene.move(from, memory);
    const std::vector<MovingBody> bodies{{&scene.floor, &scene.y, &scene.y}};
    const Points x = rounded(scene.x);
    at_end += is_at_end(memory.end, {&scene.cloth, &x, &x}, bodies, true);
    const Audit plain = scene.state(x, nullptr);
    CHECK(same(scene.state(x, &memory), plain));
    pairs += static_cast<int>(plain.self_pairs.size() + plain.vertex_pairs.size());
    of_floor += static_cast<int>(plain.obstacle_pairs.size());
    clean += plain.intersecting_pairs() == 0;
  }
  CHECK(at_end == 300);
  CHECK(pairs > 100);
  CHECK(of_floor > 100);
  CHECK(clean > 50);
}

TEST_CASE("motion end: a crossing that rounding alone makes is seen", "[audit_memory]") {
  // The upper sheet ends 3e-8 m above the lower one, which float cannot tell.
  FarAway scene;
  scene.y = rounded(scene.y);
  AuditMemory memory;
  const Points from = scene.x;
  scene.x.topRows(36).col(1).array() = 2.3 + 3e-8;
  scene.x.bottomRows(36).col(1).array() = 2.3;
  scene.x.col(0).array() += 0.03;
  scene.move(from, memory);
  CHECK(scene.state(scene.x, nullptr).intersecting_pairs() == 0);
  const Points x = rounded(scene.x);
  CHECK(scene.state(x, nullptr).intersecting_pairs() > 0);
  CHECK(same(scene.state(x, &memory), scene.state(x, nullptr)));
}

TEST_CASE("motion end: it serves only where the motion ended, and what was asked then", "[audit_memory]") {
  FarAway scene;
  scene.y = rounded(scene.y);
  AuditMemory memory;
  const Points from = scene.x;
  scene.x.col(0).array() += 0.03;
  for (int v = 0; v < 36; v += 2) scene.x(v, 1) -= 0.005;  // through the lower sheet
  scene.move(from, memory);
  const Points x = rounded(scene.x);
  const Audit plain = scene.state(x, nullptr);
  REQUIRE(plain.intersecting_pairs() > 0);
  AuditMemory copy = memory;
  REQUIRE(same(scene.state(x, &copy), plain));

  SECTION("the pairs that it lists are all that is looked at") {
    memory.end.self_pairs.clear();
    CHECK(scene.state(x, &memory).self_pairs.empty());
  }
  SECTION("a vertex elsewhere, or undefined, is not at the end") {
    for (const double there : {x(40, 1) + 1e-5, std::numeric_limits<double>::quiet_NaN()}) {
      AuditMemory emptied = memory;
      emptied.end.self_pairs.clear();
      Points other = x;
      other(40, 1) = there;
      CHECK(same(scene.state(other, &emptied), scene.state(other, nullptr)));
    }
  }
  SECTION("after another motion, one that the memory cut short or not, it is another end") {
    const Points before = scene.x;
    scene.x.col(2).array() += 0.02;
    scene.move(before, memory);
    CHECK(same(scene.state(rounded(scene.x), &memory), scene.state(rounded(scene.x), nullptr)));
    CHECK(same(scene.state(x, &memory), plain));
  }
  SECTION("what was undefined where the motion began was not looked at") {
    AuditMemory of_broken;
    Points broken = from;
    broken(4, 1) = std::numeric_limits<double>::quiet_NaN();
    scene.move(broken, of_broken);
    CHECK(same(scene.state(x, &of_broken), plain));
  }
  SECTION("without pairs of the cloth with itself it does not serve an audit with them") {
    AuditMemory of_floor_alone;
    scene.move(from, of_floor_alone, false);
    const std::vector<MovingBody> bodies{{&scene.floor, &scene.y, &scene.y}};
    CHECK(is_at_end(of_floor_alone.end, {&scene.cloth, &x, &x}, bodies, false));
    CHECK_FALSE(is_at_end(of_floor_alone.end, {&scene.cloth, &x, &x}, bodies, true));
  }
}

}  // namespace selvedge::test_motion_end
