#include <catch2/catch.hpp>

#include "collision/search/intersections.hpp"
#include "learned/steppers/safeguard.hpp"
#include "physics/frame/frame_audits.hpp"
#include "tests/physics/worlds.hpp"

namespace selvedge::test_safeguard {

using testing::make_world;
using testing::World;

namespace {

// Two sheets of 15 cm, 1 cm apart; vertices of the upper one stand behind those of the lower one.
World two_sheets() {
  testing::Sheet upper = testing::sheet(6, 0.15, 0.01);
  upper.x.col(0).array() += 0.003;
  upper.x.col(2).array() += 0.005;
  return make_world(testing::join(testing::sheet(6, 0.15, 0), upper));
}

Points moved_down(const World& world, double distance, int vertices) {
  Points x = world.state.x;
  x.bottomRows(x.rows() / 2).topRows(vertices).col(1).array() -= distance;
  return x;
}

}  // namespace

TEST_CASE("A safeguard keeps cloth from passing through cloth", "[learned]") {
  const World world = two_sheets();
  const int all = static_cast<int>(world.state.x.rows() / 2);
  IntersectionCache cache;
  // Some vertices go 2 cm down, through the lower sheet; the tip alone would tear its neighbours' triangles through.
  Points to = moved_down(world, 0.02, 3);
  REQUIRE_FALSE(intersecting_pairs(world.scene.surface, to, cache).empty());
  Safeguard guard(world.scene, {.largest_zone = 0});
  const SafeguardReport report = guard(world.state.x, to);
  INFO(report.why);
  REQUIRE(report.kept);
  CHECK(report.impulses > 0);
  CHECK(intersecting_pairs(world.scene.surface, to, cache).empty());
  AuditMemory memory;
  const ContactWorld alone = make_contact_world(world.scene.surface, {}, true, &world.scene.rest);
  CHECK(audit_path(alone, {}, world.state.x, to, memory).passed_through() == 0);

  // What meets nothing stays as it is.
  Points free = moved_down(world, 0.004, all);
  const Points before = free;
  CHECK(guard(world.state.x, free).kept);
  CHECK(free == before);
}

TEST_CASE("A safeguard gives up as ContourCraft's released code does", "[learned]") {
  const World world = two_sheets();
  const auto why = [&](const SafeguardOptions& options, const Points& from, Points to) {
    const SafeguardReport report = Safeguard(world.scene, options)(from, to);
    CHECK(report.kept == report.why.empty());
    return report.why;
  };
  const int all = static_cast<int>(world.state.x.rows() / 2);
  const Points through = moved_down(world, 0.02, all);
  CHECK(why({.most_contacts = 3}, world.state.x, through).find("contacts") != std::string::npos);
  CHECK(why({.largest_zone = 0, .largest_impulse = 1e-4}, world.state.x, through).find("impulse") != std::string::npos);
  Points lost = through;
  lost(0, 0) = std::numeric_limits<double>::quiet_NaN();
  CHECK(why({}, world.state.x, lost).find("finite") != std::string::npos);
  CHECK(why({}, moved_down(world, 0.012, 3), world.state.x).find("before") != std::string::npos);
}

}  // namespace selvedge::test_safeguard
