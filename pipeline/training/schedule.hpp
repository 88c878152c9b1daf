#pragma once

#include "learned/losses/loss_options.hpp"

namespace selvedge {

// Whether a number has its final value for at least the last tenth of the run.
bool reaches_its_end(const LossRamp&);

enum class Decay { cosine, halving, none };

// The factor of the learning rate: half a cosine from 1 to 0 over the run, or 1/2 every `halving_steps` steps plus a
// floor (HOOD, released configuration), or 1. `progress` is the fraction of the run, 0 to 1.
double learning_factor(Decay, double progress, long step, long halving_steps, double floor);

}  // namespace selvedge
