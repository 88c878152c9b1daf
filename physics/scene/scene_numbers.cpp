#include "physics/scene/scene_numbers.hpp"

#include <array>
#include <cstdio>

#include "collision/geometry/error.hpp"
#include "physics/scene/joint_lists.hpp"
#include "physics/scene/stepper.hpp"

namespace selvedge {
namespace {

constexpr double roughest = 1e3, most_drag = 1e6;  // coefficients

std::string value_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

void check_rows(Eigen::Index rows, Eigen::Index wanted, const std::string& where) {
  if (rows != wanted)
    throw Error("has " + std::to_string(rows) + " rows, there are " + std::to_string(wanted) + " vertices", where,
                "give one a vertex");
}

void check_vertex(int vertex, const Scene& scene, const std::string& where) {
  if (vertex < 0 || vertex >= scene.surface.vertex_count)
    throw Error("names vertex " + std::to_string(vertex) + ", there are " + std::to_string(scene.surface.vertex_count),
                where, "number vertices from 0");
}

void check_rest(const Scene& scene) {
  check_rows(scene.rest.rows(), scene.surface.vertex_count, "rest positions");
  check_positions(scene.rest, "rest positions");
  if (std::ssize(scene.rest_triangle) != scene.surface.triangles.rows())
    throw Error("are " + std::to_string(scene.rest_triangle.size()) + ", there are " +
                    std::to_string(scene.surface.triangles.rows()) + " triangles",
                "rest shapes", "give one a triangle");
  for (std::size_t t = 0; t < scene.rest_triangle.size(); ++t)
    if (const RestTriangle& rest = scene.rest_triangle[t];
        !rest.allFinite() || !(rest.cwiseAbs().maxCoeff() <= 2 * limits::farthest))
      throw Error("is not finite or too large", "rest shape of triangle " + std::to_string(t), "repair it");
}

}  // namespace

template <>
std::span<const NumberField<Material>> number_fields() {
  using M = Material;
  static constexpr std::array<NumberField<M>, 9> fields{
      {{"density", &M::density, 0, limits::heaviest, false},
       {"lame_mu", &M::lame_mu, 0, limits::stiffest},
       {"lame_lambda", &M::lame_lambda, 0, limits::stiffest},
       {"warp", &M::warp, 0, limits::stiffest},
       {"weft", &M::weft, 0, limits::stiffest},
       {"shear", &M::shear, 0, limits::stiffest},
       {"bending", &M::bending, 0, limits::stiffest},
       {"stiffness_damping", &M::stiffness_damping, 0, limits::longest},
       {"mass_damping", &M::mass_damping, 0, limits::longest}}};
  return fields;
}

template <>
std::span<const NumberField<Elasticity>> number_fields() {
  using E = Elasticity;
  static constexpr std::array<NumberField<E>, 2> fields{
      {{"youngs_modulus", &E::youngs_modulus, 0, limits::stiffest}, {"poisson", &E::poisson, 0, 1, true, false}}};
  return fields;
}

template <>
std::span<const NumberField<ContactSettings>> number_fields() {
  using C = ContactSettings;
  static constexpr std::array<NumberField<C>, 3> fields{{{"thickness", &C::thickness, 0, limits::thickest, false},
                                                         {"friction", &C::friction, 0, roughest},
                                                         {"self_friction", &C::self_friction, 0, roughest}}};
  return fields;
}

template <>
std::span<const NumberField<Wind>> number_fields() {
  static constexpr std::array<NumberField<Wind>, 3> fields{{{"air_density", &Wind::air_density, 0, 1e12},
                                                            {"drag", &Wind::drag, 0, most_drag},
                                                            {"lift", &Wind::lift, 0, most_drag}}};
  return fields;
}

template <>
std::span<const NumberField<Spring>> number_fields() {
  static constexpr std::array<NumberField<Spring>, 2> fields{
      {{"rest_length", &Spring::rest_length, 0, limits::farthest},
       {"stiffness", &Spring::stiffness, 0, limits::stiffest, false}}};
  return fields;
}

void refuse_number(const std::string& field, double value, double low, double high, bool low_in, bool high_in,
                   const std::string& where) {
  throw Error(field + " is " + value_text(value), where,
              "allowed: " + std::string(low_in ? "from " : "above ") + value_text(low) + " to " +
                  (high_in ? "" : "below ") + value_text(high));
}

bool is_time_step(double dt) { return dt > 0 && dt <= limits::longest; }

void check_time_step(double dt, const std::string& where) {
  if (!is_time_step(dt)) refuse_number("the time step [s]", dt, 0, limits::longest, false, true, where);
}

void check_positions(const Points& x, const std::string& where, const std::string& unit) {
  for (Eigen::Index v = 0; v < x.rows(); ++v)
    if (!x.row(v).allFinite() || !(x.row(v).cwiseAbs().maxCoeff() <= limits::farthest))
      throw Error((x.row(v).allFinite() ? "is [" : "is not finite, [") + value_text(x(v, 0)) + ", " +
                      value_text(x(v, 1)) + ", " + value_text(x(v, 2)) + "] " + unit + " in row " + std::to_string(v),
                  where,
                  "leave NaN and infinity out; up to " + value_text(limits::farthest) + " " + unit + " is allowed");
}

void set_elasticity(const Elasticity& given, const std::string& where, Material& material) {
  check_numbers(given, where);
  const auto [e, nu] = given;
  material.lame_mu = e / (2 * (1 + nu));
  material.lame_lambda = e * nu / (1 - nu * nu);
}

void check_scene(const Scene& scene) {
  for (const Cloth& cloth : scene.cloths) check_numbers(cloth.material, "cloth `" + cloth.name + "`, material");
  check_numbers(scene.contact, "contact");
  check_numbers(scene.wind, "wind");
  check_rest(scene);
  for (std::size_t p = 0; p < scene.pins.size(); ++p) {
    const std::string where = "pin " + std::to_string(p);
    check_vertex(scene.pins[p], scene, where);
    if (p > 0 && scene.pins[p] <= scene.pins[p - 1])
      throw Error("is vertex " + std::to_string(scene.pins[p]) + " after " + std::to_string(scene.pins[p - 1]), where,
                  "sort the pins, each once");
  }
  for_each_joint_list([&](auto list, const JointKind& kind) {
    for (std::size_t j = 0; j < (scene.*list).size(); ++j) {
      const std::string where = std::string(kind.joint) + " " + std::to_string(j);
      for (const int node : nodes_of((scene.*list)[j])) check_vertex(node, scene, where);
      check_numbers((scene.*list)[j], where);
    }
  });
}

void check_state(const Scene& scene, const State& state) {
  const Eigen::Index count = scene.surface.vertex_count;
  check_rows(state.x.rows(), count, "x");
  check_rows(state.v.rows(), count, "v");
  check_positions(state.x, "x");
  check_positions(state.v, "v", "m/s");
  for (std::size_t k = 0; k < state.obstacles.size(); ++k)
    check_positions(state.obstacles[k], "obstacle `" + scene.obstacles[k].name + "`");
}

}  // namespace selvedge
