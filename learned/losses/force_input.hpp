#pragma once

#include "learned/losses/objective.hpp"

namespace selvedge {

// The forces that are an input of a network (docs/training.md).
struct ForceOptions {
  double contact_stiffness = 300;   // of a quadratic contact with the body [N/m]; 0: none
  double contact_thickness = 3e-3;  // [m]
  double contour_weight = 0;        // [N/m]; 0: contours are not looked for
  bool inertia = false;             // include inertia: for a second pass, whose guess is not free flight
};

// The displacement d = -dE/dx / D at inputs.predicted, the guess. E is the cloth's objective with the options' contact
// and contours. D is the Jacobi diagonal: m / dt^2 + sum of (2 mu + lambda) A |grad phi|^2 over the vertex' triangles +
// twice the stiffness of its springs, whose other end moves too. V x 3; zero at pinned vertices and where it is not
// finite.
Points force_input(const LossInputs&, const LossOptions&, const ForceOptions&, LossSearch&);

// The force that networks with force inputs see, in training and in roll-outs. It comes from the energies and a soft
// contact with the body at inputs.predicted, the guess. It includes inertia from the second pass on, because the first
// guess has none. `contour_weight` [N/m] weighs the part that shortens intersection contours; 0: none.
Points shown_force(const LossInputs&, int pass, double contour_weight, LossSearch&);

// The diagonal D [N/m]. `dt` is that of the inertia [s].
std::vector<double> jacobi_diagonal(const LossGarment&, double dt);

// Gives the garment, whose materials are set, the springs of its scene. None becomes stiffer than the diagonal of the
// cloth alone at either end. Stiffer springs would hide every other force and loss.
void set_springs(std::span<const Spring>, LossGarment&);

}  // namespace selvedge
