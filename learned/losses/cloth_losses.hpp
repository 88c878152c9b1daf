#pragma once

#include <span>

#include "learned/graph/cloth_pairs.hpp"
#include "learned/losses/loss_garment.hpp"
#include "learned/losses/loss_options.hpp"

namespace selvedge {

// The losses of cloth alone, without their weights. Each returns its value [J] and adds the derivative [N] by the
// positions x, n x 3, where `gradient` is not null. The energies are those of physics/energies. Vertices without a
// triangle have no weight and no inertia.

// St. Venant-Kirchhoff: sum of A (mu |G|^2 + lambda / 2 tr(G)^2), G = (F^T F - I) / 2.
double stretching_loss(const LossGarment&, const Points& x, Points* gradient);

// The energy of hinges, with the edge length that the garment was made with.
double bending_loss(const LossGarment&, const Points& x, Points* gradient);

// The energy of springs: sum of k (l - L)^2 / 2.
double spring_loss(const LossGarment&, const Points& x, Points* gradient);

// Sum of m g y.
double gravity_loss(const LossGarment&, double strength, const Points& x, Points* gradient);

// Sum of m |x - (now + velocity)|^2 / (2 dt^2). The velocity is in m/frame.
double inertia_loss(const LossGarment&, const Points& now, const Points& velocity, double dt, const Points& x,
                    Points* gradient);

// Sum of (s max(eps - d, 0))^3 over pairs of a vertex and a face, without the weight [m^3]. d is the vertex' distance
// from the face's plane, positive on the side where it is now. Pairs that are farther apart now than `correspondence`
// and faces without area take no part. s is the pinned factor where the vertex or a corner is pinned, else 1. (Grigorev
// et al. 2024, section 4.2; parity README, 24.)
double repulsion_loss(const LossGarment&, const RepulsionLoss&, std::span<const ClothPair>, const Points& now,
                      const Points& x, Points* gradient);

// 1000 sqrt(sum of m |x - target|^2 / sum of m), the distance from a target, over the vertices that have a mass and are
// not pinned [mm, not J]; the derivative is in mm/m. At the target the derivative counts as 0.
double target_loss(const LossGarment&, const Points& target, const Points& x, Points* gradient);

}  // namespace selvedge
