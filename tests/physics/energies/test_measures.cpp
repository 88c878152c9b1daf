#include <catch2/catch.hpp>

#include "physics/energies/measures.hpp"
#include "physics/scene/stepper.hpp"
#include "tests/physics/meshes.hpp"
#include "tests/physics/single_elements.hpp"

namespace selvedge::test_measures {

using meshes::grid;

namespace {

Scene two_cloths() {
  Material soft, stiff;
  soft.density = 0.1;
  soft.bending_model = BendingModel::hinge;
  stiff.density = 0.3;
  stiff.membrane = MembraneModel::baraff_witkin;
  Scene scene = meshes::make_scene(grid(4, 3, 0.4, 0.3), soft);
  meshes::add_cloth(scene, grid(3, 3, 0.5, 0.5, meshes::Pattern::jittered), stiff);
  return scene;
}

}  // namespace

TEST_CASE("measures: kinetic and gravity energy, momenta of a rigidly moving cloth", "[measures]") {
  const Scene scene = two_cloths();
  const double mass = 0.1 * 0.12 + 0.3 * 0.25, g = 9.81;
  const Vec3 speed(1, -2, 0.5), acceleration(0, -g, 0);
  const Points v = speed.transpose().replicate(scene.rest.rows(), 1);
  Points raised = scene.rest;
  raised.col(1).array() += 1.5;
  const Energies energy = energies(scene, raised, v, acceleration);
  CHECK(energy.kinetic == Approx(0.5 * mass * speed.squaredNorm()));
  CHECK(energy.gravity == Approx(mass * g * 1.5));
  CHECK(std::abs(energy.membrane) < 1e-20);
  CHECK(std::abs(energy.bending) < 1e-15);
  CHECK(energy.total() == Approx(energy.kinetic + energy.gravity));
  CHECK((linear_momentum(scene, v) - mass * speed).norm() < 1e-14);

  const Eigen::VectorXd masses = lumped_masses(scene);
  const Vec3 centre = raised.transpose() * masses / mass;
  CHECK((angular_momentum(scene, raised, v) - mass * centre.cross(speed)).norm() < 1e-14);
  Points spinning(raised.rows(), 3);  // omega about the x axis: L_x = sum m (y^2 + z^2) omega
  for (int i = 0; i < spinning.rows(); ++i) spinning.row(i) = Vec3(2, 0, 0).cross(row(raised, i)).transpose();
  const double inertia = masses.dot(raised.rightCols<2>().rowwise().squaredNorm());
  CHECK(angular_momentum(scene, raised, spinning).x() == Approx(2 * inertia));
}

TEST_CASE("measures: elastic energies are sums over the terms, each cloth with its own material", "[measures]") {
  const Scene scene = two_cloths();
  Points x = scene.rest;
  for (int i = 0; i < x.rows(); ++i) x.row(i) << 1.1 * x(i, 0), 0.3 * x(i, 0) * x(i, 2), 0.95 * x(i, 2);
  const EnergyTerms terms = energy_terms(scene);
  CHECK(terms.membrane.size() == 24 + 18);
  double membrane = 0, bending = 0;
  for (const MembraneElement& element : terms.membrane)
    membrane += single::membrane_energy(scene.cloths[element.material].material, element, x);
  for (const Hinge& hinge : terms.hinges) bending += hinge_energy(hinge, x);
  CHECK(bending > 0);
  for (int k = 0; k < 3; ++k) bending += 0.5 * x.col(k).dot(terms.curvature.flat * x.col(k));
  const Energies energy = energies(scene, x, Points::Zero(x.rows(), 3), Vec3::Zero());
  CHECK(energy.membrane == Approx(membrane));
  CHECK(energy.bending == Approx(bending));
  CHECK(energy.kinetic == 0);
  CHECK(energy.gravity == 0);
}

TEST_CASE("measures: springs store half their stiffness times the stretch squared", "[measures]") {
  Scene scene = two_cloths();
  scene.springs = {{0, scene.cloths[1].first_vertex, 0.1, 30}, {1, 2, 0.05, 7}};
  Points x = scene.rest;
  x.bottomRows(scene.cloths[1].vertex_count).col(1).array() += 0.3;
  const double apart = (x.row(0) - x.row(scene.cloths[1].first_vertex)).norm();
  const Energies energy = energies(scene, x, Points::Zero(x.rows(), 3), Vec3::Zero());
  CHECK(energy.springs == Approx(0.5 * 30 * std::pow(apart - 0.1, 2) + 0.5 * 7 * std::pow(0.1 - 0.05, 2)));
  CHECK(energy.total() == Approx(energy.membrane + energy.bending + energy.springs));
}

TEST_CASE("measures: the energy of a force that the stepper ignores is not a number", "[measures]") {
  Scene scene = two_cloths();
  const Points still = Points::Zero(scene.rest.rows(), 3);
  const auto of = [&](const std::vector<std::string>& ignored) {
    return energies(scene, energy_terms(scene, {.name = "some", .ignores = ignored}), scene.rest, still, Vec3::Zero());
  };
  CHECK(of({"springs"}).springs == 0);  // there are none
  scene.springs = {{0, scene.cloths[1].first_vertex, 0.1, 30}};
  CHECK(of({"wind"}).springs == energies(scene, scene.rest, still, Vec3::Zero()).springs);
  CHECK(of({"wind"}).springs > 0);
  CHECK(std::isnan(of({"springs"}).springs));
  CHECK(std::isfinite(of({"springs"}).membrane));
  CHECK(std::isnan(of({"membrane"}).membrane));
  CHECK(std::isnan(of({"bending (hinge)"}).bending));
}

TEST_CASE("measures: bending energy of curved rest shapes counts", "[measures]") {
  meshes::Mesh mesh = grid(6, 6, 0.6, 0.6);
  mesh.flat.clear();
  const Points flat = mesh.points;
  for (int i = 0; i < flat.rows(); ++i) mesh.points(i, 1) = flat(i, 0) * flat(i, 0);
  const Scene scene = meshes::make_scene(mesh);
  const Points still = Points::Zero(flat.rows(), 3);
  CHECK(energies(scene, scene.rest, still, Vec3::Zero()).bending < 1e-20);
  CHECK(energies(scene, flat, still, Vec3::Zero()).bending > 1e-6);
}

TEST_CASE("measures: principal stretches, smallest first", "[measures]") {
  Scene scene = meshes::make_scene(grid(3, 3, 0.3, 0.3, meshes::Pattern::jittered));
  scene.rest_triangle[5].setZero();
  const double angle = 0.6;
  Points x = scene.rest;
  for (int i = 0; i < x.rows(); ++i) {  // 1.4 along one direction of the plane, 0.7 across it
    const double along = std::cos(angle) * x(i, 0) + std::sin(angle) * x(i, 2);
    const double across = -std::sin(angle) * x(i, 0) + std::cos(angle) * x(i, 2);
    x.row(i) << 0.7 * across, 2, 1.4 * along;
  }
  const auto stretches = principal_stretches(scene, x);
  REQUIRE(stretches.rows() == 18);
  for (int t = 0; t < stretches.rows(); ++t) {
    CHECK(stretches(t, 0) == Approx(t == 5 ? 1 : 0.7));
    CHECK(stretches(t, 1) == Approx(t == 5 ? 1 : 1.4));
  }
  const auto line = principal_stretches(scene, x * Vec3(0, 0, 1).asDiagonal());  // collapsed onto a line
  CHECK(line.col(0)[0] == Approx(0).margin(1e-15));
  CHECK(line.col(1)[0] == Approx(1.4));
  CHECK(principal_stretches(scene, Points::Zero(x.rows(), 3)).row(0).norm() == 0);
}

}  // namespace selvedge::test_measures
