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

// Energy of one element [J] for the material's model: St. Venant-Kirchhoff, stable neo-Hookean on principal stretches,
// or Baraff-Witkin in its I5/I6 form (Kim 2020).
double membrane_energy(const Material&, MembraneElement, const Points& x);

// Energy of elements of cloths with these materials [J].
double membrane_energy(std::span<const Material>, std::span<const MembraneElement>, const Points& x);

// Gradient in the order x0 y0 z0 x1 y1 z1 x2 y2 z2 [N] and the Hessian projected to PSD in closed form [N/m];
// the unprojected Hessian with psd = false. Many elements are faster in lanes (membrane_lanes.hpp).
void membrane_derivatives(const Material&, MembraneElement, const Points& x, Vec9& gradient, Mat9* hessian,
                          bool psd = true);

}  // namespace selvedge
