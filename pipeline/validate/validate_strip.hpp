#pragma once

#include "physics/scene/stepper.hpp"
#include "physics/solve/equilibrium.hpp"
#include "pipeline/config/config_tables.hpp"
#include "pipeline/shapes/generate_strip.hpp"
#include "pipeline/validate/validate_case.hpp"

namespace selvedge {

// Parameters: elements along the cloth, which the noun names; a strip's width over its length; how the cloth is cut.
ValidationParameter resolution_parameter(const std::string& otherwise, const std::string& brief,
                                         const std::string& noun = "strip");
ValidationParameter width_parameter(const std::string& value = "0.2666667");  // 8 elements of 30
ValidationParameter mesh_parameter(const std::string& meshes);

// Those of a case: its own, then mesh, angle and resolution, as every strip has them.
std::vector<ValidationParameter> strip_parameters(std::vector<ValidationParameter> own,
                                                  const ValidationParameter& resolution, const std::string& meshes,
                                                  const std::string& angles);
Triangulation read_triangulation(const std::string&);

// Cloth of stiffness E h [N/m].
Material cloth_material(double density, double stretch, double nu, double bending);

// A plate of stiffness B per width and of thickness h as cloth: E h = 12 (1 - nu^2) B / h^2.
Material plate_material(double density, double bending, double thickness, double nu);

// A single cloth that rests in the plane of its texture coordinates, without contact with itself; `rest`: in space.
Scene flat_cloth(const std::string& name, const Mesh&, const Points& rest, const Material&);

// A strip along x, its width along `across` and pinned where its group says.
struct Strip {
  Scene scene;
  Points start;  // as at rest
  std::vector<int> root, tip, grip;
};
// Of `length` and `width` [m], with the run's mesh, angle and resolution (elements along the length).
StripShape strip_shape(const ValidationValues&, double length, double width);
// `pinned` is a group, or empty. The strip has a row of elements for a clamp where that is pinned.
Strip make_strip_scene(StripShape, const Material&, const Vec3& along, const Vec3& across, const std::string& pinned);

Vec3 mean_of(const Points& x, const std::vector<int>& vertices);

// Equilibrium under gravity; throws Error where none is found.
Points settled(const Scene&, const Points& start, const Vec3& gravity);
// Under the added term alone; size [N] as in StaticLoad.
Points settled(const Scene&, const Points& start, const AddedTerm&, double size);

// Steps a state by dt; throws Error where the step is rejected.
void advance(Stepper&, const Drive&, double dt, State&);

// A force on the vertices of a straight line [N], shared among them by the lengths of the edges beside each; they need
// not be in order.
using VertexForces = std::vector<std::pair<int, double>>;
VertexForces line_forces(const Points& x, const std::vector<int>& vertices, double force);

// The potential of dead forces along an axis.
AddedTerm dead_load(const VertexForces&, int axis);

}  // namespace selvedge
