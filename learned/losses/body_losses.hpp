#pragma once

#include <array>
#include <vector>

#include "learned/losses/loss_garment.hpp"
#include "learned/losses/loss_options.hpp"

namespace selvedge {

// The losses of cloth and body, without their weights. Which face of the body belongs to a vertex is given, -1: none
// (learned/graph/nearest_faces.hpp), and no part of the derivative; nor are faces without area. Each returns its value
// and adds the derivative by the cloth's positions x where `gradient` is not null.

// The samples of the options: the vertices of each, -1 behind them. They lie in the mean of these.
std::vector<std::array<int, 3>> cloth_samples(const LossGarment&, ClothSamples);
Points sample_points(const std::vector<std::array<int, 3>>& samples, const Points& x);

// Over the samples, of which each has a face: the sum of p^3 [m^3] or p^2 / 2 [m^2], p = max(eps - d, 0), d the
// distance of the sample from the plane through the face's centroid where the body will be (parity README, 13).
double collision_loss(const LossGarment&, const CollisionLoss&, const std::vector<int>& face, const Surface& body,
                      const Points& body_next, const Points& x, Points* gradient);

// Sum of m mu g c |t| [J] as HOOD's released code has it (parity README, 14). The cloth goes from `now` to x while the
// body goes from `body_previous` to `body_now`, a frame behind. t is the part across n of what x has slid, beside the
// motion of the centroid of the face `before`; n is the mean of that face's normal before the motion and of the normal
// of face `after` after it, not of unit length; c = sqrt(|1 - cos^2| + 1e-4), with the angle between t and the slope
// axis. Only vertices count whose centroids are within the radius at both ends.
double friction_loss(const LossGarment&, const FrictionLoss&, double strength, const std::vector<int>& before,
                     const std::vector<int>& after, const Surface& body, const Points& body_previous,
                     const Points& body_now, const Points& now, const Points& x, Points* gradient);

}  // namespace selvedge
