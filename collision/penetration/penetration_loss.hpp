#pragma once

#include "collision/penetration/penetration_regions.hpp"

namespace selvedge {

enum class PenetrationMeasure {
  volume,  // 6 |V| of each region [m^3]
  area     // of the clipped faces [m^2]: an ablation of the paper, without an exact gradient here
};

// How crossings follow the vertices. exact: they stay where two faces meet and slide in both; then they do not appear
// in the derivative of a closed volume. frozen_on_edge, frozen_on_face (the paper's): a crossing has fixed weights on
// its edge or on its face, and both sheets share this point.
enum class CrossingMotion { exact, frozen_on_edge, frozen_on_face };

struct PenetrationLossOptions {
  PenetrationMeasure measure = PenetrationMeasure::volume;
  CrossingMotion crossings = CrossingMotion::exact;
  double weight = 3e4;    // of 6 |V|, as in the paper's code: a pressure of 180 kPa [J/m^3]
  double saturation = 0;  // |V| of a region above which its pressure falls; not for areas; 0: never [m^3]
};

// The volume that counts for a region of volume |V|: |V| up to the saturation V0, V0 (1 + ln(|V| / V0)) beyond, so that
// the pressure falls by the factor V0 / |V|.
double saturated_volume(double volume, double saturation);

// Sum over the regions of weight x measure (Liao et al. 2024, section 3.2.4), with the absolute value of each region.
// If `gradient` is given it gets the derivative by the closed positions, n x 3; by_cloth_positions turns it into one by
// the cloth's. With `exact` the derivative by x_i is the sum over faces of sign x normal x integral of the hat function
// of x_i over the clipped face, and positions must be those at which the regions were found. With `frozen_...` and with
// `area` positions may have moved since: the value is that of the patches as they were cut then, each clipped face as a
// fan round the mean of its corners, and the gradient is its derivative.
double penetration_loss(const ClosedSurface&, const Points& closed_x, const Penetration&,
                        const PenetrationLossOptions& = {}, Points* gradient = nullptr);

}  // namespace selvedge
