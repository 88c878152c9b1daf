#pragma once

#include <string>
#include <vector>

#include "pipeline/garments/garment.hpp"

namespace selvedge {

// A boundary loop of a garment, named by where on the body it lies; docs/garments.md has the rules.
struct NamedLoop {
  std::string name;           // cuff_left, hem_2, ...: once in a garment
  std::vector<int> vertices;  // ascending
  bool holds_up = false;      // the waist of a piece that would fall: nothing of it is above the shoulder joints
};

// Where the boundary loops of a garment lie, piece by piece, by its weights and its place in the body's zero pose.
// Names that are `taken` are not given again.
std::vector<NamedLoop> named_loops(const SkinnedSurface&, const BodyModel&, const std::vector<std::string>& taken);

// The vertices of the groups that an option --pin names, ascending, each once. Throws Error for a group that the
// garment has not.
std::vector<int> pins_of(const Garment&, const std::vector<std::string>& groups);

}  // namespace selvedge
