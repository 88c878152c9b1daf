#pragma once

#include <array>
#include <vector>

#include "learned/losses/loss_garment.hpp"
#include "learned/losses/loss_options.hpp"

namespace selvedge {

// The losses of cloth and body, without their weights. The caller gives each vertex' face of the body, or -1
// (learned/graph/nearest_faces.hpp); derivatives take it as fixed. Faces without area give nothing. Each function
// returns its value and adds the derivative by the cloth's positions x [m] where `gradient` is not null.

// The vertices of each sample, -1 after the last. A sample lies at their mean.
std::vector<std::array<int, 3>> cloth_samples(const LossGarment&, ClothSamples);
Points sample_points(const std::vector<std::array<int, 3>>& samples, const Points& x);

// The sum over the samples with a face of p^3 [m^3] or p^2 / 2 [m^2]. p = max(eps - d, 0), and d is the distance from
// the plane through the centroid of face[sample], where the body will be (parity README, 13).
double collision_loss(const LossGarment&, const CollisionLoss&, const std::vector<int>& face, const Surface& body,
                      const Points& body_next, const Points& x, Points* gradient);

// Sum of m mu g c |t| [J] as in HOOD's released code (parity README, 14). The cloth goes from `now` to x, while the
// body goes from `body_previous` to `body_now`, a frame late. A vertex slides by its motion less that of the centroid
// of face `before`, and t is the part of the slide across n. n is the mean, not of unit length, of this face's normal
// before the motion and the normal of face `after` after it. c = sqrt(|1 - cos^2| + 1e-4) of the angle between t and
// the slope axis. A vertex counts if the centroids are within the radius both times.
double friction_loss(const LossGarment&, const FrictionLoss&, double strength, const std::vector<int>& before,
                     const std::vector<int>& after, const Surface& body, const Points& body_previous,
                     const Points& body_now, const Points& now, const Points& x, Points* gradient);

}  // namespace selvedge
