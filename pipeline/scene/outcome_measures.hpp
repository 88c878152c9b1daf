#pragma once

#include "pipeline/scene/outcome.hpp"

namespace selvedge {

// What the measures of outcome.hpp come to in one frame.
double measured(const OutsideBox&, const Scene&, const State&, const Drive&);
double measured(const PartsApart&, const Scene&, const State&, const Drive&);
double measured(const Disorder&, const Scene&, const State&, const Drive&);
double measured(const Ahead&, const Scene&, const State&, const Drive&);
double measured(const LargestStretch&, const Scene&, const State&, const Drive&);
double measured(const Lag&, const Scene&, const State&, const Drive&);
double measured(const WantedPairs&, const Scene&, const State&, const Drive&);

double turned(const Turns&, const Points& before, const Points& now);  // from one frame to the next, under half a turn
double drift(const Drift&, const Points& start, const Points& now);

// Largest distance of a vertex of obstacle k from where it was wanted [m].
double obstacle_lag(const State&, const Drive&, std::size_t k);

}  // namespace selvedge
