#include <algorithm>
#include <cmath>
#include <numbers>

#include "pipeline/validate/validate_strip.hpp"

// The drape test of textile laboratories: a disc of 30 cm held between two of 18 cm; the part of the free ring that the
// shadow of the draped cloth covers.
namespace selvedge {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double radius = 0.15, support = 0.09;           // [m]
constexpr double density = 0.2, g = 9.81, stretch = 1e3;  // [kg/m2], [m/s2], E h [N/m]

// Of all triangles seen from above, by counting squares.
double shadow_area(const Points& x, const Triangles& triangles) {
  constexpr int cells = 600;
  constexpr double side = 2.2 * radius / cells;
  std::vector<char> dark(static_cast<std::size_t>(cells) * cells, 0);
  const auto cell_of = [&](double at) { return std::clamp(static_cast<int>(at / side + cells / 2.0), 0, cells - 1); };
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    std::array<Vec2, 3> p;
    for (int k = 0; k < 3; ++k) p[k] = {x(triangles(t, k), 0), x(triangles(t, k), 2)};
    const double turn = cross(p[1] - p[0], p[2] - p[0]) < 0 ? -1 : 1;
    const auto [left, right] = std::minmax({p[0].x(), p[1].x(), p[2].x()});
    const auto [low, high] = std::minmax({p[0].y(), p[1].y(), p[2].y()});
    for (int j = cell_of(low); j <= cell_of(high); ++j)
      for (int i = cell_of(left); i <= cell_of(right); ++i) {
        const Vec2 at((i + 0.5 - cells / 2.0) * side, (j + 0.5 - cells / 2.0) * side);
        bool inside = true;
        for (int k = 0; k < 3; ++k) inside = inside && turn * cross(p[(k + 1) % 3] - p[k], at - p[k]) >= 0;
        if (inside) dark[static_cast<std::size_t>(j) * cells + i] = 1;
      }
  }
  return side * side * static_cast<double>(std::count(dark.begin(), dark.end(), 1));
}

std::vector<Measured> drape(const ValidationValues& values) {
  const int rings = values.integer("resolution");
  const double length = 0.01 * values.number("bending_length"), nu = values.number("nu");
  const Mesh mesh = make_disc(radius, rings, {read_triangulation(values.word("mesh")), 1});
  Scene scene =
      flat_cloth("disc", mesh, mesh.x, cloth_material(density, stretch, nu, density * g * std::pow(length, 3)));
  Points start = mesh.x;
  for (int v = 0; v < start.rows(); ++v) {
    const double r = std::hypot(start(v, 0), start(v, 2)), beyond = std::max(0.0, r - support);
    if (r <= support * (1 + 1e-9)) scene.pins.push_back(v);
    start(v, 1) = -beyond * (0.5 + 0.1 * std::sin(5 * std::atan2(start(v, 2), start(v, 0))));  // where folds may begin
  }
  const Points x = settled(scene, start, Vec3(0, -g, 0));
  const double held = pi * support * support, whole = pi * radius * radius;
  return {{"drape coefficient", (shadow_area(x, mesh.triangles) - held) / (whole - held), 0, Judged::rises, 0.01}};
}

}  // namespace

std::vector<ValidationCase> drape_cases() {
  return {{"drape",
           "a held disc drapes less the stiffer it is for its weight",
           {mesh_parameter("alternating"),
            {"resolution", "20", "10", "rings of vertices", {.low = 10, .high = 200}},
            {"nu", "0.3", "0.3", "Poisson's ratio", {.low = 0, .high = 0.9}},
            {"bending_length", "1,1.5,2,2.5,3,3.9", "1.5,2.5,3.9", "cube root of B / (rho g) [cm], ascending",
             table::positive}},
           drape}};
}

}  // namespace selvedge
