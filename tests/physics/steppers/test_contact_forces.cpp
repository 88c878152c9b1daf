#include <catch2/catch.hpp>

#include <cmath>
#include <memory>

#include "physics/scene/contact_forces.hpp"
#include "tests/physics/worlds.hpp"

namespace selvedge::test_contact_forces {

using Catch::Matchers::WithinRel;
using testing::World;

namespace {

constexpr double dt = 1.0 / 30, gravity = 9.81;

std::unique_ptr<Stepper> stepper_of(const Scene& scene, bool measured = true, bool rest = false) {
  ConventionalOptions options;
  options.contact_forces = measured;
  options.implicit_euler.velocity_tolerance = options.implicit_euler.relative_tolerance = 1e-4;  // for sums within 1 %
  return decorated(scene, conventional_maker(options), {.rest = rest});
}

struct Stepped {
  State state;
  StepReport report;  // of the last step
};

Stepped stepped(const World& w, Stepper& stepper, int frames) {
  Stepped now{w.state, {}};
  for (int f = 0; f < frames; ++f) {
    State to;
    now.report = testing::frame(w.scene, stepper, now.state, w.drive, dt, to);
    REQUIRE(now.report.status == StepStatus::accepted);
    now.state = to;
  }
  return now;
}

ContactForces forces_after(const World& w, int frames) {
  const Stepped end = stepped(w, *stepper_of(w.scene), frames);
  REQUIRE(end.report.contact_forces);
  return *end.report.contact_forces;
}

double weight(const Scene& scene, int first = 0, int count = -1) {
  const Eigen::VectorXd masses = lumped_masses(scene);
  return gravity * (count < 0 ? masses : Eigen::VectorXd(masses.segment(first, count))).sum();
}

Vec3 sum(const Points& forces) { return forces.colwise().sum().transpose(); }

World with_gravity(World w) {
  w.drive.acceleration = Vec3(0, -gravity, 0);
  return w;
}

// A sheet that lies on a plate, both tilted.
World on_incline(double angle, double friction) {
  const Mat3 turn = Eigen::AngleAxisd(angle, Vec3::UnitZ()).toRotationMatrix();
  World w = make_world(testing::tilted(testing::sheet(6, 0.2, 0.002), angle));
  testing::Sheet plate = testing::sheet(2, 4, 0);
  plate.x = (plate.x * turn.transpose()).eval();
  add_obstacle(w, plate);
  w.scene.contact.friction = friction;
  return with_gravity(w);
}

testing::Sheet ball(double radius) {
  constexpr int rings = 12, around = 24;
  testing::Sheet s{Points((rings - 1) * around + 2, 3), Triangles(2 * (rings - 1) * around, 3)};
  for (int r = 1; r < rings; ++r)
    for (int k = 0; k < around; ++k) {
      const double polar = M_PI * r / rings, turn = 2 * M_PI * k / around;
      s.x.row((r - 1) * around + k) << radius * std::sin(polar) * std::cos(turn), radius * std::cos(polar),
          radius * std::sin(polar) * std::sin(turn);
    }
  const int top = (rings - 1) * around, bottom = top + 1;
  s.x.row(top) << 0, radius, 0;
  s.x.row(bottom) << 0, -radius, 0;
  int t = 0;
  for (int k = 0; k < around; ++k) {
    const int next = (k + 1) % around, last = (rings - 2) * around;
    s.triangles.row(t++) << top, next, k;
    s.triangles.row(t++) << bottom, last + k, last + next;
    for (int r = 0; r + 2 < rings; ++r) {
      const int a = r * around;
      s.triangles.row(t++) << a + k, a + next, a + around + k;
      s.triangles.row(t++) << a + next, a + around + next, a + around + k;
    }
  }
  return s;
}

// A sheet just above the floor, and another one as a second cloth.
World beside_a_sheet_on_the_floor(const testing::Sheet& other) {
  World w = make_world(testing::sheet(6, 0.2, 0.002));
  selvedge::add_cloth(w.scene, other.x, other.triangles, {}, "other");
  Points both(w.state.x.rows() + other.x.rows(), 3);
  both << w.state.x, other.x;
  w.state = first_state(w.scene, both);
  w.drive = at_rest(w.scene, w.state);
  add_obstacle(w, testing::sheet(2, 0.6, 0));
  return with_gravity(w);
}

}  // namespace

TEST_CASE("the normal forces on a sheet that lies on a plate are its weight, and the pressure is weight by area") {
  World w = make_world(testing::sheet(6, 0.2, 0.002));
  add_obstacle(w, testing::sheet(2, 0.6, 0));
  w = with_gravity(w);
  const ContactForces forces = forces_after(w, 30);
  const double borne = weight(w.scene);
  CHECK_THAT(sum(forces.normal).y(), WithinRel(borne, 0.01));
  CHECK(sum(forces.normal).cwiseProduct(Vec3(1, 0, 1)).norm() < 1e-3 * borne);
  CHECK(sum(forces.friction).norm() < 0.01 * borne);
  double area = 0, pressed = 0;
  for (const RestTriangle& triangle : w.scene.rest_triangle) area += selvedge::area(triangle);
  const Eigen::VectorXd areas = area * lumped_masses(w.scene) / lumped_masses(w.scene).sum();
  pressed = forces.pressure.dot(areas);
  CHECK_THAT(pressed, WithinRel(borne, 0.01));
  CHECK(forces.pressure.minCoeff() >= 0);
}

TEST_CASE("the normal forces and the friction of a sheet that hangs over a ball bear its weight") {
  World w = make_world(testing::sheet(10, 0.3, 0.102));
  add_obstacle(w, ball(0.1));
  w.scene.contact.friction = 0.8;
  w = with_gravity(w);
  const Stepped end = stepped(w, *stepper_of(w.scene), 120);
  const ContactForces& forces = *end.report.contact_forces;
  const Vec3 total = sum(forces.normal) + sum(forces.friction);
  const double borne = weight(w.scene);
  CHECK_THAT(total.y(), WithinRel(borne, 0.01));
  CHECK(total.cwiseProduct(Vec3(1, 0, 1)).norm() < 0.01 * borne);
  CHECK(forces.pressure.maxCoeff() > 0);
}

TEST_CASE("friction holds a sheet on an incline with m g sin a") {
  const double angle = 0.3;
  const World w = on_incline(angle, 0.8);
  const ContactForces forces = forces_after(w, 60);
  const Vec3 uphill(std::cos(angle), std::sin(angle), 0), outward(-std::sin(angle), std::cos(angle), 0);
  const double borne = weight(w.scene);
  CHECK_THAT(sum(forces.friction).dot(uphill), WithinRel(borne * std::sin(angle), 0.01));
  CHECK_THAT(sum(forces.normal).dot(outward), WithinRel(borne * std::cos(angle), 0.01));
  CHECK(std::abs(sum(forces.friction).dot(outward)) < 1e-3 * borne);
}

TEST_CASE("friction of a sheet that slides is the coefficient times the normal force") {
  const double angle = 0.6, coefficient = 0.2;
  const ContactForces forces = forces_after(on_incline(angle, coefficient), 15);
  const Vec3 uphill(std::cos(angle), std::sin(angle), 0);
  CHECK_THAT(sum(forces.friction).dot(uphill), WithinRel(coefficient * sum(forces.normal).norm(), 0.05));
}

TEST_CASE("contact forces between cloths cancel, and a layer between two others has its pressure") {
  const testing::Sheet upper = testing::sheet(6, 0.2, 0.0045);
  const World w = beside_a_sheet_on_the_floor(upper);
  const ContactForces forces = forces_after(w, 60);
  const int n = static_cast<int>(upper.x.rows());
  CHECK_THAT(sum(forces.normal).y(), WithinRel(weight(w.scene), 0.01));
  CHECK_THAT(sum(forces.normal.bottomRows(n)).y(), WithinRel(weight(w.scene, n, n), 0.02));
  const Eigen::VectorXd masses = lumped_masses(w.scene);
  const double lower = forces.pressure.head(n).dot(masses.head(n)) / masses.head(n).sum(),
               above = forces.pressure.tail(n).dot(masses.tail(n)) / masses.tail(n).sum();
  CHECK(lower > 1.7 * above);
}

TEST_CASE("cloth that touches nothing has contact forces of 0") {
  World w = with_gravity(make_world(testing::sheet(4, 0.2, 0.05)));
  const ContactForces alone = forces_after(w, 2);
  CHECK(alone.normal.isZero(0));
  add_obstacle(w, testing::sheet(2, 0.6, -3));
  const ContactForces above = forces_after(w, 2);
  CHECK((above.normal.isZero(0) && above.friction.isZero(0) && above.pressure.isZero(0)));
}

TEST_CASE("contact forces change no bit of the motion, and are there only where they are asked for") {
  World w = make_world(testing::tilted(testing::sheet(8, 0.2, 0.05), 0.4));
  add_obstacle(w, ball(0.1));
  w.state.x.col(1).array() += 0.1;
  w = with_gravity(w);
  const Stepped with = stepped(w, *stepper_of(w.scene), 30), without = stepped(w, *stepper_of(w.scene, false), 30);
  CHECK(with.state.x == without.state.x);
  CHECK(with.state.v == without.state.v);
  CHECK(with.report.contact_forces);
  CHECK_FALSE(without.report.contact_forces);
}

TEST_CASE("cloth that rests keeps the contact forces of its last step") {
  World w = make_world(testing::sheet(6, 0.2, 0.002));
  add_obstacle(w, testing::sheet(2, 0.6, 0));
  w = with_gravity(w);
  const std::unique_ptr<Stepper> stepper = stepper_of(w.scene, true, true);
  const Stepped end = stepped(w, *stepper, 60);
  REQUIRE(end.report.resting == 1);
  REQUIRE(end.report.contact_forces);
  CHECK_THAT(sum(end.report.contact_forces->normal).y(), WithinRel(weight(w.scene), 0.01));
  State to;
  const auto fresh = stepper_of(w.scene, true, true);  // knows nothing but the state
  const StepReport next = testing::frame(w.scene, *fresh, end.state, w.drive, dt, to);
  REQUIRE(next.contact_forces);
  CHECK(next.contact_forces->normal == end.report.contact_forces->normal);
}

TEST_CASE("cloth that moves beside one that rests has its own contact forces") {
  testing::Sheet far = testing::sheet(6, 0.2, 1.5);
  far.x.col(0).array() += 1;
  const World w = beside_a_sheet_on_the_floor(far);
  const Stepped end = stepped(w, *stepper_of(w.scene, true, true), 30);
  REQUIRE(end.report.resting == 1);
  const int n = static_cast<int>(far.x.rows());
  CHECK_THAT(sum(end.report.contact_forces->normal.topRows(n)).y(), WithinRel(weight(w.scene, 0, n), 0.01));
  CHECK(end.report.contact_forces->normal.bottomRows(n).isZero(0));
}

}  // namespace selvedge::test_contact_forces
