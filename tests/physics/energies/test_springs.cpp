#include "collision/geometry/factorisations.hpp"
#include "physics/energies/joints.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "physics/energies/measures.hpp"
#include "physics/linear/cholesky.hpp"
#include "physics/solve/equilibrium.hpp"
#include "physics/steppers/icm_stepper.hpp"
#include "tests/frame.hpp"
#include "tests/physics/worlds.hpp"
#include "tests/threads.hpp"

namespace selvedge::test_springs {

using testing::make_world;
using testing::World;

namespace {

Points two_points(const Vec3& a, const Vec3& b) {
  Points x(2, 3);
  x << a.transpose(), b.transpose();
  return x;
}

Vec6 numeric_gradient(const Spring& spring, const Points& x, double h) {
  Vec6 gradient;
  for (int i = 0; i < 6; ++i) {
    Points up = x, down = x;
    up.data()[i] += h;
    down.data()[i] -= h;
    gradient[i] = (joint_energy(spring, up) - joint_energy(spring, down)) / (2 * h);
  }
  return gradient;
}

Mat6 numeric_hessian(const Spring& spring, const Points& x, double h) {
  Mat6 hessian;
  for (int i = 0; i < 6; ++i) {
    Points up = x, down = x;
    up.data()[i] += h;
    down.data()[i] -= h;
    Vec6 above, below;
    joint_derivatives(spring, up, above, nullptr);
    joint_derivatives(spring, down, below, nullptr);
    hessian.col(i) = (above - below) / (2 * h);
  }
  return hessian;
}

double least_eigenvalue(const Mat6& hessian) { return symmetric_eigenvalues(hessian)[0]; }

// Two sheets of n x n quads, `gap` apart, as two cloths; the upper one, which comes first, is pinned if asked for.
World two_sheets(int n, double size, double gap, bool pinned) {
  const testing::Sheet above = testing::sheet(n, size, 0), below = testing::sheet(n, size, -gap);
  World w = make_world(testing::join(above, below));
  Cloth first = w.scene.cloths[0], second = first;
  first.vertex_count = second.first_vertex = static_cast<int>(above.x.rows());
  first.triangle_count = second.first_triangle = static_cast<int>(above.triangles.rows());
  second.vertex_count -= first.vertex_count;
  second.triangle_count -= first.triangle_count;
  w.scene.cloths = {first, second};
  for (int i = 0; pinned && i < first.vertex_count; ++i) w.scene.pins.push_back(i);
  w.drive.pins = w.state.x.topRows(static_cast<Eigen::Index>(w.scene.pins.size()));
  return w;
}

double weight_below(const World& w) { return 9.81 * lumped_masses(w.scene).tail(w.scene.cloths[1].vertex_count).sum(); }

double length_of(const Spring& spring, const Points& x) { return (row(x, spring.b) - row(x, spring.a)).norm(); }

// What hangs below by the middles of two sheets, each vertex of which is 4 n (n + 2) / 8.
World hung_by_the_middle(int n, double stiffness) {
  World w = two_sheets(n, 0.1, 0.25, true);
  const int count = w.scene.cloths[0].vertex_count, middle = count / 2;
  w.scene.springs = {{middle, count + middle, 0.2, stiffness}};
  return w;
}

State run(const World& w, Stepper& stepper, int frames, double dt) {
  State state = w.state, to;
  for (int f = 0; f < frames; ++f) {
    REQUIRE(testing::frame(w.scene, stepper, state, w.drive, dt, to).status == StepStatus::accepted);
    state = to;
  }
  return state;
}

}  // namespace

TEST_CASE("springs: derivatives are those of the energy, stretched, compressed, at rest and without rest length",
          "[springs]") {
  std::mt19937 random(5);
  std::uniform_real_distribution<> uniform(-1, 1);
  for (const double rest : {0.0, 0.3, 1.0, 2.5}) {
    const Spring spring{0, 1, rest, 40};
    const Vec3 a(uniform(random), uniform(random), uniform(random));
    const Vec3 direction = Vec3(uniform(random), uniform(random), uniform(random)).normalized();
    const Points x = two_points(a, a + direction);  // 1 apart
    Vec6 gradient;
    Mat6 exact, filtered;
    CHECK(joint_derivatives(spring, x, gradient, &exact, false) == joint_energy(spring, x));
    CHECK(joint_energy(spring, x) == Approx(20 * (1 - rest) * (1 - rest)).margin(1e-14));
    joint_derivatives(spring, x, gradient, &filtered);
    CHECK((gradient - numeric_gradient(spring, x, 1e-5)).norm() < 1e-8);
    CHECK((exact - numeric_hessian(spring, x, 1e-6)).norm() < 1e-7);
    CHECK(least_eigenvalue(filtered) > -1e-12);
    const Mat3 block = filtered.topLeftCorner<3, 3>();
    CHECK((block * direction).dot(direction) == Approx(40));
    if (rest <= 1)
      CHECK((filtered - exact).norm() < 1e-12);
    else  // the exact one pushes the ends aside
      CHECK((least_eigenvalue(exact) < -1 && (block - 40 * direction * direction.transpose()).norm() < 1e-12));
  }
}

TEST_CASE("springs: at zero length all is finite, and exact where that is the rest length", "[springs]") {
  const Points x = two_points({1, 2, 3}, {1, 2, 3});
  for (const double rest : {0.0, 0.1})
    for (const bool psd : {false, true}) {
      Vec6 gradient;
      Mat6 hessian;
      const Spring spring{0, 1, rest, 7};
      CHECK(joint_derivatives(spring, x, gradient, &hessian, psd) == Approx(3.5 * rest * rest));
      CHECK(gradient.isZero(0));
      CHECK((hessian.topLeftCorner<3, 3>() - 7 * Mat3::Identity()).isZero(0));
      CHECK((hessian.topRightCorner<3, 3>() + 7 * Mat3::Identity()).isZero(0));
    }
  Vec6 gradient;
  Mat6 hessian;
  joint_derivatives({0, 1, 0.1, 7}, two_points({0, 0, 0}, {0, 1e-160, 0}), gradient, &hessian);
  CHECK((gradient.allFinite() && hessian.allFinite()));
}

TEST_CASE("springs: which parts they join", "[springs]") {
  const std::vector<int> part{0, 0, 1, 2, 3, 4};
  Scene scene;
  CHECK(joined_parts(scene, part, 5) == std::vector<int>{0, 1, 2, 3, 4});
  scene.springs = {{5, 2}, {3, 5}, {0, 1}};
  CHECK(joined_parts(scene, part, 5) == std::vector<int>{0, 1, 1, 3, 1});
  const std::vector<char> there{1, 1, 1, 0, 1, 1};
  CHECK(joined_parts(scene, part, 5, there) == std::vector<int>{0, 1, 2, 3, 1});
}

TEST_CASE("springs: a weight stretches its spring by m g / k, whatever solves for it", "[springs]") {
  const double stiffness = GENERATE(2.0, 500.0, 1e5);
  const World w = hung_by_the_middle(8, stiffness);
  const auto solver = GENERATE(LinearSolver::cholmod, LinearSolver::pcg, LinearSolver::multigrid);
  if (solver == LinearSolver::cholmod && !Cholesky::available()) return;
  EquilibriumOptions options;
  options.implicit_euler.linear_solver = solver;
  const StaticLoad load{w.drive.acceleration, nullptr, weight_norm(w.scene, w.drive.acceleration)};
  const Equilibrium rest = settle(w.scene, w.state.x, load, options);
  CHECK(rest.converged);
  CHECK(std::abs(length_of(w.scene.springs[0], rest.x) - 0.2 - weight_below(w) / stiffness) < 1e-6);
}

TEST_CASE("springs: each stepper brings the weight to rest where it belongs", "[springs]") {
  World w = hung_by_the_middle(2, 30);
  for (Cloth& cloth : w.scene.cloths) cloth.material.mass_damping = 20;
  ConventionalOptions options;
  options.implicit_euler.velocity_tolerance = 1e-6;
  options.implicit_euler.relative_tolerance = 0;
  options.implicit_euler.linear_tolerance = 1e-6;
  ConventionalOptions bdf2 = options;
  bdf2.integrator = Integrator::bdf2;
  IcmOptions icm;
  icm.implicit_euler = options.implicit_euler;
  std::unique_ptr<Stepper> steppers[] = {make_recovering_conventional_stepper(w.scene, options),
                                         make_recovering_conventional_stepper(w.scene, bdf2),
                                         make_icm_stepper(w.scene, icm)};
  for (const auto& stepper : steppers) {
    const State end = run(w, *stepper, 60, 1.0 / 30);
    CHECK(std::abs(length_of(w.scene.springs[0], end.x) - 0.2 - weight_below(w) / 30) < 1e-6);
  }
}

TEST_CASE("springs: bdf2 keeps the period of two weights on a spring", "[springs]") {
  World w = two_sheets(2, 0.02, 0.3, false);
  w.drive.acceleration.setZero();
  w.scene.contact.self = false;
  w.scene.springs = {{4, 13, 0.2, 0.01}};
  ConventionalOptions options;
  options.integrator = Integrator::bdf2;
  options.substeps = 1;
  options.implicit_euler.velocity_tolerance = 1e-9;
  options.implicit_euler.relative_tolerance = 0;
  const double half_mass = lumped_masses(w.scene).sum() / 4;  // the reduced one
  const double period = 2 * M_PI * std::sqrt(half_mass / 0.01);
  const auto stepper = make_recovering_conventional_stepper(w.scene, options);
  const State half = run(w, *stepper, 100, period / 200);
  CHECK(length_of(w.scene.springs[0], half.x) == Approx(0.1).epsilon(0.01));
}

TEST_CASE("springs: what they join keeps its momentum to rounding", "[springs]") {
  World w = two_sheets(12, 0.3, 0.5, false);
  w.scene.springs = {{0, 169, 0.49, 200}, {84, 253, 0.49, 200}};
  w.scene.contact.self = false;
  w.drive.acceleration.setZero();
  ConventionalOptions options;
  options.implicit_euler.linear_solver = LinearSolver::pcg;
  const auto stepper = make_recovering_conventional_stepper(w.scene, options);
  const State end = run(w, *stepper, 5, 1.0 / 30);
  State next;
  const StepReport report = testing::frame(w.scene, *stepper, end, w.drive, 1.0 / 30, next);
  CHECK(report.reason == Reason::none);
  CHECK_FALSE(report.doubts.any());
  CHECK(report.iterations < 5 * report.substeps);  // more if the sheets were moved each as if it were alone
  const double moved = lumped_masses(w.scene).dot(end.v.rowwise().norm());
  CHECK(moved > 1e-4);
  CHECK(linear_momentum(w.scene, end.v).norm() < 1e-11 * moved);
}

TEST_CASE("springs: one button holds a cloth under another, clean, at its length", "[springs]") {
  World w = two_sheets(6, 0.3, 4e-3, true);
  w.scene.springs = {{24, 49 + 24, w.scene.contact.thickness, Spring{}.stiffness}};
  State state = w.state, to;
  const auto stepper = testing::conventional(w.scene);
  for (int f = 0; f < 60; ++f) {
    const StepReport report = testing::frame(w.scene, *stepper, state, w.drive, 1.0 / 30, to);
    REQUIRE(report.status == StepStatus::accepted);
    CHECK(report.collision.pairs_after == 0);
    CHECK(report.collision.passed_through == 0);
    state = to;
  }
  CHECK(length_of(w.scene.springs[0], state.x) == Approx(2e-3 + weight_below(w) / 1e4).margin(1e-4));
  CHECK(state.x.col(1).minCoeff() < -0.1);  // hangs down all round
  CHECK(state.v.rowwise().norm().mean() < 0.1);
}

TEST_CASE("springs: many stiff ones are solved in few iterations", "[springs]") {
  World w = two_sheets(40, 1, 2e-3, true);
  const int count = w.scene.cloths[0].vertex_count;
  for (int i = 0; i < count; i += 7) w.scene.springs.push_back({i, count + i, 2e-3, 1e4});
  State to;
  const StepReport report = testing::frame(w.scene, *testing::conventional(w.scene), w.state, w.drive, 1.0 / 30, to);
  CHECK(report.status == StepStatus::accepted);
  CHECK(report.linear_iterations < 8 * report.iterations);
}

TEST_CASE("springs: one and two threads give the same bits, and dropped caches too", "[springs][threads]") {
  World w = two_sheets(35, 1, 0.02, false);
  const int count = w.scene.cloths[0].vertex_count;
  for (int i = 0; i < count; i += 3) w.scene.springs.push_back({i, count + i, 0.01, 100});
  Points ends[2];
  for (int k = 0; k < 2; ++k) with_threads(k + 1, [&] { ends[k] = testing::run(w, 2, k == 0 ? 1 << 30 : 2).state.x; });
  CHECK(same_bits(ends[0], ends[1]));
}

}  // namespace selvedge::test_springs
