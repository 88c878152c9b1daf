#pragma once

#include "learned/graph/feature_tables.hpp"
#include "learned/graph/seen_positions.hpp"

namespace selvedge {

struct NextCloth {
  Points x, velocity;  // [m], [m/frame]
};

// The next frame from the network's output (V x 3, normalised), per frame and without dt (parity README, 11): a =
// output * deviation + mean, velocity + a, x + velocity + a. x is where the options see it (seen_positions.hpp). Pinned
// vertices go to their targets, with the velocity target - x; it is zero where they were moved beforehand (parity
// README, 1). Where the state has a guess, a is added to guess - x in place of the velocity, so that each pass of a
// frame starts from the last one's result.
//
// With OutputBase::carried a = frame * (output * deviation), x is the guess + a, and the velocity is x minus where the
// vertex is seen.
//
// Throws Error for another shape of the output.
NextCloth integrate(const RestGraph&, const GraphState&, const FeatureOptions&, const Statistics& output,
                    const FeatureRows& decoded);

// The derivative of a function by a, from its derivative by NextCloth::x (V x 3): in the frames of the vertices, and
// zero where vertices are pinned.
Points by_acceleration(const RestGraph&, const GraphState&, const FeatureOptions&, Points by_x);

// The accelerations from which the output's statistics are gathered: target - 2 x + previous (V x 3) [m/frame^2], with
// OutputBase::carried in the frames of the vertices.
FeatureRows target_accelerations(const RestGraph&, const GraphState&, const FeatureOptions&);

// Pushes vertices to at least `margin` [m] in front of the plane of the body's face with the nearest centroid, the
// lowest of several (HOOD's first frame, parity README, 18). Returns how many it moved.
int push_out(const Surface& body, const Points& body_x, double margin, Points& x);
constexpr double push_out_margin = 2e-3;  // HOOD's

}  // namespace selvedge
