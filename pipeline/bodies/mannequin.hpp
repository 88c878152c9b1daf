#pragma once

#include <array>
#include <filesystem>

#include "pipeline/bodies/body.hpp"

namespace selvedge {

// What one unit (one standard deviation) of each shape coefficient changes; docs/mannequin.md has the amounts.
inline constexpr std::array mannequin_shapes{"height",    "weight", "leg_length", "arm_length", "shoulder_width",
                                             "hip_width", "waist",  "chest",      "muscle",     "head_size"};

// Height of the pelvis, which is the origin, above the soles in the zero pose and shape [m].
constexpr double mannequin_pelvis_height = 0.94;

// A body of about 7,000 vertices with SMPL's joints in its T-pose and the shapes above: closed, symmetric in X, with
// the pelvis at the origin, the arms along X, left at +X, facing +Z. Without pose directions. Made anew by each call,
// which takes seconds; the same bits on one machine and build. Coefficients are meant to lie within -3 and 3.
BodyModel make_mannequin();

// To be raised with every change of what make_mannequin makes, so that no file of an older one is used.
constexpr int mannequin_recipe = 1;

// The mannequin of a file in the folder, which is made and written where there is none or none that can be read;
// made anew for an empty path. Throws Error if it cannot be written.
BodyModel kept_mannequin(const std::filesystem::path& folder);

}  // namespace selvedge
