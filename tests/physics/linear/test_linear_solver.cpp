#include <cmath>
#include <filesystem>
#include <iterator>
#include <random>

#include <Eigen/Dense>
#include <catch2/catch.hpp>

#include "collision/geometry/error.hpp"
#include "collision/geometry/stop_scope.hpp"
#include "physics/linear/cholesky.hpp"
#include "physics/linear/linear_solver.hpp"
#include "physics/linear/pcg.hpp"
#include "tests/physics/linear_example.hpp"
#include "tests/threads.hpp"

namespace selvedge::test_linear_solver {

namespace {

// A made-up cloth: random elements that do not see translations, a squared graph Laplacian, contacts and held vertices.
struct Example : testing::LinearExample {
  Points right;

  Vertices vertices() const {  // of a square grid
    const int side = static_cast<int>(std::lround(std::sqrt(pattern.rows)));
    Points rest(pattern.rows, 3);
    for (int i = 0; i < pattern.rows; ++i) rest.row(i) << i % side, i / side, 0;
    return {rest, testing::graph_of(pattern), std::vector<Rim>(pattern.rows, Rim::inside)};
  }
};

Example make_example(int side, double stiffness, bool with_contacts, bool with_flat) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  Example e;
  const int n = side * side;
  const auto [begin, nodes] = testing::grid_elements(side);
  e.pattern = make_pair_pattern(n, begin, nodes);
  e.pairs.assign(e.pattern.pairs.size(), Mat3::Zero());
  for (std::size_t t = 0; t + 1 < begin.size(); ++t)
    for (int term = 0; term < 3; ++term) {
      Mat3 g;  // a column a node, columns sum to zero
      for (int k = 0; k < 9; ++k) g(k) = normal(random);
      g.col(2) = -g.col(0) - g.col(1);
      for (int a = 0; a < 3; ++a)
        for (int b = a + 1; b < 3; ++b) {
          const int i = nodes[begin[t] + a], j = nodes[begin[t] + b];
          const Mat3 block = stiffness * g.col(a) * g.col(b).transpose();
          e.pairs[find_pair(e.pattern, i, j)] += i < j ? block : Mat3(block.transpose());
        }
    }
  e.diagonal.resize(n);
  e.flat_scale.assign(n, 1.5);
  e.free.assign(n, 1);
  e.right = Points::Zero(n, 3);
  for (int i = 0; i < n; ++i) {
    e.diagonal[i] = 0.5 + 0.1 * std::abs(normal(random));
    for (int k = 0; k < 3; ++k) e.right(i, k) = normal(random);
  }
  for (int i = 0; i < n; i += 17) e.free[i] = 0;
  if (with_flat) {
    e.flat = 0.1 * stiffness * testing::squared_laplacian(e.pattern);
    e.flat.makeCompressed();
  }
  if (with_contacts)
    for (int c = 0; c < n / 4; ++c) {
      const Vec3 direction(normal(random), normal(random), normal(random));
      const int first = (c * 37) % (n - 50);
      e.contacts.push_back({{first, first + 20, first + 31, c % 2 ? -1 : first + 49},
                            {-1, 0.25, 0.25, c % 2 ? 0.0 : 0.5},
                            direction.normalized(),
                            10 * stiffness,
                            c % 3 ? 0.0 : stiffness});
    }
  e.finish();
  return e;
}

Eigen::MatrixXd dense(const Example& e) {
  const int n = e.pattern.rows;
  Eigen::MatrixXd a(3 * n, 3 * n);
  Points unit(n, 3), product;
  for (int column = 0; column < 3 * n; ++column) {
    unit.setZero();
    unit(column / 3, column % 3) = e.free[column / 3] ? 1 : 0;
    multiply(e.system(), unit, product);
    if (!e.free[column / 3]) product(column / 3, column % 3) = 1;
    a.col(column) = Eigen::Map<Eigen::VectorXd>(product.data(), 3 * n);
  }
  return a;
}

Points exact(const Example& e) {
  Points right = e.right;
  for (int i = 0; i < right.rows(); ++i)
    if (!e.free[i]) right.row(i).setZero();
  const Eigen::VectorXd x = dense(e).ldlt().solve(Eigen::Map<Eigen::VectorXd>(right.data(), right.size()));
  return Eigen::Map<const Points>(x.data(), right.rows(), 3);
}

Points solve(const Example& e, LinearSolver method, double tolerance, LinearReport& report) {
  LinearSystemSolver solver(method, e.vertices(), e.free);
  Points x;
  report = solver.solve(e.system(), e.blocks, e.right, tolerance, 3000, x);
  return x;
}

}  // namespace

TEST_CASE("The block matrix is symmetric, its diagonal blocks are right, and it does not see translations",
          "[linear_solver]") {
  const Example e = make_example(9, 3.0, true, true);
  const Eigen::MatrixXd a = dense(e);
  CHECK((a - a.transpose()).norm() < 1e-12 * a.norm());
  CHECK(a.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff() > 0.4);
  for (int i = 0; i < e.pattern.rows; ++i)
    if (e.free[i]) CHECK((a.block<3, 3>(3 * i, 3 * i) - e.blocks[i]).norm() < 1e-12 * a.norm());
  Points translation = Points::Constant(e.pattern.rows, 3, 0.7);
  for (int i = 0; i < e.pattern.rows; ++i) CHECK(multiply_row(e.pattern, e.pairs, translation, i).norm() == 0);
}

TEST_CASE("CHOLMOD and PCG give the dense answer, with every combination of terms", "[linear_solver]") {
  const bool contacts = GENERATE(false, true), flat = GENERATE(false, true);
  const double stiffness = GENERATE(1e-2, 1e3);
  const Example e = make_example(10, stiffness, contacts, flat);
  const Points truth = exact(e);
  LinearReport report;
  for (const LinearSolver method : {LinearSolver::pcg, LinearSolver::multigrid}) {
    const Points iterative = solve(e, method, 1e-11, report);
    CHECK(report.converged);
    CHECK((iterative - truth).norm() < 1e-8 * truth.norm());
  }
  if (!Cholesky::available()) return;
  const Points direct = solve(e, LinearSolver::cholmod, 1e-11, report);
  CHECK(report.converged);
  CHECK((direct - truth).norm() < 1e-10 * truth.norm());
}

TEST_CASE("A loose tolerance costs few iterations and is kept", "[linear_solver]") {
  const Example e = make_example(20, 10.0, true, true);
  LinearReport loose, tight;
  const Points x = solve(e, LinearSolver::pcg, 0.05, loose);
  solve(e, LinearSolver::pcg, 1e-9, tight);
  CHECK(loose.converged);
  CHECK(2 * loose.iterations < tight.iterations);
  Points product;
  multiply(e.system(), x, product);
  double left = 0, before = 0;
  for (int i = 0; i < x.rows(); ++i) {
    if (!e.free[i]) continue;
    const Vec3 r = row(e.right, i) - row(product, i);
    left += r.dot(e.blocks[i].inverse() * r);
    before += row(e.right, i).dot(e.blocks[i].inverse() * row(e.right, i));
  }
  CHECK(std::sqrt(left / before) < 0.0501);
}

TEST_CASE("Translations of a cloth a billion times stiffer than heavy survive float", "[linear_solver]") {
  Example e = make_example(12, 1e9, false, false);
  e.free.assign(e.pattern.rows, 1);
  for (int i = 0; i < e.pattern.rows; ++i) e.right.row(i) = e.diagonal[i] * Eigen::RowVector3d(1, -2, 3);
  LinearReport report;
  const Points x = solve(e, LinearSolver::pcg, 1e-6, report);
  CHECK(report.converged);
  CHECK((x.rowwise() - Eigen::RowVector3d(1, -2, 3)).cwiseAbs().maxCoeff() < 1e-3);
}

TEST_CASE("The pattern of the direct solver follows the contacts", "[linear_solver]") {
  if (!Cholesky::available()) return;
  Example e = make_example(10, 5.0, false, true);
  LinearSystemSolver solver(LinearSolver::cholmod, e.vertices(), e.free);
  Points x;
  CHECK(solver.solve(e.system(), e.blocks, e.right, 0.05, 100, x).converged);
  CHECK((x - exact(e)).norm() < 1e-10 * x.norm());
  e = make_example(10, 5.0, true, true);
  CHECK(solver.solve(e.system(), e.blocks, e.right, 0.05, 100, x).converged);
  CHECK((x - exact(e)).norm() < 1e-10 * x.norm());
}

TEST_CASE("The matrix of the kernels is the system's: contacts at a vertex, within elements and across",
          "[linear_solver]") {
  const bool flat = GENERATE(true, false);
  Example e = make_example(12, 3.0, true, flat);
  const Vec3 n = Vec3(1, 2, -1).normalized();
  for (const int i : {13, 40, 77}) {
    e.contacts.push_back({{i, -1, -1, -1}, {1, 0, 0, 0}, n, 50, 4});
    e.contacts.push_back({{i, i + 1, i + 12, -1}, {0.2, 0.3, 0.5, 0}, n, 30, 0});
    e.contacts.push_back({{-1, i + 1, -1, i + 12}, {0, -0.4, 0, -0.6}, n, 20, 7});
  }
  e.finish();
  PcgMatrix<double> matrix;
  for (const double stiffness : {1.0, 0.25}) {  // filled again with other numbers, and with fewer contacts
    if (stiffness != 1) e.contacts.erase(e.contacts.begin() + 3, e.contacts.begin() + 9);
    for (ContactBlock& contact : e.contacts) contact.normal_stiffness *= stiffness;
    e.flat_scale.assign(e.pattern.rows, stiffness);
    e.finish();
    matrix.fill(e.system());
    CHECK(matrix.contacts().size() == static_cast<std::size_t>(e.contacts.size() - 9));
    Points u = e.right, expected;
    for (int i = 0; i < u.rows(); ++i)
      if (!e.free[i]) u.row(i).setZero();
    multiply(e.system(), u, expected);
    Quads<double> in(u.rows()), out(u.rows());
    for (int i = 0; i < u.rows(); ++i)
      for (int k = 0; k < 3; ++k) in[i].lanes[k] = u(i, k);
    std::vector<double> partial(matrix.chunks());
    matrix.multiply(in, out, partial);
    for (int i = 0; i < u.rows(); ++i)
      for (int k = 0; k < 3 && e.free[i]; ++k) CHECK(out[i].lanes[k] == Approx(expected(i, k)).margin(1e-10));
  }
  e.contacts.clear();  // what contacts have left does not stay
  e.finish();
  matrix.fill(e.system());
  for (int i = 0; i < e.pattern.rows; ++i)
    CHECK(block_of(matrix.diagonal(i)).isApprox(Mat3(e.diagonal[i] * Mat3::Identity())));
}

TEST_CASE("Nothing to do, nothing free, nothing finite", "[linear_solver]") {
  const LinearSolver method = GENERATE(values({LinearSolver::pcg, LinearSolver::multigrid, LinearSolver::automatic}));
  Example e = make_example(8, 1.0, true, true);
  LinearReport report;
  const Points right = e.right;
  e.right.setZero();
  CHECK(solve(e, method, 0.05, report).norm() == 0);
  CHECK(report.converged);
  e.right = right;
  e.right(20, 1) = std::numeric_limits<double>::quiet_NaN();
  CHECK(!(solve(e, method, 0.05, report).allFinite() && report.converged));
  e.right = right;
  e.free.assign(e.pattern.rows, 0);
  CHECK(solve(e, method, 0.05, report).norm() == 0);
}

TEST_CASE("An indefinite matrix is reported and the direction stays finite", "[linear_solver]") {
  Example e = make_example(8, 1.0, false, false);
  for (double& d : e.diagonal) d = -50;
  diagonal_blocks(e.system(), e.blocks);
  LinearReport report;
  CHECK(solve(e, LinearSolver::pcg, 0.05, report).allFinite());
  CHECK(!report.converged);
}

TEST_CASE("One and two threads solve with the same bits", "[linear_solver][threads]") {
  const Example e = make_example(60, 20.0, true, true);
  LinearReport report;
  Points one, two;
  const LinearSolver method = GENERATE(values({LinearSolver::pcg, LinearSolver::multigrid}));
  with_threads(1, [&] { one = solve(e, method, 1e-6, report); });
  with_threads(2, [&] { two = solve(e, method, 1e-6, report); });
  CHECK(report.converged);
  CHECK(same_bits(one, two));
}

TEST_CASE("CHOLMOD asked for where it is absent is an error", "[linear_solver]") {
  const auto solver = [](LinearSolver wanted, int side) {
    const Example e = make_example(side, 1.0, false, false);
    return LinearSystemSolver(wanted, e.vertices(), e.free).chosen();
  };
  if (Cholesky::available())
    CHECK(solver(LinearSolver::automatic, 7) == LinearSolver::cholmod);
  else
    CHECK_THROWS_AS(solver(LinearSolver::cholmod, 10), Error);
  CHECK(solver(LinearSolver::automatic, 40) == LinearSolver::multigrid);
}

TEST_CASE("Coarse levels and factorisations ask whether to stop, and a solver that was stopped solves the next time",
          "[linear_solver]") {
  const Example e = make_example(30, 1e3, true, true);
  for (const LinearSolver method : {LinearSolver::multigrid, LinearSolver::cholmod}) {
    if (method == LinearSolver::cholmod && !Cholesky::available()) continue;
    LinearReport whole;
    const Points x = solve(e, method, 1e-8, whole);
    LinearSystemSolver solver(method, e.vertices(), e.free);
    Points after;
    for (int at = 1; at <= 2; ++at) {  // before it is built, and on the way
      int asked = 0;
      const StopFlag stop = [&] { return ++asked >= at; };
      const StopScope scope(stop);
      CHECK_THROWS_AS(solver.solve(e.system(), e.blocks, e.right, 1e-8, 3000, after), Stopped);
      CHECK(asked == at);
    }
    REQUIRE(solver.solve(e.system(), e.blocks, e.right, 1e-8, 3000, after).converged);
    CHECK(after == x);
  }
}

TEST_CASE("CHOLMOD starts no threads of its own", "[linear_solver]") {
  if (!Cholesky::available() || !std::filesystem::exists("/proc/self/task")) return;
  const auto threads = [] {
    return std::distance(std::filesystem::directory_iterator("/proc/self/task"), std::filesystem::directory_iterator());
  };
  const Example e = make_example(30, 1e3, true, true);
  LinearSystemSolver solver(LinearSolver::cholmod, e.vertices(), e.free);
  with_threads(1, [&] {
    const auto before = threads();
    Points x;
    REQUIRE(solver.solve(e.system(), e.blocks, e.right, 1e-8, 1, x).converged);
    CHECK(threads() <= before);
  });
}

}  // namespace selvedge::test_linear_solver
