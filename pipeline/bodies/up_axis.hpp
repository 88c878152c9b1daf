#pragma once

#include <string>
#include <vector>

#include "pipeline/bodies/body.hpp"

namespace selvedge {

enum class Up { y, z };

// Coordinates with y up: as they are, or turned by -90 degrees about x.
Points with_y_up(const Points& x, Up);

// The body with its rest shape and its directions of shapes turned so that y is up. Its joints follow. It must have no
// pose directions.
void turn_y_up(Up, BodyModel&);

// Whether a body stands along z: its head is farther from its pelvis along z than along y. Where it lacks those joints
// of SMPL, whether it is more than 1.5 times as long along z as along y.
bool stands_along_z(const BodyModel&);

// Adds a warning where it does. `name` is the file's.
void warn_of_axis(const std::string& name, const BodyModel&, std::vector<std::string>& warnings);

}  // namespace selvedge
