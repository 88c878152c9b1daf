#include "learned/steppers/shown_force.hpp"

namespace selvedge {

Points shown_force(const LossInputs& inputs, int pass, double contour_weight, LossSearch& search) {
  ForceOptions force;
  force.inertia = pass > 0;
  force.contour_weight = inputs.contours ? contour_weight : 0;
  return force_input(inputs, LossOptions{}, force, search);
}

}  // namespace selvedge
