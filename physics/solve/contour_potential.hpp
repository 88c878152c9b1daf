#pragma once

#include <vector>

#include "collision/contour/contour_energy.hpp"
#include "collision/untangle/world_sheets.hpp"
#include "physics/linear/linear_system.hpp"

namespace selvedge {

// weight * contour_energy of the cloth with obstacles that stand still and, where world.self, with itself [J]: weight
// times the squared lengths of all segments, so that weight [N/m] is a stiffness. Segments are found anew for every x.
class ContourPotential {
 public:
  ContourPotential(const ContactWorld&, const Points& nodes, double weight, ContourGradient);  // keeps a reference

  double value(const Points& x);  // x: the cloth's; infinite where x is not finite
  const Segments& segments(const Points& x);
  std::span<const SheetView> sheets() const { return sheets_.views; }  // the cloth where it was asked about last

  // Adds the gradient of the chosen kind, and for each crossing one block a sheet that moves. They bound the
  // Gauss-Newton Hessian, but for edges nearly parallel to their face, where they are capped. The bound parts the two
  // ends of a segment, and edge and face, by (a + b)^2 <= 2 (a^2 + b^2), since a block has four vertices.
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
