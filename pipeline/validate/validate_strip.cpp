#include "pipeline/validate/validate_strip.hpp"

#include <algorithm>
#include <numbers>
#include <numeric>

#include <fmt/format.h>

#include "collision/geometry/error.hpp"
#include "physics/scene/make_scene.hpp"

namespace selvedge {
namespace {

std::string first_of(const std::string& list) { return list.substr(0, list.find(',')); }

const std::vector<int>& group(const Mesh& mesh, const std::string& name) {
  return std::find_if(mesh.groups.begin(), mesh.groups.end(), [&name](const auto& g) { return g.first == name; })
      ->second;
}

Points settled(const Scene& scene, const Points& start, const StaticLoad& load) {
  const Equilibrium found = settle(scene, start, load);
  if (!found.converged)
    throw Error(fmt::format("no equilibrium within {} steps: the last one still moved by {:.2g} of the extent",
                            found.steps, found.moved),
                "validate", "report it; another resolution or thickness may do");
  return found.x;
}

}  // namespace

ValidationParameter resolution_parameter(const std::string& otherwise, const std::string& brief,
                                         const std::string& noun) {
  return {"resolution", otherwise, brief, "elements along the " + noun, {.low = 4, .high = 400}};
}

ValidationParameter width_parameter(const std::string& value) {
  return {"width", value, value, "of the strip over its length", table::positive};
}

ValidationParameter mesh_parameter(const std::string& meshes) {
  return {
      "mesh", meshes, first_of(meshes), "how the cloth is cut", {}, {"one_diagonal", "alternating", "unstructured"}};
}

std::vector<ValidationParameter> strip_parameters(std::vector<ValidationParameter> own,
                                                  const ValidationParameter& resolution, const std::string& meshes,
                                                  const std::string& angles) {
  const ValidationParameter angle{"angle", angles, first_of(angles), "of the strip to the mesh [degrees]"};
  own.insert(own.end(), {mesh_parameter(meshes), angle, resolution});
  return own;
}

Triangulation read_triangulation(const std::string& word) {
  return word == "one_diagonal"  ? Triangulation::one_diagonal
         : word == "alternating" ? Triangulation::alternating
                                 : Triangulation::unstructured;
}

Material cloth_material(double density, double stretch, double nu, double bending) {
  Material material;
  material.density = density;
  material.bending = bending;
  material.lame_mu = stretch / (2 * (1 + nu));
  material.lame_lambda = stretch * nu / (1 - nu * nu);
  return material;
}

Material plate_material(double density, double bending, double thickness, double nu) {
  return cloth_material(density, 12 * (1 - nu * nu) * bending / (thickness * thickness), nu, bending);
}

StripShape strip_shape(const ValidationValues& values, double length, double width) {
  StripShape shape;
  shape.length = length;
  shape.width = width;
  shape.along = values.integer("resolution");
  shape.angle = values.number("angle") * std::numbers::pi / 180;
  shape.sheet.triangulation = read_triangulation(values.word("mesh"));
  return shape;
}

Scene flat_cloth(const std::string& name, const Mesh& mesh, const Points& rest, const Material& material) {
  std::vector<RestTriangle> metric(static_cast<std::size_t>(mesh.triangles.rows()));
  for (std::size_t t = 0; t < metric.size(); ++t)
    for (int k = 0; k < 3; ++k)
      metric[t].col(k) = mesh.uv.row(mesh.triangles(static_cast<Eigen::Index>(t), k)).transpose();
  Scene scene;
  add_cloth(scene, rest, mesh.triangles, material, name, metric);
  scene.contact.self = false;
  return scene;
}

Strip make_strip_scene(StripShape shape, const Material& material, const Vec3& along, const Vec3& across,
                       const std::string& pinned) {
  shape.clamp = pinned == "clamp";
  const Mesh mesh = make_strip(shape);
  Strip strip;
  Eigen::Matrix<double, 2, 3> frame;
  frame << along.transpose(), across.transpose();
  strip.start = mesh.uv * frame;
  strip.scene = flat_cloth("strip", mesh, strip.start, material);
  if (!pinned.empty()) strip.scene.pins = group(mesh, pinned);
  strip.root = group(mesh, "root");
  strip.tip = group(mesh, "tip");
  strip.grip = group(mesh, "grip");
  return strip;
}

Vec3 mean_of(const Points& x, const std::vector<int>& vertices) {
  Vec3 sum = Vec3::Zero();
  for (const int v : vertices) sum += row(x, v);
  return sum / static_cast<double>(vertices.size());
}

Points settled(const Scene& scene, const Points& start, const Vec3& gravity) {
  return settled(scene, start, StaticLoad{gravity, nullptr, weight_norm(scene, gravity)});
}

Points settled(const Scene& scene, const Points& start, const AddedTerm& added, double size) {
  return settled(scene, start, StaticLoad{Vec3::Zero(), &added, size});
}

void advance(Stepper& stepper, const Drive& drive, double dt, State& state) {
  State next;
  if (stepper.step(state, drive, dt, next).status != StepStatus::accepted)
    throw Error(fmt::format("the step to {:.3f} s was rejected", state.time + dt), "validate", "report it");
  std::swap(state, next);
}

VertexForces line_forces(const Points& x, const std::vector<int>& vertices, double force) {
  const std::size_t count = vertices.size();
  const Vec3 origin = row(x, vertices[0]);
  Vec3 far = origin;
  for (const int v : vertices)
    if ((row(x, v) - origin).norm() > (far - origin).norm()) far = row(x, v);
  const Vec3 axis = (far - origin).normalized();
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), 0);
  const auto place = [&](std::size_t i) { return (row(x, vertices[i]) - origin).dot(axis); };
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return place(a) < place(b); });
  const double length = place(order.back()) - place(order.front());
  std::vector<double> shares(count, 0.0);
  for (std::size_t k = 0; k + 1 < count; ++k) {
    const double half = 0.5 * (place(order[k + 1]) - place(order[k])) / length;
    shares[order[k]] += half;
    shares[order[k + 1]] += half;
  }
  VertexForces forces;
  for (std::size_t k = 0; k < count; ++k) forces.emplace_back(vertices[k], force * shares[k]);
  return forces;
}

AddedTerm dead_load(const VertexForces& forces, int axis) {
  AddedTerm load;
  load.value = [forces, axis](const Points& x) {
    double work = 0;
    for (const auto& [v, force] : forces) work += force * x(v, axis);
    return -work;
  };
  load.add_derivatives = [forces, axis](const Points&, Points& gradient, std::vector<ContactBlock>&) {
    for (const auto& [v, force] : forces) gradient(v, axis) -= force;
  };
  return load;
}

}  // namespace selvedge
