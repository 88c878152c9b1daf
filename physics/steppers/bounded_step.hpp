#pragma once

#include <string>

#include "collision/geometry/pair_budget.hpp"
#include "physics/scene/stepper.hpp"

namespace selvedge {

// The report of `take`, which takes a step; where one of its searches meets more pairs than it may look at
// (pair_budget.hpp), that of a rejected step.
template <class Take>
StepReport bounded_step(const std::string& by, Take&& take) {
  try {
    return take();
  } catch (const TooManyPairs&) {
    StepReport report;
    report.by = by;
    report.status = StepStatus::rejected;
    report.reason = Reason::too_many_pairs;
    return report;
  }
}

}  // namespace selvedge
