#pragma once

#include "collision/contour/segments.hpp"
#include "collision/penetration/closed_surface.hpp"

namespace selvedge {

struct WindingOptions {
  double weight = 1.8e5;  // [J/m^3], as 6 x 3e4 in PenetrationLossOptions
  double far = 2;         // DipoleTree::far
};

// The cost of a point with winding number w: phi(|w - 1/2|), where phi(t) is 0 up to 1, 2 (t - 1) up to 1.5 and t - 1/2
// beyond. It is zero for w from -1/2 to 3/2, since near a clean open garment w is not a whole number.
double winding_cost(double w);

struct WindingReport {
  double value = 0;      // weight x the integral of the cost over the volume bounded by the reached faces [J]
  int faces = 0;         // number of faces with a push that is not zero
  double rim_share = 0;  // net push divided by the sum of all pushes: 0 if the faces alone bound the volume
};

// The volume that garments wind round too often, without closing them. Each garment is taken alone, without its fans;
// for intersections between garments see find_penetration. Only faces count that are reached from one that crosses its
// own garment through faces whose weight phi(p + 1/2) - phi(p - 1/2) is not zero; p is the principal value of the
// winding number. If `gradient` is given it gets the derivative by the closed positions, n x 3: weight x normal x
// integral of the hat functions, over faces that are cut at the crossings. The effect of moving a rim on w far away is
// left out. The value of an open part is the volume of the cones from the mean of its faces; its relative error is
// about rim_share.
WindingReport winding_loss(const ClosedSurface&, const Points& closed_x, const Segments&, const WindingOptions& = {},
                           Points* gradient = nullptr);

}  // namespace selvedge
