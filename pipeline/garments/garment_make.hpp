#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "pipeline/garments/garment_cut.hpp"

namespace selvedge {

// Length that edges have, and the distance that a garment keeps from those under it [m].
struct GarmentOptions {
  double edge = 0.02;
  double gap = 0.008;
};

// A garment by code for the mannequin, over others in the order in which they are put on; docs/garments.md has the
// recipe. Manifold and free of intersections with itself, the mannequin and those under it, in the zero pose and shape.
// The same bits on one machine and build; takes seconds. Throws Error for a name that garment_cuts lacks and for edges
// that are not from 5 mm to 5 cm.
Garment make_garment(const std::string& name, const BodyModel& mannequin, const GarmentOptions& = {},
                     std::span<const std::string> under = {});

// To be raised with every change of what make_garment makes, so that no file of an older one is used.
constexpr int garment_recipe = 3;

// The same from a file in the folder, which is made and written where there is none or none that can be read; made
// anew for an empty path. Throws Error as well if it cannot be written.
Garment kept_garment(const std::filesystem::path& folder, const std::string& name, const BodyModel& mannequin,
                     const GarmentOptions& = {}, std::span<const std::string> under = {});

std::vector<std::string> garment_names();

}  // namespace selvedge
