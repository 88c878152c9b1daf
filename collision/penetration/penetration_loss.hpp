#pragma once

#include "collision/penetration/penetration_regions.hpp"

namespace selvedge {

enum class PenetrationMeasure {
  volume,  // 6 |V| of each region [m^3]
  area     // of the clipped faces [m^2]: an ablation of the paper, which has no exact gradient here
};

// How crossings follow the vertices. exact: they stay where two faces meet, so that they slide in both, and the
// derivative of a closed volume needs nothing of them. The others are the paper's: a crossing has fixed weights, of its
// edge or of its face, and both sheets have it in common.
enum class CrossingMotion { exact, frozen_on_edge, frozen_on_face };

struct PenetrationLossOptions {
  PenetrationMeasure measure = PenetrationMeasure::volume;
  CrossingMotion crossings = CrossingMotion::exact;
  double weight = 3e4;    // of 6 |V|, as released: a pressure of 180 kPa [J/m^3]
  double saturation = 0;  // |V| of a region from which on its pressure falls, not of areas; 0: nowhere [m^3]
};

// What a region of |V| is counted as: |V| up to the saturation V0, V0 (1 + ln(|V| / V0)) beyond, so that its pressure
// is V0 / |V| of what it was.
double saturated_volume(double volume, double saturation);

// Sum over the regions of weight x measure (Liao et al. 2024, section 3.2.4; the absolute value is each region's). If
// `gradient` is given it gets the derivative by the closed positions, n x 3; by_cloth_positions brings it to the cloth.
// With `exact` the derivative by x_i is the sum over faces of sign x normal x integral of the hat function of x_i over
// the clipped face. With `frozen_` and with `area` positions may have moved since the regions were found: the value is
// that of the patches as they were cut then, their faces fans round the mean of their corners, and the gradient is its
// derivative. With `exact` they must be those that the regions were found at.
double penetration_loss(const ClosedSurface&, const Points& closed_x, const Penetration&,
                        const PenetrationLossOptions& = {}, Points* gradient = nullptr);

}  // namespace selvedge
