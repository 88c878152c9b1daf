#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "pipeline/compare/compare_result.hpp"
#include "pipeline/compare/comparison.hpp"
#include "pipeline/scene/setup.hpp"

namespace selvedge {

// A state of the reference run and where the cloth is `horizon` frames later. It has no history: every integrator
// starts anew.
struct CommonState {
  State from;
  Points target;
};

struct CompareReference {
  CompareFloor floor;
  std::vector<CommonState> states;
};

// What one setting makes of the common states.
struct CompareErrors {
  std::string trouble;  // empty: nothing
  double algebraic = unknown, algebraic_largest = unknown, temporal = unknown;
};

using Stop = std::function<bool()>;  // asked after every frame; may be empty

// The run of the scene with steps of a 16th of a frame, its states, and how far it may be trusted. Absent: stopped.
// Throws Error where the reference itself fails, or the run is shorter than the horizon.
std::optional<CompareReference> make_reference(const Comparison&, const CompareScene&, bool short_form, const Stop&);

// The same numbers every time. Absent: stopped.
std::optional<CompareErrors> errors_of(const Setup&, const CompareReference&, const Stop&);

// Energy of a state [J].
double energy_of(const Setup&, const State&);

// A scene of the comparison with further overrides.
Setup read_compared(const CompareScene&, bool short_form, const std::vector<std::string>& overrides,
                    const Kinds& = known_kinds());

}  // namespace selvedge
