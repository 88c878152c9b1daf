#include <cmath>
#include <numbers>

#include "pipeline/validate/known_answers.hpp"
#include "pipeline/validate/validate_strip.hpp"

// Strips of a plate that bend under their own weight.
namespace selvedge {
namespace {

constexpr double length = 0.1, density = 0.2, g = 9.81;  // of every strip here: [m], [kg/m2], [m/s2]

const ValidationParameter thickness_parameter{"thickness",
                                              "0.01",
                                              "0.01",
                                              "of the plate over the length; sets how little it stretches",
                                              {.low = 0, .low_in = false},
                                              {}};

ValidationParameter gamma_parameter(const std::string& otherwise, const std::string& brief) {
  return {"gamma", otherwise, brief, "rho g L^3 over the bending stiffness", {.low = 0, .low_in = false}, {}};
}

Material plate(const ValidationValues& values, double gamma, double nu) {
  return plate_material(density, density * g * length * length * length / gamma, values.number("thickness") * length,
                        nu);
}

std::vector<Measured> droop(const ValidationValues& values, BendingModel model) {
  const double gamma = values.number("gamma");
  Material material = plate(values, gamma, 0);
  material.bending_model = model;
  // The papers' weight is a quarter of the one that its inventors gave the hinge.
  if (model == BendingModel::hinge) material.bending *= 4;
  StripShape shape = strip_shape(values, length, values.number("width") * length);
  shape.clamp = true;
  const Strip strip = make_strip_scene(shape, material, Vec3::UnitX(), -Vec3::UnitZ(), "clamp");
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
  StripShape shape = strip_shape(values, length, values.number("width") * length);
  shape.clamp = true;
  const Strip strip = make_strip_scene(shape, plate(values, gamma, 0), Vec3::UnitY(), Vec3::UnitX(), "clamp");
  Points start = strip.start;
  for (int v = 0; v < start.rows(); ++v)
    if (start(v, 1) > 0) start(v, 2) += 0.05 * start(v, 1) * start(v, 1) / length;
  const Points x = settled(strip.scene, start, Vec3(0, -g, 0));
  const double aside = std::abs(mean_of(x, strip.tip).z()) / length;
  const bool stands = gamma < greenhill_gamma;
  return {{stands ? "tip aside (stands)" : "tip aside (falls)", aside, 0, stands ? Judged::at_most : Judged::at_least,
           stands ? 0.01 : 0.1}};
}

// Gravity in the strip's plane; it stays there or it tips over.
std::vector<Measured> lateral(const ValidationValues& values) {
  const double nu = values.number("nu"), gamma = values.number("load") * lateral_buckling_gamma(nu);
  StripShape shape = strip_shape(values, length, values.number("width") * length);
  shape.clamp = true;
  const Strip strip = make_strip_scene(shape, plate(values, gamma, nu), Vec3::UnitX(), Vec3::UnitY(), "clamp");
  Points start = strip.start;
  for (int v = 0; v < start.rows(); ++v)
    if (start(v, 0) > 0) start(v, 2) += 0.02 * start(v, 0) * start(v, 0) / length;
  const Points x = settled(strip.scene, start, Vec3(0, -g, 0));
  const double aside = std::abs(mean_of(x, strip.tip).z()) / length;
  const bool stays = values.number("load") < 1;
  return {{stays ? "tip aside (stays)" : "tip aside (tips over)", aside, 0, stays ? Judged::at_most : Judged::at_least,
           stays ? 0.005 : 0.05}};
}

ValidationParameter width_parameter(const std::string& value, const std::string& about) {
  return {"width", value, value, about, {.low = 0, .low_in = false}, {}};
}

ValidationParameter resolution(const std::string& otherwise, const std::string& brief) {
  return {"resolution", otherwise, brief, "elements along the strip", {.low = 4, .high = 400}, {}};
}

const char* const all_meshes = "one_diagonal,alternating,unstructured";

}  // namespace

std::vector<ValidationCase> bending_cases() {
  const std::string eighths = "0.2666667";  // 8 elements of 30
  const auto strip = [](const ValidationParameter& fineness, const std::string& angles, const std::string& meshes,
                        std::vector<ValidationParameter> first) {
    const std::vector<ValidationParameter> common = strip_parameters(fineness, meshes, angles);
    first.insert(first.end(), common.begin(), common.end());
    first.push_back(thickness_parameter);
    return first;
  };
  const ValidationParameter nu{"nu", "0,0.3,0.5", "0.3", "Poisson's ratio", {.low = 0, .high = 0.9}, {}};
  const ValidationParameter load{"load", "0.85,1.15", "0.85,1.15", "over the critical one", {.low = 0, .low_in = false},
                                 {}};
  return {{"cantilever", "a level strip, clamped at one end, bends under its own weight",
           strip(resolution("30,60", "30"), "0,45,135", all_meshes,
                 {gamma_parameter("0.1,1,10,100", "10"), width_parameter(eighths, "of the strip over its length")}),
           cantilever},
          {"hinge", "the same by dihedral angles, for comparison",
           strip(resolution("30", "30"), "0,45,135", all_meshes,
                 {gamma_parameter("1,10", "10"), width_parameter(eighths, "of the strip over its length")}),
           hinge},
          {"greenhill", "an upright strip, clamped at its foot, stands or falls",
           strip(resolution("30", "30"), "0,45", all_meshes,
                 {gamma_parameter("7,8.7", "7,8.7"), width_parameter(eighths, "of the strip over its length")}),
           greenhill},
          {"lateral", "a strip on its edge, clamped at one end, stays upright or tips over",
           strip(resolution("60", "40"), "0,45", "alternating,unstructured",
                 {load, nu, width_parameter("0.1", "of the strip over its length")}),
           lateral}};
}

}  // namespace selvedge
