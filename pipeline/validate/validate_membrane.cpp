#include <Eigen/LU>
#include <cmath>

#include "pipeline/validate/known_answers.hpp"
#include "pipeline/validate/validate_strip.hpp"

// Strips that hang or are pulled.
namespace selvedge {
namespace {

constexpr double density = 0.2, g = 9.81;  // [kg/m2], [m/s2]

// Laid on the arc of a circle between its ends, which are pinned.
std::vector<Measured> catenary(const ValidationValues& values) {
  const double ratio = values.number("ratio"), distance = 1, length = ratio * distance;
  const double bending = density * g * std::pow(length, 3) / values.number("gamma");
  Strip strip = make_strip_scene(strip_shape(values, length, values.number("width") * length),
                                 cloth_material(density, 1e4 * density * g * length, 0, bending), Vec3::UnitX(),
                                 -Vec3::UnitZ(), "root");
  strip.scene.pins.insert(strip.scene.pins.end(), strip.tip.begin(), strip.tip.end());
  std::sort(strip.scene.pins.begin(), strip.scene.pins.end());
  double low = 1e-6, high = 3.14;  // half the arc's angle: sin(a) / a = distance / length
  for (int i = 0; i < 100; ++i)
    (std::sin((low + high) / 2) / (low + high) * 2 > 1 / ratio ? low : high) = (low + high) / 2;
  const double radius = length / (2 * low);
  Points start = strip.start;
  for (int v = 0; v < start.rows(); ++v) {
    const double a = (strip.start(v, 0) - length / 2) / radius;
    start(v, 0) = radius * std::sin(a);
    start(v, 1) = radius * (std::cos(low) - std::cos(a));
  }
  const Points x = settled(strip.scene, start, Vec3(0, -g, 0));
  return {{"sag / distance", -x.col(1).minCoeff() / distance, catenary_sag(ratio), Judged::relative, 0.02}};
}

// u = rho g / k (L s - s^2 / 2): the top strain is the fit's slope at the top.
std::vector<Measured> hanging(const ValidationValues& values) {
  constexpr double length = 1;
  const double stretch = density * g * length / values.number("strain");
  const Strip strip = make_strip_scene(strip_shape(values, length, values.number("width") * length),
                                       cloth_material(density, stretch, values.number("nu"), 1e-5), -Vec3::UnitY(),
                                       Vec3::UnitX(), "root");
  const Points x = settled(strip.scene, strip.start, Vec3(0, -g, 0));
  // Least squares of u = fit[0] s + fit[1] s^2.
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Vec2 right = Vec2::Zero();
  for (Eigen::Index v = 0; v < x.rows(); ++v) {
    const double y = strip.start(v, 1);
    const Vec2 terms(-y, y * y);
    normal += terms * terms.transpose();
    right += (y - x(v, 1)) * terms;
  }
  const Vec2 fit = normal.inverse() * right;
  const double tip = mean_of(strip.start, strip.tip).y() - mean_of(x, strip.tip).y();
  return {{"tip elongation / L", tip / length, density * g * length / (2 * stretch), Judged::relative, 0.02},
          {"top strain", fit[0], density * g * length / stretch, Judged::relative, 0.02}};
}

// Dead forces on both ends of a strip that nothing holds.
std::vector<Measured> stretch(const ValidationValues& values) {
  constexpr double length = 1, modulus = 1000;
  const double l = values.number("stretch"), nu = values.number("nu"), width = values.number("width") * length;
  const Strip strip = make_strip_scene(strip_shape(values, length, width), cloth_material(density, modulus, nu, 1e-5),
                                       Vec3::UnitX(), -Vec3::UnitZ(), "");
  const double force = 0.5 * l * modulus * (l * l - 1) * width;
  VertexForces forces = line_forces(strip.start, strip.tip, force);
  for (const auto& one : line_forces(strip.start, strip.root, -force)) forces.push_back(one);
  const Points x = settled(strip.scene, strip.start, dead_load(forces, 0), force);
  const Eigen::RowVector3d extent = x.colwise().maxCoeff() - x.colwise().minCoeff();
  return {{"stretch", extent.x() / length, l, Judged::relative, 0.02},
          {"lateral stretch", extent.z() / width, std::sqrt(1 - nu * (l * l - 1)), Judged::relative, 0.02}};
}

}  // namespace

std::vector<ValidationCase> membrane_cases() {
  const Range poisson{.low = 0, .high = 0.9};
  const auto with = [](std::vector<ValidationParameter> own) {
    own.push_back(width_parameter());
    return strip_parameters(std::move(own), resolution_parameter("30", "30"), "alternating,unstructured", "0,45");
  };
  return {{"catenary", "a strip of little stiffness hangs between its pinned ends",
           with({{"ratio", "1.05,1.5,3", "1.5", "length over the distance of the ends", {.low = 1, .low_in = false}},
                 {"gamma", "1e6", "1e6", "rho g L^3 over the bending stiffness", table::positive}}),
           catenary},
          {"hanging", "a strip hangs by its upper end",
           with({{"strain", "0.001", "0.001", "at the top", table::positive},
                 {"nu", "0", "0", "Poisson's ratio", poisson}}),
           hanging},
          {"stretch", "St. Venant-Kirchhoff, pulled along",
           with({{"stretch", "1.05,1.3", "1.3", "wanted", {.low = 1, .high = 2, .low_in = false}},
                 {"nu", "0,0.3", "0.3", "Poisson's ratio", poisson}}),
           stretch}};
}

}  // namespace selvedge
