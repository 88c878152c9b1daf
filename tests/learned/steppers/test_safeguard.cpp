#include <catch2/catch.hpp>

#include "collision/search/intersections.hpp"
#include "learned/steppers/learned_state.hpp"
#include "learned/steppers/safeguard.hpp"
#include "physics/frame/frame_audits.hpp"
#include "tests/frame.hpp"
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

Points moved_down(const World& world, double way, int vertices) {
  Points x = world.state.x;
  x.bottomRows(x.rows() / 2).topRows(vertices).col(1).array() -= way;
  return x;
}

// Goes to the positions that it was given, whatever the state is.
class FixedProposal final : public Stepper {
 public:
  explicit FixedProposal(Points x) : x_(std::move(x)) {}
  const StepperTraits& traits() const override { return traits_; }
  StepReport step(const State& from, const Drive& drive, double dt, State& to, const StepExtras&) override {
    to = {};
    to.time = from.time + dt;
    to.x = x_;
    to.v = (x_ - from.x) / dt;
    to.obstacles = drive.obstacles;
    to.memory = {{"learned.velocity", x_ - from.x}};
    StepReport report;
    report.status = StepStatus::accepted;
    return report;
  }

 private:
  Points x_;
  StepperTraits traits_{"fixed"};
};

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

TEST_CASE("A safeguarded stepper goes where the response lets it, and carries what is left of its velocity",
          "[learned]") {
  World world = two_sheets();
  world.scene.contact.self = true;
  const Points proposed = moved_down(world, 0.02, 3);
  const auto stepper = make_safeguarded(world.scene, std::make_unique<FixedProposal>(proposed), {.largest_zone = 0});
  CHECK(stepper->traits().name == "safeguarded fixed");
  State to;
  const StepReport report = testing::frame(world.scene, *stepper, world.state, world.drive, learned_dt, to);
  REQUIRE(report.status == StepStatus::accepted);
  CHECK(report.by == "safeguarded fixed");
  CHECK(report.collision.pairs_after == 0);
  CHECK(to.clean);
  CHECK(to.x != proposed);
  REQUIRE(to.memory.size() == 1);
  CHECK(to.memory[0].rows.isApprox(to.x - world.state.x, 1e-12));
  CHECK(to.v.isApprox((to.x - world.state.x) / learned_dt, 1e-9));

  const auto strict =
      make_safeguarded(world.scene, std::make_unique<FixedProposal>(proposed), {.largest_impulse = 1e-5});
  const StepReport refused = testing::frame(world.scene, *strict, world.state, world.drive, learned_dt, to);
  CHECK(refused.status == StepStatus::rejected);
  CHECK(refused.reason == Reason::penetrating);
}

}  // namespace selvedge::test_safeguard
