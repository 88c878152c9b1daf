#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "pipeline/garments/garment_cut.hpp"

namespace selvedge {

// How the program makes a garment.
struct GarmentOptions {
  double edge = 0.02;  // edge length [m]
  double gap = 0.008;  // distance of a garment from those under it [m]
};

// Makes a garment for the mannequin, over others in the order in which they are put on; docs/garments.md has the
// recipe. It is manifold and free of intersections with itself, the mannequin and garments under it, in the zero pose
// and shape. The same bits on one machine and build; takes seconds. Throws Error for a name that garment_cuts lacks and
// for edges outside 5 mm to 5 cm.
Garment make_garment(const std::string& name, const BodyModel& mannequin, const GarmentOptions& = {},
                     std::span<const std::string> under = {});

// Raise this with every change of the garments, so that files of older ones are not used.
constexpr int garment_recipe = 3;

// The same from a file in the folder. If there is no readable one, it is made and written. With an empty path it is
// made anew. Throws Error also if the file cannot be written.
Garment kept_garment(const std::filesystem::path& folder, const std::string& name, const BodyModel& mannequin,
                     const GarmentOptions& = {}, std::span<const std::string> under = {});

std::vector<std::string> garment_names();

}  // namespace selvedge
