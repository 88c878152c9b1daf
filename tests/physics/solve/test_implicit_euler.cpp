#include "physics/solve/implicit_euler.hpp"

#include <cmath>
#include <limits>
#include <random>

#include <catch2/catch.hpp>

#include "physics/energies/measures.hpp"
#include "physics/linear/cholesky.hpp"
#include "physics/solve/step_potential.hpp"
#include "tests/physics/meshes.hpp"
#include "tests/threads.hpp"

namespace selvedge::test_implicit_euler {

namespace {

const Vec3 gravity(0, -9.81, 0);

Points noise(Eigen::Index rows, double size, unsigned seed = 5) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-size, size);
  Points result(rows, 3);
  for (Eigen::Index i = 0; i < result.size(); ++i) result.data()[i] = uniform(random);
  return result;
}

Points rows_of(const Points& x, const std::vector<int>& vertices) {
  Points result(vertices.size(), 3);
  for (std::size_t k = 0; k < vertices.size(); ++k) result.row(k) = x.row(vertices[k]);
  return result;
}

ImplicitEulerOptions accurate(LinearSolver solver = LinearSolver::automatic) {
  ImplicitEulerOptions options;
  options.velocity_tolerance = 1e-10;
  options.relative_tolerance = 0;
  options.linear_tolerance = 1e-10;
  options.max_newton = 60;
  options.linear_solver = solver;
  return options;
}

// A cloth and how it moves when nothing but physics acts.
struct Run {
  const Scene& scene;
  ImplicitEuler solver;
  Points x, v;
  Vec3 acceleration = Vec3::Zero();
  NewtonReport report;

  Run(const Scene& s, const ImplicitEulerOptions& options, const Points& start)
      : scene(s), solver(s, options), x(start), v(Points::Zero(start.rows(), 3)) {}

  void step(double h) {
    const Points pins = rows_of(x, scene.pins);
    StepProblem problem;
    problem.h = h;
    problem.x0 = &x;
    problem.v0 = &v;
    problem.pins = &pins;
    problem.acceleration = acceleration;
    Points next = x + h * v;
    report = solver.solve(problem, next);
    v = (next - x) / h;
    x = next;
  }
};

// Two cloths with every term: both bendings, damping of both kinds, pins, wind, contacts that push and rub.
struct Everything {
  Scene scene;
  Points x0, v0, x, pins;
  std::vector<ContactTerm> contacts;

  explicit Everything(int cells) {
    Material material;
    material.bending = 1e-3;
    material.stiffness_damping = 0.004;
    material.mass_damping = 0.7;
    scene = meshes::make_scene(meshes::grid(cells, cells, 0.4, 0.4, meshes::Pattern::jittered), material);
    material.bending_model = BendingModel::hinge;
    material.membrane = MembraneModel::stable_neo_hookean;
    meshes::add_cloth(scene, meshes::grid(cells, cells, 0.4, 0.4), material);
    scene.pins = {0, cells};
    scene.wind.on = true;
    x0 = scene.rest + noise(scene.rest.rows(), 0.1 * 0.4 / cells);
    v0 = noise(x0.rows(), 0.2, 6);
    x = x0 + noise(x0.rows(), 0.05 * 0.4 / cells, 8);
    pins = rows_of(x, scene.pins);
    const int second = scene.cloths[1].first_vertex;
    for (int k = 2; k < second - cells - 3; k += 2) {
      ContactTerm term;
      term.nodes = {second + k, k, k + 1, k + cells + 1};
      term.weights = {1, -0.3, -0.3, -0.4};
      term.normal = Vec3(0.1, 1, 0.2).normalized();
      term.target = 0.01;
      term.softness = 0.002;
      term.stiffness = 50;
      term.friction = 0.4;
      term.normal_force = 0.01;
      term.offset = k % 4 ? 0.003 : 0.009 - contact_gap(term, x);
      term.drift = Vec3(1e-5 * k, 0, 0);
      contacts.push_back(term);
    }
  }
  StepProblem problem() const {
    StepProblem p;
    p.h = 0.01;
    p.x0 = &x0;
    p.v0 = &v0;
    p.pins = &pins;
    p.acceleration = gravity;
    p.wind = Vec3(3, 0, 1);
    p.contacts = contacts;
    return p;
  }
};

}  // namespace

TEST_CASE("The gradient is that of the potential, with every term on", "[implicit_euler]") {
  const Everything all(5);
  ImplicitEuler solver(all.scene, {});
  const Points gradient = solver.gradient(all.problem(), all.x);
  for (int pin : all.scene.pins) CHECK(gradient.row(pin).norm() == 0);
  for (unsigned seed = 1; seed < 12; ++seed) {
    Points direction = noise(all.x.rows(), 1, seed);
    for (int pin : all.scene.pins) direction.row(pin).setZero();
    const double e = 1e-7;
    const double difference = (solver.potential(all.problem(), all.x + e * direction) -
                               solver.potential(all.problem(), all.x - e * direction)) /
                              (2 * e);
    CHECK(difference == Approx(gradient.cwiseProduct(direction).sum()).epsilon(1e-6));
  }
}

TEST_CASE("The Hessian is that of the gradient where nothing had to be filtered", "[implicit_euler]") {
  Everything all(5);
  // Under tension everywhere, a sheet of the curvature form, slip and motion zero: every term is at a smooth point.
  Scene scene =
      meshes::make_scene(meshes::grid(5, 5, 0.4, 0.4, meshes::Pattern::jittered), all.scene.cloths[0].material);
  scene.pins = {0, 5};
  const Points x = 1.1 * scene.rest, v = Points::Zero(x.rows(), 3), pins = rows_of(x, scene.pins);
  std::vector<ContactTerm> contacts(6);
  for (int k = 0; k < 6; ++k) {
    contacts[k] = all.contacts[0];
    contacts[k].nodes = {7 + k, 14 + k, 21 + k, -1};
    contacts[k].weights = {1, -0.5, -0.6, 0};
    contacts[k].offset = 0.002 * k - contact_gap(contacts[k], x) + contacts[k].offset;
    contacts[k].drift.setZero();
  }
  StepProblem problem = all.problem();
  problem.x0 = &x;
  problem.v0 = &v;
  problem.pins = &pins;
  problem.contacts = contacts;

  const Eigen::VectorXd masses = lumped_masses(scene);
  const Elastic elastic = make_elastic(scene);
  StepPotential step;
  StepScratch scratch;
  prepare(scene, elastic, masses, problem, 1e-3, scratch, step);
  Points gradient, forward, backward, product;
  PairBlocks hessian;
  derivatives(step, x, scratch, gradient, &hessian);
  for (unsigned seed = 1; seed < 6; ++seed) {
    Points direction = noise(x.rows(), 1, seed);
    for (int pin : scene.pins) direction.row(pin).setZero();
    multiply(
        {elastic.pattern, hessian, step.diagonal, elastic.flat, step.flat_scale, step.contacts, step.lists, step.free},
        direction, product);
    StepPotential other = step;
    const double e = 1e-9;
    derivatives(other, x + e * direction, scratch, forward, nullptr);
    derivatives(other, x - e * direction, scratch, backward, nullptr);
    CHECK(((forward - backward) / (2 * e) - product).norm() < 1e-4 * product.norm());
  }
}

TEST_CASE("Both solvers find the same minimiser, with every term on", "[implicit_euler]") {
  const Everything all(6);
  Points reference = all.x;
  ImplicitEuler solver(all.scene, accurate(LinearSolver::pcg));
  const NewtonReport report = solver.solve(all.problem(), reference);
  CHECK(report.converged);
  CHECK(solver.gradient(all.problem(), reference).rowwise().norm().maxCoeff() < 1e-7);
  CHECK(solver.potential(all.problem(), reference) < solver.potential(all.problem(), all.x));
  for (std::size_t k = 0; k < all.scene.pins.size(); ++k) CHECK(reference.row(all.scene.pins[k]) == all.pins.row(k));

  if (!Cholesky::available()) return;
  Points direct = all.x;
  CHECK(ImplicitEuler(all.scene, accurate(LinearSolver::cholmod)).solve(all.problem(), direct).converged);
  CHECK((direct - reference).rowwise().norm().maxCoeff() < 1e-10);
}

TEST_CASE("Default tolerances come as near to the minimiser as they promise", "[implicit_euler]") {
  Scene scene = meshes::make_scene(meshes::grid(15, 15, 1, 1, meshes::Pattern::alternating));
  scene.pins = {0, 15};
  Run run(scene, {}, scene.rest), exact(scene, accurate(), scene.rest);
  run.acceleration = exact.acceleration = gravity;
  for (int n = 0; n < 15; ++n) {
    exact.x = run.x;
    exact.v = run.v;
    run.step(1.0 / 60);
    exact.step(1.0 / 60);
    REQUIRE(run.report.converged);
    REQUIRE(exact.report.converged);
    const double rms = (run.x - exact.x).norm() / std::sqrt(static_cast<double>(run.x.rows()));
    CHECK(rms < ImplicitEulerOptions{}.velocity_tolerance / 60);
  }
}

TEST_CASE("Free fall is exact", "[implicit_euler]") {
  const LinearSolver method = GENERATE(values({LinearSolver::automatic, LinearSolver::pcg}));
  const Scene scene = meshes::make_scene(meshes::grid(7, 7, 1, 1, meshes::Pattern::jittered));
  ImplicitEulerOptions options;
  options.linear_solver = method;
  Run run(scene, options, scene.rest);
  run.acceleration = gravity;
  const Eigen::RowVector3d start(0.5, 1, -0.25);
  run.v.rowwise() = start;
  const double h = 1.0 / 60;
  for (int n = 1; n <= 60; ++n) {
    run.step(h);
    REQUIRE(run.report.converged);
    const Eigen::RowVector3d fallen = n * h * start + h * h * n * (n + 1) / 2 * gravity.transpose();
    REQUIRE((run.x - (scene.rest.rowwise() + fallen)).cwiseAbs().maxCoeff() < 1e-12);
  }
}

TEST_CASE("A free stretched cloth keeps its linear momentum to rounding", "[implicit_euler]") {
  const LinearSolver method = GENERATE(values({LinearSolver::automatic, LinearSolver::pcg}));
  const Scene scene = meshes::make_scene(meshes::grid(8, 8, 1, 1, meshes::Pattern::jittered));
  ImplicitEulerOptions options;
  options.linear_solver = method;
  Points start = 1.2 * scene.rest + noise(scene.rest.rows(), 0.02);
  Run run(scene, options, start);
  run.v = noise(start.rows(), 0.5);
  const Vec3 before = linear_momentum(scene, run.v);
  double speed = 0;
  for (int n = 0; n < 20; ++n) {
    run.step(0.01);
    speed = std::max(speed, run.v.rowwise().norm().maxCoeff());
    REQUIRE((linear_momentum(scene, run.v) - before).norm() < 1e-13 * speed * run.solver.masses().sum() * (n + 1) * 10);
  }
  CHECK(speed > 1);
}

TEST_CASE("Angular momentum changes as implicit Euler must", "[implicit_euler]") {
  const Scene scene = meshes::make_scene(meshes::grid(6, 6, 0.5, 0.5, meshes::Pattern::jittered));
  const auto spin = [&](double h, double time, bool check) {
    Run run(scene, accurate(), scene.rest);
    for (int i = 0; i < run.x.rows(); ++i) run.v.row(i) = Vec3(0.3, 2, 0.4).cross(row(run.x, i)).transpose();
    const double first = angular_momentum(scene, run.x, run.v).norm();
    for (int n = 0; n < std::lround(time / h); ++n) {
      const Points x = run.x, v = run.v;
      run.step(h);
      if (!check) continue;
      Vec3 change = Vec3::Zero();
      for (int i = 0; i < x.rows(); ++i) change += h * run.solver.masses()[i] * row(run.v, i).cross(row(v, i));
      const Vec3 found = angular_momentum(scene, run.x, run.v) - angular_momentum(scene, x, v);
      REQUIRE(change.norm() > 1e-5 * first);
      REQUIRE((found - change).norm() < 1e-9 * first);
    }
    return 1 - angular_momentum(scene, run.x, run.v).norm() / first;
  };
  const double coarse = spin(0.01, 0.2, true), fine = spin(0.005, 0.2, false);
  CHECK(coarse > 0);
  CHECK(coarse / fine == Approx(2).epsilon(0.1));
}

TEST_CASE("A rest state in equilibrium stays still, bit for bit", "[implicit_euler]") {
  const BendingModel bending = GENERATE(values({BendingModel::curvature, BendingModel::hinge}));
  const MembraneModel membrane =
      GENERATE(values({MembraneModel::stvk, MembraneModel::stable_neo_hookean, MembraneModel::baraff_witkin}));
  Material material;
  material.bending_model = bending;
  material.membrane = membrane;
  material.bending = 1e-3;
  material.stiffness_damping = GENERATE(0.0, 0.01);
  meshes::Mesh mesh = meshes::grid(6, 6, 1, 1, meshes::Pattern::jittered);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  mesh.points = mesh.points * turn.transpose();
  const Scene scene = meshes::make_scene(mesh, material);
  Run run(scene, accurate(), scene.rest);
  for (int n = 0; n < 10; ++n) {
    run.step(1.0 / 30);
    REQUIRE(run.report.converged);
    REQUIRE(same_bits(run.x, scene.rest));
  }
}

TEST_CASE("A hanging strip stretches by rho g L^2 / (2 k)", "[implicit_euler]") {
  Material material;
  material.lame_mu = 500;  // E h = 1000 N/m, nu = 0
  material.lame_lambda = 0;
  meshes::Mesh mesh = meshes::grid(3, 30, 0.1, 1);
  for (int i = 0; i < mesh.points.rows(); ++i) mesh.points.row(i) << mesh.flat[i].x(), -mesh.flat[i].y(), 0;
  Scene scene = meshes::make_scene(mesh, material);
  scene.pins = {0, 1, 2, 3};
  Run run(scene, accurate(), scene.rest);
  run.acceleration = gravity;
  for (int n = 0; n < 12; ++n) run.step(1.0);
  CHECK(run.report.converged);
  CHECK(run.v.cwiseAbs().maxCoeff() < 1e-6);
  const double stretch = -1 - run.x.col(1).tail(4).mean();
  CHECK(stretch == Approx(-0.2 * gravity.y() / (2 * 1000)).epsilon(0.01));
}

TEST_CASE("Pins are held exactly while they move", "[implicit_euler]") {
  Scene scene = meshes::make_scene(meshes::grid(6, 6, 1, 1));
  scene.pins = {0, 6};
  ImplicitEuler solver(scene, {});
  Points x = scene.rest, v = Points::Zero(x.rows(), 3);
  for (int n = 1; n <= 20; ++n) {
    Points pins = rows_of(scene.rest, scene.pins);
    pins.col(1).array() += 0.1 * std::sin(0.3 * n);
    StepProblem problem;
    problem.h = 1.0 / 60;
    problem.x0 = &x;
    problem.v0 = &v;
    problem.pins = &pins;
    problem.acceleration = gravity;
    Points next = x + problem.h * v;
    const NewtonReport report = solver.solve(problem, next);
    REQUIRE(report.finite);
    REQUIRE(rows_of(next, scene.pins) == pins);
    v = (next - x) / problem.h;
    x = next;
  }
}

TEST_CASE("One and two threads step with the same bits", "[implicit_euler][threads]") {
  const LinearSolver method = GENERATE(values({LinearSolver::automatic, LinearSolver::pcg}));
  const Everything all(method == LinearSolver::pcg ? 34 : 3);
  ImplicitEulerOptions options;
  options.linear_solver = method;
  options.max_newton = 4;
  Points results[2];
  for (int k = 0; k < 2; ++k)
    with_threads(k + 1, [&] {
      results[k] = all.x;
      CHECK(ImplicitEuler(all.scene, options).solve(all.problem(), results[k]).finite);
    });
  CHECK(same_bits(results[0], results[1]));
}

TEST_CASE("A stiff cloth far too large for its pins comes back in one large step", "[implicit_euler]") {
  const LinearSolver method = GENERATE(values({LinearSolver::automatic, LinearSolver::pcg}));
  Material material;
  material.lame_mu = 4e6;
  material.lame_lambda = 3e6;
  material.density = 0.02;
  Scene scene = meshes::make_scene(meshes::grid(8, 8, 1, 1), material);
  scene.pins = {0};
  ImplicitEulerOptions options;
  options.linear_solver = method;
  options.max_newton = 200;
  options.max_linear = 500;
  const Points start = 1.5 * scene.rest + noise(scene.rest.rows(), 0.01);
  Run run(scene, options, start);
  run.acceleration = gravity;
  run.step(1.0 / 30);
  CHECK(run.report.finite);
  CHECK(run.x.allFinite());
  CHECK(run.report.converged);
  const auto stretches = principal_stretches(scene, run.x);
  CHECK(stretches.col(1).maxCoeff() < 1.01);
}

TEST_CASE("A stiff, crumpled cloth goes downhill and stays finite", "[implicit_euler]") {
  const LinearSolver method = GENERATE(values({LinearSolver::automatic, LinearSolver::pcg}));
  Material material;
  material.lame_mu = 4e6;
  material.lame_lambda = 3e6;
  material.density = 0.02;
  material.membrane = GENERATE(values({MembraneModel::stvk, MembraneModel::stable_neo_hookean}));
  Scene scene = meshes::make_scene(meshes::grid(8, 8, 1, 1), material);
  scene.pins = {0};
  ImplicitEulerOptions options;
  options.linear_solver = method;
  ImplicitEuler solver(scene, options);
  const Points x0 = 3 * scene.rest + noise(scene.rest.rows(), 0.3), v0 = noise(x0.rows(), 5);
  const Points pins = rows_of(x0, scene.pins);
  StepProblem problem;
  problem.h = 1.0 / 30;
  problem.x0 = &x0;
  problem.v0 = &v0;
  problem.pins = &pins;
  problem.acceleration = gravity;
  Points x = x0;
  const NewtonReport report = solver.solve(problem, x);
  CHECK(report.finite);
  CHECK(x.allFinite());
  CHECK(report.iterations > 0);
  CHECK(solver.potential(problem, x) < 1e-3 * solver.potential(problem, x0));
}

TEST_CASE("The smallest and emptiest problems work", "[implicit_euler]") {
  Points points(4, 3);
  points << 0, 0, 0, 1, 0, 0, 0, 1, 0, 5, 5, 5;
  Triangles triangles(1, 3);
  triangles << 0, 1, 2;
  Scene scene = meshes::make_scene(points, triangles);  // vertex 3 is isolated and has no mass
  SECTION("one triangle falls, an isolated vertex stays") {
    Run run(scene, {}, scene.rest);
    run.acceleration = gravity;
    run.step(0.1);
    CHECK(run.report.converged);
    CHECK(run.x(0, 1) == Approx(-0.0981));
    CHECK(row(run.x, 3) == Vec3(5, 5, 5));
  }
  SECTION("all pinned") {
    scene.pins = {0, 1, 2};
    Run run(scene, {}, scene.rest);
    run.acceleration = gravity;
    run.step(0.1);
    CHECK(run.report.converged);
    CHECK(run.report.iterations == 0);
    CHECK(same_bits(run.x, scene.rest));
  }
  SECTION("what comes in broken is reported") {
    Run run(scene, {}, scene.rest);
    run.v(1, 1) = std::numeric_limits<double>::quiet_NaN();
    run.step(0.1);
    CHECK_FALSE(run.report.finite);
    CHECK_FALSE(run.report.converged);
  }
}

}  // namespace selvedge::test_implicit_euler
