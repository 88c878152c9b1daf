#pragma once

#include <vector>

#include "learned/losses/loss_options.hpp"

namespace selvedge {

// Counts of the contours of a frame, and the volume that they enclose.
struct VolumeCounts {
  int contours = 0, enclosed = 0;
  double volume = 0;  // enclosed [m^3]
};

// The self-collision loss L_sc without its weight of 3e4: the sum over the regions of 6 |V| as saturated_volume counts
// it [m^3], or of their area [m^2]. By winding numbers it is 6 times the integral of their cost. Adds the derivative by
// the cloth's positions x where `gradient` is not null. `closed` is the closed cloth (close_surface), made once per
// garment. Positions that are not finite give 0.
double volume_loss(const ClosedSurface& closed, const VolumeLoss&, const Points& x, Points* gradient,
                   VolumeCounts* counts = nullptr);

// The energy of forces without contact, which takes the place of gravity's: -sum of m a.x [J]; `acceleration` is V x 3
// [m/s2]. Adds the derivative where `gradient` is not null.
double force_loss(const std::vector<double>& mass, const Points& acceleration, const Points& x, Points* gradient);

// The repulsion that the paper compares with (its appendix A): the sum of (distance - d)^power over pairs of cloth
// vertices that are closer than `distance` and share no edge. The power is 1 or 2 [m or m^2].
double vertex_repulsion_loss(const Surface&, double distance, int power, const Points& x, Points* gradient);

}  // namespace selvedge
