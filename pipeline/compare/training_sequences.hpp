#pragma once

#include "pipeline/compare/comparison.hpp"

namespace selvedge {

// Adds the scenes of a training file's people: everything that one wears with every clip, in turn, as the file of
// `sequences` has the scene, of the split that is asked for. A scene is of the latest split of its person, of what is
// worn and of its clip. At most `count` of them, where that is above 0, spread over all. Throws Error where there are
// none, and where a setting's weights say that they were trained on what is held out in one of these. Says in
// `split_text` what is held out and what weights were trained on, with a warning of those that do not say it.
void add_training_sequences(Comparison&);

}  // namespace selvedge
