#pragma once

#include "learned/losses/objective.hpp"
#include "pipeline/config/options.hpp"

namespace selvedge {

constexpr Range from_0_to_1{.low = 0, .high = 1};

const Options<LossRamp>& ramp_options();

template <class Struct>
Option<Struct> ramp(std::string name, LossRamp Struct::*member, std::string about) {
  return table::renamed(table::section(member, ramp_options(), std::move(about)), std::move(name));
}

// The table of the losses and their weights.
const Options<LossOptions>& objective_options();

}  // namespace selvedge
