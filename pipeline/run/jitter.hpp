#pragma once

#include <cstdint>

#include "pipeline/scene/setup.hpp"

namespace selvedge {

// Moves every free vertex of a start of the scene by up to `amount` mean edge lengths of the rest shape along each
// axis, the same seed the same way on every machine. A start that is clean stays clean: a jitter that makes triangles
// intersect is halved until none do; the amount used is returned. Throws Error if the start itself is not clean.
double jitter_start(const Setup&, double amount, std::uint64_t seed, State& start);

}  // namespace selvedge
