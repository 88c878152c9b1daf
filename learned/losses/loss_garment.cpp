#include "learned/losses/loss_garment.hpp"

#include <cmath>

#include "collision/geometry/error.hpp"
#include "physics/energies/membrane.hpp"

namespace selvedge {
namespace {

constexpr const char* garment_place = "a garment's losses";

bool is_usable(const VertexMaterial& m) {
  const auto good = [](double value) { return std::isfinite(value) && value >= 0; };
  return good(m.density) && good(m.lame_mu) && good(m.lame_lambda) && good(m.bending);
}

// A scene of one cloth whose hinges have the coefficient 1.
Scene cloth_alone(const Surface& surface, const Points& rest, HingeLength length) {
  Scene scene;
  scene.surface = surface;
  scene.rest = rest;
  scene.rest_triangle.reserve(static_cast<std::size_t>(surface.triangles.rows()));
  for (int t = 0; t < static_cast<int>(surface.triangles.rows()); ++t)
    scene.rest_triangle.push_back(flatten(row(rest, surface.triangles(t, 0)), row(rest, surface.triangles(t, 1)),
                                          row(rest, surface.triangles(t, 2))));
  Cloth cloth;
  cloth.material.bending_model = BendingModel::hinge;
  cloth.material.hinge_length = length;
  cloth.material.bending = 1;
  cloth.vertex_count = surface.vertex_count;
  cloth.triangle_count = static_cast<int>(surface.triangles.rows());
  scene.cloths.push_back(cloth);
  return scene;
}

Material membrane_material(double mu, double lambda) {
  Material material;
  material.name = "losses";
  material.membrane = MembraneModel::stvk;
  material.lame_mu = mu;
  material.lame_lambda = lambda;
  return material;
}

void check_material(const VertexMaterial& material) {
  if (!is_usable(material))
    throw Error("a material has a number that is negative or not finite", garment_place, "give positive numbers");
}

// `material_of(vertex)` returns a VertexMaterial.
template <class MaterialOf>
void set_masses_and_hinges(LossGarment& garment, const MaterialOf& material_of) {
  garment.mass.assign(static_cast<std::size_t>(garment.surface.vertex_count), 0);
  for (const MembraneElement& e : garment.membranes) {
    double density = 0;
    for (const int v : e.nodes) density += material_of(v).density / 3;
    for (const int v : e.nodes) garment.mass[static_cast<std::size_t>(v)] += density * e.area / 3;
  }
  for (std::size_t h = 0; h < garment.hinges.size(); ++h) {
    Hinge& hinge = garment.hinges[h];
    hinge.weight =
        0.5 * (material_of(hinge.nodes[0]).bending + material_of(hinge.nodes[1]).bending) * garment.hinge_shape[h];
  }
}

}  // namespace

LossGarment make_loss_garment(const Surface& surface, const Points& rest, const std::vector<char>& pinned,
                              const VertexMaterial& material, HingeLength length) {
  if (rest.rows() != surface.vertex_count || !rest.allFinite())
    throw Error("the rest shape needs a finite position for each vertex", garment_place,
                "give the rest shape of this surface");
  if (!pinned.empty() && pinned.size() != static_cast<std::size_t>(surface.vertex_count))
    throw Error("the pins need one flag for each vertex", garment_place, "give flags of this surface, or none");
  const Scene scene = cloth_alone(surface, rest, length);
  LossGarment garment;
  garment.surface = surface;
  garment.closed = close_surface(surface);
  garment.pinned = pinned.empty() ? std::vector<char>(static_cast<std::size_t>(surface.vertex_count), 0) : pinned;
  garment.membranes = membrane_elements(scene);
  garment.hinges = hinges(scene);
  for (const Hinge& hinge : garment.hinges) garment.hinge_shape.push_back(hinge.weight);
  set_material(garment, material);
  return garment;
}

void set_material(LossGarment& garment, const VertexMaterial& material) {
  check_material(material);
  garment.materials = {membrane_material(material.lame_mu, material.lame_lambda)};
  for (MembraneElement& e : garment.membranes) e.material = 0;
  set_masses_and_hinges(garment, [&](int) -> const VertexMaterial& { return material; });
}

void set_materials(LossGarment& garment, std::span<const VertexMaterial> materials) {
  if (materials.size() != static_cast<std::size_t>(garment.surface.vertex_count))
    throw Error("each vertex needs a material", garment_place, "give as many materials as the surface has vertices");
  for (const VertexMaterial& material : materials) check_material(material);
  const auto material_of = [&](int v) -> const VertexMaterial& { return materials[static_cast<std::size_t>(v)]; };
  garment.materials.clear();
  for (MembraneElement& e : garment.membranes) {
    double mu = 0, lambda = 0;
    for (const int v : e.nodes) {
      mu += material_of(v).lame_mu / 3;
      lambda += material_of(v).lame_lambda / 3;
    }
    e.material = static_cast<int>(garment.materials.size());
    garment.materials.push_back(membrane_material(mu, lambda));
  }
  set_masses_and_hinges(garment, material_of);
}

double inverse_mass_norm(const LossGarment& garment, const Points& gradient) {
  double sum = 0;
  for (int v = 0; v < garment.surface.vertex_count; ++v)
    if (const double mass = garment.mass[static_cast<std::size_t>(v)]; mass > 0 && !garment.pinned[v])
      sum += gradient.row(v).squaredNorm() / mass;
  return std::sqrt(sum);
}

}  // namespace selvedge
