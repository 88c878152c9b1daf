#pragma once

#include <string>
#include <vector>

#include "physics/scene/scene.hpp"
#include "physics/scene/stepper.hpp"
#include "pipeline/scene/cloth_part.hpp"

// What is allowed in a scene and will hardly come out as meant.
namespace selvedge {

// Neighbours of a triangle lie within its smallest altitude: a thicker cloth pushes them apart at rest.
void warn_of_thickness(const Scene&, std::vector<std::string>& warnings);

// Frames are stored and audited as 32-bit floats, which far from the origin are too coarse for layers of cloth.
void warn_of_rounding(const Scene&, const Points& x, const std::vector<Points>& obstacles,
                      std::vector<std::string>& warnings);

// Pins that start inside closed obstacles, which nothing can bring out: how many of which cloth and which pin.
void warn_of_pins_inside(const std::vector<ClothPart>&, const Scene&, const Points& x,
                         const std::vector<Points>& obstacles, std::vector<std::string>& warnings);

// Pins whose keyframes move them in one frame farther than their cloth is large: it cannot follow, and its steps take
// long.
void warn_of_fast_pins(const std::vector<ClothPart>&, double fps, int frames, std::vector<std::string>& warnings);

// Wind that is faster than any storm [m/s].
void warn_of_storm(const std::vector<Vec3>& wind, std::vector<std::string>& warnings);

}  // namespace selvedge
