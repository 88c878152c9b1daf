#pragma once

#include "learned/graph/feature_tables.hpp"
#include "learned/graph/seen_positions.hpp"

namespace selvedge {

struct NextCloth {
  Points x, velocity;  // [m], [m/frame]
};

// From the network's output (V x 3, normalised) to the next frame, per frame and without dt (parity README, 11): a =
// output * deviation + mean, velocity + a, x + velocity + a, from where the options see x (seen_positions.hpp). Pinned
// vertices go to their targets; their velocity is target - x: zero where pinned vertices are moved beforehand (parity
// README, 1). Where the state has a guess, a is added to guess - x in place of the velocity: each pass of a frame
// starts from the result of the one before.
NextCloth integrate(const RestGraph&, const GraphState&, const FeatureOptions&, const Statistics& output,
                    const FeatureRows& decoded);

// The accelerations that the output's statistics are gathered of: target - 2 x + previous (V x 3) [m/frame^2].
FeatureRows target_accelerations(const RestGraph&, const GraphState&, const FeatureOptions&);

// Pushes vertices out of the body to `margin` [m] in front of the plane of the face with the nearest centroid (HOOD's
// first frame, parity README, 18). The lowest of several such faces counts. Returns how many it moved.
int push_out(const Surface& body, const Points& body_x, double margin, Points& x);
constexpr double push_out_margin = 2e-3;  // HOOD's

}  // namespace selvedge
