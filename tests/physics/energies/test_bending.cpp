#include <catch2/catch.hpp>
#include <numbers>
#include <random>

#include "collision/geometry/factorisations.hpp"
#include "physics/energies/bending.hpp"
#include "tests/physics/meshes.hpp"
#include "tests/physics/single_elements.hpp"

namespace selvedge::test_bending {

using meshes::grid;
using meshes::make_scene;
using meshes::Mesh;
using meshes::Pattern;
using single::hinge_derivatives;
using single::Mat12;
using single::Vec12;

namespace {

constexpr double pi = std::numbers::pi;

Material bent(double bending, BendingModel model = BendingModel::curvature) {
  Material material;
  material.bending = bending;
  material.bending_model = model;
  return material;
}

// The flat points rolled without stretch on a cylinder of radius 1 / curvature, bent along `degrees` in the u, v plane.
Points rolled(const Mesh& mesh, double degrees, double curvature) {
  const Vec2 along(std::cos(degrees * pi / 180), std::sin(degrees * pi / 180)), axis(-along.y(), along.x());
  Points x(mesh.points.rows(), 3);
  for (int v = 0; v < x.rows(); ++v) {
    const double s = mesh.flat[v].dot(along), r = 1 / curvature;
    x.row(v) << r * std::sin(s / r), r * (1 - std::cos(s / r)), mesh.flat[v].dot(axis);
  }
  return x;
}

double flat_energy(const CurvatureBending& bending, const Points& x) {
  return 0.5 * (bending.flat * x).cwiseProduct(x).sum();
}

double energy_of(const CurvatureBending& bending, const Points& x) {
  double sum = flat_energy(bending, x);
  for (const CurvedVertex& vertex : bending.curved) sum += curved_energy(vertex, x);
  return sum;
}

Points moved(const Points& x) {
  const Mat3 turn = Eigen::AngleAxisd(1.1, Vec3(1, -2, 0.5).normalized()).toRotationMatrix();
  return (x * turn.transpose()).rowwise() + Eigen::RowVector3d(0.3, -1, 2);
}

Points perturbed(const Points& x, double size, unsigned seed = 3) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<> noise(-size, size);
  Points y = x;
  for (Eigen::Index i = 0; i < y.size(); ++i) y.data()[i] += noise(random);
  return y;
}

double total_area(const Scene& scene) {
  double sum = 0;
  for (const RestTriangle& rest : scene.rest_triangle) sum += area(rest);
  return sum;
}

Hinge example_hinge(double rest_angle = 0.4) { return {{0, 1, 2, 3}, 0.7, rest_angle}; }

Points example_hinge_points(double angle) {
  Points x(4, 3);  // edge along x, wing a toward +z folded down by half the angle, wing b toward -z
  x << 0, 0, 0, 1.2, 0, 0, 0.3, -0.8 * std::sin(angle / 2), -0.8 * std::cos(angle / 2), 0.7, -0.6 * std::sin(angle / 2),
      0.6 * std::cos(angle / 2);
  return x;
}

}  // namespace

TEST_CASE("curvature bending: a rolled sheet has B / 2 kappa^2 per area on any mesh and in any direction",
          "[bending]") {
  const double B = 3e-5, curvature = 0.5;
  for (const Pattern pattern : {Pattern::one_diagonal, Pattern::alternating, Pattern::jittered})
    for (const double degrees : {0.0, 45.0, 135.0, 20.0}) {
      const Mesh mesh = grid(24, 30, 1, 1.25, pattern);
      const CurvatureBending bending = curvature_bending(make_scene(mesh, bent(B)));
      const double exact = 0.5 * B * curvature * curvature * 1.25;
      CAPTURE(static_cast<int>(pattern), degrees);
      CHECK(flat_energy(bending, rolled(mesh, degrees, curvature)) / exact ==
            Approx(1).epsilon(pattern == Pattern::jittered ? 0.015 : 0.001));
    }
}

TEST_CASE("curvature bending: the strips along boundary and clamp have full weight", "[bending]") {
  const double B = 2e-5, curvature = 0.5;
  // Bent in the strip next to one edge alone: the first inner row answers for half a cell, one cell and that is all.
  const Mesh mesh = grid(10, 8, 1, 0.8);
  const Scene scene = make_scene(mesh, bent(B));
  const CurvatureBending bending = curvature_bending(scene);
  Points x = mesh.points;
  for (int v = 0; v < x.rows(); ++v) x(v, 1) = 0.5 * curvature * mesh.flat[v].x() * mesh.flat[v].x();
  CHECK(flat_energy(bending, x) == Approx(0.5 * B * curvature * curvature * total_area(scene)));
}

TEST_CASE("curvature bending: the kink at a clamp counts on the half cell that gives way", "[bending]") {
  const double B = 2e-5, kink = 0.05, cell = 0.1, width = 1.6;
  const Mesh mesh = grid(10, 16, 1, width);
  Scene scene = make_scene(mesh, bent(B));
  Points x = mesh.points;
  for (int v = 0; v < x.rows(); ++v) {
    if (mesh.flat[v].x() < 1.5 * cell) scene.pins.push_back(v);
    x(v, 1) = kink * std::max(0.0, mesh.flat[v].x() - cell);
  }
  const double exact = 0.5 * B * kink * kink / (cell / 2) * width;
  CHECK(flat_energy(curvature_bending(scene), x) == Approx(exact).epsilon(0.05));
  scene.pins.clear();
  CHECK(flat_energy(curvature_bending(scene), x) < 0.8 * exact);
}

TEST_CASE("curvature bending: every quadric has the plate's energy, on any mesh and for any Poisson's ratio",
          "[bending]") {
  const double B = 3e-5, nu = GENERATE(0.0, 0.3, 0.5);
  Material material = bent(B);
  material.lame_mu = 500 / (1 + nu);
  material.lame_lambda = 1000 * nu / (1 - nu * nu);
  CHECK(bending_poisson(material) == Approx(nu).margin(1e-12));
  for (const Pattern pattern : {Pattern::one_diagonal, Pattern::alternating, Pattern::jittered}) {
    const Mesh mesh = grid(9, 7, 0.9, 0.7, pattern);
    const Scene scene = make_scene(mesh, material);
    const CurvatureBending bending = curvature_bending(scene);
    for (const Vec3& k : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(1, -1, 0), Vec3(0.3, 0.9, -0.4)}) {
      Points x = mesh.points;
      for (int v = 0; v < x.rows(); ++v) {
        const Vec2& p = mesh.flat[v];
        x(v, 1) = 0.5 * k[0] * p.x() * p.x() + 0.5 * k[1] * p.y() * p.y() + k[2] * p.x() * p.y() + 0.2 * p.x();
      }
      const double trace = k[0] + k[1], determinant = k[0] * k[1] - k[2] * k[2];
      const double exact = 0.5 * B * (trace * trace - 2 * (1 - nu) * determinant) * total_area(scene);
      CAPTURE(static_cast<int>(pattern), nu, k.transpose());
      CHECK(flat_energy(bending, x) == Approx(exact).epsilon(1e-6));
    }
  }
}

TEST_CASE("curvature bending: no vertex hangs loose, the tips of corner triangles neither", "[bending]") {
  for (const Pattern pattern : {Pattern::one_diagonal, Pattern::alternating, Pattern::jittered}) {
    const Eigen::MatrixXd Q = curvature_bending(make_scene(grid(6, 5, 0.6, 0.5, pattern), bent(1))).flat;
    const Eigen::VectorXd spectrum = symmetric_eigenvalues(Q);
    CHECK(spectrum[2] < 1e-9 * spectrum[41]);  // a plane's three motions along its normal
    CHECK(spectrum[3] > 1e-5 * spectrum[41]);
  }
}

TEST_CASE("curvature bending: rest and rigid motion carry neither energy nor force", "[bending]") {
  for (const Pattern pattern : {Pattern::one_diagonal, Pattern::alternating, Pattern::jittered}) {
    const Mesh mesh = grid(6, 5, 0.6, 0.5, pattern);
    const CurvatureBending bending = curvature_bending(make_scene(mesh, bent(1)));
    for (const Points& x : std::vector<Points>{mesh.points, moved(mesh.points)}) {
      CHECK(std::abs(flat_energy(bending, x)) < 1e-10);
      CHECK((bending.flat * x).norm() < 1e-11);
    }
    const Eigen::MatrixXd Q = bending.flat;
    CHECK((Q - Q.transpose()).norm() == 0);
    CHECK(symmetric_eigenvalues(Q)[0] > -1e-9 * Q.norm());
  }
}

TEST_CASE("curvature bending: each cloth has its own stiffness, others contribute nothing", "[bending]") {
  const Mesh mesh = grid(6, 5, 0.6, 0.5);
  Scene scene = make_scene(mesh, bent(1));
  meshes::add_cloth(scene, mesh, bent(0));
  meshes::add_cloth(scene, mesh, bent(1, BendingModel::hinge));
  meshes::add_cloth(scene, mesh, bent(5));
  const int n = static_cast<int>(mesh.points.rows());
  const Eigen::MatrixXd Q = curvature_bending(scene).flat;
  REQUIRE(Q.rows() == 4 * n);
  CHECK(Q.block(n, 0, 2 * n, 4 * n).norm() == 0);
  CHECK(Q.block(0, n, n, 3 * n).norm() == 0);
  CHECK((Q.block(3 * n, 3 * n, n, n) - 5 * Q.topLeftCorner(n, n)).norm() < 1e-12 * Q.norm());
  CHECK(Q.topLeftCorner(n, n).norm() > 0);
}

TEST_CASE("curvature bending: no inner vertex, isolated vertices and several components", "[bending]") {
  CHECK(curvature_bending(make_scene(grid(1, 8, 0.1, 0.8), bent(1))).flat.nonZeros() == 0);
  // One cloth of a patch, a ribbon without inner vertices and a loose vertex between them.
  const Mesh patch = grid(4, 4, 1, 1), ribbon = grid(1, 3, 1, 3);
  Mesh both;
  both.points.resize(patch.points.rows() + 1 + ribbon.points.rows(), 3);
  both.points << patch.points, Eigen::RowVector3d(9, 9, 9), ribbon.points;
  both.triangles.resize(patch.triangles.rows() + ribbon.triangles.rows(), 3);
  both.triangles << patch.triangles, (ribbon.triangles.array() + static_cast<int>(patch.points.rows()) + 1).matrix();
  both.flat = patch.flat;
  both.flat.emplace_back(0, 0);
  both.flat.insert(both.flat.end(), ribbon.flat.begin(), ribbon.flat.end());
  const Eigen::MatrixXd Q = curvature_bending(make_scene(both, bent(1))).flat;
  const Eigen::MatrixXd alone = curvature_bending(make_scene(patch, bent(1))).flat;
  CHECK(Q.allFinite());
  CHECK((Q.topLeftCorner(25, 25) - alone).norm() == 0);
  CHECK(Q.norm() == Approx(alone.norm()).epsilon(1e-14));
}

TEST_CASE("curvature bending: degenerate rest triangles and non-manifold edges leave it finite", "[bending]") {
  Scene scene = make_scene(grid(4, 4, 1, 1), bent(1));
  scene.rest_triangle[10].setZero();
  CHECK(Eigen::MatrixXd(curvature_bending(scene).flat).allFinite());
  Mesh fins = grid(2, 2, 1, 1);  // a fin on an edge of the only inner vertex: nothing is inside any more
  fins.points.conservativeResize(10, 3);
  fins.points.row(9) << 0.5, 1, -0.5;
  fins.triangles.conservativeResize(9, 3);
  fins.triangles.row(8) << 4, 5, 9;
  fins.flat.clear();
  const CurvatureBending bending = curvature_bending(make_scene(fins, bent(1)));
  CHECK(bending.flat.nonZeros() == 0);
  CHECK(bending.curved.empty());
}

TEST_CASE("curved rest shape: no energy at rest, the right one when unrolled or rolled on", "[bending]") {
  const double B = 2e-5, curvature = 0.8, length = 1, width = 0.7;
  for (const Pattern pattern : {Pattern::one_diagonal, Pattern::alternating, Pattern::jittered})
    for (const double degrees : {0.0, 45.0, 135.0}) {
      const Mesh flat = grid(20, 14, length, width, pattern);
      const Mesh curved{rolled(flat, degrees, curvature), flat.triangles, {}};
      const Scene scene = make_scene(curved, bent(B));
      const CurvatureBending bending = curvature_bending(scene);
      CAPTURE(static_cast<int>(pattern), degrees);
      CHECK(bending.flat.nonZeros() == 0);
      CHECK(bending.curved.size() == 19 * 13);
      const double exact = 0.5 * B * curvature * curvature * length * width;
      for (const Points& x : std::vector<Points>{curved.points, moved(curved.points)}) {
        CHECK(energy_of(bending, x) < 1e-16 * exact);
        for (const CurvedVertex& vertex : bending.curved) {
          Eigen::VectorXd gradient;
          curved_derivatives(vertex, x, gradient, nullptr);
          CHECK(gradient.norm() < 1e-9 * B);
        }
      }
      CHECK(energy_of(bending, flat.points) / exact == Approx(1).epsilon(0.03));
      CHECK(energy_of(bending, rolled(flat, degrees, 2 * curvature)) / exact == Approx(1).epsilon(0.03));
      CHECK(energy_of(bending, rolled(flat, degrees, -curvature)) / exact == Approx(4).epsilon(0.03));
    }
}

TEST_CASE("curved rest shape: flat parts keep the constant form", "[bending]") {
  const Mesh flat = grid(12, 4, 1.2, 0.4);
  Mesh mesh{flat.points, flat.triangles, {}};
  for (int v = 0; v < mesh.points.rows(); ++v)  // flat up to u = 0.55, then a fold
    mesh.points(v, 1) = std::max(0.0, mesh.points(v, 0) - 0.55);
  const Scene scene = make_scene(mesh, bent(1));
  const CurvatureBending bending = curvature_bending(scene);
  CHECK(bending.curved.size() == 2 * 3);  // the columns beside the fold
  CHECK(bending.flat.nonZeros() > 0);
  CHECK((bending.flat * scene.rest).norm() < 1e-10);
}

TEST_CASE("curved rest shape: derivatives by finite differences", "[bending]") {
  const Mesh flat = grid(6, 6, 0.6, 0.6, Pattern::jittered);
  const Scene scene = make_scene(Mesh{rolled(flat, 30, 1.5), flat.triangles, {}}, bent(0.5));
  const CurvatureBending bending = curvature_bending(scene);
  const Points x = perturbed(scene.rest, 0.02);
  REQUIRE(bending.curved.size() == 25);
  for (const CurvedVertex& vertex : bending.curved) {
    Eigen::VectorXd gradient;
    Eigen::MatrixXd hessian;
    const double energy = curved_derivatives(vertex, x, gradient, &hessian), h = 1e-6;
    CHECK(energy == Approx(curved_energy(vertex, x)));
    const double lever = energy > 0 ? 1 / std::sqrt(2 * energy / vertex.stiffness) : 0;  // |gradient| to d((L x) . n)
    for (int i = 0; i < gradient.size(); ++i) {
      Points up = x, down = x;
      up(vertex.nodes[i / 3], i % 3) += h;
      down(vertex.nodes[i / 3], i % 3) -= h;
      CHECK((curved_energy(vertex, up) - curved_energy(vertex, down)) / (2 * h) ==
            Approx(gradient[i]).epsilon(1e-5).margin(1e-6 * gradient.norm()));
    }
    const Eigen::VectorXd slope = gradient * lever / vertex.stiffness;  // Gauss-Newton: stiffness slope slope^T
    CHECK((hessian - vertex.stiffness * slope * slope.transpose()).norm() < 1e-9 * hessian.norm());
  }
}

TEST_CASE("curved rest shape: a collapsed ring gives numbers", "[bending]") {
  const Mesh flat = grid(4, 4, 1, 1);
  const Scene scene = make_scene(Mesh{rolled(flat, 0, 1), flat.triangles, {}}, bent(1));
  const Points x = Points::Zero(25, 3);
  for (const CurvedVertex& vertex : curvature_bending(scene).curved) {
    Eigen::VectorXd gradient;
    Eigen::MatrixXd hessian;
    CHECK(std::isfinite(curved_derivatives(vertex, x, gradient, &hessian)));
    CHECK(gradient.allFinite());
    CHECK(hessian.allFinite());
  }
}

TEST_CASE("hinge: known angles, sign and weight", "[bending]") {
  const auto angle_of = [](double angle) {
    const Points x = example_hinge_points(angle);
    return dihedral_angle(row(x, 0), row(x, 1), row(x, 2), row(x, 3));
  };
  for (const double angle : {0.0, 0.3, pi / 2, 3.0, -0.7, -pi / 2, -3.1}) CHECK(angle_of(angle) == Approx(angle));
  CHECK(hinge_energy(example_hinge(0.4), example_hinge_points(0.9)) == Approx(0.5 * 0.7 * 0.25));
  // Across the cut of atan2 the difference goes the short way.
  CHECK(hinge_energy(example_hinge(3.0), example_hinge_points(-3.0)) ==
        Approx(0.5 * 0.7 * (2 * pi - 6) * (2 * pi - 6)));

  Mesh mesh;
  mesh.points.resize(4, 3);
  mesh.points << 0, 0, 0, 1, 0, 0, 0, 0, -1, 1, 0, -1;  // the unit square's diagonal
  mesh.triangles.resize(2, 3);
  mesh.triangles << 0, 1, 2, 3, 2, 1;
  const std::vector<Hinge> square = hinges(make_scene(mesh, bent(0.3, BendingModel::hinge)));
  REQUIRE(square.size() == 1);
  CHECK(square[0].weight == Approx(0.3 * 2 / (4 * 1)));
  CHECK(square[0].rest_angle == Approx(0).margin(1e-15));
  Points roof = mesh.points;
  roof(0, 1) = roof(3, 1) = -0.5;  // both corners down: convex seen from above, where the normals point
  CHECK(dihedral_angle(row(roof, square[0].nodes[0]), row(roof, square[0].nodes[1]), row(roof, square[0].nodes[2]),
                       row(roof, square[0].nodes[3])) > 1);
  CHECK(hinges(make_scene(mesh, bent(0, BendingModel::hinge))).empty());
  CHECK(hinges(make_scene(mesh, bent(1))).empty());
}

TEST_CASE("hinge: rest angles of a curved shape; rest and rigid motion carry no energy", "[bending]") {
  const Mesh flat = grid(5, 4, 0.5, 0.4, Pattern::alternating);
  const Scene scene = make_scene(Mesh{rolled(flat, 30, 3), flat.triangles, {}}, bent(1, BendingModel::hinge));
  const std::vector<Hinge> all = hinges(scene);
  CHECK(all.size() == 5 * 3 + 4 * 4 + 20);
  for (const Points& x : std::vector<Points>{scene.rest, moved(scene.rest)})
    for (const Hinge& hinge : all) {
      Vec12 gradient;
      CHECK(hinge_derivatives(hinge, x, gradient, nullptr) < 1e-26);
      CHECK(gradient.norm() < 1e-12);
    }
}

TEST_CASE("hinge: derivatives by finite differences; the projection is PSD and bounds the Hessian", "[bending]") {
  const Hinge hinge = example_hinge();
  for (unsigned trial = 0; trial < 300; ++trial) {
    const Points x = perturbed(Points::Zero(4, 3), 1, trial);
    const double angle = dihedral_angle(row(x, 0), row(x, 1), row(x, 2), row(x, 3));
    Vec12 gradient;
    Mat12 hessian, projected;
    const double energy = hinge_derivatives(hinge, x, gradient, &hessian, false), h = 1e-7;
    hinge_derivatives(hinge, x, gradient, &projected, true);
    const Eigen::VectorXd spectrum = symmetric_eigenvalues(projected);
    CHECK(spectrum[0] >= -1e-9 * spectrum[11]);
    const Eigen::VectorXd excess = symmetric_eigenvalues(projected - hessian);
    CHECK(excess[0] >= -1e-9 * spectrum[11]);
    if (pi - std::abs(std::remainder(angle - 0.4, 2 * pi)) < 1e-2 || hessian.norm() > 1e4) continue;
    CHECK(energy == Approx(hinge_energy(hinge, x)));
    Vec12 numeric;
    Mat12 numeric_hessian;
    for (int i = 0; i < 12; ++i) {
      Points up = x, down = x;
      up.data()[i] += h;
      down.data()[i] -= h;
      Vec12 g_up, g_down;
      numeric[i] =
          (hinge_derivatives(hinge, up, g_up, nullptr) - hinge_derivatives(hinge, down, g_down, nullptr)) / (2 * h);
      numeric_hessian.col(i) = (g_up - g_down) / (2 * h);
    }
    CHECK((gradient - numeric).norm() < 1e-5 * (1 + gradient.norm()));
    CHECK((hessian - numeric_hessian).norm() < 1e-4 * (1 + hessian.norm()));
  }
}

TEST_CASE("hinge: with the current edge length, as in HOOD's loss", "[bending]") {
  Hinge hinge = example_hinge(0);
  hinge.length = HingeLength::current;
  // The edge is 1.2 long: the weight is per square of it.
  CHECK(hinge_energy(hinge, example_hinge_points(0.9)) == Approx(0.5 * 0.7 * 1.44 * 0.81));
  for (unsigned trial = 0; trial < 200; ++trial) {
    const Points x = perturbed(Points::Zero(4, 3), 1, trial);
    const double angle = dihedral_angle(row(x, 0), row(x, 1), row(x, 2), row(x, 3)), h = 1e-7;
    Vec12 gradient;
    Mat12 hessian, projected, numeric;
    hinge_derivatives(hinge, x, gradient, &hessian, false);
    hinge_derivatives(hinge, x, gradient, &projected, true);
    const Eigen::VectorXd spectrum = symmetric_eigenvalues(projected);
    CHECK(spectrum[0] >= -1e-9 * spectrum[11]);
    const Eigen::VectorXd excess = symmetric_eigenvalues(projected - hessian);
    CHECK(excess[0] >= -1e-9 * spectrum[11]);
    if (pi - std::abs(angle) < 1e-2 || hessian.norm() > 1e4) continue;
    Vec12 slope;
    for (int i = 0; i < 12; ++i) {
      Points up = x, down = x;
      up.data()[i] += h;
      down.data()[i] -= h;
      Vec12 g_up, g_down;
      slope[i] =
          (hinge_derivatives(hinge, up, g_up, nullptr) - hinge_derivatives(hinge, down, g_down, nullptr)) / (2 * h);
      numeric.col(i) = (g_up - g_down) / (2 * h);
    }
    CHECK((gradient - slope).norm() < 1e-5 * (1 + gradient.norm()));
    CHECK((hessian - numeric).norm() < 1e-4 * (1 + hessian.norm()));
  }
  Mesh mesh;
  mesh.points.resize(4, 3);
  mesh.points << 0, 0, 0, 1, 0, 0, 0, 0, -1, 1, 0, -1;
  mesh.triangles.resize(2, 3);
  mesh.triangles << 0, 1, 2, 3, 2, 1;
  Material material = bent(0.3, BendingModel::hinge);
  material.hinge_length = HingeLength::current;
  const std::vector<Hinge> square = hinges(make_scene(mesh, material));
  REQUIRE(square.size() == 1);
  CHECK(square[0].weight == Approx(0.3 / 4));
  CHECK(square[0].length == HingeLength::current);
}

TEST_CASE("hinge: at its rest angle the Hessian is left alone", "[bending]") {
  const Hinge hinge = example_hinge(0.4);
  Vec12 gradient;
  Mat12 hessian, projected;
  hinge_derivatives(hinge, example_hinge_points(0.4), gradient, &hessian, false);
  hinge_derivatives(hinge, example_hinge_points(0.4), gradient, &projected, true);
  CHECK(hessian.norm() > 0.1);
  CHECK((hessian - projected).norm() < 1e-12 * hessian.norm());
}

TEST_CASE("hinge: degenerate triangles give numbers", "[bending]") {
  std::vector<Points> cases(4, example_hinge_points(0.5));
  cases[0].row(1) = cases[0].row(0);  // no edge
  cases[1].row(2) << 0.5, 0, 0;       // a tip on the edge
  cases[2].setZero();                 // a point
  cases[3].row(2) << 0.5, 1e-14, 0;   // a sliver
  for (const Points& x : cases) {
    Vec12 gradient;
    Mat12 hessian;
    CHECK(std::isfinite(hinge_derivatives(example_hinge(), x, gradient, &hessian)));
    CHECK(gradient.allFinite());
    CHECK(hessian.allFinite());
    CHECK(gradient.norm() < 1e5);
  }
}

TEST_CASE("hinge: depends on the mesh as the papers' form does, the curvature form does not", "[bending]") {
  const Mesh mesh = grid(24, 24, 1, 1);
  const double curvature = 0.2, exact = 0.5 * curvature * curvature;
  // The table is for weight l^2 / (A0 + A1) theta^2 / 2; the papers' is a quarter of it.
  const std::vector<Hinge> all = hinges(make_scene(mesh, bent(4, BendingModel::hinge)));
  const auto ratio = [&](double degrees) {
    double sum = 0;
    for (const Hinge& hinge : all) sum += hinge_energy(hinge, rolled(mesh, degrees, curvature));
    return sum / exact;
  };
  CHECK(ratio(0) == Approx(0.96).margin(0.04));
  CHECK(std::max(ratio(45), ratio(135)) == Approx(3.0).margin(0.15));
  CHECK(std::min(ratio(45), ratio(135)) == Approx(1.07).margin(0.1));
}

}  // namespace selvedge::test_bending
