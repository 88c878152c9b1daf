#include <map>

#include "collision/audit/audit_motion.hpp"
#include "collision/contact/contact_pairs.hpp"
#include "collision/contact/proximity.hpp"
#include "collision/contour/segments.hpp"
#include "collision/exact/inside.hpp"
#include "collision/geometry/parallel.hpp"
#include "collision/geometry/stop_scope.hpp"
#include "collision/search/intersections.hpp"
#include "collision/untangle/give_way.hpp"
#include "collision/untangle/untangle.hpp"
#include "tests/collision/solids.hpp"
#include "tests/frame.hpp"
#include "tests/physics/worlds.hpp"

namespace selvedge::test_stop_phases {

using testing::Sheet;
using testing::World;

namespace {

// Triangles with corners of their own, of which many coincide, as in a mesh whose faces share no vertices.
Sheet soup(int n) {
  const Sheet whole = testing::sheet(n, 0.6, 0.35);
  Sheet s{Points(3 * whole.triangles.rows(), 3), Triangles(whole.triangles.rows(), 3)};
  for (Eigen::Index t = 0; t < whole.triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k) {
      s.x.row(3 * t + k) = whole.x.row(whole.triangles(t, k));
      s.triangles(t, k) = static_cast<int>(3 * t) + k;
    }
  return s;
}

}  // namespace

TEST_CASE("every long phase of a step asks whether to stop, and ends where it is told to", "[stop_phases]") {
  const ThreadLimit one(1);  // how often many threads ask depends on who takes which part of a loop
  const Sheet cloth = soup(12);
  const Surface surface = cloth.surface();
  const testing::Solid ball = testing::ball(12);
  const Surface body = ball.surface;
  const AuditBody audited{&body, &ball.x};
  const MovingBody moving{&body, &ball.x, &ball.x};
  const Points fallen = cloth.x.rowwise() - Eigen::RowVector3d(0, 0.1, 0);
  const SheetView view{&surface, &cloth.x};
  const GiveWay tissue(body, ball.x);
  const ContactWorld world = make_contact_world(surface, {}, true);
  PairSearch search(world);
  IntersectionCache cache;
  std::vector<NodePair> pairs, found;
  search.find(cloth.x, fallen, 1e-3, pairs);
  REQUIRE(pairs.size() > 1000);
  const std::map<std::string, std::function<void()>> phases{
      {"audit of positions",
       [&] {
         audit(surface, cloth.x, {&audited, 1});
       }},
      {"audit of a motion",
       [&] {
         audit_motion(surface, cloth.x, fallen, {&moving, 1});
       }},
      {"smallest gap", [&] { min_gap(surface, cloth.x, {}, 0.01); }},
      {"pairs on a path", [&] { search.find(cloth.x, fallen, 1e-3, found); }},
      {"proximities", [&] { find_proximities(world, pairs, cloth.x, 1e-3); }},
      {"crossing triangles", [&] { intersecting_pairs(surface, cloth.x, cache); }},
      {"segments of contours",
       [&] {
         find_segments({&view, 1});
       }},
      {"winding numbers", [&] { winding_numbers(body, ball.x, cloth.x); }},
      {"untangling", [&] { untangle(surface, cloth.x, {}); }},
      {"soft tissue", [&] { tissue(ball.x); }}};
  for (const auto& [name, work] : phases) {
    INFO(name);
    int asked = 0;
    {
      const StopFlag never = [&] { return ++asked < 0; };
      const StopScope scope(never);
      CHECK_NOTHROW(work());
      CHECK(asked > 0);
    }
    int after = 0;
    const StopFlag at_once = [&] { return ++after > 0; };
    const StopScope scope(at_once);
    CHECK_THROWS_AS(work(), Stopped);
    CHECK(after <= 2);  // nothing goes on after it
  }
}

TEST_CASE("the audit of a motion asks every few proofs, of which one may be long", "[stop_phases]") {
  const ThreadLimit one(1);
  const Sheet cloth = soup(6);
  const Surface surface = cloth.surface();
  Points turned = cloth.x;  // about the vertical: what coincides stays so, but for rounding
  for (Eigen::Index v = 0; v < turned.rows(); ++v) turned.row(v) << -cloth.x(v, 2), cloth.x(v, 1), cloth.x(v, 0);
  int asked = 0;
  const StopFlag never = [&] { return ++asked < 0; };
  const StopScope scope(never);
  const MotionAudit found = audit_motion(surface, cloth.x, turned, {});
  REQUIRE(found.passed_through() > 100);
  CHECK(asked >= found.passed_through() / 16);
}

TEST_CASE("a step of a soup of coincident vertices ends wherever it is stopped", "[stop_phases]") {
  const ThreadLimit one(1);  // how often many threads ask depends on who takes which part of a loop
  World w = make_world(soup(4));
  const testing::Solid ball = testing::ball(10);
  add_obstacle(w, {Points(0.3 * ball.x), ball.surface.triangles});
  const auto stepper = testing::conventional(w.scene);
  int asked = 0;
  State to;
  REQUIRE(
      testing::frame(w.scene, *stepper, w.state, w.drive, 1.0 / 30, to, {.stop = [&] { return ++asked < 0; }}).reason !=
      Reason::stopped);
  REQUIRE(asked > 20);
  for (const int at : {0, 1, asked / 7, asked / 3, asked / 2, asked / 4 * 3}) {
    INFO("stopped after " << at << " of " << asked << " times");
    int now = 0, late = 0;
    const StopFlag stop = [&] {
      late += now > at;
      return now++ >= at;
    };
    const StepReport report =
        testing::frame(w.scene, *testing::conventional(w.scene), w.state, w.drive, 1.0 / 30, to, {.stop = stop});
    CHECK(report.reason == Reason::stopped);
    CHECK(report.status == StepStatus::rejected);
    CHECK(late < 20);
  }
}

}  // namespace selvedge::test_stop_phases
