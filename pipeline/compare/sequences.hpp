#pragma once

#include "pipeline/compare/comparison.hpp"

namespace selvedge {

// Adds the scenes of `sequences`: sequence n has outfit n and, once each outfit has had a clip, the next clip; every
// second one is tangled until there are enough, or every one. A tangled one starts where `tangled_place`
// (training_roll.hpp) finds 20 pairs or more: layers without their gap, soft tissue that does not give way, a body
// shape of a wide spread. Throws Error for outfits and clips that are unknown, and where tangled ones begin on bodies
// with which a bare network was trained. Takes seconds for garments that are not in the cache.
void add_sequences(Comparison&);

}  // namespace selvedge
