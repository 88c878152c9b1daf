#pragma once

#include <vector>

#include "collision/contour/contour_energy.hpp"
#include "collision/untangle/world_sheets.hpp"
#include "physics/linear/linear_system.hpp"

namespace selvedge {

// weight * contour_energy of the cloth with obstacles that stand still and, if world.self, with itself [J]. That is
// weight [N/m] times the sum of squared lengths of all segments. Segments are found anew for every x.
class ContourPotential {
 public:
  ContourPotential(const ContactWorld&, const Points& nodes, double weight, ContourGradient);  // keeps a reference

  double value(const Points& x);  // x: the cloth's; infinite where x is not finite
  const Segments& segments(const Points& x);
  std::span<const SheetView> sheets() const { return sheets_.views; }  // with the cloth at the x asked for last

  // Adds the gradient of the chosen kind, and for each crossing one block per moving sheet. The blocks bound the
  // Gauss-Newton Hessian from above, except for edges nearly parallel to their face, where they are capped. Since a
  // block has four vertices, the bound separates the two ends of a segment, and edge and face, by (a + b)^2 <= 2 (a^2 +
  // b^2).
  void add_derivatives(const Points& x, Points& gradient, std::vector<ContactBlock>& blocks);

 private:
  void add_blocks(const Crossing&, int uses, std::vector<ContactBlock>& blocks) const;

  const ContactWorld& world_;
  WorldSheets sheets_;
  double weight_;
  ContourGradient kind_;
  Segments found_;  // at sheets_.positions[0]
  bool known_ = false;
};

}  // namespace selvedge
