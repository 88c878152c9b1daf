#pragma once

#include "pipeline/compare/comparison.hpp"

namespace selvedge {

// Adds the scenes of a training file's people: everything that one wears with every clip, in turn, as the file of
// `sequences` has the scene, of the split that is asked for. A scene is of the latest split of its person, of what is
// worn and of its clip. At most `count` of them, where that is above 0, spread over all. Throws Error where there are
// none.
void add_training_sequences(Comparison&);

}  // namespace selvedge
