#pragma once

#include <catch2/catch.hpp>

#include "physics/scene/make_scene.hpp"
#include "physics/steppers/decorated_stepper.hpp"
#include "physics/steppers/resting_stepper.hpp"
#include "tests/collision/sheets.hpp"
#include "tests/frame.hpp"

// Small scenes for the tests of steppers.
namespace selvedge::testing {

struct World {
  Scene scene;
  State state;
  Drive drive;
};

inline World make_world(const Sheet& cloth) {
  World w;
  selvedge::add_cloth(w.scene, cloth.x, cloth.triangles, {}, "sheet");
  w.state = first_state(w.scene, cloth.x);
  w.drive = at_rest(w.scene, w.state);
  return w;
}

inline void add_obstacle(World& w, const Sheet& body) {
  selvedge::add_obstacle(w.scene, static_cast<int>(body.x.rows()), body.triangles, false, "body");
  w.state.obstacles.push_back(body.x);
  w.drive.obstacles.push_back(body.x);
}

// Its cloth, which meets itself, and its first obstacle.
inline ContactWorld with_its_obstacle(const World& w) {
  return make_contact_world(w.scene.surface, {&w.scene.obstacles[0].surface}, true);
}

// A sheet 5 cm above a plate, known to be clean.
inline World sheet_over_plate() {
  World w = make_world(sheet(4, 0.2, 0.05));
  add_obstacle(w, sheet(2, 0.6, 0));
  w.state.clean = true;
  return w;
}

inline Sheet tilted(Sheet s, double angle) {
  const Mat3 turn = Eigen::AngleAxisd(angle, Vec3::UnitZ()).toRotationMatrix();
  s.x = (s.x * turn.transpose()).eval();
  return s;
}

struct Run {
  State state;
  int contacts = 0, pairs = 0, passed_through = 0, left_alone = 0;  // sums
  int held = 0;
  double lag = 0;
};

inline std::unique_ptr<Stepper> conventional(const Scene& scene) {
  return make_recovering_conventional_stepper(scene, {});
}

// Every `renew` frames it makes the stepper and all caches anew.
inline Run run(const World& w, int frames, int renew = 1 << 30, const MakeStepper& make = conventional) {
  Run r{w.state};
  auto stepper = make(w.scene);
  for (int f = 0; f < frames; ++f) {
    if (f % renew == renew - 1) stepper = make(w.scene);
    State to;
    const StepReport report = testing::frame(w.scene, *stepper, r.state, w.drive, 1.0 / 30, to);
    REQUIRE(report.status == StepStatus::accepted);
    r.contacts += report.collision.contacts;
    r.pairs += report.collision.pairs_after;
    r.passed_through += report.collision.passed_through;
    r.left_alone += report.collision.left_alone;
    r.held += report.collision.held_vertices;
    r.lag = std::max(r.lag, report.collision.obstacle_lag);
    r.state = to;
  }
  return r;
}

}  // namespace selvedge::testing
