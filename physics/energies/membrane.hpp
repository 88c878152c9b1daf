#pragma once

#include <span>
#include <vector>

#include "physics/energies/membrane_element.hpp"
#include "physics/scene/scene.hpp"

namespace selvedge {

// Triangles of zero rest area carry no membrane energy and are left out.
std::vector<MembraneElement> membrane_elements(const Scene&);

// F, 3 x 2: takes vectors of the rest plane to those of the triangle in space.
Mat32 deformation_gradient(const MembraneElement&, const Points& x);

// Energy of elements of cloths with these materials [J], by the material's model: St. Venant-Kirchhoff, stable
// neo-Hookean on principal stretches, or Baraff-Witkin in its I5/I6 form (Kim 2020). Derivatives: membrane_lanes.hpp.
double membrane_energy(std::span<const Material>, std::span<const MembraneElement>, const Points& x);

}  // namespace selvedge
