#include <cmath>

#include "pipeline/validate/known_answers.hpp"
#include "pipeline/validate/validate_strip.hpp"

// Strips of a plate that bend under their own weight.
namespace selvedge {
namespace {

constexpr double length = 0.1, density = 0.2, g = 9.81;  // of every strip here: [m], [kg/m2], [m/s2]

const ValidationParameter thickness_parameter{
    "thickness", "0.01", "0.01", "of the plate over the length; sets how little it stretches", table::positive};

ValidationParameter gamma_parameter(const std::string& otherwise, const std::string& brief) {
  return {"gamma", otherwise, brief, "rho g L^3 over the bending stiffness", table::positive};
}

Material plate(const ValidationValues& values, double gamma, double nu) {
  return plate_material(density, density * g * length * length * length / gamma, values.number("thickness") * length,
                        nu);
}

// A strip of the run's width and mesh, clamped where it begins.
Strip clamped(const ValidationValues& values, const Material& material, const Vec3& along, const Vec3& across) {
  return make_strip_scene(strip_shape(values, length, values.number("width") * length), material, along, across,
                          "clamp");
}

// How far the tip is aside, over the length, where a strip rests that started aside, at its tip by `push`.
double aside_at_rest(const Strip& strip, int along, double push) {
  Points start = strip.start;
  for (int v = 0; v < start.rows(); ++v)
    if (start(v, along) > 0) start(v, 2) += push * start(v, along) * start(v, along) / length;
  return std::abs(mean_of(settled(strip.scene, start, Vec3(0, -g, 0)), strip.tip).z()) / length;
}

std::vector<Measured> droop(const ValidationValues& values, BendingModel model) {
  const double gamma = values.number("gamma");
  Material material = plate(values, gamma, 0);
  material.bending_model = model;
  // The papers' weight is a quarter of the one that its inventors gave the hinge.
  if (model == BendingModel::hinge) material.bending *= 4;
  const Strip strip = clamped(values, material, Vec3::UnitX(), -Vec3::UnitZ());
  const Points x = settled(strip.scene, strip.start, Vec3(0, -g, 0));
  const Vec3 tip = mean_of(x, strip.tip);
  const Cantilever exact = elastica(gamma);
  // 3 % from 30 elements on, 1 % from 60 on; coarser strips are shown.
  const int along = values.integer("resolution");
  return {{"H/W", -tip.y() / tip.x(), exact.H / exact.W, Judged::relative, along < 60 ? 0.03 : 0.01,
           model == BendingModel::curvature && along >= 30}};
}

std::vector<Measured> cantilever(const ValidationValues& values) { return droop(values, BendingModel::curvature); }
std::vector<Measured> hinge(const ValidationValues& values) { return droop(values, BendingModel::hinge); }

// Pushed aside at the start; it rests upright or it does not.
std::vector<Measured> greenhill(const ValidationValues& values) {
  const double gamma = values.number("gamma");
  const double aside = aside_at_rest(clamped(values, plate(values, gamma, 0), Vec3::UnitY(), Vec3::UnitX()), 1, 0.05);
  const bool stands = gamma < greenhill_gamma;
  return {{stands ? "tip aside (stands)" : "tip aside (falls)", aside, 0, stands ? Judged::at_most : Judged::at_least,
           stands ? 0.01 : 0.1}};
}

// Gravity in the strip's plane; it stays there or it tips over.
std::vector<Measured> lateral(const ValidationValues& values) {
  const double nu = values.number("nu"), gamma = values.number("load") * lateral_buckling_gamma(nu);
  const double aside = aside_at_rest(clamped(values, plate(values, gamma, nu), Vec3::UnitX(), Vec3::UnitY()), 0, 0.02);
  const bool stays = values.number("load") < 1;
  return {{stays ? "tip aside (stays)" : "tip aside (tips over)", aside, 0, stays ? Judged::at_most : Judged::at_least,
           stays ? 0.005 : 0.05}};
}

const char* const all_meshes = "one_diagonal,alternating,unstructured";

}  // namespace

std::vector<ValidationCase> bending_cases() {
  const auto strip = [](std::vector<ValidationParameter> own, const ValidationParameter& fineness,
                        const std::string& meshes, const std::string& angles) {
    std::vector<ValidationParameter> all = strip_parameters(std::move(own), fineness, meshes, angles);
    all.push_back(thickness_parameter);
    return all;
  };
  const ValidationParameter nu{"nu", "0,0.3,0.5", "0.3", "Poisson's ratio", {.low = 0, .high = 0.9}};
  const ValidationParameter load{"load", "0.85,1.15", "0.85,1.15", "over the critical one", table::positive};
  return {
      {"cantilever", "a level strip, clamped at one end, bends under its own weight",
       strip({gamma_parameter("0.1,1,10,100", "10"), width_parameter()}, resolution_parameter("30,60", "30"),
             all_meshes, "0,45,135"),
       cantilever},
      {"hinge", "the same by dihedral angles, for comparison",
       strip({gamma_parameter("1,10", "10"), width_parameter()}, resolution_parameter("30", "30"), all_meshes,
             "0,45,135"),
       hinge},
      {"greenhill", "an upright strip, clamped at its foot, stands or falls",
       strip({gamma_parameter("7,8.7", "7,8.7"), width_parameter()}, resolution_parameter("30", "30"), all_meshes,
             "0,45"),
       greenhill},
      {"lateral", "a strip on its edge, clamped at one end, stays upright or tips over",
       strip({load, nu, width_parameter("0.1")}, resolution_parameter("60", "40"), "alternating,unstructured", "0,45"),
       lateral}};
}

}  // namespace selvedge
