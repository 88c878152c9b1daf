#pragma once

#include "physics/energies/measures.hpp"
#include "pipeline/hdf5/trajectory_hdf5.hpp"
#include "pipeline/run/simulate.hpp"

namespace selvedge {

// The data of a frame for a trajectory. Positions are rounded to float first; audit, stretches and energies are those
// of the rounded positions, which a reader gets. A frame that has its audit is not audited again.
Frame record_frame(const Scene&, const EnergyTerms&, const FrameEvent&);

// Frame 0: the state before any step.
Frame record_initial(const Scene&, const EnergyTerms&, const State&, const Drive&);

}  // namespace selvedge
