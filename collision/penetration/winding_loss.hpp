#pragma once

#include "collision/contour/segments.hpp"
#include "collision/penetration/closed_surface.hpp"

namespace selvedge {

struct WindingOptions {
  double weight = 1.8e5;  // [J/m^3], as 6 x 3e4 of the enclosed volume
  double far = 2;         // DipoleTree
};

// What a place where a garment winds w times costs: phi(|w - 1/2|), where phi(t) is 0 up to 1, 2 (t - 1) up to 1.5 and
// t - 1/2 beyond. Between 0 and 1, and half a turn beyond on both sides, it costs nothing: round a clean open garment w
// is not a whole number.
double winding_cost(double w);

struct WindingReport {
  double value = 0;      // weight x the integral of the cost, as far as the reached faces bound it [J]
  int faces = 0;         // with a weight that is not zero
  double rim_share = 0;  // net push over the sum of all pushes: 0 where the faces' part is all there is
};

// The volume that garments wind round too often, without closing them. Each garment is taken alone, its fans left out;
// for what garments do to each other, see find_penetration. Only faces count that are reached from one that crosses its
// own garment through faces whose weight phi(p + 1/2) - phi(p - 1/2) is not zero; p is the principal value of the
// winding number. If `gradient` is given it gets one matrix by closed positions: weight x normal x integral of the hat
// functions, over faces that are cut at the crossings. What moving a rim does to w far away is left out. The value of
// an open part is that of its faces from their mean, and so good to the share of the rim.
WindingReport winding_loss(const ClosedSurface&, const Points& closed_x, const Segments&, const WindingOptions& = {},
                           Points* gradient = nullptr);

}  // namespace selvedge
