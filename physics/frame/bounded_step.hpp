#pragma once

#include <optional>
#include <string>

#include "collision/geometry/pair_budget.hpp"
#include "collision/geometry/stop_scope.hpp"
#include "physics/scene/stepper.hpp"

namespace selvedge {

// Calls `take` and returns its report. If a search meets too many pairs (pair_budget.hpp), or `stop` ends a search
// (stop_scope.hpp), it returns the report of a rejected step instead.
template <class Take>
StepReport bounded_step(const std::string& by, const StopFlag& stop, Take&& take) {
  StepReport rejected;
  rejected.by = by;
  std::optional<StopScope> scope;
  if (stop) scope.emplace(stop);
  try {
    return take();
  } catch (const TooManyPairs&) {
    reject(Reason::too_many_pairs, rejected);
  } catch (const Stopped&) {
    reject(Reason::stopped, rejected);
  }
  return rejected;
}

}  // namespace selvedge
