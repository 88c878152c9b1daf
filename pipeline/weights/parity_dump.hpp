#pragma once

#include <filesystem>
#include <vector>

#include "learned/graph/graph_state.hpp"
#include "learned/network/architecture.hpp"
#include "pipeline/formats/npz.hpp"

namespace selvedge {

// One step of the authors' code, in the layout of the parity pack (docs/weights.md lists the arrays): the inputs of
// their model as our scene and state, and the file with its results.
struct ParityDump {
  Npz file;
  GraphScene scene;
  GraphState state;
  std::vector<int> centres;  // of the coarse levels, one per component that has them
  bool gathered = false;     // statistics took this step's features first; arrays after_* hold the new sums
};

// Throws Error, which names file and array, for an array that is missing, of another shape, or with indices outside of
// its mesh, and where the recorded coarse edges follow from no centre.
ParityDump read_parity_dump(const std::filesystem::path&, const Architecture&);

}  // namespace selvedge
