#pragma once

#include <filesystem>
#include <vector>

#include "learned/graph/graph_state.hpp"
#include "learned/network/architecture.hpp"
#include "pipeline/formats/npz.hpp"

namespace selvedge {

// One step that the authors' code took, in the layout of the parity pack (docs/weights.md lists the arrays): what their
// model was given, as a scene and a state of ours, and the file with what it computed.
struct ParityDump {
  Npz file;
  GraphScene scene;
  GraphState state;
  std::vector<int> centres;  // of the coarse levels, one a component that has them
  bool gathered = false;     // statistics took this step's features first; arrays after_* say what their sums became
};

// Throws Error, naming file and array, for an array that is missing, of another shape, or of indices outside of their
// mesh; and where no vertex is a centre from which the recorded coarse edges follow.
ParityDump read_parity_dump(const std::filesystem::path&, const Architecture&);

}  // namespace selvedge
