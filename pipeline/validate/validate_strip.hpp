#pragma once

#include "physics/solve/equilibrium.hpp"
#include "pipeline/shapes/generate_strip.hpp"
#include "pipeline/validate/validate_case.hpp"

namespace selvedge {

// mesh, angle and resolution, as every strip has them.
std::vector<ValidationParameter> strip_parameters(const ValidationParameter& resolution, const std::string& meshes,
                                                  const std::string& angles);
Triangulation read_triangulation(const std::string&);

// A plate of stiffness B per width and of thickness h as cloth: E h = 12 (1 - nu^2) B / h^2.
Material plate_material(double density, double bending, double thickness, double nu);

// A single cloth that rests in the plane of its texture coordinates, without contact with itself; `rest`: in space.
Scene flat_cloth(const std::string& name, const Mesh&, const Points& rest, const Material&);

// A strip along x, its width along `across` and pinned where its group says.
struct Strip {
  Scene scene;
  Points start;  // as at rest
  std::vector<int> root, tip, grip, side;
};
// Of `length` and `width` [m], with the run's mesh, angle and resolution (elements along the length).
StripShape strip_shape(const ValidationValues&, double length, double width);
Strip make_strip_scene(const StripShape&, const Material&, const Vec3& along, const Vec3& across,
                       const std::string& pinned);

Vec3 mean_of(const Points& x, const std::vector<int>& vertices);

// Equilibrium under gravity; throws Error where none is found.
Points settled(const Scene&, const Points& start, const Vec3& gravity);
// Under the added term alone; size [N] as in StaticLoad.
Points settled(const Scene&, const Points& start, const AddedTerm&, double size);

// Shares of a total of one among the vertices of a straight line, by the lengths of the edges beside each; they need
// not be in order.
std::vector<double> line_shares(const Points& x, const std::vector<int>& vertices);

}  // namespace selvedge
