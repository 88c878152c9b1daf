#include <catch2/catch.hpp>

#include "collision/search/intersections.hpp"
#include "physics/recovery/recovery.hpp"
#include "pipeline/obstacles/setup_paths.hpp"
#include "pipeline/run/prepare.hpp"
#include "pipeline/scene/make_stepper.hpp"
#include "tests/frame.hpp"

namespace selvedge::test_legs_crossing {

namespace {

// 1 for the body's vertices that are switched off, or within two rings of such.
std::vector<char> near_switched_off(const ContactWorld& world, const Exemption& exemption) {
  const Surface& body = *world.obstacles[0];
  std::vector<char> near(static_cast<std::size_t>(body.vertex_count), 0);
  if (exemption.switched_off.empty()) return near;
  for (int v = 0; v < body.vertex_count; ++v) near[v] = exemption.switched_off[world.first_node[0] + v];
  for (int ring = 0; ring < 2; ++ring) {
    std::vector<char> next = near;
    for (const auto& triangle : body.triangles.rowwise())
      if (near[triangle[0]] || near[triangle[1]] || near[triangle[2]])
        for (const int v : triangle) next[v] = 1;
    near = std::move(next);
  }
  return near;
}

}  // namespace

// Each foot of the mannequin steps to the far side of the other one; shins and thighs go through each other. The work
// is counted, not timed.
TEST_CASE("legs that go through each other in wide trousers: what they carry neither piles up nor costs much",
          "[.long]") {
  const Setup setup = read_setup(config_folder() / "wardrobe" / "garment.yaml",
                                 {"obstacles.0.body.clip=legs_crossing", "cloths.0.garment.cut=wide_trousers"});
  const Surface &cloth = setup.scene.surface, &body = setup.scene.obstacles[0].surface;
  const ContactWorld world = make_contact_world(cloth, {&body}, true);
  SelfCrossings crossings(world);
  const auto stepper = make_stepper(setup);
  const double dt = 1 / setup.run.fps;
  State state = prepare(setup).value().state, to;
  int before = 0, most = 0, passes = 0, frames = 0;
  long outside = 0, late = 0;
  IntersectionCache of_cloth, of_body;
  for (; state.frame < 112; state = to) {
    const StepReport report = testing::frame(setup.scene, *stepper, state, setup.drive_at(state.time + dt), dt, to);
    REQUIRE(report.status == StepStatus::accepted);
    Exemption exemption;
    crossings.switch_off(gather_nodes(state.x, {state.obstacles[0]}), gather_nodes(to.x, {to.obstacles[0]}),
                         setup.drive_at(state.time + dt).skinned_targets, exemption);
    const bool crosses = !exemption.switched_off.empty();
    if (crosses && to.frame < 103) {
      ++frames;
      most = std::max(most, report.iterations);
      passes += report.untangling;
      const std::vector<char> near = near_switched_off(world, exemption);
      for (const auto& [a, t] : intersecting_pairs(cloth, to.x, of_cloth, body, to.obstacles[0], of_body)) {
        const auto corners = body.triangles.row(t);
        outside += !near[corners[0]] && !near[corners[1]] && !near[corners[2]];
      }
    } else if (frames == 0) {
      before = std::max(before, report.iterations);
    }
    if (to.frame >= 107) late += report.collision.pairs_after;
  }
  CHECK(frames > 30);
  CHECK(outside < 3000);      // 15,500 where what waits is left to itself
  CHECK(most <= 3 * before);  // Newton iterations
  CHECK(passes <= 5);         // of untangling; 110 before
  CHECK(late == 0);           // the body is free for good from frame 107 on
}

}  // namespace selvedge::test_legs_crossing
