#pragma once

#include <map>
#include <ostream>
#include <string>

#include "pipeline/compare/comparison.hpp"
#include "pipeline/training/training_roll.hpp"

namespace selvedge {

// Adds the scenes of `sequences`: sequence n has outfit n and, once each outfit has had a clip, the next clip; every
// second one is tangled until there are enough, or every one. A tangled one has yet to be given its start by
// find_start. Throws Error for outfits that are unknown, and where tangled ones begin on bodies with which a bare
// network was trained.
void add_sequences(Comparison&);

// What searches for tangled starts share, by outfit: bodies, garments and clips.
struct TangledSearch {
  std::map<std::string, RollMaker> makers;
};

// Gives a tangled sequence its start, and does nothing to other scenes. It starts where `tangled_place`
// (training_roll.hpp) finds 20 pairs or more: layers without their gap, soft tissue that does not give way, a body
// shape of a wide spread. The search takes about a second, and some more for an outfit's first one. What it finds is
// kept in the cache folder, for the same program (program_key) and options; the log (or null) says why it cannot be
// kept. Throws Error for clips that are unknown.
void find_start(const Comparison&, const std::string& program, std::ostream* log, TangledSearch&, CompareScene&);

}  // namespace selvedge
