#pragma once

#include "learned/losses/loss_options.hpp"

namespace selvedge {

// Whether a number is what it ends with before the run does, for at least a tenth of it.
bool reaches_its_end(const LossRamp&);

enum class Decay { cosine, halving, none };

// What the learning rate is multiplied with: half a cosine from 1 to 0 over the run, or 1/2 every so many steps plus a
// floor (HOOD, released configuration), or 1. `progress`: part of the run, 0 to 1.
double learning_factor(Decay, double progress, long step, long halving_steps, double floor);

}  // namespace selvedge
