#pragma once

#include <string>
#include <vector>

#include "pipeline/garments/garment.hpp"

namespace selvedge {

// A boundary loop of a garment, named by its place on the body; docs/garments.md has the rules.
struct NamedLoop {
  std::string name;           // cuff_left, hem_2, ...: unique in a garment
  std::vector<int> vertices;  // ascending
  bool holds_up = false;      // the waist of a piece that would fall, since nothing of it is above the shoulder joints
};

// The named boundary loops of a garment, piece by piece. Places follow from its weights and its positions in the body's
// zero pose. Names in `taken` are not used again.
std::vector<NamedLoop> named_loops(const SkinnedSurface&, const BodyModel&, const std::vector<std::string>& taken);

// The vertices of the groups that an option --pin names, ascending, each once. Throws Error for a group that the
// garment lacks.
std::vector<int> pins_of(const Garment&, const std::vector<std::string>& groups);

}  // namespace selvedge
