#include <random>

#include <catch2/catch.hpp>

#include "physics/solve/assembly.hpp"
#include "tests/physics/meshes.hpp"
#include "tests/physics/single_elements.hpp"
#include "tests/threads.hpp"

namespace selvedge::test_assembly {

namespace {

Points shaken(const Points& points, double size) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-size, size);
  Points result = points;
  for (Eigen::Index i = 0; i < result.size(); ++i) result.data()[i] += uniform(random);
  return result;
}

// A flat curvature cloth and a hinge cloth, joined by a spring, with another one along a mesh edge.
Scene three_cloths(int cells) {
  Material material;
  material.bending = 1e-3;
  material.stiffness_damping = 0.01;
  Scene scene = meshes::make_scene(meshes::grid(cells, cells, 0.5, 0.5, meshes::Pattern::jittered), material);
  material.bending_model = BendingModel::hinge;
  material.membrane = MembraneModel::stable_neo_hookean;
  material.stiffness_damping = 0.03;
  meshes::add_cloth(scene, meshes::grid(cells, cells, 0.5, 0.5, meshes::Pattern::alternating), material);
  scene.springs = {{scene.cloths[1].first_vertex + 5, 2, 0.02, 300}, {0, 1, 0.3, 50}};
  return scene;
}

Scene rolled_cloth(int cells) {
  Material material;
  material.bending = 1e-3;
  meshes::Mesh mesh = meshes::grid(cells, cells, 0.5, 0.5);
  for (int i = 0; i < mesh.points.rows(); ++i) {
    const Vec3 p = row(mesh.points, i);
    mesh.points.row(i) << 0.2 * std::sin(5 * p.x()), 0.2 * std::cos(5 * p.x()), p.z();
  }
  mesh.flat.clear();
  return meshes::make_scene(mesh, material);
}

double total(const std::vector<double>& parts) {
  double sum = 0;
  for (double part : parts) sum += part;
  return sum;
}

}  // namespace

TEST_CASE("Assembly adds up every element, each where it belongs", "[assembly]") {
  const bool rolled = GENERATE(false, true);
  const Scene scene = rolled ? rolled_cloth(5) : three_cloths(5);
  const Elastic elastic = make_elastic(scene);
  if (rolled)
    REQUIRE(!elastic.curved.empty());
  else
    REQUIRE((elastic.flat.rows() > 0 && !elastic.hinges.empty() && elastic.joints.springs.size() == 2));
  const Points x = shaken(scene.rest, 0.01);
  const int n = static_cast<int>(x.rows());

  double energy = 0;
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(3 * n);
  Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(3 * n, 3 * n);
  const auto add = [&](const auto& nodes, const auto& g, const auto& h) {
    for (std::size_t a = 0; a < nodes.size(); ++a) {
      gradient.segment<3>(3 * nodes[a]) += g.template segment<3>(3 * a);
      for (std::size_t b = 0; b < nodes.size(); ++b)
        hessian.block<3, 3>(3 * nodes[a], 3 * nodes[b]) += h.template block<3, 3>(3 * a, 3 * b);
    }
  };
  for (const MembraneElement& element : elastic.membrane) {
    single::Vec9 g;
    single::Mat9 h;
    energy += single::membrane_energy(elastic.materials[element.material], element, x);
    single::membrane_derivatives(elastic.materials[element.material], element, x, g, &h);
    add(element.nodes, g, h);
  }
  for (const Hinge& hinge : elastic.hinges) {
    single::Vec12 g;
    single::Mat12 h;
    energy += single::hinge_derivatives(hinge, x, g, &h);
    add(hinge.nodes, g, h);
  }
  for (const CurvedVertex& vertex : elastic.curved) {
    Eigen::VectorXd g;
    Eigen::MatrixXd h;
    energy += curved_derivatives(vertex, x, g, &h);
    add(vertex.nodes, g, h);
  }
  for (const Spring& spring : elastic.joints.springs) {
    Vec6 g;
    Mat6 h;
    energy += joint_derivatives(spring, x, g, &h);
    add(std::array{spring.a, spring.b}, g, h);
  }
  if (elastic.flat.rows() > 0) {
    const Points force = elastic.flat * x;
    energy += 0.5 * force.cwiseProduct(x).sum();
    for (int i = 0; i < n; ++i) gradient.segment<3>(3 * i) += row(force, i);
  }

  AssemblyScratch scratch;
  Points assembled;
  PairBlocks pairs;
  std::vector<double> energies{1.0};
  append_elastic_energies(elastic, x, energies);
  elastic_derivatives(elastic, x, scratch, &assembled, &pairs);
  CHECK(total(energies) - 1 == Approx(energy).epsilon(1e-10));
  CHECK((Eigen::Map<Eigen::VectorXd>(assembled.data(), 3 * n) - gradient).norm() < 1e-10 * gradient.norm());
  const Points u = shaken(Points::Zero(n, 3), 1);
  const Eigen::VectorXd wanted = hessian * Eigen::Map<const Eigen::VectorXd>(u.data(), 3 * n);
  for (int i = 0; i < n; ++i) {
    CHECK((multiply_row(elastic.pattern, pairs, u, i) - wanted.segment<3>(3 * i)).norm() < 1e-10 * wanted.norm());
    CHECK((diagonal_block(elastic.pattern, pairs, i) - hessian.block<3, 3>(3 * i, 3 * i)).norm() <
          1e-10 * hessian.norm());
  }
}

TEST_CASE("Damping weights every element with its own cloth, a spring between two with the mean", "[assembly]") {
  const Scene scene = three_cloths(4);
  const Elastic elastic = make_elastic(scene);
  AssemblyScratch scratch;
  PairBlocks plain, damped;
  elastic_derivatives(elastic, scene.rest, scratch, nullptr, &plain);
  elastic_derivatives(elastic, scene.rest, scratch, nullptr, &damped, HessianForm::damping);
  for (std::size_t p = 0; p < plain.size(); ++p) {
    const bool first = elastic.pattern.pairs[p][0] < scene.cloths[1].first_vertex,
               second = elastic.pattern.pairs[p][1] >= scene.cloths[1].first_vertex;
    const double rate = first && second ? 0.02 : first ? 0.01 : 0.03;
    CHECK((damped[p] - rate * plain[p]).norm() <= 1e-14 * plain[p].norm());
  }
}

TEST_CASE("What a scene does not have is not built", "[assembly]") {
  Material material;
  material.bending = 0;
  const Elastic elastic = make_elastic(meshes::make_scene(meshes::grid(4, 4, 1, 1), material));
  CHECK(elastic.hinges.empty());
  CHECK(elastic.curved.empty());
  CHECK(elastic.joints.springs.empty());
  CHECK(elastic.flat.rows() == 0);
  CHECK(elastic.pattern.pairs.size() == 4 * 5 * 2 + 16);  // the mesh's edges
}

TEST_CASE("One and two threads assemble the same bits", "[assembly][threads]") {
  const Scene scene = three_cloths(40);
  const Elastic elastic = make_elastic(scene);
  const Points x = shaken(scene.rest, 0.003);
  AssemblyScratch scratch;
  Points gradients[2];
  PairBlocks pairs[2];
  std::vector<double> sums[2];
  for (int k = 0; k < 2; ++k)
    with_threads(k + 1, [&] {
      append_elastic_energies(elastic, x, sums[k]);
      elastic_derivatives(elastic, x, scratch, &gradients[k], &pairs[k]);
    });
  CHECK(same_bits(gradients[0], gradients[1]));
  CHECK(sums[0] == sums[1]);
  CHECK(pairs[0] == pairs[1]);
}

}  // namespace selvedge::test_assembly
