#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>
#include <random>

#include "collision/geometry/factorisations.hpp"
#include "physics/energies/membrane.hpp"
#include "physics/energies/membrane_lanes.hpp"
#include "tests/physics/meshes.hpp"
#include "tests/physics/single_elements.hpp"

namespace selvedge::test_membrane {

using single::Mat9;
using single::membrane_derivatives;
using single::membrane_energy;
using single::Vec9;

namespace {

Material material_of(MembraneModel model) {
  Material material;
  material.membrane = model;
  material.lame_mu = 380;
  material.lame_lambda = 330;
  material.warp = 1000;
  material.weft = 700;
  material.shear = 400;
  return material;
}

const std::vector<MembraneModel> models{MembraneModel::stvk, MembraneModel::stable_neo_hookean,
                                        MembraneModel::baraff_witkin};

class Random {
 public:
  double operator()(double low, double high) { return std::uniform_real_distribution<>(low, high)(engine_); }
  Points points(int n, double size = 1) {
    Points x(n, 3);
    for (int i = 0; i < n; ++i)
      for (int k = 0; k < 3; ++k) x(i, k) = (*this)(-size, size);
    return x;
  }
  Mat3 rotation() {
    const Vec3 axis(normal_(engine_), normal_(engine_), normal_(engine_));
    return Eigen::AngleAxisd((*this)(0, 3), axis.normalized()).toRotationMatrix();
  }

 private:
  std::mt19937 engine_{11};
  std::normal_distribution<> normal_;
};

MembraneElement element_of(const RestTriangle& rest) {
  Scene scene;
  Triangles triangle(1, 3);
  triangle << 0, 1, 2;
  scene.surface = make_surface(3, triangle);
  scene.rest_triangle = {rest};
  scene.cloths = {Cloth{"one", {}, 0, 3, 0, 1}};
  const auto elements = membrane_elements(scene);
  REQUIRE(elements.size() == 1);
  return elements[0];
}

MembraneElement slanted() {
  RestTriangle rest;
  rest << 0.1, 0.5, 0.2, 0.0, 0.1, 0.7;
  return element_of(rest);
}

// Its shape gradients are an orthogonal frame, so clamping in F and clamping the 9 x 9 are the same.
MembraneElement equilateral() {
  RestTriangle rest;
  rest << 0, 1, 0.5, 0, 0, std::sqrt(0.75);
  return element_of(rest);
}

// Positions with F = rotation * stretch, `stretch` along the axes at `angle` in the rest plane.
Points posed(const MembraneElement& element, double s1, double s2, double angle, const Mat3& rotation) {
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd(angle).toRotationMatrix();
  const Mat32 F = rotation.leftCols<2>() * Eigen::Vector2d(s1, s2).asDiagonal() * turn;
  const Mat32 edges = F * element.inverse.inverse();
  Points x(3, 3);
  x.row(0).setZero();
  x.row(1) = edges.col(0).transpose();
  x.row(2) = edges.col(1).transpose();
  return x;
}

Vec9 numeric_gradient(const Material& material, const MembraneElement& element, const Points& x, double h) {
  Vec9 gradient;
  for (int i = 0; i < 9; ++i) {
    Points up = x, down = x;
    up.data()[i] += h;
    down.data()[i] -= h;
    gradient[i] = (membrane_energy(material, element, up) - membrane_energy(material, element, down)) / (2 * h);
  }
  return gradient;
}

Mat9 numeric_hessian(const Material& material, const MembraneElement& element, const Points& x, double h) {
  Mat9 hessian;
  for (int i = 0; i < 9; ++i) {
    Points up = x, down = x;
    up.data()[i] += h;
    down.data()[i] -= h;
    Vec9 g_up, g_down;
    membrane_derivatives(material, element, up, g_up, nullptr);
    membrane_derivatives(material, element, down, g_down, nullptr);
    hessian.col(i) = (g_up - g_down) / (2 * h);
  }
  return hessian;
}

Mat9 clamped(const Mat9& matrix) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spectrum(matrix);
  return spectrum.eigenvectors() * spectrum.eigenvalues().cwiseMax(0).asDiagonal() *
         spectrum.eigenvectors().transpose();
}

// Stretch pairs that meet every case: rest, equal, compressed, nearly and fully degenerate.
const std::vector<std::array<double, 2>> stretches{{1, 1},    {1.3, 0.8},    {1.2, 1.2},   {0.5, 0.4}, {0.3, 0.3},
                                                   {2, 0.05}, {3, 2},        {1, 1e-7},    {1, 0},     {1e-9, 1e-9},
                                                   {0, 0},    {1, 1 - 1e-9}, {0.9, 1e-15}, {5, 0.2},   {1e-3, 2e-3}};

}  // namespace

TEST_CASE("membrane: gradient and Hessian by finite differences", "[membrane]") {
  Random random;
  const MembraneElement element = slanted();
  for (const MembraneModel model : models) {
    const Material material = material_of(model);
    for (int trial = 0; trial < 60; ++trial) {
      const Points x = posed(element, random(0.15, 2), random(0.15, 2), random(-3, 3), random.rotation());
      Vec9 gradient;
      Mat9 hessian;
      membrane_derivatives(material, element, x, gradient, &hessian, false);
      CHECK((gradient - numeric_gradient(material, element, x, 1e-6)).norm() < 1e-6 * (1 + gradient.norm()));
      CHECK((hessian - numeric_hessian(material, element, x, 1e-6)).norm() < 1e-6 * hessian.norm());
    }
  }
}

TEST_CASE("membrane: projected Hessians are PSD and finite for any F", "[membrane]") {
  Random random;
  for (const MembraneElement& element : {slanted(), equilateral()})
    for (const MembraneModel model : models) {
      const Material material = material_of(model);
      const auto check = [&](const Points& x) {
        Vec9 gradient;
        Mat9 hessian, raw;
        membrane_derivatives(material, element, x, gradient, &hessian, true);
        membrane_derivatives(material, element, x, gradient, &raw, false);
        const bool finite = std::isfinite(membrane_energy(material, element, x)) && gradient.allFinite() &&
                            hessian.allFinite() && raw.allFinite();
        const Eigen::VectorXd values = symmetric_eigenvalues(hessian);
        return finite && values[0] >= -1e-9 * std::max(values[8], 1e-12) &&
               (hessian - hessian.transpose()).norm() <= 1e-14 * hessian.norm();
      };
      int failures = 0;
      for (int trial = 0; trial < 1000; ++trial)
        if (!check(random.points(3, trial % 2 ? 1 : 0.1))) ++failures;
      for (const auto& s : stretches)
        for (const double angle : {0.0, 0.7, 1.5707963267948966, -2.0})
          if (!check(posed(element, s[0], s[1], angle, random.rotation()))) ++failures;
      CHECK(failures == 0);
    }
}

TEST_CASE("membrane: projection clamps eigenvalues and nothing else", "[membrane]") {
  Random random;
  const MembraneElement element = equilateral();
  // Baraff-Witkin is projected term by term.
  std::vector<Material> materials{material_of(MembraneModel::stvk), material_of(MembraneModel::stable_neo_hookean)};
  for (int term = 0; term < 3; ++term) {
    Material material = material_of(MembraneModel::baraff_witkin);
    if (term != 0) material.warp = 0;
    if (term != 1) material.weft = 0;
    if (term != 2) material.shear = 0;
    materials.push_back(material);
  }
  for (const Material& material : materials)
    for (int trial = 0; trial < 200; ++trial) {
      const Points x = posed(element, random(0.1, 1.6), random(0.1, 1.6), random(-3, 3), random.rotation());
      Vec9 gradient;
      Mat9 raw, projected;
      membrane_derivatives(material, element, x, gradient, &raw, false);
      membrane_derivatives(material, element, x, gradient, &projected, true);
      CHECK((projected - clamped(raw)).norm() < 1e-11 * raw.norm());
    }
}

TEST_CASE("membrane: elements side by side are what each is alone, whatever their number and models", "[membrane]") {
  Random random;
  std::vector<Material> materials;
  for (const MembraneModel model : models) materials.push_back(material_of(model));
  for (const int count : {1, 15, 16, 17, 41}) {
    std::vector<MembraneElement> elements;
    Points x(3 * count, 3);
    for (int e = 0; e < count; ++e) {
      elements.push_back(e % 2 ? slanted() : equilateral());
      elements.back().nodes = {3 * e, 3 * e + 1, 3 * e + 2};
      elements.back().material = 3 * e / count;                                      // a run of each model
      x.middleRows(3 * e, 3) = e == 7 ? Points::Ones(3, 3) : random.points(3, 0.5);  // one of no area
    }
    double sum = 0;
    MembraneLanes lanes;
    int first = 0;
    for (std::span<const MembraneElement> rest = elements; !rest.empty(); rest = rest.subspan(lanes.count)) {
      const auto group = rest.first(together(materials, rest));
      membrane_derivatives(materials, group, x, true, true, lanes);
      REQUIRE(lanes.count == static_cast<int>(group.size()));
      for (int l = 0; l < lanes.count; ++l) {
        const MembraneElement& element = elements[first + l];
        const Material& material = materials[element.material];
        Vec9 gradient;
        Mat9 hessian;
        MembraneElement alone = element;
        alone.nodes = {0, 1, 2};
        membrane_derivatives(material, alone, x.middleRows(3 * (first + l), 3), gradient, &hessian);
        for (int k = 0; k < 6; ++k) CHECK(lanes.force[k][l] == Approx(gradient[3 + k]).margin(1e-12));
        CHECK((block_of(lanes, 2, l) - hessian.block<3, 3>(3, 6)).norm() <= 1e-12 * hessian.norm());
        sum += membrane_energy(material, element, x);
      }
      first += lanes.count;
    }
    REQUIRE(first == count);
    CHECK(membrane_energy(materials, elements, x) == Approx(sum));
  }
}

TEST_CASE("membrane: a stretched triangle's Hessian is left alone", "[membrane]") {
  const MembraneElement element = slanted();
  for (const MembraneModel model : {MembraneModel::stvk, MembraneModel::baraff_witkin}) {
    const Points x = posed(element, 1.3, 1.1, 0, Mat3::Identity());  // no shear, all in tension
    Vec9 gradient;
    Mat9 raw, projected;
    membrane_derivatives(material_of(model), element, x, gradient, &raw, false);
    membrane_derivatives(material_of(model), element, x, gradient, &projected, true);
    CHECK((raw - projected).norm() < 1e-12 * raw.norm());
  }
}

TEST_CASE("membrane: rest and rigid motion carry neither energy nor force", "[membrane]") {
  Random random;
  const MembraneElement element = slanted();
  for (const MembraneModel model : models)
    for (int trial = 0; trial < 20; ++trial) {
      Points x = posed(element, 1, 1, random(-3, 3), random.rotation());
      x.rowwise() += Eigen::RowVector3d(random(-1, 1), random(-1, 1), random(-1, 1));
      Vec9 gradient;
      CHECK(membrane_energy(material_of(model), element, x) < 1e-25 * 1e3);
      membrane_derivatives(material_of(model), element, x, gradient, nullptr);
      CHECK(gradient.norm() < 1e-12 * 1e3);
    }
}

TEST_CASE("membrane: small strain is linear plane stress for both isotropic models", "[membrane]") {
  const MembraneElement element = slanted();
  const double e1 = 1e-5, e2 = -4e-6, mu = 380, lambda = 330;
  const double exact = element.area * (mu * (e1 * e1 + e2 * e2) + 0.5 * lambda * (e1 + e2) * (e1 + e2));
  for (const MembraneModel model : {MembraneModel::stvk, MembraneModel::stable_neo_hookean})
    CHECK(membrane_energy(material_of(model), element, posed(element, 1 + e1, 1 + e2, 0.4, Mat3::Identity())) ==
          Approx(exact).epsilon(1e-4));
}

TEST_CASE("membrane: St. Venant-Kirchhoff under uniaxial tension", "[membrane]") {
  const double k = 1000, nu = 0.3, stretch = 1.2;
  Material material;
  material.lame_mu = k / (2 * (1 + nu));
  material.lame_lambda = k * nu / (1 - nu * nu);
  RestTriangle rest;
  rest << 0, 1, 0, 0, 0, 1;
  const MembraneElement element = element_of(rest);
  const double lateral = std::sqrt(1 - nu * (stretch * stretch - 1));
  Vec9 gradient;
  membrane_derivatives(material, element, posed(element, stretch, lateral, 0, Mat3::Identity()), gradient, nullptr);
  const double force = stretch * k * (stretch * stretch - 1) / 2;  // per width
  CHECK(gradient[3] == Approx(force / 2));                         // area times d F / d x1
  CHECK(gradient.segment<3>(6).norm() < 1e-10 * force);
}

TEST_CASE("membrane: Baraff-Witkin answers along the threads", "[membrane]") {
  RestTriangle rest;
  rest << 0, 1, 0, 0, 0, 1;
  const MembraneElement element = element_of(rest);
  const Material material = material_of(MembraneModel::baraff_witkin);
  CHECK(membrane_energy(material, element, posed(element, 1.1, 1, 0, Mat3::Identity())) == Approx(0.5 * 500 * 0.01));
  CHECK(membrane_energy(material, element, posed(element, 1, 1.1, 0, Mat3::Identity())) == Approx(0.5 * 350 * 0.01));
  Points sheared(3, 3);
  sheared << 0, 0, 0, 1, 0, 0, std::sin(0.1), std::cos(0.1), 0;
  CHECK(membrane_energy(material, element, sheared) == Approx(0.5 * 200 * std::pow(std::sin(0.1), 2)));
}

TEST_CASE("membrane: elements of a scene leave out triangles without area", "[membrane]") {
  Scene scene = meshes::make_scene(meshes::grid(3, 2, 0.3, 0.2));
  scene.rest_triangle[4].row(1).setZero();
  const auto elements = membrane_elements(scene);
  CHECK(elements.size() == 11);
  for (const MembraneElement& element : elements) {
    CHECK(element.area == Approx(0.005));
    CHECK((deformation_gradient(element, scene.rest) - (Mat32() << 1, 0, 0, 0, 0, -1).finished()).norm() < 1e-13);
  }
}

}  // namespace selvedge::test_membrane
