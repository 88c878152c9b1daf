#pragma once

#include <array>
#include <filesystem>

#include "pipeline/bodies/body.hpp"

namespace selvedge {

// The names of the shape coefficients; one unit is a standard deviation (amounts in docs/mannequin.md).
inline constexpr std::array mannequin_shapes{"height",    "weight", "leg_length", "arm_length", "shoulder_width",
                                             "hip_width", "waist",  "chest",      "muscle",     "head_size"};

// Height of the pelvis, which is the origin, above the soles in the zero pose and shape [m].
constexpr double mannequin_pelvis_height = 0.94;

// A body of about 7,000 vertices with SMPL's joints in its T-pose and the shapes above: closed, symmetric in X, with
// the pelvis at the origin, the arms along X, left at +X, facing +Z. Without pose directions. Each call makes it anew,
// which takes seconds; the same bits on one machine and build. Shape coefficients should be between -3 and 3.
BodyModel make_mannequin();

// Raise this with every change of the mannequin, so that files of older ones are not used.
constexpr int mannequin_recipe = 1;

// The mannequin from a file in the folder. If there is no readable one, it is made and written. With an empty path it
// is made anew. Throws Error if it cannot be written.
BodyModel kept_mannequin(const std::filesystem::path& folder);

}  // namespace selvedge
