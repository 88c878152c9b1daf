#include <catch2/catch.hpp>

#include <cmath>
#ifdef _OPENMP
#include <omp.h>
#endif

#include "collision/audit.hpp"
#include "physics/conventional_stepper.hpp"
#include "physics/measures.hpp"
#include "tests/collision/sheets.hpp"

using namespace selvedge;

namespace {

struct World {
  Scene scene;
  State state;
  Drive drive;
};

World make_world(const testing::Sheet& cloth) {
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

void add_obstacle(World& w, const testing::Sheet& body) {
  w.scene.obstacles.push_back({"body", make_surface(static_cast<int>(body.x.rows()), body.triangles), false});
  w.state.obstacles.push_back(body.x);
  w.drive.obstacles.push_back(body.x);
}

testing::Sheet tilted(testing::Sheet s, double angle) {
  const Mat3 turn = Eigen::AngleAxisd(angle, Vec3::UnitZ()).toRotationMatrix();
  s.x = (s.x * turn.transpose()).eval();
  return s;
}

// A small sheet that falls on a peaked block and folds over it.
World folding_world(int n) {
  World w = make_world(testing::sheet(n, 0.4, 0.08));
  testing::Sheet peak;
  peak.x.resize(5, 3);
  peak.x << -0.1, 0, -0.1, 0.1, 0, -0.1, 0.1, 0, 0.1, -0.1, 0, 0.1, 0.01, 0.06, 0.02;
  peak.triangles.resize(6, 3);
  peak.triangles << 0, 1, 2, 0, 2, 3, 0, 4, 1, 1, 4, 2, 2, 4, 3, 3, 4, 0;
  add_obstacle(w, peak);
  add_obstacle(w, testing::sheet(2, 3, -0.05));
  return w;
}

struct Run {
  State state;
  int contacts = 0, pairs = 0;
  double lag = 0;
};

// Drops the stepper, and with it all caches, every `renew` frames.
Run run(const World& w, int frames, int renew = 1 << 30) {
  Run r{w.state};
  auto stepper = make_conventional_stepper(w.scene, {});
  for (int f = 0; f < frames; ++f) {
    if (f % renew == renew - 1) stepper = make_conventional_stepper(w.scene, {});
    State to;
    const StepReport report = stepper->step(r.state, w.drive, 1.0 / 30, to);
    REQUIRE(report.status == StepStatus::accepted);
    r.contacts += report.collision.contacts;
    r.pairs += report.collision.pairs_after;
    r.lag = std::max(r.lag, report.collision.obstacle_lag);
    r.state = to;
  }
  return r;
}

void same_bits(const State& a, const State& b) {
  CHECK(a.x == b.x);
  CHECK(a.v == b.v);
}

}  // namespace

TEST_CASE("conventional stepper: free fall is implicit Euler's, to rounding", "[conventional_stepper]") {
  World w = make_world(testing::sheet(3, 0.3, 0));
  w.scene.contact.self = false;
  w.state.v.rowwise() = Eigen::RowVector3d(1, 2, 3);
  ConventionalOptions options;
  options.substeps = 4;
  auto stepper = make_conventional_stepper(w.scene, options);
  State state = w.state;
  const int frames = 10;
  for (int f = 0; f < frames; ++f) {
    State to;
    REQUIRE(stepper->step(state, w.drive, 1.0 / 30, to).status == StepStatus::accepted);
    state = to;
  }
  const int n = 4 * frames;
  const double h = 1.0 / 120;
  Points expected = w.state.x + n * h * w.state.v;
  expected.col(1).array() -= 9.81 * h * h * n * (n + 1) / 2;
  CHECK((state.x - expected).cwiseAbs().maxCoeff() < 1e-10);
  CHECK(state.frame == frames);
  CHECK(state.time == Approx(frames / 30.0));
}

TEST_CASE("conventional stepper: a sheet folds over a peak and stays clean", "[conventional_stepper]") {
  const World w = folding_world(14);
  const Run r = run(w, 45);
  CHECK(r.contacts > 0);
  CHECK(r.pairs == 0);
  CHECK(r.lag == 0);
  CHECK(r.state.x.col(1).minCoeff() > -0.05);
  CHECK(principal_stretches(w.scene, r.state.x).maxCoeff() < 1.2);
}

TEST_CASE("conventional stepper: caches carry no state", "[conventional_stepper]") {
  const World w = folding_world(10);
  same_bits(run(w, 20).state, run(w, 20, 3).state);
}

#ifdef _OPENMP
TEST_CASE("conventional stepper: one and two threads give the same bits in 100 frames with contact",
          "[conventional_stepper]") {
  const World w = folding_world(10);
  const int threads = omp_get_max_threads();
  omp_set_num_threads(1);
  const Run one = run(w, 100);
  omp_set_num_threads(2);
  const Run two = run(w, 100);
  omp_set_num_threads(threads);
  CHECK(one.contacts > 0);
  same_bits(one.state, two.state);
}
#endif

TEST_CASE("conventional stepper: friction holds a sheet on a slope below its angle and lets it slide above",
          "[conventional_stepper]") {
  const double angle = 0.3;  // tan = 0.309
  World w = make_world(tilted(testing::sheet(5, 0.1, 2e-3), angle));
  add_obstacle(w, tilted(testing::sheet(4, 4, 0), angle));
  w.scene.contact.self = false;
  const Vec3 down(-std::cos(angle), -std::sin(angle), 0);
  w.scene.contact.friction = 0.4;
  const Run settled = run(w, 15);  // lands, from the thickness to where its weight puts it
  w.state = settled.state;
  const Run held = run(w, 60);
  CHECK(std::abs(((held.state.x - w.state.x) * down).mean()) < 1e-4);
  w.scene.contact.friction = 0.2;
  const Run sliding = run(w, 30);
  const double expected = 0.5 * 9.81 * (std::sin(angle) - 0.2 * std::cos(angle));  // after 1 s
  CHECK(((sliding.state.x - w.state.x) * down).mean() == Approx(expected).epsilon(0.05));
}
