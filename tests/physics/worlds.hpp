#pragma once

#include <catch2/catch.hpp>

#include "physics/steppers/decorated_stepper.hpp"
#include "physics/steppers/resting_stepper.hpp"
#include "tests/collision/sheets.hpp"

// Small scenes for the tests of steppers.
namespace selvedge::testing {

struct World {
  Scene scene;
  State state;
  Drive drive;
};

inline World make_world(const Sheet& cloth) {
  World w;
  w.scene.surface = make_surface(static_cast<int>(cloth.x.rows()), cloth.triangles);
  w.scene.rest = cloth.x;
  for (int t = 0; t < cloth.triangles.rows(); ++t)
    w.scene.rest_triangle.push_back(flatten(row(cloth.x, cloth.triangles(t, 0)), row(cloth.x, cloth.triangles(t, 1)),
                                            row(cloth.x, cloth.triangles(t, 2))));
  w.scene.cloths.push_back({"sheet", {}, 0, w.scene.surface.vertex_count, 0, static_cast<int>(cloth.triangles.rows())});
  w.state.x = cloth.x;
  w.state.v = Points::Zero(cloth.x.rows(), 3);
  w.drive.pins = Points(0, 3);
  w.drive.acceleration = {0, -9.81, 0};
  return w;
}

inline void add_obstacle(World& w, const Sheet& body) {
  w.scene.obstacles.push_back({"body", make_surface(static_cast<int>(body.x.rows()), body.triangles), false});
  w.state.obstacles.push_back(body.x);
  w.drive.obstacles.push_back(body.x);
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

inline std::unique_ptr<Stepper> conventional(const Scene& scene) { return make_recovering_conventional_stepper(scene, {}); }

// Drops the stepper, and with it all caches, every `renew` frames.
inline Run run(const World& w, int frames, int renew = 1 << 30, const MakeStepper& make = conventional) {
  Run r{w.state};
  auto stepper = make(w.scene);
  for (int f = 0; f < frames; ++f) {
    if (f % renew == renew - 1) stepper = make(w.scene);
    State to;
    const StepReport report = stepper->step(r.state, w.drive, 1.0 / 30, to);
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
