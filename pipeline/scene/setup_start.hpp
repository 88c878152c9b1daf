#pragma once

#include <functional>

#include "physics/scene/scene.hpp"
#include "physics/scene/stepper.hpp"
#include "pipeline/scene/cloth_part.hpp"

namespace selvedge {

// Puts a placed cloth where its `start` section has it. One that then starts in one point, an exact equilibrium of any
// membrane, is opened by random displacements of a thousandth of its mean edge; a warning says so.
void apply_start(const Config& section, ClothPart&, std::vector<std::string>& warnings);

// Where the scene's garments are to be draped, lets its time begin before 0 and puts them on their bodies as they are
// then. Returns how many frames before.
int begin_draped(const Performances&, double fps, std::vector<ClothPart>&);

// Where garments are to start by cutting, cuts their tangled triangles out of the scene's state at time 0.
void begin_cut(const std::vector<ClothPart>&, const Scene&, State&);

// Drive::skinned_targets of the scene at a time [s]; empty if it has no garment.
std::function<Points(double time)> skinned_targets_of(const std::vector<ClothPart>&, const Scene&);

}  // namespace selvedge
