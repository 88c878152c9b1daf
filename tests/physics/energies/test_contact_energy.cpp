#include <catch2/catch.hpp>

#include "physics/energies/contact_energy.hpp"

namespace selvedge::test_contact_energy {

namespace {

ContactTerm example() {
  ContactTerm term;
  term.nodes = {2, 0, 3, -1};
  term.weights = {1, -0.25, -0.75, 0};
  term.normal = Vec3(1, 2, 2) / 3;
  term.offset = 0.01;
  term.target = 0.002;
  term.softness = 5e-4;
  term.stiffness = 300;
  term.friction = 0.4;
  term.normal_force = 2;
  term.drift = Vec3(0.01, -0.02, 0.03);
  return term;
}

}  // namespace

TEST_CASE("contact force: derivatives by finite differences on each piece", "[contact_energy]") {
  const ContactTerm term = example();
  const double h = 1e-8;
  for (const double gap : {0.003, 0.0019, 0.0016, 0.0012, 0.0, -0.004}) {
    const ContactForce f = contact_force(term, gap), up = contact_force(term, gap + h),
                       down = contact_force(term, gap - h);
    CHECK(f.first == Approx((up.energy - down.energy) / (2 * h)).margin(1e-9).epsilon(1e-5));
    CHECK(f.second == Approx((up.first - down.first) / (2 * h)).margin(1e-6).epsilon(1e-6));
    CHECK(f.first <= 0);
    CHECK(f.second >= 0);
  }
}

TEST_CASE("contact force: value, first and second derivative meet at both joints", "[contact_energy]") {
  const ContactTerm term = example();
  for (const double joint : {term.target, term.target - term.softness}) {
    const double h = 1e-12;
    const ContactForce above = contact_force(term, joint + h), below = contact_force(term, joint - h);
    CHECK(above.energy == Approx(below.energy).margin(1e-14).epsilon(1e-7));
    CHECK(above.first == Approx(below.first).margin(1e-9).epsilon(1e-7));
    CHECK(above.second == Approx(below.second).margin(1e-5).epsilon(1e-7));
  }
  CHECK(contact_force(term, term.target).energy == 0);
  CHECK(contact_force(term, term.target - term.softness).second == Approx(term.stiffness));
}

TEST_CASE("contact force: a jump onset without softness is a plain spring", "[contact_energy]") {
  ContactTerm term = example();
  term.softness = 0;
  CHECK(contact_force(term, term.target).energy == 0);
  CHECK(contact_force(term, term.target - 0.01).energy == Approx(0.5 * 300 * 1e-4));
}

TEST_CASE("contact: gap and slip are what the linearisation says", "[contact_energy]") {
  const ContactTerm term = example();
  const Points x0 = Points::Random(4, 3), x = x0 + 0.1 * Points::Random(4, 3);
  const Vec3 relative = row(x, 2) - 0.25 * row(x, 0) - 0.75 * row(x, 3);
  CHECK(contact_gap(term, x) == Approx(term.normal.dot(relative) + 0.01));
  const Vec3 before = row(x0, 2) - 0.25 * row(x0, 0) - 0.75 * row(x0, 3);
  const Vec3 slip = contact_slip(term, x0, x);
  CHECK(slip.dot(term.normal) == Approx(0).margin(1e-15));
  const Vec3 whole = relative - before + term.drift;
  CHECK((slip.cross(term.normal) - whole.cross(term.normal)).norm() == Approx(0).margin(1e-15));
}

TEST_CASE("friction: gradient, bound and the joint at the slip width", "[contact_energy]") {
  const ContactTerm term = example();
  const double width = 1e-3, h = 1e-9;
  const Vec3 along = Vec3(2, -1, 0).normalized();
  for (const double slip : {1e-5, 4e-4, 9.99e-4, 1.001e-3, 0.02}) {
    const double slope = (friction_force(term, along * (slip + h), width).energy -
                          friction_force(term, along * (slip - h), width).energy) /
                         (2 * h);
    const double force = friction_force(term, along * slip, width).factor * slip;
    CHECK(force == Approx(slope).epsilon(1e-5));
    CHECK(force <= 0.4 * 2 * (1 + 1e-12));
  }
  const FrictionForce inside = friction_force(term, along * width * (1 - 1e-9), width),
                      outside = friction_force(term, along * width * (1 + 1e-9), width);
  CHECK(inside.energy == Approx(outside.energy).epsilon(1e-8));
  CHECK(inside.factor == Approx(outside.factor).epsilon(1e-8));
  CHECK(outside.energy == Approx(0.8 * width));
  CHECK(friction_force(term, Vec3::Zero(), width).factor == Approx(2 * 0.8 / width));
  CHECK(friction_force(term, Vec3::Zero(), 0).factor == 0);
}

}  // namespace selvedge::test_contact_energy
