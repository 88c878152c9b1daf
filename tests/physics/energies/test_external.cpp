#include <catch2/catch.hpp>

#include "physics/energies/external.hpp"
#include "physics/solve/implicit_euler.hpp"
#include "tests/physics/meshes.hpp"

namespace selvedge::test_external {

namespace {

Scene sheet(double drag, double lift) {
  Scene scene = meshes::make_scene(meshes::grid(4, 3, 0.8, 0.5, meshes::Pattern::jittered));
  scene.wind = {true, 1.2, drag, lift};
  return scene;
}

Vec3 total(const Points& forces) { return forces.colwise().sum().transpose(); }

}  // namespace

TEST_CASE("wind: a sheet across the wind feels 1/2 rho cd A u^2, from either side", "[external]") {
  const Scene scene = sheet(0.9, 0.4);
  const Points still = Points::Zero(scene.rest.rows(), 3);
  for (const double speed : {3.0, -3.0}) {
    const Vec3 force = total(wind_forces(scene, scene.rest, still, Vec3(0, speed, 0)));
    CHECK((force - Vec3(0, std::copysign(0.5 * 1.2 * 0.9 * 0.4 * 9, speed), 0)).norm() < 1e-13);
  }
}

TEST_CASE("wind: along the sheet only the tangential part acts, oblique wind splits", "[external]") {
  const Scene scene = sheet(0.9, 0.4);
  const Points still = Points::Zero(scene.rest.rows(), 3);
  const Vec3 along = total(wind_forces(scene, scene.rest, still, Vec3(2, 0, 0)));
  CHECK((along - Vec3(0.5 * 1.2 * 0.4 * 0.4 * 4, 0, 0)).norm() < 1e-13);
  const Vec3 oblique = total(wind_forces(scene, scene.rest, still, Vec3(3, 4, 0)));
  CHECK((oblique - 0.5 * 1.2 * 0.4 * 5 * Vec3(0.4 * 3, 0.9 * 4, 0)).norm() < 1e-13);
}

TEST_CASE("wind: only the motion relative to the air counts, and a triangle's corners share equally", "[external]") {
  Scene scene = sheet(1, 0.5);
  const Vec3 wind(1, 2, -3);
  const Points along = wind.transpose().replicate(scene.rest.rows(), 1);
  CHECK(wind_forces(scene, scene.rest, along, wind).norm() < 1e-14);
  const Points still = Points::Zero(scene.rest.rows(), 3);
  CHECK((wind_forces(scene, scene.rest, -along, Vec3::Zero()) - wind_forces(scene, scene.rest, still, wind)).norm() <
        1e-14);
  const Points forces = wind_forces(scene, scene.rest, still, Vec3(0, 1, 0));
  const Eigen::VectorXd masses = lumped_masses(scene);
  CHECK((forces.col(1) / forces(0, 1) - masses / masses[0]).norm() < 1e-12);
  scene.wind.on = false;
  CHECK(wind_forces(scene, scene.rest, still, wind).norm() == 0);
}

TEST_CASE("wind: a collapsed triangle feels nothing", "[external]") {
  const Scene scene = sheet(1, 1);
  const Points zero = Points::Zero(scene.rest.rows(), 3);
  CHECK(wind_forces(scene, zero, zero, Vec3(1, 2, 3)).norm() == 0);
}

TEST_CASE("wind: a storm carries a loose light sheet up to its own speed and not beyond", "[external]") {
  Scene scene = sheet(1, 0.1);
  scene.cloths[0].material.density = 0.015;
  const Vec3 wind(0, 100, 0);
  Points x = scene.rest, v = Points::Zero(x.rows(), 3);
  ImplicitEuler solver(scene, {});
  double before = 0;
  for (int step = 0; step < 30; ++step) {
    StepProblem problem;
    problem.h = 1.0 / 30;
    problem.x0 = &x;
    problem.v0 = &v;
    problem.wind = wind;
    Points next = x;
    CHECK(solver.solve(problem, next).converged);
    v = 30 * (next - x);
    x = next;
    const double speed = Vec3(v.colwise().mean()).dot(wind) / 100;
    CHECK(speed > before - 0.1);
    CHECK(speed < 100.1);
    before = speed;
  }
  CHECK(before > 95);
  CHECK(v.rowwise().norm().maxCoeff() < 110);
}

}  // namespace selvedge::test_external
