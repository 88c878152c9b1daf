#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "pipeline/compare/compare_result.hpp"
#include "pipeline/compare/comparison.hpp"
#include "pipeline/scene/setup.hpp"

namespace selvedge {

// A state of the reference run and where the cloth is one frame and `horizon` frames later, by steps of a 16th of a
// frame (temporal) and by one converged step of implicit Euler a frame (algebraic; empty: it failed). Integrators have
// no history there and start anew; networks go on from it as from a state of their own.
struct CommonState {
  State from;
  Points target, next;
  Points algebraic_target, algebraic_next;
};

struct CompareReference {
  CompareFloor floor;
  std::vector<CommonState> states;
};

// What one setting makes of the common states.
struct CompareErrors {
  std::string trouble;  // empty: nothing
  double algebraic = unknown, algebraic_largest = unknown, temporal = unknown;
  // RMS distances [m], means over the states: temporal_1, algebraic_1, algebraic_end; and l2_mm, e3d of the temporal
  // target.
  std::map<std::string, double> measures = {};
};

using Stop = std::function<bool()>;  // asked after every frame; may be empty

// The run of the scene with steps of a 16th of a frame, its states, and how far it may be trusted. Absent: stopped.
// Throws Error where the reference itself fails, or the run is shorter than the horizon.
std::optional<CompareReference> make_reference(const Comparison&, const CompareScene&, bool short_form, const Stop&);

// The same numbers every time, unless time ends it. Absent: stopped.
std::optional<CompareErrors> errors_of(const Setup&, const CompareReference&, const RowLimits&, const Stop&);

// Energy of a state [J].
double energy_of(const Setup&, const State&);

// A scene of the comparison with further overrides.
Setup read_compared(const CompareScene&, bool short_form, const std::vector<std::string>& overrides,
                    const Kinds& = known_kinds());

}  // namespace selvedge
